//! UF2: blocks that a boot loader takes as a file dropped onto its drive.
//!
//! Written from the published description at <https://github.com/microsoft/uf2>: each block
//! of 512 bytes stands for itself, with 256 bytes of the image and their address.

use super::family::Family;
use super::placement::{self, PlacementError};

/// Bytes of one block.
pub const BLOCK: usize = 512;

/// Bytes of the image in one block: the one size that every boot loader takes.
pub const PAYLOAD: u32 = 256;

/// What erased flash holds; fills up the last block.
const ERASED: u8 = 0xff;

const MAGIC: [u32; 2] = [0x0a32_4655, 0x9e5d_5157];
const END_MAGIC: [u8; 4] = 0x0ab1_6f30_u32.to_le_bytes();
const FAMILY_ID_PRESENT: u32 = 0x2000;

/// The image at its address, filled up with `0xff` to a multiple of `unit` bytes.
///
/// `unit`, a multiple of [`PAYLOAD`], is the size of an erase sector where that is known: a
/// Pico's boot loader may lose parts of a sector that is not filled (erratum RP2040-E14).
///
/// # Errors
///
/// An address that is no multiple of [`PAYLOAD`], or bytes past the 32-bit address space.
pub fn encode(
    image: &[u8],
    address: u32,
    family: Family,
    unit: u32,
) -> Result<Vec<u8>, PlacementError> {
    let end = (u64::from(address) + image.len() as u64).next_multiple_of(u64::from(unit));
    let length = (end - u64::from(address)) as usize;
    placement::check(address, length, PAYLOAD, "a UF2 block holds one page of flash")?;
    let mut filled = image.to_vec();
    filled.resize(length, ERASED);
    let pages = filled.chunks(PAYLOAD as usize);
    let blocks = pages.len() as u32;
    let mut file = Vec::with_capacity(pages.len() * BLOCK);
    for (number, page) in (0_u32..).zip(pages) {
        let at = address + number * PAYLOAD;
        let [first, second] = MAGIC;
        let header = [first, second, FAMILY_ID_PRESENT, at, PAYLOAD, number, blocks, family.id()];
        file.extend(header.iter().flat_map(|word| word.to_le_bytes()));
        file.extend(page);
        // The room past the page is padded with 0xff too.
        file.resize(BLOCK * (number as usize + 1) - END_MAGIC.len(), ERASED);
        file.extend(END_MAGIC);
    }
    Ok(file)
}

#[cfg(test)]
mod tests;

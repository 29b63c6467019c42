//! `cargo xtask uf2`: a real board's program as a file to drop onto the drive of its boot loader.
//!
//! Written from the published description at <https://github.com/microsoft/uf2> and the RP2350 data sheet. Nothing is
//! written that the boot ROM would not start.

mod image;

use std::path::PathBuf;

use crate::boards::{self, Drive};
use crate::elf;
use crate::failure::Failure;
use crate::firmware;
use crate::options::Options;
use image::{Image, SECTOR};

/// Bytes of flash in one block.
const PAGE: u32 = 256;

/// First and last word of a block, and its length.
const MAGIC: [u32; 2] = [0x0a32_4655, 0x9e5d_5157];
const END_MAGIC: u32 = 0x0ab1_6f30;
const BLOCK: usize = 512;

/// Flags: the block names a family; the block has tags after its page.
const FAMILY_ID_PRESENT: u32 = 0x2000;
const EXTENSION_TAGS_PRESENT: u32 = 0x8000;

/// The family of blocks that are written where they say, whatever partitions the flash has.
const ABSOLUTE: u32 = 0xe48b_ff57;

/// `RP2_IGNORE_BLOCK`: chips whose boot ROM is mended leave the block out (data sheet, RP2350-E10).
const IGNORE_BLOCK: u32 = 0x9957_e304;

/// Builds the boards named, or every board that has such a drive, and prints the path of each file.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    for board in boards::chosen_real(options)? {
        println!("{}", make(board, options)?.display());
    }
    Ok(())
}

/// Builds a board's program and writes the file beside it.
pub(crate) fn make(board: &boards::Real, options: &Options) -> Result<PathBuf, Failure> {
    let program = firmware::build_program(&board.program, options)?;
    let failed = |why: String| Failure::failed(format!("{}: {why}", program.display()));
    let bytes = std::fs::read(&program).map_err(|error| failed(error.to_string()))?;
    let segments = elf::segments(&bytes).map_err(|why| failed(why.into()))?;
    let address = |name| elf::address(&bytes, name).map_err(|why| failed(why.into()));
    let flash = &board.drive.flash;
    let room = flash.start..address("_weights_start")?.unwrap_or(flash.end);
    let image = Image::of(&segments, &room).map_err(|why| failed(why.to_string()))?;
    image.check_boots().map_err(|why| failed(why.to_string()))?;
    let weights_end = address("_weights_end")?.unwrap_or(flash.start);
    if weights_end > last_page(&board.drive) / SECTOR * SECTOR {
        return Err(failed("the file would erase the last sector of the weights".into()));
    }
    let file = program.with_extension("uf2");
    std::fs::write(&file, encode(&image, &board.drive))
        .map_err(|error| Failure::failed(format!("cannot write {}: {error}", file.display())))?;
    Ok(file)
}

/// The blocks: one that wakes the flash of chips with erratum RP2350-E10, then the pages of the program.
fn encode(image: &Image, drive: &Drive) -> Vec<u8> {
    let mut file = Vec::new();
    // The data sheet asks for number 0 of 2, so that the chip goes on waiting for the program.
    let wake = [0xef; PAGE as usize];
    block(&mut file, last_page(drive), [0, 2], ABSOLUTE, &wake, Some(IGNORE_BLOCK));
    let pages = image.pages();
    let count = pages.len() as u32;
    for (number, (address, page)) in (0..count).zip(pages) {
        block(&mut file, address, [number, count], drive.family, page, None);
    }
    file
}

/// Where the waking block goes: what is at the end of flash.
fn last_page(drive: &Drive) -> u32 {
    drive.flash.end - PAGE
}

/// Appends one block: `[number, count]` among those of its family, one page, and perhaps a tag without data.
fn block(
    file: &mut Vec<u8>,
    address: u32,
    [number, count]: [u32; 2],
    family: u32,
    page: &[u8],
    tag: Option<u32>,
) {
    let start = file.len();
    let [first, second] = MAGIC;
    let flags = FAMILY_ID_PRESENT | if tag.is_some() { EXTENSION_TAGS_PRESENT } else { 0 };
    let header = [first, second, flags, address, PAGE, number, count, family];
    file.extend(header.iter().flat_map(|word| word.to_le_bytes()));
    file.extend(page);
    file.extend(tag.iter().flat_map(|tag| tag.to_le_bytes()));
    file.resize(start + BLOCK - 4, 0);
    file.extend(END_MAGIC.to_le_bytes());
}

#[cfg(test)]
mod tests;

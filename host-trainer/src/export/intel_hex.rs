//! Intel HEX: bytes and their address as text.

use ihex::{Record, create_object_file_representation};

use super::placement::{self, PlacementError};

/// Data bytes per line; what most tools write.
const LINE: usize = 16;

/// The image at its address, with an extended linear address record wherever bits 16 and up
/// of the address change.
///
/// # Errors
///
/// An address that is no multiple of 4, or bytes past the 32-bit address space.
pub fn encode(image: &[u8], address: u32) -> Result<String, PlacementError> {
    placement::check(address, image.len(), 4, "the car reads the words in place")?;
    let mut records = Vec::new();
    let mut upper_before = None;
    let mut at = address;
    let mut rest = image;
    while !rest.is_empty() {
        let upper = (at >> 16) as u16;
        if upper_before != Some(upper) {
            records.push(Record::ExtendedLinearAddress(upper));
            upper_before = Some(upper);
        }
        let offset = at as u16;
        // A record that crossed into the next 64 KiB would wrap to the start of this one.
        let to_the_border = usize::from(u16::MAX - offset) + 1;
        let (line, after) = rest.split_at(LINE.min(to_the_border).min(rest.len()));
        records.push(Record::Data { offset, value: line.to_vec() });
        // Wraps only after a last line that ends with the address space.
        at = at.wrapping_add(line.len() as u32);
        rest = after;
    }
    records.push(Record::EndOfFile);
    Ok(create_object_file_representation(&records)
        .expect("lines are short and the end is at the end"))
}

#[cfg(test)]
mod tests;

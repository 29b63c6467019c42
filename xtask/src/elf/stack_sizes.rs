//! What the compiler says each function takes of the stack: the section `.stack_sizes`.

use std::collections::BTreeMap;

use super::{CUT, section, word};

/// Bytes by the function's address; empty where the program was built without the record.
///
/// The section is a row of entries: the address as a word, then the size as a ULEB128 number.
pub(crate) fn stack_sizes(elf: &[u8]) -> Result<BTreeMap<u32, u32>, &'static str> {
    let mut rest = section(elf, ".stack_sizes")?.unwrap_or_default();
    let mut sizes = BTreeMap::new();
    while !rest.is_empty() {
        let address = word(rest, 0).ok_or(CUT)? & !1;
        let (size, length) = uleb128(rest.get(4..).ok_or(CUT)?).ok_or(CUT)?;
        // A function that the linker removed leaves an entry for address 0.
        if address != 0 {
            sizes.insert(address, size);
        }
        rest = rest.get(4 + length..).ok_or(CUT)?;
    }
    Ok(sizes)
}

/// The number, and how many bytes it takes; none past 32 bits.
fn uleb128(bytes: &[u8]) -> Option<(u32, usize)> {
    let mut value = 0;
    for (index, byte) in bytes.iter().enumerate().take(5) {
        value |= u64::from(byte & 0x7f) << (7 * index);
        if byte & 0x80 == 0 {
            return Some((u32::try_from(value).ok()?, index + 1));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_those_of_the_dwarf_standard() {
        // DWARF 5, table of examples in section 7.6.
        for (bytes, value) in [
            (&[0x02][..], 2),
            (&[0x7f], 127),
            (&[0x80, 1], 128),
            (&[0x81, 1], 129),
            (&[0xb9, 0x64], 12857),
        ] {
            assert_eq!(uleb128(bytes), Some((value, bytes.len())));
        }
        assert_eq!(uleb128(&[0x80]), None, "cut");
        assert_eq!(uleb128(&[0xff, 0xff, 0xff, 0xff, 0x7f]), None, "more than 32 bits");
    }
}

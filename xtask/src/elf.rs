//! The few fields of a 32-bit little-endian ELF file that tell how much memory a program takes.

/// Bytes a program takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Size {
    /// Code, constants and the initial values of variables.
    pub(crate) flash: u64,
    /// Variables, initialised or zeroed; the stack is not in it.
    pub(crate) ram: u64,
}

const SECTION_NOBITS: u32 = 8;
const FLAG_WRITE: u32 = 1;
const FLAG_ALLOC: u32 = 2;

/// What `riscv-rt` calls the memory left over; a section there, but nobody's variables.
const LEFT_OVER: [&[u8]; 2] = [b".stack\0", b".heap\0"];

/// Adds up the sections that are loaded or reserved on the device.
pub(crate) fn size(elf: &[u8]) -> Result<Size, &'static str> {
    const CUT: &str = "the ELF file is cut short";
    if !elf.starts_with(b"\x7fELF\x01\x01") {
        return Err("not a 32-bit little-endian ELF file");
    }
    let table = word(elf, 32).ok_or(CUT)? as usize;
    let entry_size = half(elf, 46).ok_or(CUT)?;
    let count = half(elf, 48).ok_or(CUT)?;
    let names = half(elf, 50).ok_or(CUT)?;
    let names = word(elf, table + names * entry_size + 16).ok_or(CUT)? as usize;
    let mut size = Size::default();
    for index in 0..count {
        let section = table + index * entry_size;
        let field = |offset| word(elf, section + offset).ok_or(CUT);
        let (kind, flags, bytes) = (field(4)?, field(8)?, u64::from(field(20)?));
        let name = elf.get(names + field(0)? as usize..).ok_or(CUT)?;
        if flags & FLAG_ALLOC == 0 || LEFT_OVER.iter().any(|other| name.starts_with(other)) {
            continue;
        }
        let (stored, variable) = (kind != SECTION_NOBITS, flags & FLAG_WRITE != 0);
        size.flash += if stored { bytes } else { 0 };
        size.ram += if variable { bytes } else { 0 };
    }
    Ok(size)
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    bytes.get(at..at + 4)?.try_into().ok().map(u32::from_le_bytes)
}

fn half(bytes: &[u8], at: usize) -> Option<usize> {
    Some(u16::from_le_bytes(bytes.get(at..at + 2)?.try_into().ok()?).into())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where each name starts among the names.
    const UNNAMED: u32 = 0;
    const STACK: u32 = 1;

    /// A header and one entry per `(name, type, flags, size)`; the first holds the names.
    fn elf(sections: &[(u32, u32, u32, u32)]) -> Vec<u8> {
        let mut file = vec![0; 52];
        file[..6].copy_from_slice(b"\x7fELF\x01\x01");
        file[32..36].copy_from_slice(&60u32.to_le_bytes());
        file[46..48].copy_from_slice(&40u16.to_le_bytes());
        file[48..50].copy_from_slice(&(sections.len() as u16).to_le_bytes());
        file.extend(b"\0.stack\0");
        for (name, kind, flags, size) in sections {
            let mut entry = [0; 40];
            entry[..4].copy_from_slice(&name.to_le_bytes());
            entry[4..8].copy_from_slice(&kind.to_le_bytes());
            entry[8..12].copy_from_slice(&flags.to_le_bytes());
            entry[16..20].copy_from_slice(&52u32.to_le_bytes());
            entry[20..24].copy_from_slice(&size.to_le_bytes());
            file.extend(entry);
        }
        file
    }

    #[test]
    fn initialised_variables_count_in_flash_and_in_ram_and_debug_data_nowhere() {
        let code = (UNNAMED, 1, 6, 1000);
        let constants = (UNNAMED, 1, 2, 200);
        let initialised = (UNNAMED, 1, 3, 30);
        let zeroed = (UNNAMED, 8, 3, 4);
        let debug = (UNNAMED, 1, 0, 9999);
        let sections = [code, constants, initialised, zeroed, debug];
        assert_eq!(size(&elf(&sections)), Ok(Size { flash: 1230, ram: 34 }));
    }

    #[test]
    fn memory_left_for_the_stack_is_not_static() {
        let zeroed = (UNNAMED, 8, 3, 4);
        let stack = (STACK, 8, 3, 4 << 20);
        assert_eq!(size(&elf(&[zeroed, stack])), Ok(Size { flash: 0, ram: 4 }));
    }

    #[test]
    fn a_cut_or_foreign_file_is_refused() {
        let whole = elf(&[(UNNAMED, 1, 6, 1000)]);
        for length in 6..whole.len() - 16 {
            assert!(size(&whole[..length]).is_err(), "{length} bytes were accepted");
        }
        assert_eq!(size(b"MZ"), Err("not a 32-bit little-endian ELF file"));
    }
}

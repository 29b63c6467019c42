//! The few fields of a 32-bit little-endian ELF file that tell what a program loads, how much memory it takes,
//! where the linker put a name, and which code belongs to which function.

mod functions;
mod stack_sizes;

pub(crate) use functions::{Function, functions};
pub(crate) use stack_sizes::stack_sizes;

/// Bytes a program takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Size {
    /// Code, constants and the initial values of variables.
    pub(crate) flash: u64,
    /// Variables, initialised or zeroed; the stack is not in it.
    pub(crate) ram: u64,
}

const SEGMENT_LOAD: u32 = 1;
const SECTION_SYMBOLS: u32 = 2;
const SECTION_NOBITS: u32 = 8;
const FLAG_WRITE: u32 = 1;
const FLAG_ALLOC: u32 = 2;
const SYMBOL_BYTES: usize = 16;
const CUT: &str = "the ELF file is cut short";

/// What `riscv-rt` calls the memory left over; a section there, but nobody's variables.
const LEFT_OVER: [&[u8]; 2] = [b".stack\0", b".heap\0"];

/// Adds up the sections that are loaded or reserved on the device.
pub(crate) fn size(elf: &[u8]) -> Result<Size, &'static str> {
    let sections = sections(elf)?;
    let names = sections.get(half(elf, 50).ok_or(CUT)?).ok_or(CUT)?.file_offset;
    let mut size = Size::default();
    for section in sections {
        let name = elf.get(names + section.name..).ok_or(CUT)?;
        if section.flags & FLAG_ALLOC == 0 || LEFT_OVER.iter().any(|other| name.starts_with(other))
        {
            continue;
        }
        let (stored, variable) = (section.kind != SECTION_NOBITS, section.flags & FLAG_WRITE != 0);
        size.flash += if stored { section.bytes as u64 } else { 0 };
        size.ram += if variable { section.bytes as u64 } else { 0 };
    }
    Ok(size)
}

/// The address of a name, if the program has it.
pub(crate) fn address(elf: &[u8], name: &str) -> Result<Option<u32>, &'static str> {
    let found = symbols(elf)?.into_iter().find(|symbol| symbol.name == name.as_bytes());
    Ok(found.map(|symbol| symbol.value))
}

/// The instruction set, as the header's `e_machine` states it.
pub(crate) fn machine(elf: &[u8]) -> Result<u16, &'static str> {
    sections(elf)?;
    half(elf, 18).ok_or(CUT).map(|machine| machine as u16)
}

/// The bytes of the first section with this name.
pub(crate) fn section<'a>(elf: &'a [u8], name: &str) -> Result<Option<&'a [u8]>, &'static str> {
    let sections = sections(elf)?;
    let names = sections.get(half(elf, 50).ok_or(CUT)?).ok_or(CUT)?.file_offset;
    for section in sections.iter().filter(|section| section.kind != SECTION_NOBITS) {
        if text(elf, names + section.name)? == name.as_bytes() {
            let end = section.file_offset + section.bytes;
            return elf.get(section.file_offset..end).ok_or(CUT).map(Some);
        }
    }
    Ok(None)
}

/// Bytes that a loader puts into memory before the program starts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Segment<'a> {
    /// Where they are stored: flash, also for variables that start-up code copies to RAM.
    pub(crate) address: u32,
    /// The bytes.
    pub(crate) bytes: &'a [u8],
}

/// What is loaded from the file, in its order; memory that is only reserved is left out.
pub(crate) fn segments(elf: &[u8]) -> Result<Vec<Segment<'_>>, &'static str> {
    check_kind(elf)?;
    let table = word(elf, 28).ok_or(CUT)? as usize;
    let entry_size = half(elf, 42).ok_or(CUT)?;
    let count = half(elf, 44).ok_or(CUT)?;
    let mut segments = Vec::new();
    for index in 0..count {
        let field = |offset| word(elf, table + index * entry_size + offset).ok_or(CUT);
        let (kind, address) = (field(0)?, field(12)?);
        let (start, length) = (field(4)? as usize, field(16)? as usize);
        if kind == SEGMENT_LOAD && length > 0 {
            let bytes = elf.get(start..start + length).ok_or(CUT)?;
            segments.push(Segment { address, bytes });
        }
    }
    Ok(segments)
}

/// One row of the symbol table.
struct Symbol<'a> {
    name: &'a [u8],
    value: u32,
    bytes: u32,
    kind: u8,
    section: usize,
}

fn symbols(elf: &[u8]) -> Result<Vec<Symbol<'_>>, &'static str> {
    let sections = sections(elf)?;
    let mut symbols = Vec::new();
    for table in sections.iter().filter(|section| section.kind == SECTION_SYMBOLS) {
        let names = sections.get(table.link).ok_or(CUT)?.file_offset;
        for at in (0..table.bytes / SYMBOL_BYTES).map(|i| table.file_offset + i * SYMBOL_BYTES) {
            let field = |offset| word(elf, at + offset).ok_or(CUT);
            symbols.push(Symbol {
                name: text(elf, names + field(0)? as usize)?,
                value: field(4)?,
                bytes: field(8)?,
                kind: *elf.get(at + 12).ok_or(CUT)? & 0x0f,
                section: half(elf, at + 14).ok_or(CUT)?,
            });
        }
    }
    Ok(symbols)
}

/// The bytes before the zero that ends a name.
fn text(elf: &[u8], at: usize) -> Result<&[u8], &'static str> {
    let rest = elf.get(at..).ok_or(CUT)?;
    let end = rest.iter().position(|byte| *byte == 0).ok_or(CUT)?;
    Ok(&rest[..end])
}

/// One row of the section table.
struct Section {
    name: usize,
    kind: u32,
    flags: u32,
    address: u32,
    file_offset: usize,
    bytes: usize,
    link: usize,
}

fn sections(elf: &[u8]) -> Result<Vec<Section>, &'static str> {
    check_kind(elf)?;
    let table = word(elf, 32).ok_or(CUT)? as usize;
    let entry_size = half(elf, 46).ok_or(CUT)?;
    let count = half(elf, 48).ok_or(CUT)?;
    (0..count)
        .map(|index| {
            let field = |offset| word(elf, table + index * entry_size + offset).ok_or(CUT);
            Ok(Section {
                name: field(0)? as usize,
                kind: field(4)?,
                flags: field(8)?,
                address: field(12)?,
                file_offset: field(16)? as usize,
                bytes: field(20)? as usize,
                link: field(24)? as usize,
            })
        })
        .collect()
}

fn check_kind(elf: &[u8]) -> Result<(), &'static str> {
    let known = elf.starts_with(b"\x7fELF\x01\x01");
    if known { Ok(()) } else { Err("not a 32-bit little-endian ELF file") }
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
    const WEIGHTS: u32 = 8;
    const NAMES: &[u8] = b"\0.stack\0_weights_start\0";

    /// Two symbols: `weights_start` at 7 and `_weights_start` at 9.
    const SYMBOLS: u32 = 52 + NAMES.len() as u32;

    /// A header, names, two symbols, and one entry per `(name, type, flags, size)`; the first section
    /// also tells where the names lie.
    fn elf(sections: &[(u32, u32, u32, u32)]) -> Vec<u8> {
        let mut file = vec![0; 52];
        file[..6].copy_from_slice(b"\x7fELF\x01\x01");
        file[46..48].copy_from_slice(&40u16.to_le_bytes());
        file[48..50].copy_from_slice(&(sections.len() as u16).to_le_bytes());
        file.extend(NAMES);
        for word in [WEIGHTS + 1, 7, 0, 0, WEIGHTS, 9, 0, 0u32] {
            file.extend(word.to_le_bytes());
        }
        let table = file.len() as u32;
        file[32..36].copy_from_slice(&table.to_le_bytes());
        for (name, kind, flags, size) in sections {
            let offset = if *kind == SECTION_SYMBOLS { SYMBOLS } else { 52 };
            for word in [*name, *kind, *flags, 0, offset, *size, 0, 0, 0, 0] {
                file.extend(word.to_le_bytes());
            }
        }
        file
    }

    #[test]
    fn a_name_is_found_only_as_a_whole() {
        let file = elf(&[(UNNAMED, 1, 6, 1000), (UNNAMED, SECTION_SYMBOLS, 0, 32)]);
        assert_eq!(address(&file, "_weights_start"), Ok(Some(9)));
        assert_eq!(address(&file, "_weights"), Ok(None));
        assert_eq!(address(&file, "_weights_end"), Ok(None));
        for length in 6..file.len() - 12 {
            assert!(address(&file[..length], "_weights_start").is_err(), "{length} bytes");
        }
    }

    #[test]
    fn segments_lie_where_they_are_stored_and_reserved_memory_is_none() {
        let mut file = elf(&[]);
        let table = file.len() as u32;
        file[28..32].copy_from_slice(&table.to_le_bytes());
        file[42..44].copy_from_slice(&32_u16.to_le_bytes());
        file[44..46].copy_from_slice(&3_u16.to_le_bytes());
        // Type, file offset, address in RAM, address in flash, bytes in the file, bytes in memory, flags, alignment.
        for header in [
            [SEGMENT_LOAD, 1, 0x2000_0000, 0x1000_0100, 3, 3, 6, 4],
            [SEGMENT_LOAD, 0, 0x2000_0100, 0x2000_0100, 0, 64, 6, 4],
            [0x7000_0001, 0, 0, 0, 8, 8, 4, 4],
        ] {
            file.extend(header.iter().flat_map(|word: &u32| word.to_le_bytes()));
        }
        let expected = Segment { address: 0x1000_0100, bytes: b"ELF" };
        assert_eq!(segments(&file), Ok(vec![expected]));
        for length in 6..file.len() - 12 {
            assert!(segments(&file[..length]).is_err(), "{length} bytes");
        }
        assert_eq!(segments(b"MZ"), Err("not a 32-bit little-endian ELF file"));
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
        for length in 6..whole.len() - 12 {
            assert!(size(&whole[..length]).is_err(), "{length} bytes were accepted");
        }
        assert_eq!(size(b"MZ"), Err("not a 32-bit little-endian ELF file"));
    }
}

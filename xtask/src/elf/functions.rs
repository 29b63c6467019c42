//! Which instructions belong to which function.

use super::{CUT, Section, sections, symbols};

/// One function, with its instructions.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Function {
    /// As the compiler named it; where several names stand for the same code, the first.
    pub(crate) name: String,
    /// Where it starts; always even.
    pub(crate) address: u32,
    /// From its first instruction to its last, and the constants between them.
    pub(crate) code: Vec<u8>,
    /// Offsets in `code` where constants begin and end.
    pub(crate) constants: Vec<(usize, usize)>,
}

const SYMBOL_FUNCTION: u8 = 2;
const FLAG_EXECUTE: u32 = 4;

/// All functions, by address.
pub(crate) fn functions(elf: &[u8]) -> Result<Vec<Function>, &'static str> {
    let sections = sections(elf)?;
    let holds_code =
        |index: usize| sections.get(index).filter(|section| section.flags & FLAG_EXECUTE != 0);
    let mut starts = Vec::new();
    // Marks of the ABIs: from here on constants (`$d`), from here on instructions (`$t`, `$x`).
    let mut marks = Vec::new();
    for symbol in symbols(elf)? {
        let Some(section) = holds_code(symbol.section) else { continue };
        if symbol.kind == SYMBOL_FUNCTION {
            // The lowest bit of a Thumb function's address tells the processor's state.
            let address = symbol.value & !1;
            let name = String::from_utf8_lossy(symbol.name).into_owned();
            starts.push((address, symbol.bytes, name, section));
        } else if let [b'$', what, ..] = symbol.name {
            marks.push((symbol.value, *what == b'd'));
        }
    }
    starts.sort_by_key(|start| (start.0, std::cmp::Reverse(start.1)));
    starts.dedup_by_key(|start| start.0);
    marks.sort_unstable();
    let mut functions = Vec::new();
    for (index, (address, bytes, name, section)) in starts.iter().enumerate() {
        // Hand-written assembly may not state a length: it ends where the next function starts.
        let next = starts.get(index + 1).map(|start| start.0);
        let end = match bytes {
            0 => next.unwrap_or(u32::MAX).min(section_end(section)),
            bytes => address.checked_add(*bytes).ok_or(CUT)?,
        };
        let code = bytes_between(elf, section, *address, end).ok_or(CUT)?;
        let constants = constants(&marks, *address, end);
        let name = name.clone();
        functions.push(Function { name, address: *address, code: code.to_vec(), constants });
    }
    Ok(functions)
}

fn section_end(section: &Section) -> u32 {
    section.address.saturating_add(section.bytes as u32)
}

fn bytes_between<'a>(elf: &'a [u8], section: &Section, start: u32, end: u32) -> Option<&'a [u8]> {
    let offset = section.file_offset + start.checked_sub(section.address)? as usize;
    (end <= section_end(section)).then_some(())?;
    elf.get(offset..offset + end.checked_sub(start)? as usize)
}

fn constants(marks: &[(u32, bool)], start: u32, end: u32) -> Vec<(usize, usize)> {
    let first = marks.partition_point(|mark| mark.0 < start);
    let mut ranges = Vec::new();
    let mut since = None;
    for (address, constant) in marks[first..].iter().take_while(|mark| mark.0 < end) {
        let offset = (address - start) as usize;
        match (constant, since) {
            (true, None) => since = Some(offset),
            (false, Some(from)) => {
                ranges.push((from, offset));
                since = None;
            }
            _ => {}
        }
    }
    ranges.extend(since.map(|from| (from, (end - start) as usize)));
    ranges
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants_lie_between_their_mark_and_the_next_mark_of_code_or_the_end() {
        let marks = [(0, true), (96, false), (100, true), (108, false), (116, true), (130, false)];
        assert_eq!(constants(&marks, 96, 120), [(4, 12), (20, 24)]);
        assert_eq!(constants(&marks, 108, 116), []);
    }
}

//! What a program leaves in flash, and whether the RP2350's boot ROM would start it.

use std::fmt;
use std::ops::Range;

use super::PAGE;
use crate::elf::Segment;

/// Bytes that are erased together. Whole ones are written: what is left of one would be lost anyway.
pub(super) const SECTOR: u32 = 4096;

/// What erased flash holds.
const ERASED: u8 = 0xff;

/// The boot ROM looks for the image definition this far from the start (data sheet, 5.9.5).
const SEARCHED: usize = 4096;

/// How an image definition begins and ends.
const START_MARKER: u32 = 0xffff_ded3;
const END_MARKER: u32 = 0xab12_3579;

/// Its one item (0x42, one word): executable, secure, Arm, RP2350.
const ARM_PROGRAM: u32 = 0x1021_0142;

/// The item that ends the list (0xff): one word of items came before it.
const LAST_ITEM: u32 = 0x0000_01ff;

/// Why a program is no image that the boot ROM starts.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum ImageError {
    /// Nothing in it is to be written to flash.
    Empty,
    /// A part of it lies where the board keeps no program.
    Outside { part: Range<u32>, room: Range<u32> },
    /// It does not begin where flash begins, where the boot ROM looks.
    NotAtTheStart { found: u32, expected: u32 },
    /// Two parts want the same bytes of flash.
    Overlap { at: u32 },
    /// The boot ROM would find no image definition.
    NoDefinition,
    /// There is one, and it is not what the boot ROM takes for an Arm program.
    Definition { at: u32, word: usize, found: u32, expected: u32 },
    /// The vector table's reset vector leads out of the program.
    Reset { found: u32 },
}

impl fmt::Display for ImageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Empty => write!(f, "nothing in it is to be written to flash"),
            Self::Outside { part, room } => write!(
                f,
                "a part lies from {:#010x} to {:#010x}, expected inside {:#010x} to {:#010x}",
                part.start, part.end, room.start, room.end
            ),
            Self::NotAtTheStart { found, expected } => {
                write!(f, "it begins at {found:#010x}, expected {expected:#010x}")
            }
            Self::Overlap { at } => write!(f, "two parts want the flash at {at:#010x}"),
            Self::NoDefinition => {
                write!(f, "no image definition in its first {SEARCHED} bytes: it would not boot")
            }
            Self::Definition { at, word, found, expected } => write!(
                f,
                "word {word} of the image definition at {at:#010x} is {found:#010x}, expected \
                 {expected:#010x}: it would not boot"
            ),
            Self::Reset { found } => {
                write!(f, "the reset vector {found:#010x} leads out of the program")
            }
        }
    }
}

/// Whole sectors of flash from the start of the program to its end.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Image {
    base: u32,
    bytes: Vec<u8>,
    /// Bytes before the filling.
    length: usize,
}

impl Image {
    /// Puts the parts where they belong in `room`; what is between and after them reads as erased.
    pub(super) fn of(segments: &[Segment<'_>], room: &Range<u32>) -> Result<Self, ImageError> {
        let mut segments = segments.to_vec();
        segments.sort_by_key(|segment| segment.address);
        let mut bytes = Vec::new();
        for Segment { address, bytes: part } in &segments {
            let end = u64::from(*address) + part.len() as u64;
            if *address < room.start || end > u64::from(room.end) {
                let part = *address..u32::try_from(end).unwrap_or(u32::MAX);
                return Err(ImageError::Outside { part, room: room.clone() });
            }
            let offset = (address - room.start) as usize;
            if bytes.is_empty() && offset > 0 {
                let (found, expected) = (*address, room.start);
                return Err(ImageError::NotAtTheStart { found, expected });
            }
            if offset < bytes.len() {
                return Err(ImageError::Overlap { at: *address });
            }
            bytes.resize(offset, ERASED);
            bytes.extend_from_slice(part);
        }
        if bytes.is_empty() {
            return Err(ImageError::Empty);
        }
        let length = bytes.len();
        bytes.resize(length.next_multiple_of(SECTOR as usize), ERASED);
        Ok(Self { base: room.start, bytes, length })
    }

    /// Refuses what the boot ROM would not start: see the data sheet, 5.9.5, for the smallest image of an Arm
    /// program, a block that is the only one of its loop.
    pub(super) fn check_boots(&self) -> Result<(), ImageError> {
        let (at, _) = (0..SEARCHED)
            .step_by(4)
            .zip(self.words())
            .find(|(_, word)| *word == START_MARKER)
            .ok_or(ImageError::NoDefinition)?;
        let expected = [START_MARKER, ARM_PROGRAM, LAST_ITEM, 0, END_MARKER];
        let definition = self.words().skip(at / 4);
        let at = self.base + at as u32;
        for (word, (found, expected)) in definition.zip(expected).enumerate() {
            if found != expected {
                return Err(ImageError::Definition { at, word, found, expected });
            }
        }
        // Bit 0 says Thumb and is no part of the address.
        let found = self.words().nth(1).unwrap_or(0);
        let end = self.base + self.length as u32;
        let inside = (self.base..end).contains(&(found & !1));
        if found & 1 == 1 && inside { Ok(()) } else { Err(ImageError::Reset { found }) }
    }

    /// Its pages with their addresses, without a gap.
    pub(super) fn pages(&self) -> impl ExactSizeIterator<Item = (u32, &[u8])> {
        let page = |(number, bytes)| (self.base + number as u32 * PAGE, bytes);
        self.bytes.chunks_exact(PAGE as usize).enumerate().map(page)
    }

    fn words(&self) -> impl Iterator<Item = u32> {
        self.bytes.as_chunks().0.iter().map(|bytes| u32::from_le_bytes(*bytes))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROOM: Range<u32> = 0x1000_0000..0x1000_8000;

    /// A vector table, a definition after it, and code that the reset vector points to.
    fn program() -> Vec<u8> {
        let mut words = vec![0x2008_2000, 0x1000_0101];
        words.resize(16, 0);
        words.extend([START_MARKER, ARM_PROGRAM, LAST_ITEM, 0, END_MARKER]);
        words.resize(100, 0xbf00_bf00);
        words.iter().flat_map(|word: &u32| word.to_le_bytes()).collect()
    }

    fn of(parts: &[(u32, &[u8])]) -> Result<Image, ImageError> {
        let segments: Vec<_> =
            parts.iter().map(|(address, bytes)| Segment { address: *address, bytes }).collect();
        Image::of(&segments, &ROOM)
    }

    fn boots(program: &[u8]) -> Result<(), ImageError> {
        of(&[(ROOM.start, program)]).expect("an image").check_boots()
    }

    #[test]
    fn parts_lie_at_their_addresses_and_the_rest_of_the_sectors_is_erased() {
        let image = of(&[(0x1000_1010, b"code"), (0x1000_0000, b"table")]).expect("an image");
        assert_eq!(image.bytes.len(), 8192);
        assert_eq!(image.bytes[..5], *b"table");
        assert_eq!(image.bytes[4112..4116], *b"code");
        assert!(
            [5..4112, 4116..8192]
                .iter()
                .all(|gap| image.bytes[gap.clone()].iter().all(|byte| *byte == ERASED))
        );
        let addresses: Vec<u32> = image.pages().map(|(address, _)| address).collect();
        assert_eq!(addresses, (0x1000_0000..0x1000_2000).step_by(256).collect::<Vec<u32>>());
    }

    #[test]
    fn parts_that_have_no_place_are_refused_with_the_place() {
        assert_eq!(of(&[]), Err(ImageError::Empty));
        assert_eq!(
            of(&[(0x1000_0000, b"ab"), (0x1000_0001, b"c")]),
            Err(ImageError::Overlap { at: 0x1000_0001 })
        );
        assert_eq!(
            of(&[(0x1000_0004, b"ab")]).expect_err("late").to_string(),
            "it begins at 0x10000004, expected 0x10000000"
        );
        for (address, bytes) in
            [(0x2000_0000, &b"ram"[..]), (0x1000_7fff, b"ab"), (0x0fff_ffff, b"a")]
        {
            let error = of(&[(address, bytes)]).expect_err("outside");
            assert!(matches!(error, ImageError::Outside { .. }), "{error}");
        }
    }

    #[test]
    fn a_program_as_the_data_sheet_wants_it_boots() {
        assert_eq!(boots(&program()), Ok(()));
    }

    #[test]
    fn a_definition_that_differs_in_any_word_does_not_boot() {
        for word in 17..21 {
            let mut program = program();
            program[4 * word] ^= 1;
            let error = boots(&program).expect_err("damaged");
            assert!(
                matches!(error, ImageError::Definition { word: found, .. } if found == word - 16),
                "{error}"
            );
        }
        let mut without = program();
        without[4 * 16] ^= 1;
        assert_eq!(boots(&without), Err(ImageError::NoDefinition));
    }

    #[test]
    fn a_definition_past_the_first_4096_bytes_is_not_found() {
        let shifted = |by: usize| [&program()[..64], &vec![0; by], &program()[64..]].concat();
        assert_eq!(boots(&shifted(4096 - 64 - 4)), Ok(()));
        assert_eq!(boots(&shifted(4096 - 64)), Err(ImageError::NoDefinition));
    }

    #[test]
    fn a_reset_vector_has_to_be_thumb_code_of_the_program() {
        for vector in [0x1000_0100_u32, 0x1000_0191, 0x2000_0001, 0] {
            let mut program = program();
            program[4..8].copy_from_slice(&vector.to_le_bytes());
            assert_eq!(boots(&program), Err(ImageError::Reset { found: vector }));
        }
    }
}

//! Addresses: how they are typed, and which cannot work.

use std::fmt;
use std::num::IntErrorKind;

/// Where weights cannot go.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PlacementError {
    /// The address is no multiple of what the form of file needs.
    Unaligned {
        /// What it must be a multiple of.
        multiple: u32,
        /// Why.
        reason: &'static str,
    },
    /// The last byte would lie past the 32-bit address space.
    PastTheEnd {
        /// Number of bytes to be placed.
        length: usize,
    },
    /// Not the flash of this board.
    OutsideFlash {
        /// The board's name.
        board: &'static str,
        /// First address of its flash.
        start: u32,
        /// First address past it.
        end: u32,
    },
    /// Not in the region that the board keeps for weights.
    OutsideWeights {
        /// The board's name.
        board: &'static str,
        /// First address of the region.
        start: u32,
        /// First address past it.
        end: u32,
    },
    /// The bytes would leave the region that the board keeps for weights.
    NoRoom {
        /// The board's name.
        board: &'static str,
        /// Number of bytes to be placed.
        length: usize,
        /// Bytes from the address to the region's end.
        room: usize,
    },
}

impl fmt::Display for PlacementError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unaligned { multiple, reason } => {
                write!(f, "a multiple of {multiple} expected, since {reason}")
            }
            Self::PastTheEnd { length } => {
                write!(f, "{length} bytes from there end past 0xffffffff, the last address")
            }
            Self::OutsideFlash { board, start, end } => {
                write!(f, "the flash of a {board} lies from {start:#010x} to {:#010x}", end - 1)
            }
            Self::OutsideWeights { board, start, end } => write!(
                f,
                "the weights of a {board} lie from {start:#010x} to {:#010x}; elsewhere its \
                 program does not find them",
                end - 1
            ),
            Self::NoRoom { board, length, room } => write!(
                f,
                "{length} bytes do not fit into the {room} bytes that a {board} has there for weights"
            ),
        }
    }
}

impl std::error::Error for PlacementError {}

/// Refuses an address that is no multiple of `multiple`, and bytes past the address space.
///
/// # Errors
///
/// [`PlacementError::Unaligned`], which gives `reason`, or [`PlacementError::PastTheEnd`].
pub fn check(
    address: u32,
    length: usize,
    multiple: u32,
    reason: &'static str,
) -> Result<(), PlacementError> {
    if !address.is_multiple_of(multiple) {
        return Err(PlacementError::Unaligned { multiple, reason });
    }
    if u64::from(address) + length as u64 > 1 << 32 {
        return Err(PlacementError::PastTheEnd { length });
    }
    Ok(())
}

/// Text that is no 32-bit number.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NumberError {
    /// Not digits.
    NotANumber,
    /// Digits, of a number above 2³² − 1.
    TooLarge,
}

impl fmt::Display for NumberError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotANumber => "a number such as 0x103f_0000 or 272_564_224 expected",
            Self::TooLarge => "a number of at most 0xffff_ffff expected",
        })
    }
}

impl std::error::Error for NumberError {}

/// Reads a 32-bit number: hexadecimal after `0x`, else decimal, with `_` between digits.
///
/// ```
/// use host_trainer::export::placement::{NumberError, parse_number};
///
/// assert_eq!(parse_number("0x103f_0000"), Ok(0x103f_0000));
/// assert_eq!(parse_number("103f0000"), Err(NumberError::NotANumber));
/// ```
///
/// # Errors
///
/// [`NumberError`]: no number, or one that does not fit.
pub fn parse_number(text: &str) -> Result<u32, NumberError> {
    let (digits, radix) = match text.strip_prefix("0x").or_else(|| text.strip_prefix("0X")) {
        Some(digits) => (digits, 16),
        None => (text, 10),
    };
    // `from_str_radix` would take a sign.
    if !digits.starts_with(|first: char| first.is_digit(radix)) || digits.ends_with('_') {
        return Err(NumberError::NotANumber);
    }
    u32::from_str_radix(&digits.replace('_', ""), radix).map_err(|cause| match cause.kind() {
        IntErrorKind::PosOverflow => NumberError::TooLarge,
        _ => NumberError::NotANumber,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_hexadecimal_or_decimal_with_underscores() {
        let good = [
            ("0", 0),
            ("0x0", 0),
            ("0XfF", 255),
            ("0x103f_0000", 0x103f_0000),
            ("272_564_224", 0x103f_0000),
            ("4294967295", u32::MAX),
            ("0xffff_ffff", u32::MAX),
        ];
        for (text, number) in good {
            assert_eq!(parse_number(text), Ok(number), "{text}");
        }
    }

    #[test]
    fn anything_else_is_refused_with_what_was_expected() {
        let no_numbers = [
            "", "x", "0x", "_1", "0x_1", "1_", "-1", "+1", "0x+1", "0b1", "1.0", "ff", " 1", "1k",
            "٣",
        ];
        for text in no_numbers {
            assert_eq!(parse_number(text), Err(NumberError::NotANumber), "{text}");
        }
        for text in ["4294967296", "0x1_0000_0000", "99999999999999999999999"] {
            assert_eq!(parse_number(text), Err(NumberError::TooLarge), "{text}");
        }
    }

    #[test]
    fn the_last_byte_may_be_the_last_address_and_no_further() {
        let check = |address, length| check(address, length, 4, "words are read in place");
        assert_eq!(check(0xffff_fffc, 4), Ok(()));
        assert_eq!(check(0xffff_fffc, 5), Err(PlacementError::PastTheEnd { length: 5 }));
        let unaligned =
            PlacementError::Unaligned { multiple: 4, reason: "words are read in place" };
        assert_eq!(check(2, 4), Err(unaligned));
    }
}

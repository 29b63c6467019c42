//! Grey images as netpbm's PGM: plain (`P2`) and raw (`P5`), maxval up to 65535.
//!
//! Follows netpbm's own reader: the header is three decimal numbers between white space,
//! `#` starts a comment up to the end of its line, exactly one white-space character (or
//! comment) stands between maxval and raw samples, samples are one byte up to maxval 255
//! and two bytes, high byte first, above. Bytes after the image are ignored.

use std::io::{self, BufRead};
use std::ops::RangeInclusive;

use super::MAX_SIDE;
use super::canvas::Canvas;
use super::error::{MapProblem, Place};
use super::numbers::{Numbers, Token};
use super::shade::{CellRule, Pixel};

/// Why and where an image was refused.
type Refusal = (Place, MapProblem);

/// Reads a PGM, the magic number included.
pub(super) fn read(input: impl BufRead, rule: CellRule) -> Result<Canvas, Refusal> {
    let mut numbers = Numbers::new(input);
    let magic = [numbers.byte().map_err(unread)?, numbers.byte().map_err(unread)?];
    let raw = match magic {
        [Some(b'P'), Some(b'2')] => false,
        [Some(b'P'), Some(b'5')] => true,
        _ => {
            let found = "another magic number".to_owned();
            return Err((Place::Byte(0), MapProblem::UnknownFormat { found }));
        }
    };
    let side = 1..=MAX_SIDE;
    let width = header(&mut numbers, "width", "a whole number from 1 to 65536", side.clone())?;
    let height = header(&mut numbers, "height", "a whole number from 1 to 65536", side)?;
    let canvas = Canvas::new(width, height, rule).map_err(|problem| (numbers.place(), problem))?;
    let maxval = header(&mut numbers, "maxval", "a whole number from 1 to 65535", 1..=65535)?;
    let maxval = maxval as u16;
    if raw { raw_samples(numbers, canvas, maxval) } else { plain_samples(numbers, canvas, maxval) }
}

/// One number of the header.
fn header(
    numbers: &mut Numbers<impl BufRead>,
    field: &'static str,
    expected: &'static str,
    range: RangeInclusive<u32>,
) -> Result<u32, Refusal> {
    let found = match numbers.token().map_err(unread)? {
        Token::Number(value) if range.contains(&value) => return Ok(value),
        Token::Number(value) => value.to_string(),
        Token::Junk(quote) => quote,
        Token::End => "the end of the file".to_owned(),
    };
    Err((numbers.place(), MapProblem::PgmHeader { field, found, expected }))
}

/// Samples in decimal digits.
fn plain_samples(
    mut numbers: Numbers<impl BufRead>,
    mut canvas: Canvas,
    maxval: u16,
) -> Result<Canvas, Refusal> {
    let (width, height) = (canvas.width(), canvas.height());
    for row in 0..height {
        for x in 0..width {
            let problem = match numbers.token().map_err(unread)? {
                Token::Number(sample) if sample <= u32::from(maxval) => {
                    canvas.paint(x, row, Pixel::grey(stretch(sample as u16, maxval)));
                    continue;
                }
                Token::Number(sample) => MapProblem::AboveMaxval { sample, maxval, x, row },
                Token::Junk(found) => MapProblem::PgmSample { found, maxval },
                Token::End => MapProblem::Truncated {
                    found: u64::from(row) * u64::from(width) + u64::from(x),
                    expected: u64::from(width) * u64::from(height),
                    unit: "grey values",
                },
            };
            return Err((numbers.place(), problem));
        }
    }
    Ok(canvas)
}

/// Samples in one or two bytes each.
fn raw_samples(
    numbers: Numbers<impl BufRead>,
    mut canvas: Canvas,
    maxval: u16,
) -> Result<Canvas, Refusal> {
    let (width, height) = (canvas.width(), canvas.height());
    let sample_bytes = if maxval > 255 { 2 } else { 1 };
    let start = numbers.offset();
    let mut input = numbers.into_rest();
    let mut line = vec![0; width as usize * sample_bytes];
    for row in 0..height {
        let before = u64::from(row) * line.len() as u64;
        let got = fill(&mut input, &mut line).map_err(unread)?;
        if got < line.len() {
            let found = before + got as u64;
            let expected = u64::from(height) * line.len() as u64;
            let problem = MapProblem::Truncated { found, expected, unit: "bytes" };
            return Err((Place::Byte(start + found), problem));
        }
        for (x, bytes) in (0..width).zip(line.chunks_exact(sample_bytes)) {
            let sample = bytes.iter().fold(0, |value, &byte| value << 8 | u16::from(byte));
            if sample > maxval {
                let offset = start + before + u64::from(x) * sample_bytes as u64;
                let sample = u32::from(sample);
                let problem = MapProblem::AboveMaxval { sample, maxval, x, row };
                return Err((Place::Byte(offset), problem));
            }
            canvas.paint(x, row, Pixel::grey(stretch(sample, maxval)));
        }
    }
    Ok(canvas)
}

/// Stretches `0..=maxval` to `0..=65535`, rounding to nearest.
fn stretch(sample: u16, maxval: u16) -> u16 {
    let (sample, maxval) = (u32::from(sample), u32::from(maxval));
    ((sample * u32::from(u16::MAX) + maxval / 2) / maxval) as u16
}

/// Reads until the buffer is full or the input ends; returns how many bytes there were.
fn fill(input: &mut impl BufRead, buffer: &mut [u8]) -> io::Result<usize> {
    let mut got = 0;
    while got < buffer.len() {
        match input.read(&mut buffer[got..]) {
            Ok(0) => break,
            Ok(count) => got += count,
            Err(cause) if cause.kind() == io::ErrorKind::Interrupted => {}
            Err(cause) => return Err(cause),
        }
    }
    Ok(got)
}

fn unread(cause: io::Error) -> Refusal {
    (Place::File, MapProblem::Read(cause))
}

#[cfg(test)]
mod tests {
    use super::super::error::MapError;
    use super::super::shade::Mode;
    use super::*;

    /// Shows grey values 0 to 100 as they are, so that cells tell which pixel went where.
    const AS_IS: CellRule =
        CellRule { mode: Mode::Raw, negate: false, free_thresh: 0.0, occupied_thresh: 1.0 };

    fn cells(image: &[u8]) -> Vec<i8> {
        read(image, AS_IS).unwrap().finish().unwrap()
    }

    fn refusal(image: &[u8]) -> String {
        let (place, problem) = read(image, AS_IS).unwrap_err();
        let error = MapError { file: "map.pgm".into(), place, problem };
        error.to_string()
    }

    #[test]
    fn plain_and_raw_images_of_the_same_pixels_agree_and_rows_start_at_the_bottom() {
        let plain = cells(b"P2 # plain\n3 2\n255\n1 2 3 # top row\n4 5 6");
        let raw = cells(b"P5\n# CREATOR: map_saver\n3 2\n255\n\x01\x02\x03\x04\x05\x06");
        assert_eq!(plain, [4, 5, 6, 1, 2, 3]);
        assert_eq!(raw, plain);
    }

    #[test]
    fn header_numbers_may_stand_anywhere_between_white_space_and_comments() {
        for header in ["P5 3 1 255 ", "P5\t3\r\n1\n255\t", "P5#a\n#b\n3#c\n#d\n1 255#e\n"] {
            let image = [header.as_bytes(), b"\x0a#\x20"].concat();
            assert_eq!(cells(&image), [0x0a, 0x23, 0x20], "{header:?}");
        }
    }

    #[test]
    fn sixteen_bit_samples_come_high_byte_first_and_other_maxvals_are_stretched() {
        // 25700 / 65535 is 100 / 255; 2 of 5 is 102 of 255, which raw mode calls unknown.
        assert_eq!(cells(b"P5 2 1 65535\n\x64\x64\x00\x00"), [100, 0]);
        assert_eq!(cells(b"P2 3 1 5\n1 2 0"), [51, -1, 0]);
    }

    #[test]
    fn bytes_after_the_image_are_ignored() {
        assert_eq!(cells(b"P5 1 1 255\n\x07P5 1 1 255\n\x08"), [7]);
    }

    #[test]
    fn refusals_name_the_place_what_was_found_and_what_was_expected() {
        let messages: Vec<String> = [
            b"P6 1 1 255\n\0\0\0".as_slice(),
            b"P5\nwide 2 255\n",
            b"P5 3",
            b"P5 3 0 255\n",
            b"P5 99999999999 3 255\n",
            b"P5 65536 65536 255\n",
            b"P5 3 2 0\n",
            b"P5 3 2 65536\n",
            b"P5 3 2 255\nabcd",
            b"P5 2 2 65535\nabcde",
            b"P5 2 2 15\n\x00\x0f\x10\x00",
            b"P2 2 2 15\n0 15\n16 0",
            b"P2 2 2 15\n0 15\n-1 0",
            b"P2 2 2 15\n0 15 3",
        ]
        .into_iter()
        .map(refusal)
        .collect();
        assert_eq!(
            messages,
            [
                "map.pgm: byte 0: found another magic number, expected a PGM (P2 or P5) or PNG image",
                "map.pgm:2:1: PGM width: found `wide`, expected a whole number from 1 to 65536",
                "map.pgm:1:5: PGM height: found the end of the file, expected a whole number from 1 to 65536",
                "map.pgm:1:6: PGM height: found 0, expected a whole number from 1 to 65536",
                "map.pgm:1:4: PGM width: found `99999999999`, expected a whole number from 1 to 65536",
                "map.pgm:1:10: 65536 × 65536 pixels; expected 1 to 65536 each way and at most 67108864 in all",
                "map.pgm:1:8: PGM maxval: found 0, expected a whole number from 1 to 65535",
                "map.pgm:1:8: PGM maxval: found 65536, expected a whole number from 1 to 65535",
                "map.pgm: byte 15: pixel data ends early: found 4 of 6 bytes",
                "map.pgm: byte 18: pixel data ends early: found 5 of 8 bytes",
                "map.pgm: byte 12: grey value 16 (column 0, row 1 from the top), expected at most the header's 15",
                "map.pgm:3:1: grey value 16 (column 0, row 1 from the top), expected at most the header's 15",
                "map.pgm:3:1: found `-1`, expected a grey value from 0 to 15 in decimal digits",
                "map.pgm:2:7: pixel data ends early: found 3 of 4 grey values",
            ]
        );
    }
}

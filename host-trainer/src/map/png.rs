//! Images as PNG: grey, colour or palette, 1 to 16 bits, with or without alpha, interlaced
//! or not.
//!
//! Rows are turned into cells as they are decoded, so memory follows the cells and not the
//! size of the decoded picture. Where a PNG says which colour is see-through (`tRNS`), the
//! image has an alpha channel, as for `map_server`.

use std::io::{self, BufRead, Seek};

use ::png::{BitDepth, ColorType, DecodingError, Limits, Transformations};

use super::canvas::Canvas;
use super::error::{MapProblem, Place};
use super::shade::{CellRule, Pixel};

/// Most memory for a file's side information (palette, profiles), bytes.
const SIDE_INFORMATION: usize = 8 << 20;

/// Reads a PNG, the signature included.
pub(super) fn read(
    input: impl BufRead + Seek,
    rule: CellRule,
) -> Result<Canvas, (Place, MapProblem)> {
    decode(input, rule).map_err(|problem| (Place::File, problem))
}

fn decode(input: impl BufRead + Seek, rule: CellRule) -> Result<Canvas, MapProblem> {
    let mut decoder = ::png::Decoder::new_with_limits(input, Limits { bytes: SIDE_INFORMATION });
    decoder.set_transformations(Transformations::EXPAND);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let (width, height) = decoder.read_header_info().map_err(refused)?.size();
    let mut canvas = Canvas::new(width, height, rule)?;

    let mut reader = decoder.read_info().map_err(refused)?;
    let (color, depth) = reader.output_color_type();
    let pixel_bytes = color.samples() * if depth == BitDepth::Sixteen { 2 } else { 1 };
    for line in lines(width, height, reader.info().interlaced) {
        let Some(row) = reader.next_row().map_err(refused)? else { break };
        let columns = (line.x..width).step_by(line.step);
        for (x, bytes) in columns.zip(row.data().chunks_exact(pixel_bytes)) {
            canvas.paint(x, line.row, pixel(color, depth, bytes));
        }
    }
    // Reads to the end of the image data, where a checksum stands.
    reader.next_row().map_err(refused)?;
    Ok(canvas)
}

/// Which pixels of the image a stored row holds: `x`, `x + step`, … of `row`.
struct Line {
    x: u32,
    step: usize,
    row: u32,
}

/// The stored rows in order. An interlaced image is stored as seven coarser ones (PNG
/// specification, section 8.2).
fn lines(width: u32, height: u32, interlaced: bool) -> impl Iterator<Item = Line> {
    const WHOLE: &[[u8; 4]] = &[[0, 1, 0, 1]];
    const ADAM7: &[[u8; 4]] = &[
        [0, 8, 0, 8],
        [4, 8, 0, 8],
        [0, 4, 4, 8],
        [2, 4, 0, 4],
        [0, 2, 2, 4],
        [1, 2, 0, 2],
        [0, 1, 1, 2],
    ];
    let passes = if interlaced { ADAM7 } else { WHOLE };
    passes.iter().filter(move |[x, ..]| u32::from(*x) < width).flat_map(
        move |&[x, step, row, row_step]| {
            (u32::from(row)..height).step_by(row_step.into()).map(move |row| Line {
                x: x.into(),
                step: step.into(),
                row,
            })
        },
    )
}

/// One pixel from its bytes, 8 bits stretched to 16.
fn pixel(color: ColorType, depth: BitDepth, bytes: &[u8]) -> Pixel {
    let sample = |index: usize| match depth {
        BitDepth::Sixteen => u16::from_be_bytes([bytes[2 * index], bytes[2 * index + 1]]),
        _ => u16::from(bytes[index]) * 257,
    };
    match color {
        // The decoder has expanded palettes to RGB.
        ColorType::Grayscale | ColorType::Indexed => Pixel::grey(sample(0)),
        ColorType::GrayscaleAlpha => Pixel { alpha: Some(sample(1)), ..Pixel::grey(sample(0)) },
        ColorType::Rgb => Pixel { rgb: [sample(0), sample(1), sample(2)], alpha: None },
        ColorType::Rgba => Pixel { rgb: [sample(0), sample(1), sample(2)], alpha: Some(sample(3)) },
    }
}

/// A decoder's error, sorted into ours.
fn refused(error: DecodingError) -> MapProblem {
    match error {
        DecodingError::IoError(cause) if cause.kind() == io::ErrorKind::UnexpectedEof => {
            MapProblem::Png("the file ends early".to_owned())
        }
        DecodingError::IoError(cause) => MapProblem::Read(cause),
        DecodingError::LimitsExceeded => MapProblem::Png(format!(
            "more than {SIDE_INFORMATION} bytes beside the pixels, expected a plain image"
        )),
        other => MapProblem::Png(other.to_string()),
    }
}

//! From a pixel to a cell, as ROS's `map_server` does it.
//!
//! The rule is that of `loadMapFromFile` in `nav2_map_server/src/map_io.cpp`
//! (ros-navigation/navigation2 at commit 000b462d, the form shipped with Humble and Jazzy,
//! and in trinary mode that of ROS 1): the shade is the mean of red, green and blue, in
//! trinary mode of alpha too where the image has it; the occupancy is `1 − shade`, or the
//! shade with `negate`; both thresholds are compared strictly. Later versions of that file
//! work on 8-bit luma, compare with "or equal" and call see-through cells unknown in trinary
//! mode as well; grey maps without alpha differ only where a pixel equals a threshold.

use serde::{Deserialize, Serialize};

/// A cell nobody has seen.
pub const UNKNOWN: i8 = -1;
/// A cell known to be free.
pub const FREE: i8 = 0;
/// A cell known to be occupied.
pub const OCCUPIED: i8 = 100;

/// How shades become cells; `mode` in the YAML.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Mode {
    /// Free, occupied or unknown.
    #[default]
    Trinary,
    /// As trinary, but between the thresholds the occupancy is stretched over 0 to 100;
    /// pixels that are not opaque are unknown.
    Scale,
    /// Grey values 0 to 100 are the occupancy itself, others unknown; `negate` and the
    /// thresholds have no effect.
    Raw,
}

/// The settings that turn pixels into cells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CellRule {
    pub(super) mode: Mode,
    pub(super) negate: bool,
    pub(super) free_thresh: f64,
    pub(super) occupied_thresh: f64,
}

/// One pixel, each channel stretched to `0..=65535`.
///
/// Sixteen bits are what the image library of `map_server` computes with; 8-bit and 16-bit
/// samples fit without loss.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Pixel {
    pub(super) rgb: [u16; 3],
    /// Opaque is 65535; none where the image has no such channel.
    pub(super) alpha: Option<u16>,
}

impl Pixel {
    /// An opaque grey.
    pub(super) fn grey(shade: u16) -> Self {
        Self { rgb: [shade; 3], alpha: None }
    }
}

impl CellRule {
    /// The cell a pixel stands for: [`UNKNOWN`] or `0..=100`.
    pub(super) fn cell(&self, pixel: Pixel) -> i8 {
        let shade = self.shade(pixel);
        let occupancy = if self.negate { shade } else { 1.0 - shade };
        match self.mode {
            Mode::Raw => match (shade * 255.0).round() {
                value @ 0.0..=100.0 => value as i8,
                _ => UNKNOWN,
            },
            Mode::Scale if pixel.alpha.is_some_and(|alpha| alpha != u16::MAX) => UNKNOWN,
            _ if self.occupied_thresh < occupancy => OCCUPIED,
            _ if occupancy < self.free_thresh => FREE,
            Mode::Trinary => UNKNOWN,
            Mode::Scale => {
                let span = self.occupied_thresh - self.free_thresh;
                ((occupancy - self.free_thresh) / span * 100.0).round_ties_even() as i8
            }
        }
    }

    /// How bright a pixel is, 0 to 1.
    fn shade(&self, pixel: Pixel) -> f64 {
        let rgb: u32 = pixel.rgb.iter().map(|&channel| u32::from(channel)).sum();
        let mean = match pixel.alpha {
            Some(alpha) if self.mode == Mode::Trinary => f64::from(rgb + u32::from(alpha)) / 4.0,
            _ => f64::from(rgb) / 3.0,
        };
        mean / f64::from(u16::MAX)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROS1: CellRule =
        CellRule { mode: Mode::Trinary, negate: false, free_thresh: 0.196, occupied_thresh: 0.65 };

    fn grey8(rule: CellRule, value: u8) -> i8 {
        rule.cell(Pixel::grey(u16::from(value) * 257))
    }

    #[test]
    fn the_grey_of_unknown_cells_is_unknown_at_0_196_and_free_at_0_25() {
        // 205 is what map savers write for unknown: (255 − 205) / 255 = 0.19608.
        let ros2 = CellRule { free_thresh: 0.25, ..ROS1 };
        assert_eq!([0, 205, 254].map(|v| grey8(ROS1, v)), [OCCUPIED, UNKNOWN, FREE]);
        assert_eq!([0, 205, 254].map(|v| grey8(ros2, v)), [OCCUPIED, FREE, FREE]);
    }

    #[test]
    fn negate_swaps_black_and_white() {
        let rule = CellRule { negate: true, ..ROS1 };
        assert_eq!([0, 128, 255].map(|v| grey8(rule, v)), [FREE, UNKNOWN, OCCUPIED]);
    }

    #[test]
    fn both_thresholds_are_strict() {
        // 51/255 is exactly 0.2 and 204/255 exactly 0.8 in real numbers and in doubles.
        let rule = CellRule { negate: true, free_thresh: 0.2, occupied_thresh: 0.8, ..ROS1 };
        assert_eq!([50, 51, 204, 205].map(|v| grey8(rule, v)), [FREE, UNKNOWN, UNKNOWN, OCCUPIED]);
    }

    #[test]
    fn scale_stretches_the_band_between_the_thresholds_and_rounds_ties_to_even() {
        let rule =
            CellRule { mode: Mode::Scale, negate: true, free_thresh: 0.2, occupied_thresh: 0.8 };
        // (v/255 − 0.2) / 0.6 · 100, so 153 levels share 100 steps.
        assert_eq!(
            [50, 51, 52, 127, 128, 204, 205].map(|v| grey8(rule, v)),
            [0, 0, 1, 50, 50, 100, 100]
        );
        // 16 of 128 levels is 12.5 exactly.
        let rule = CellRule { free_thresh: 0.0, occupied_thresh: 128.0 / 255.0, ..rule };
        assert_eq!(grey8(rule, 16), 12);
    }

    #[test]
    fn scale_calls_see_through_pixels_unknown_and_trinary_averages_alpha_in() {
        let see_through = Pixel { rgb: [0; 3], alpha: Some(u16::MAX - 1) };
        let opaque = Pixel { rgb: [0; 3], alpha: Some(u16::MAX) };
        let scale = CellRule { mode: Mode::Scale, ..ROS1 };
        assert_eq!(scale.cell(see_through), UNKNOWN);
        assert_eq!(scale.cell(opaque), OCCUPIED);
        // Opaque black: shade 1/4, occupancy 0.75. With occupied_thresh 0.8 that is unknown.
        assert_eq!(ROS1.cell(opaque), OCCUPIED);
        assert_eq!(CellRule { occupied_thresh: 0.8, ..ROS1 }.cell(opaque), UNKNOWN);
    }

    #[test]
    fn raw_takes_grey_values_as_they_are() {
        let rule = CellRule { mode: Mode::Raw, negate: true, ..ROS1 };
        assert_eq!([0, 1, 100, 101, 255].map(|v| grey8(rule, v)), [0, 1, 100, UNKNOWN, UNKNOWN]);
    }

    #[test]
    fn colours_count_by_their_plain_mean() {
        let yellow = Pixel { rgb: [u16::MAX, u16::MAX, 0], alpha: None };
        // Shade 2/3, occupancy 1/3.
        let at = |free_thresh| CellRule { free_thresh, ..ROS1 }.cell(yellow);
        assert_eq!([at(0.33), at(0.34)], [UNKNOWN, FREE]);
    }
}

//! Which cell and sector a pose lies in.

use super::region::Region;
use crate::world::shape::Rect;
use controller_core::motion::Pose;
use std::f64::consts::TAU;

/// Sectors of heading; a power of two.
pub(super) const SECTORS: usize = 16;

/// Sectors per radian.
const PER_RADIAN: f32 = SECTORS as f32 / std::f32::consts::TAU;

/// Adding 2²³ leaves the nearest integer in the low bits.
const ROUND: f32 = 8_388_608.0;

/// The nearest integer; something larger than 2²² for negative numbers, for those above that,
/// and for NaN. Faster than a conversion, which has to saturate.
#[inline(always)]
fn nearest_integer(value: f32) -> usize {
    (value + ROUND).to_bits().wrapping_sub(ROUND.to_bits()) as usize
}

/// Upright square cells around points that are whole sides from the origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    origin: [f32; 2],
    side: f32,
    per_metre: f32,
    pub(super) columns: usize,
    pub(super) rows: usize,
}

impl Grid {
    /// Cells of this side over a rectangle, both metres; larger cells where there would be more
    /// than `most` of them.
    pub(super) fn new(low: [f32; 2], high: [f32; 2], side: f32, most: usize) -> Self {
        let size = [high[0] - low[0], high[1] - low[1]].map(|size| size.max(f32::MIN_POSITIVE));
        let count = |side: f32| size.map(|size| (size / side).ceil() + 1.0);
        let mut side = side.max(f32::MIN_POSITIVE);
        while count(side)[0] * count(side)[1] > most as f32 {
            side *= 2.0;
        }
        let [columns, rows] = count(side).map(|count| count as usize);
        Self { origin: low, side, per_metre: 1.0 / side, columns, rows }
    }

    /// Column, row and sector; none outside of the grid.
    #[inline(always)]
    pub(super) fn locate(&self, pose: &Pose<f32>) -> Option<(usize, usize, usize)> {
        let column = nearest_integer((pose.x - self.origin[0]) * self.per_metre);
        let row = nearest_integer((pose.y - self.origin[1]) * self.per_metre);
        let sector = nearest_integer(pose.heading * PER_RADIAN + SECTORS as f32);
        // Two turns of sectors hold every heading within ±π, and no NaN.
        let inside = column < self.columns && row < self.rows && sector < 2 * SECTORS;
        inside.then_some((column, row, sector % SECTORS))
    }

    /// Every pose that [`Self::locate`] puts in this cell, by sector, and a little more.
    pub(super) fn regions(&self, column: usize, row: usize) -> [Region; SECTORS] {
        let unit = f64::from(f32::EPSILON);
        let side = f64::from(self.side);
        let axis = |axis: usize, index: usize| {
            let origin = f64::from(self.origin[axis]);
            let cells = index as f64;
            // Rounding of the difference, of the side's inverse, of the product, and of the
            // number before it becomes an integer.
            let half = 0.5 * side + 4.0 * unit * (cells + 1.0) * side;
            (origin + cells * side - half, origin + cells * side + half)
        };
        let ((x0, x1), (y0, y1)) = (axis(0, column), axis(1, row));
        let sector_size = TAU / SECTORS as f64;
        std::array::from_fn(|sector| Region {
            cell: Rect { low: [x0, y0], high: [x1, y1] },
            heading: sector as f64 * sector_size,
            half_sector: sector_size * 0.5,
        })
    }
}

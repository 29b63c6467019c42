//! How far `f32` rounding can move what `controller_core::geometry` computes.
//!
//! With `u = 2⁻²⁴`, and `w` and `e` the vectors from a beam's start to a wall's end and along the
//! wall: differences of coordinates are exact up to `u` of themselves wherever in the world they
//! are taken, so every bound is a multiple of `u · (|w| + |e|)`, called a *size* here. Summing
//! the roundings of `Ray::to_segment` gives
//!
//! - a hit is computed only where the beam's line passes the wall within 4 sizes;
//! - its distance is off by at most 14 sizes / sin(angle between beam and wall), which has no
//!   bound for a beam that runs along a wall: such a wall is never left out;
//! - a disc's distance is off by at most the root of 2 · radius · 6 sizes, where a beam grazes it.

use crate::world::shape::{Rect, Shape};

/// Half a unit in the last place of 1.
const UNIT: f64 = 1.0 / (1 << 24) as f64;

/// Bounds for one obstacle seen from one region.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rounding {
    /// The beam's line passes the obstacle within this, metres, where a hit is computed.
    pub(super) aside: f64,
    /// The computed distance is off by at most this / sin(angle), metres.
    pub(super) ahead: f64,
    /// The computed distance is off by at most this, metres, for any beam from the region.
    pub(super) distance: f64,
}

impl Rounding {
    pub(super) fn new(shape: &Shape, from: &Rect) -> Self {
        let farthest = shape.farthest(from);
        let size = UNIT * (farthest + shape.length);
        let (aside, ahead) = (6.0 * size, 16.0 * size);
        let distance = if shape.is_wall() {
            // sin(angle) = distance from the wall's line / distance to the hit.
            match shape.side(from).abs() {
                0.0 => f64::INFINITY,
                side => ahead * farthest / side,
            }
        } else {
            let aside = 8.0 * size;
            (2.0 * shape.radius * aside).sqrt() + ahead + aside
        };
        Self { aside, ahead, distance }
    }

    /// How far a body's contact test may be off, metres.
    pub(super) fn contact(&self) -> f64 {
        2.0 * self.ahead + 1.0e-6
    }
}

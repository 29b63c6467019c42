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

use crate::world::Obstacles;
use crate::world::shape::{Rect, Shape};

/// Half a unit in the last place of 1.
const UNIT: f64 = 1.0 / (1 << 24) as f64;

/// A hit's distance is off by at most so many sizes, divided by the sine of its angle.
const AHEAD: f64 = 16.0;

/// Only what has a distance with an error of at most this is left out, metres: hardly anything else
/// is there, and so what is left out can only be computed as nearer if it is met not much later.
pub(super) const MOST_ERROR: f64 = 0.125;

/// Obstacles larger than so many times the range hide nothing.
const MOST_RANGES: f64 = 4.0;

/// Bounds for every obstacle of a world.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// Ends of walls closer than this meet, metres.
    pub(super) joint: f64,
    /// The computed distance of an obstacle no larger than `largest`, within range, is off by at most
    /// this / sin(angle), metres.
    pub(super) ahead: f64,
    /// A beam that passes a wall's end within this is not to be trusted, metres.
    pub(super) slack: f64,
    /// The largest obstacle of at most [`MOST_RANGES`] ranges, metres. Larger ones hide nothing: rounding
    /// grows with their size, and so would the slack of a whole world with the walls around it.
    pub(super) largest: f64,
}

impl Limits {
    /// For these obstacles, seen from cells no larger than `cell` by beams that reach `range`, metres.
    pub(super) fn new(range: f32, obstacles: &Obstacles, cell: f64) -> Self {
        let joint = f64::from(obstacles.joint(range));
        let largest = obstacles.largest_within(MOST_RANGES * f64::from(range));
        let ahead = AHEAD * UNIT * (1.01 * f64::from(range) + 4.0 * (largest + cell));
        // So much that a beam which keeps clear of a wall's ends by it has a distance to that wall
        // with an error of an eighth of its length. More than a joint, on which `cone`, `discs` and
        // `shade` rely; and past what of a wall sticks out before another one, at whose end it begins to
        // stand behind it, where they meet at 30° or more.
        let slack = 4.0 * ahead + 1.2 * joint;
        Self { joint, ahead, slack, largest }
    }
}

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
        let (aside, ahead) = (6.0 * size, AHEAD * size);
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

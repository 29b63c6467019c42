//! The beams of one car side by side, against one obstacle after the other.
//!
//! Inlined into its callers, whose vector instructions it uses; for the same reason nothing here
//! hands a vector to a closure.

use crate::vector::Eight;
use controller_core::geometry::{Disc, Ray, Segment};
use controller_core::observation::BEAMS;

/// Beams side by side; those past [`BEAMS`] repeat the first.
pub(super) const WIDTH: usize = 8;

/// A wall as a beam meets it: its first end, and the vector from there to the other.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(16))]
pub(super) struct Edge {
    start: (f32, f32),
    along: (f32, f32),
}

impl From<&Segment<f32>> for Edge {
    fn from(wall: &Segment<f32>) -> Self {
        Self { start: wall.a, along: (wall.b.0 - wall.a.0, wall.b.1 - wall.a.1) }
    }
}

/// Beams, and what they have met so far.
#[derive(Clone, Copy)]
pub(super) struct Beams<E> {
    ray: Ray<E>,
    near: E,
    past: E,
}

impl<E: Eight> Beams<E> {
    /// Nothing met yet.
    #[inline(always)]
    pub(super) fn new(ray: Ray<E>) -> Self {
        let nothing = E::from(f32::INFINITY);
        Self { ray, near: nothing, past: nothing }
    }

    /// Tests a wall.
    ///
    /// The numbers are those of [`Ray::to_segment`], operation by operation. Only the tests differ:
    /// a hit has `0 ≤ along ≤ den`, that is, neither `along` nor `den - along` is negative; and
    /// `den` = 0 needs no test of its own, since the quotient is then infinite or NaN, which no
    /// minimum takes.
    #[inline(always)]
    pub(super) fn wall(self, edge: &Edge) -> Self {
        let zero = E::from(0.0);
        let (dx, dy) = self.ray.direction;
        let (ex, ey) = (E::from(edge.along.0), E::from(edge.along.1));
        let wx = E::from(edge.start.0) - self.ray.origin.0;
        let wy = E::from(edge.start.1) - self.ray.origin.1;
        let den = dx * ey - dy * ex;
        let along = wx * dy - wy * dx;
        let ahead = wx * ey - wy * ex;
        let flip = den.lt(zero);
        let den_size = den.abs();
        let along = E::select(flip, -along, along);
        let ahead = E::select(flip, -ahead, ahead);
        // How far inside of the nearer end; negative outside.
        let inside = (den_size - along).min(along);
        let hit = zero.le(ahead.min(inside));
        let distance = E::select(hit, ahead / den_size, E::from(f32::INFINITY));
        Self { near: distance.min(self.near), past: inside.abs().min(self.past), ..self }
    }

    /// Tests a disc.
    #[inline(always)]
    pub(super) fn disc(self, disc: &Disc<f32>) -> Self {
        let centre = (E::from(disc.centre.0), E::from(disc.centre.1));
        let disc = Disc { centre, radius: E::from(disc.radius) };
        Self { near: self.ray.to_disc(&disc).min(self.near), ..self }
    }

    /// Distance to the nearest obstacle, metres, by beam; infinity where there is none within
    /// the range.
    #[inline(always)]
    pub(super) fn nearest(self, range: f32) -> [f32; BEAMS] {
        // Which zero is least depends on the order of obstacles; the sum is the positive one.
        let within = self.near.le(E::from(range));
        let near = E::select(within, self.near + E::from(0.0), E::from(f32::INFINITY));
        let [a, b, c, d, e, ..] = near.numbers();
        [a, b, c, d, e]
    }

    /// Whether any beam's line passes any wall's end within `slack`.
    #[inline(always)]
    pub(super) fn are_doubtful(self, slack: f32) -> bool {
        E::any(self.past.le(E::from(slack)))
    }

    /// Distance from each beam's line to the nearest end of a wall, metres.
    pub(super) fn past(self) -> [f32; BEAMS] {
        let [a, b, c, d, e, ..] = self.past.numbers();
        [a, b, c, d, e]
    }
}

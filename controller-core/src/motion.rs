//! How the car moves: the kinematic bicycle driven at its front axle.
//!
//! `p' = p + d·(cos(θ+φ), sin(θ+φ))`, `θ' = θ + (d/L)·sin φ`, with the reference point in the
//! middle of the front axle: defined for every steer angle within ±π/2 (paper, Fig. 1).

use crate::lane::Lane;
use crate::trig::{sin_cos, wrap};

/// Position of the front axle's middle and the heading, with the heading's sine and cosine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<L> {
    /// Metres.
    pub x: L,
    /// Metres.
    pub y: L,
    /// Radians, counter-clockwise from the x axis, within about ±π.
    pub heading: L,
    /// Cosine of the heading.
    pub cos: L,
    /// Sine of the heading.
    pub sin: L,
}

impl<L: Lane> Pose<L> {
    /// A pose from its three coordinates.
    #[inline(always)]
    pub fn new(x: L, y: L, heading: L) -> Self {
        let heading = wrap(heading);
        let (sin, cos) = sin_cos(heading);
        Self { x, y, heading, cos, sin }
    }

    /// Where the car stands after driving `step` metres at steer angle `steer` (radians), for a
    /// car with this wheelbase in metres.
    #[inline(always)]
    pub fn driven(&self, steer: L, step: L, wheelbase: L) -> Self {
        let (sin, cos) = sin_cos(steer);
        let heading = wrap(self.heading + (step / wheelbase) * sin);
        let (heading_sin, heading_cos) = sin_cos(heading);
        Self {
            x: self.x + step * (self.cos * cos - self.sin * sin),
            y: self.y + step * (self.sin * cos + self.cos * sin),
            heading,
            cos: heading_cos,
            sin: heading_sin,
        }
    }

    /// The same heading at another pose's position: a blocked car turns but does not move.
    #[inline(always)]
    pub fn held_at(&self, position: &Self) -> Self {
        Self { x: position.x, y: position.y, ..*self }
    }

    /// A point given in the car's frame, in the world's.
    #[inline(always)]
    pub fn to_world(&self, forward: L, left: L) -> (L, L) {
        (
            self.x + (self.cos * forward - self.sin * left),
            self.y + (self.sin * forward + self.cos * left),
        )
    }

    /// A point given in the world's frame, in the car's.
    #[inline(always)]
    pub fn to_body(&self, x: L, y: L) -> (L, L) {
        let (dx, dy) = (x - self.x, y - self.y);
        (self.cos * dx + self.sin * dy, self.cos * dy - self.sin * dx)
    }
}

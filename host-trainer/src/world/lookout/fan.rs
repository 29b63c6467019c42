//! The car's beams, ready to be turned by its heading.

use super::cell::BINS;
use super::grid::{Turned, parts_of_turn};
use crate::vector::Vector;
use controller_core::geometry::Ray;
use controller_core::lane::Lane;
use controller_core::motion::Pose;
use controller_core::observation::{BEAMS, BeamMount};
use controller_core::trig::sin_cos;

/// The beams of a car, and how far they reach.
#[derive(Clone, Debug, PartialEq)]
pub struct Fan {
    beams: [Beam; BEAMS],
    range: f32,
    has_one_origin: bool,
}

/// A beam's mount, with the cosine and sine of its angle.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Beam {
    mount: BeamMount,
    cos: f32,
    sin: f32,
    /// Its angle in bins.
    bins: f32,
}

impl Fan {
    /// Beams at these mounts that reach `range` metres.
    pub fn new(mounts: &[BeamMount; BEAMS], range: f32) -> Self {
        let beams = mounts.map(|mount| {
            let (sin, cos) = sin_cos(mount.angle);
            Beam { mount, cos, sin, bins: parts_of_turn(mount.angle, BINS) }
        });
        let starts_with_first =
            |mount: &BeamMount| (mount.x, mount.y) == (mounts[0].x, mounts[0].y);
        Self { beams, range, has_one_origin: mounts.iter().all(starts_with_first) }
    }

    /// How far the beams reach, metres.
    pub fn range(&self) -> f32 {
        self.range
    }

    /// Whether all beams start at the same point of the car.
    #[inline(always)]
    pub(super) fn has_one_origin(&self) -> bool {
        self.has_one_origin
    }

    /// The bins that one beam of cars with these headings lies in.
    #[inline(always)]
    pub(super) fn bins<V: Vector>(&self, beam: usize, heading: Turned<V, BINS>) -> V {
        heading.part_beside(self.beams[beam].bins)
    }

    /// The beams of cars at these poses, rightmost first.
    pub fn rays<L: Lane>(&self, pose: &Pose<L>) -> [Ray<L>; BEAMS] {
        let zero = (L::from(0.0), L::from(0.0));
        let mut rays = [Ray { origin: zero, direction: zero }; BEAMS];
        self.cast(pose, &mut rays);
        rays
    }

    /// The same, in place.
    #[inline(always)]
    pub(super) fn cast<L: Lane>(&self, pose: &Pose<L>, rays: &mut [Ray<L>; BEAMS]) {
        let mut origin = self.beams[0].origin(pose);
        for (ray, beam) in rays.iter_mut().zip(&self.beams) {
            if !self.has_one_origin {
                origin = beam.origin(pose);
            }
            *ray = Ray { origin, direction: beam.direction(pose) };
        }
    }
}

impl Beam {
    #[inline(always)]
    fn origin<L: Lane>(&self, pose: &Pose<L>) -> (L, L) {
        pose.to_world(L::from(self.mount.x), L::from(self.mount.y))
    }

    #[inline(always)]
    fn direction<L: Lane>(&self, pose: &Pose<L>) -> (L, L) {
        let (cos, sin) = (L::from(self.cos), L::from(self.sin));
        (pose.cos * cos - pose.sin * sin, pose.sin * cos + pose.cos * sin)
    }
}

//! The car's beams, ready to be turned by its heading.

use super::beams::WIDTH;
use crate::vector::Eight;
use controller_core::geometry::Ray;
use controller_core::lane::Lanes;
use controller_core::motion::Pose;
use controller_core::observation::{BEAMS, BeamMount};
use controller_core::trig::sin_cos;
use std::array::from_fn;

/// The beams of a car, and how far they reach.
#[derive(Clone, Debug, PartialEq)]
pub struct Fan {
    x: [f32; WIDTH],
    y: [f32; WIDTH],
    cos: [f32; WIDTH],
    sin: [f32; WIDTH],
    range: f32,
}

impl Fan {
    /// Beams at these mounts that reach `range` metres.
    pub fn new(mounts: &[BeamMount; BEAMS], range: f32) -> Self {
        let mount: [&BeamMount; WIDTH] = from_fn(|lane| &mounts[lane % BEAMS]);
        let (sin, cos) = sin_cos(Lanes(mount.map(|mount| mount.angle)));
        let (x, y) = (mount.map(|mount| mount.x), mount.map(|mount| mount.y));
        Self { x, y, cos: cos.0, sin: sin.0, range }
    }

    /// How far the beams reach, metres.
    pub fn range(&self) -> f32 {
        self.range
    }

    /// Where each beam starts, and the cosine and sine of its angle.
    pub(super) fn mounts(&self) -> [[f64; 4]; BEAMS] {
        let Self { x, y, cos, sin, .. } = self;
        from_fn(|beam| [x, y, cos, sin].map(|lanes| f64::from(lanes[beam])))
    }

    /// The beams as rays of a car at this pose.
    pub fn rays(&self, pose: &Pose<f32>) -> [Ray<f32>; BEAMS] {
        let Ray { origin: (x, y), direction: (dx, dy) } = self.turned::<Lanes<WIDTH>>(pose);
        from_fn(|beam| Ray { origin: (x.0[beam], y.0[beam]), direction: (dx.0[beam], dy.0[beam]) })
    }

    /// The same side by side.
    #[inline(always)]
    pub(super) fn turned<E: Eight>(&self, pose: &Pose<f32>) -> Ray<E> {
        let (cos, sin) = (E::from(pose.cos), E::from(pose.sin));
        let heading = E::from(pose.heading);
        let wide = Pose { x: E::from(pose.x), y: E::from(pose.y), heading, cos, sin };
        let (beam_cos, beam_sin) = (E::load(&self.cos), E::load(&self.sin));
        Ray {
            origin: wide.to_world(E::load(&self.x), E::load(&self.y)),
            direction: (cos * beam_cos - sin * beam_sin, sin * beam_cos + cos * beam_sin),
        }
    }
}

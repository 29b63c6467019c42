//! Obstacles side by side, as beams and bodies meet them.
//!
//! The functions here are inlined into their callers, so that a caller compiled for wider
//! registers gets them in these.

use controller_core::geometry::{Body, Disc, Ray, Segment};
use controller_core::lane::{Lane, Lanes};
use controller_core::motion::Pose;

/// Obstacles tested side by side.
pub(super) const WIDTH: usize = 8;

/// Where a lane without an obstacle keeps its point: far outside every world, in a direction in
/// which no car is likely to look.
const NOWHERE: (f32, f32) = (1.0e9, -7.3e8);

/// Eight walls, in one or two cache lines.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub(super) struct WallPack(Segment<Lanes<WIDTH>>);

/// Eight discs.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub(super) struct DiscPack(Disc<Lanes<WIDTH>>);

impl WallPack {
    /// At most [`WIDTH`] walls; missing ones are nowhere.
    pub(super) fn new<'a>(walls: impl IntoIterator<Item = &'a Segment<f32>>) -> Self {
        let nowhere = Segment { a: NOWHERE, b: NOWHERE };
        let mut lanes = [nowhere; WIDTH];
        for (lane, wall) in lanes.iter_mut().zip(walls) {
            *lane = *wall;
        }
        let of = |f: fn(&Segment<f32>) -> f32| Lanes(lanes.each_ref().map(f));
        Self(Segment { a: (of(|s| s.a.0), of(|s| s.a.1)), b: (of(|s| s.b.0), of(|s| s.b.1)) })
    }

    /// Any number of walls in as many packs as they need.
    pub(super) fn all(walls: &[Segment<f32>]) -> Box<[Self]> {
        walls.chunks(WIDTH).map(Self::new).collect()
    }
}

impl DiscPack {
    /// At most [`WIDTH`] discs; missing ones are nowhere.
    pub(super) fn new<'a>(discs: impl IntoIterator<Item = &'a Disc<f32>>) -> Self {
        let mut lanes = [Disc { centre: NOWHERE, radius: 0.0 }; WIDTH];
        for (lane, disc) in lanes.iter_mut().zip(discs) {
            *lane = *disc;
        }
        let of = |f: fn(&Disc<f32>) -> f32| Lanes(lanes.each_ref().map(f));
        Self(Disc { centre: (of(|d| d.centre.0), of(|d| d.centre.1)), radius: of(|d| d.radius) })
    }

    /// Any number of discs in as many packs as they need.
    pub(super) fn all(discs: &[Disc<f32>]) -> Box<[Self]> {
        discs.chunks(WIDTH).map(Self::new).collect()
    }
}

/// One ray, in every lane.
#[inline(always)]
fn wide(ray: &Ray<f32>) -> Ray<Lanes<WIDTH>> {
    let splat = |(x, y): (f32, f32)| (Lanes::from(x), Lanes::from(y));
    Ray { origin: splat(ray.origin), direction: splat(ray.direction) }
}

/// The smallest lane.
#[inline(always)]
fn least(lanes: Lanes<WIDTH>) -> f32 {
    let [a, b, c, d, e, f, g, h] = lanes.0;
    let four = Lanes([a, b, c, d]).min(Lanes([e, f, g, h]));
    let [a, b, c, d] = four.0;
    let two = Lanes([a, b]).min(Lanes([c, d]));
    Lane::min(two.0[0], two.0[1])
}

/// Distance along one ray, to the nearest of all.
#[inline(always)]
pub(super) fn nearest_of_all(ray: &Ray<f32>, walls: &[WallPack], discs: &[DiscPack]) -> f32 {
    let ray = wide(ray);
    let mut near = Lanes::from(f32::INFINITY);
    for pack in walls {
        near = ray.to_segment(&pack.0).min(near);
    }
    for pack in discs {
        near = ray.to_disc(&pack.0).min(near);
    }
    least(near)
}

/// Whether the body touches any.
#[inline(always)]
pub(super) fn any_touches(
    body: &Body<f32>,
    pose: &Pose<f32>,
    walls: &[WallPack],
    discs: &[DiscPack],
) -> bool {
    let body = Body {
        rear: Lanes::from(body.rear),
        front: Lanes::from(body.front),
        half_width: Lanes::from(body.half_width),
    };
    let pose = Pose {
        x: Lanes::from(pose.x),
        y: Lanes::from(pose.y),
        heading: Lanes::from(pose.heading),
        cos: Lanes::from(pose.cos),
        sin: Lanes::from(pose.sin),
    };
    walls.iter().any(|pack| body.touches_segment(&pose, &pack.0).any())
        || discs.iter().any(|pack| body.touches_disc(&pose, &pack.0).any())
}

//! Beams against walls and discs, the body against walls and discs.
//!
//! These four tests decide everything the simulated car feels. They use no fused products and
//! no transcendental function, and the nearest hit is a plain minimum: any order of obstacles,
//! and any index that skips obstacles which cannot be hit, gives the same bits.

use crate::lane::Lane;
use crate::motion::Pose;

/// A wall from `a` to `b`, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment<L> {
    /// One end.
    pub a: (L, L),
    /// The other end.
    pub b: (L, L),
}

/// A disc, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc<L> {
    /// Its middle.
    pub centre: (L, L),
    /// Its radius.
    pub radius: L,
}

/// A beam: where it starts, and its direction as a unit vector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray<L> {
    /// Where it starts, metres.
    pub origin: (L, L),
    /// Where it points, a unit vector.
    pub direction: (L, L),
}

impl<L: Lane> Ray<L> {
    /// Distance to the wall, or infinity where the ray misses it. Both ends belong to the wall;
    /// a ray along a wall misses it (its end faces another wall, or the beam grazes).
    #[inline(always)]
    pub fn to_segment(&self, segment: &Segment<L>) -> L {
        let (dx, dy) = self.direction;
        let ex = segment.b.0 - segment.a.0;
        let ey = segment.b.1 - segment.a.1;
        let wx = segment.a.0 - self.origin.0;
        let wy = segment.a.1 - self.origin.1;
        let zero = L::from(0.0);
        let den = dx * ey - dy * ex;
        let along = wx * dy - wy * dx;
        let ahead = wx * ey - wy * ex;
        // along/den within 0..=1 and ahead/den at least 0, tested without dividing.
        let flip = den.lt(zero);
        let den_size = den.abs();
        let along = L::select(flip, -along, along);
        let ahead_signed = L::select(flip, -ahead, ahead);
        let hit = zero.lt(den_size) & zero.le(along) & along.le(den_size) & zero.le(ahead_signed);
        L::select(hit, ahead_signed / den_size, L::from(f32::INFINITY))
    }

    /// Distance to the disc from outside, or infinity where the ray misses it or starts inside.
    #[inline(always)]
    pub fn to_disc(&self, disc: &Disc<L>) -> L {
        let (dx, dy) = self.direction;
        let wx = disc.centre.0 - self.origin.0;
        let wy = disc.centre.1 - self.origin.1;
        let zero = L::from(0.0);
        let middle = wx * dx + wy * dy;
        // Distance of the disc's middle from the ray's line, as a cross product: no cancellation.
        let aside = wx * dy - wy * dx;
        let root = disc.radius * disc.radius - aside * aside;
        let distance = middle - root.max(zero).sqrt();
        let hit = zero.le(root) & zero.le(distance);
        L::select(hit, distance, L::from(f32::INFINITY))
    }
}

/// The car's body in its own frame, metres ahead of the front axle and to each side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body<L> {
    /// The rear bumper (negative).
    pub rear: L,
    /// The front bumper.
    pub front: L,
    /// Half the width.
    pub half_width: L,
}

impl<L: Lane> Body<L> {
    /// Whether the body at this pose touches the wall; touching counts.
    ///
    /// Separating axes of a rectangle and a segment: the two sides, and the wall's normal.
    #[inline(always)]
    pub fn touches_segment(&self, pose: &Pose<L>, segment: &Segment<L>) -> L::Mask {
        let half = L::from(0.5);
        let middle = (self.front + self.rear) * half;
        let half_length = (self.front - self.rear) * half;
        let a = pose.to_body(segment.a.0, segment.a.1);
        let b = pose.to_body(segment.b.0, segment.b.1);
        let (ax, bx) = (a.0 - middle, b.0 - middle);
        let (ay, by) = (a.1, b.1);
        let beside = (ax + bx).abs().le((ax - bx).abs() + (half_length + half_length));
        let ahead = (ay + by).abs().le((ay - by).abs() + (self.half_width + self.half_width));
        let (ex, ey) = (bx - ax, by - ay);
        let across = (ex * ay - ey * ax).abs();
        beside & ahead & across.le(half_length * ey.abs() + self.half_width * ex.abs())
    }

    /// Whether the body at this pose touches the disc; touching counts.
    #[inline(always)]
    pub fn touches_disc(&self, pose: &Pose<L>, disc: &Disc<L>) -> L::Mask {
        let half = L::from(0.5);
        let middle = (self.front + self.rear) * half;
        let half_length = (self.front - self.rear) * half;
        let (x, y) = pose.to_body(disc.centre.0, disc.centre.1);
        let zero = L::from(0.0);
        let dx = ((x - middle).abs() - half_length).max(zero);
        let dy = (y.abs() - self.half_width).max(zero);
        (dx * dx + dy * dy).le(disc.radius * disc.radius)
    }
}

//! Beams side by side, one of each car, against the walls and discs that each may meet.
//!
//! Inlined into its callers, whose vector instructions it uses; for the same reason nothing here
//! hands a vector to a closure.

use crate::vector::Vector;
use controller_core::geometry::{Disc, Ray, Segment};

/// An obstacle as four numbers: of a wall its first end and the vector from there to the other as
/// beams meet it, or both ends as bodies do; of a disc its centre, its radius and [`DISC`].
pub(super) type Row = [f32; 4];

/// What a disc has as its fourth number; no wall has it.
const DISC: f32 = f32::INFINITY;

/// Far outside of every world, in a direction in which no car is likely to look.
const NOWHERE: [f32; 2] = [1.0e9, -7.3e8];

/// What no beam meets and no body touches.
pub(super) const NOTHING: Row = [NOWHERE[0], NOWHERE[1], 0.0, 0.0];

/// The same as bodies meet it.
pub(super) const NOTHING_NEAR: Row = [NOWHERE[0], NOWHERE[1], NOWHERE[0], NOWHERE[1]];

/// A wall as beams meet it.
pub(super) fn edge(wall: &Segment<f32>) -> Row {
    [wall.a.0, wall.a.1, wall.b.0 - wall.a.0, wall.b.1 - wall.a.1]
}

/// A wall as bodies meet it.
pub(super) fn face(wall: &Segment<f32>) -> Row {
    [wall.a.0, wall.a.1, wall.b.0, wall.b.1]
}

/// A disc as both meet it.
pub(super) fn disc(disc: &Disc<f32>) -> Row {
    [disc.centre.0, disc.centre.1, disc.radius, DISC]
}

/// Which of these obstacles are discs.
#[inline(always)]
pub(super) fn are_discs<V: Vector>(rows: &[V; 4]) -> V::Mask {
    V::from(DISC).le(rows[3])
}

/// The ray of one lane.
pub(super) fn in_lane<V: Vector>(ray: &Ray<V>, lane: usize) -> Ray<f32> {
    let at = |(x, y): (V, V)| (x.lanes()[lane], y.lanes()[lane]);
    Ray { origin: at(ray.origin), direction: at(ray.direction) }
}

/// What beams have met so far.
#[derive(Clone, Copy)]
pub(super) struct Met<V> {
    /// How far away the nearest is, metres.
    near: V,
    /// How closely the beam's line passes the end of any, metres.
    past: V,
}

impl<V: Vector> Met<V> {
    /// Nothing yet.
    #[inline(always)]
    pub(super) fn nothing() -> Self {
        let nothing = V::from(f32::INFINITY);
        Self { near: nothing, past: nothing }
    }

    /// Something, so far away.
    #[inline(always)]
    pub(super) fn something(near: V) -> Self {
        Self { near, ..Self::nothing() }
    }

    /// What else these beams have met, as well.
    #[inline(always)]
    pub(super) fn and(&mut self, other: &Self) {
        self.near = other.near.min(self.near);
        self.past = other.past.min(self.past);
    }

    /// As two numbers of each beam.
    #[inline(always)]
    pub(super) fn numbers(&self) -> [V; 2] {
        [self.near, self.past]
    }

    /// Of such numbers.
    #[inline(always)]
    pub(super) fn of([near, past]: [V; 2]) -> Self {
        Self { near, past }
    }

    /// Tests a wall for each beam.
    ///
    /// The numbers are those of [`Ray::to_segment`], operation by operation. Only the tests differ:
    /// a hit has `0 ≤ along ≤ den`, that is, neither `along` nor `den - along` is negative; and
    /// `den` = 0 needs no test of its own, since the quotient is then infinite or NaN, which no
    /// minimum takes. (So it does not matter that -0 turns the others' signs.)
    #[inline(always)]
    pub(super) fn wall(&mut self, ray: &Ray<V>, row: [V; 4]) {
        let (distance, inside) = wall_ahead(ray, row);
        self.near = distance.min(self.near);
        self.past = inside.abs().min(self.past);
    }

    /// Tests a wall or a disc for each beam.
    #[inline(always)]
    pub(super) fn any(&mut self, ray: &Ray<V>, row: [V; 4]) {
        let is_disc = are_discs(&row);
        let (distance, inside) = wall_ahead(ray, row);
        let (to_disc, inside_disc) = disc_ahead(ray, row);
        let distance = V::select(is_disc, to_disc, distance);
        let inside = V::select(is_disc, inside_disc, inside);
        self.near = distance.min(self.near);
        self.past = inside.abs().min(self.past);
    }

    /// Distance to the nearest obstacle, metres; infinity where there is none within the range.
    #[inline(always)]
    pub(super) fn nearest(&self, range: f32) -> V {
        // Which zero is least depends on the order of obstacles; the sum is the positive one.
        let within = self.near.le(V::from(range));
        V::select(within, self.near + V::from(0.0), V::from(f32::INFINITY))
    }

    /// Distance to the nearest of what was tested, metres; infinity where nothing was met.
    #[inline(always)]
    pub(super) fn near(&self) -> V {
        self.near
    }

    /// Which beams' lines pass any tested wall's end, or a disc's edge, within `slack` metres.
    #[inline(always)]
    pub(super) fn doubtful(&self, slack: f32) -> V::Mask {
        self.past.le(V::from(slack))
    }
}

/// Distance to a wall, and how far inside of its nearer end the beam's line passes, metres;
/// negative outside.
#[inline(always)]
fn wall_ahead<V: Vector>(ray: &Ray<V>, [x, y, ex, ey]: [V; 4]) -> (V, V) {
    let zero = V::from(0.0);
    let (dx, dy) = ray.direction;
    let wx = x - ray.origin.0;
    let wy = y - ray.origin.1;
    let den = dx * ey - dy * ex;
    let along = wx * dy - wy * dx;
    let ahead = wx * ey - wy * ex;
    let (along, ahead, den_size) =
        (along.flipped_by(den), ahead.flipped_by(den), den.flipped_by(den));
    let inside = (den_size - along).min(along);
    let hit = zero.le(ahead.min(inside));
    (V::select(hit, ahead / den_size, V::from(f32::INFINITY)), inside)
}

/// The same of a disc's edge.
#[inline(always)]
fn disc_ahead<V: Vector>(ray: &Ray<V>, [x, y, radius, _]: [V; 4]) -> (V, V) {
    let (dx, dy) = ray.direction;
    let aside = (x - ray.origin.0) * dy - (y - ray.origin.1) * dx;
    let disc = Disc { centre: (x, y), radius };
    (ray.to_disc(&disc), radius - aside.abs())
}

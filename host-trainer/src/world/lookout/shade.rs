//! Walls that stand behind others wherever a beam meets them, although other beams of the same
//! cell and arc pass those by: the far sides of a box beyond its corner.
//!
//! A wall is in the shade of a chain that meets end to end if the chain's free ends lie on
//! different sides of every line on which a beam meets the wall, and the wall lies behind each
//! line of the chain. What a beam within [`Limits::slack`] of an end meets is left open, as ever:
//! it is answered by a longer list, or all obstacles. That is why an end may lie on such a line, and even a little
//! on its other side: a wall can share it with the chain.
//!
//! [`Limits::slack`]: super::rounding::Limits::slack

use super::candidate::Candidate;
use super::cone::{Cone, free_ends};
use super::rounding::{Limits, MOST_ERROR};
use crate::world::shape::{Point, cross, dot, length, minus};

/// Most walls looked at; places are bits of a word.
const MOST: usize = u64::BITS as usize;

impl Cone<'_> {
    /// Leaves out what is in the shade, but for walls that are needed, by their place in the world:
    /// a beam that passes their ends too closely has to be noticed. Returns whether anything was.
    pub(super) fn leave_out_shaded(
        &self,
        met: &mut Vec<&Candidate>,
        is_needed: impl Fn(u32) -> bool,
    ) -> bool {
        if !(2..=MOST).contains(&met.len()) {
            return false;
        }
        let (mut gone, mut needed) = (0_u64, 0_u64);
        for (place, candidate) in met.iter().enumerate() {
            needed |= u64::from(is_needed(candidate.id)) << place;
        }
        for shaded in (0..met.len()).rev() {
            if needed >> shaded & 1 == 0
                && let Some(chain) = self.shade(met, shaded, gone)
            {
                gone |= 1 << shaded;
                needed |= chain;
            }
        }
        let mut places = 0..;
        met.retain(|_| places.next().is_some_and(|place: u32| gone >> place & 1 == 0));
        gone != 0
    }

    /// The walls of a chain that one lies in the shade of.
    fn shade(&self, met: &[&Candidate], shaded: usize, gone: u64) -> Option<u64> {
        let candidate = met[shaded];
        let by_angle = candidate.rounding.ahead / self.slowest(candidate);
        let error = candidate.rounding.distance.min(by_angle);
        // Where rounding can bring it before the car, or it runs along a beam, nothing is sure.
        if !candidate.is_hiding_wall() || error >= candidate.distance.min(MOST_ERROR) {
            return None;
        }
        let is_before = |place: usize| {
            let used = gone | 1 << shaded;
            used >> place & 1 == 0 && self.stands_before(met[place], candidate, error)
        };
        (0..met.len())
            .filter(|seed| is_before(*seed))
            .find_map(|seed| self.chain_before(met, seed, candidate, is_before))
    }

    /// The chain through the seed, if its free ends lie on different sides of every line on which a
    /// beam meets the shaded wall.
    fn chain_before(
        &self,
        met: &[&Candidate],
        seed: usize,
        shaded: &Candidate,
        is_before: impl Fn(usize) -> bool,
    ) -> Option<u64> {
        let mut chain = 1_u64 << seed;
        let sides = free_ends(
            met,
            seed,
            |point| self.side_of_lines(point, shaded),
            |point| {
                let fits = |place: usize| chain >> place & 1 == 0 && is_before(place);
                let (next, entry) = self.next(met, point, fits)?;
                chain |= 1 << next;
                Some((next, entry))
            },
        )?;
        (sides[0] != sides[1]).then_some(chain)
    }

    /// Whether every beam that crosses the wall inside of its ends does so ahead, and no later than
    /// it meets the shaded one, as computed.
    fn stands_before(&self, wall: &Candidate, shaded: &Candidate, error: f64) -> bool {
        let [low, high] = wall.heights;
        if !wall.is_hiding_wall() || low * high <= 0.0 || !self.is_crossed_ahead(wall) {
            return false;
        }
        let line = dot(wall.normal, wall.shape.ends[0]);
        let depths = shaded.shape.ends.map(|end| (dot(wall.normal, end) - line) * low.signum());
        // Both distances grow with the way from the line, at the speed of the beam or slower.
        let spare = wall.rounding.ahead + error;
        let is_behind = |end: usize| depths[end] >= spare;
        let begins_at_wall = |end: usize| {
            let joint = shaded.shape.ends[end];
            let mut met = wall.shape.ends.iter().filter(|other| self.is_joint(**other, joint));
            // It may stick out before the wall, as both are lengthened, but must go on behind it. A beam
            // that passes the wall's end with the slack to spare meets it so far behind that rounding
            // does not matter: the flatter the beam, the farther along and the deeper.
            let Limits { ahead, slack, .. } = *self.limits;
            let sine = (depths[1 - end] - depths[end]) / shaded.shape.length;
            let depth = |other: &Point| depths[end] + (slack - length(minus(*other, joint))) * sine;
            sine > 0.0 && met.any(|other| depth(other) >= 2.0 * ahead)
        };
        (is_behind(0) && is_behind(1)) || begins_at_wall(0) || begins_at_wall(1)
    }

    /// On which side a point lies of every line on which a beam meets the wall: 1 left, -1 right; 0
    /// if on neither.
    fn side_of_lines(&self, point: Point, wall: &Candidate) -> f64 {
        let side = self.side(point);
        if side != 0.0 {
            return side;
        }
        // From one corner to one end the cross product is largest and smallest, since it is linear
        // in either. A line passes the point at the product divided by its length.
        let spare =
            0.6 * self.limits.slack * wall.distance - wall.rounding.aside * self.farthest(point);
        let (mut is_left, mut is_right) = (true, true);
        for corner in self.corners {
            for end in wall.shape.ends {
                let turn = cross(minus(end, corner), minus(point, corner));
                is_left &= turn >= -spare;
                is_right &= turn <= spare;
            }
        }
        match (is_left, is_right) {
            (true, false) => 1.0,
            (false, true) => -1.0,
            _ => 0.0,
        }
    }
}

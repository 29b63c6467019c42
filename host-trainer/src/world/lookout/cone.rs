//! Beams from one cell in one part of a turn: what they can meet, and what stands before it.
//!
//! A chain of walls that meet end to end hides what is farther off when all beams cross it: its
//! two free ends lie on different sides of every beam's line, and all of it lies ahead. What
//! rounding computes near an end of a wall is another matter: a beam that passes any listed
//! wall's end within [`Limits::slack`] gets its answer from a longer list, or all obstacles, instead. A beam that
//! does not is sure to meet the chain, no later than at its farthest point.

use super::candidate::Candidate;
use super::grid::Arc;
use super::rounding::{Limits, MOST_ERROR};
use crate::world::shape::{Point, Rect, cross, dot, length, minus};

/// Longest chain of walls looked for.
const LONGEST: usize = 24;

/// Beams that start in a cell and point in the directions of an arc.
pub(super) struct Cone<'a> {
    pub(super) arc: &'a Arc,
    pub(super) limits: &'a Limits,
    pub(super) corners: [Point; 4],
    /// For each edge of the arc: the least and the most of `edge × corner`.
    aside: [[f64; 2]; 2],
    /// For each edge of the arc: the most of `edge · corner`.
    ahead: [f64; 2],
}

/// What beams cannot meet first.
pub(super) struct Hidden {
    /// The places in the world of the walls that meet, or the discs that touch, before it; none
    /// before nothing, or if a single obstacle hides it.
    pub(super) joined: Vec<u32>,
    /// No distance to it is computed as less than this, metres.
    pub(super) beyond: f64,
}

impl Hidden {
    pub(super) fn nothing() -> Self {
        Self { joined: Vec::new(), beyond: f64::INFINITY }
    }
}

/// Walls that meet end to end, by their places among the candidates.
struct Chain {
    walls: [usize; LONGEST],
    count: usize,
}

impl Chain {
    fn walls(&self) -> &[usize] {
        &self.walls[..self.count]
    }
}

impl<'a> Cone<'a> {
    pub(super) fn new(cell: &Rect, arc: &'a Arc, limits: &'a Limits) -> Self {
        let corners = cell.corners();
        let aside = arc.edges.map(|edge| {
            let crosses = corners.map(|corner| cross(edge, corner));
            [least(crosses), most(crosses)]
        });
        let ahead = arc.edges.map(|edge| cell.most(edge));
        Self { arc, limits, corners, aside, ahead }
    }

    /// Keeps those of the candidates that the beams can meet first. They are all that the beams
    /// can meet, the nearest first. What is in `walked` does not matter: it is memory to be used.
    pub(super) fn keep_in_sight(
        &self,
        met: &mut Vec<&Candidate>,
        walked: &mut Vec<bool>,
    ) -> Hidden {
        let all = met.len();
        let mut nearest = f64::INFINITY;
        let mut chain = Chain { walls: [0; LONGEST], count: 0 };
        walked.clear();
        walked.resize(all, false);
        for seed in 0..met.len() {
            if met[seed].distance > nearest {
                break;
            }
            // From any wall of a chain it comes out the same.
            if walked[seed] {
                continue;
            }
            if let Some((behind, walls)) = self.behind(met, seed, walked)
                && behind < nearest
            {
                (nearest, chain) = (behind, walls);
            }
        }
        let mut joined: Vec<u32> = match chain.walls() {
            [] | [_] => Vec::new(),
            walls => walls.iter().map(|wall| met[*wall].id).collect(),
        };
        if let Some((behind, discs)) = self.behind_discs(met, nearest) {
            (nearest, joined) = (behind, discs);
        }
        met.retain(|candidate| {
            let (distance, error) = self.least_distance(candidate);
            error > MOST_ERROR || distance - error <= nearest + 4.0 * self.limits.slack
        });
        if met.len() < all {
            Hidden { joined, beyond: nearest + 3.0 * self.limits.slack }
        } else {
            Hidden::nothing()
        }
    }

    /// How far a beam goes at most that crosses the chain through the seed, if all do, and that
    /// chain.
    fn behind(&self, met: &[&Candidate], seed: usize, walked: &mut [bool]) -> Option<(f64, Chain)> {
        if !met[seed].is_hiding_wall() {
            return None;
        }
        let mut chain = Chain { walls: [seed; LONGEST], count: 1 };
        let mut farthest = 0.0_f64;
        let sides = free_ends(
            met,
            seed,
            |point| self.side(point),
            |point| {
                let fits = |next: usize| !chain.walls().contains(&next);
                let (next, entry) = self.next(met, point, fits)?;
                farthest = farthest.max(self.farthest(point));
                *chain.walls.get_mut(chain.count)? = next;
                chain.count += 1;
                walked[next] = true;
                Some((next, entry))
            },
        )?;
        if sides[0] == sides[1] {
            return None;
        }
        for wall in chain.walls() {
            let candidate = met[*wall];
            if !self.is_crossed_ahead(candidate) {
                return None;
            }
            farthest = farthest.max(self.outermost(candidate) + self.error(candidate));
        }
        Some((farthest + self.limits.slack, chain))
    }

    /// A wall that fits and goes on from another's end, and which of its ends that is.
    pub(super) fn next(
        &self,
        met: &[&Candidate],
        joint: Point,
        fits: impl Fn(usize) -> bool,
    ) -> Option<(usize, usize)> {
        met.iter().enumerate().find_map(|(next, candidate)| {
            let mut ends = candidate.shape.ends.iter();
            let entry = ends.position(|end| self.is_joint(*end, joint))?;
            (candidate.is_hiding_wall() && fits(next)).then_some((next, entry))
        })
    }

    /// Whether walls meet that have these ends.
    pub(super) fn is_joint(&self, a: Point, b: Point) -> bool {
        let [dx, dy] = minus(a, b);
        dx.abs() + dy.abs() <= self.limits.joint
    }

    /// Whether no beam's line crosses the wall behind the beam's start.
    pub(super) fn is_crossed_ahead(&self, candidate: &Candidate) -> bool {
        let slack = self.limits.slack;
        if self.slowest(candidate) > 0.0 {
            // All beams go to the same side of the wall's line; is it before all of them?
            let [low, high] = candidate.heights;
            let sign = dot(candidate.normal, self.arc.edges[0]).signum();
            if low * sign > slack && high * sign > slack {
                return true;
            }
        }
        candidate.shape.ends.iter().all(|end| self.is_ahead(*end))
    }

    /// Whether a point lies ahead of wherever a beam starts, with the slack to spare.
    pub(super) fn is_ahead(&self, point: Point) -> bool {
        let mut edges = self.arc.edges.into_iter().zip(self.ahead);
        edges.all(|(edge, most)| dot(edge, point) - most > self.limits.slack)
    }

    /// On which side of all beams' lines a point lies, with the slack to spare: 1 left, -1
    /// right; 0 if on neither.
    pub(super) fn side(&self, point: Point) -> f64 {
        let spare = 1.5 * self.limits.slack;
        let edges = || self.arc.edges.into_iter().zip(self.aside);
        if edges().all(|(edge, [_, most])| cross(edge, point) - most > spare) {
            1.0
        } else if edges().all(|(edge, [least, _])| cross(edge, point) - least < -spare) {
            -1.0
        } else {
            0.0
        }
    }

    /// From a point to the cell's farthest one.
    pub(super) fn farthest(&self, point: Point) -> f64 {
        most(self.corners.map(|corner| length(minus(point, corner))))
    }

    /// The longest way to a wall of the outermost beams; on the way over a wall, the distance
    /// grows towards where these cross, or towards an end.
    fn outermost(&self, Candidate { shape, .. }: &Candidate) -> f64 {
        let along = minus(shape.ends[1], shape.ends[0]);
        let mut most = 0.0_f64;
        for edge in self.arc.edges {
            let den = cross(edge, along);
            for corner in self.corners {
                let start = minus(shape.ends[0], corner);
                let aside = cross(start, edge) * den.signum();
                if (0.0..=den.abs()).contains(&aside) {
                    most = most.max(cross(start, along) / den);
                }
            }
        }
        most
    }

    /// What rounding can add to the distance of a wall, metres. A beam that passes a wall's ends
    /// with the slack to spare does not run along it, and is off by an eighth of it at most.
    fn error(&self, candidate: &Candidate) -> f64 {
        let by_angle = candidate.rounding.ahead / self.slowest(candidate).max(f64::MIN_POSITIVE);
        by_angle.min(candidate.shape.length * 0.125)
    }

    /// How fast, of all beams, the slowest approaches the wall's line; 0 unless all go to the same
    /// side of it.
    pub(super) fn slowest(&self, candidate: &Candidate) -> f64 {
        let [right, left] = self.arc.edges.map(|edge| dot(candidate.normal, edge));
        let sign = right.signum();
        (right * sign).min(left * sign).max(0.0)
    }

    /// A distance that no beam goes below until it meets the obstacle, and how much rounding may
    /// take off it.
    fn least_distance(&self, candidate: &Candidate) -> (f64, f64) {
        let slowest = self.slowest(candidate);
        let [low, high] = candidate.heights;
        if !candidate.shape.is_wall() || slowest < 1.0e-2 || low * high <= 0.0 {
            return (candidate.distance, candidate.rounding.distance);
        }
        // Nearest to the normal, somewhere on the arc.
        let speeds = self.arc.edges.map(|edge| dot(candidate.normal, edge).abs());
        let fastest = (most(speeds) / self.arc.cos_half).min(1.0);
        let way = low.abs().min(high.abs()) / fastest;
        (way.max(candidate.distance), candidate.rounding.ahead / slowest)
    }
}

/// Follows a chain from the seed in both directions until a point lies on a side, and says on which;
/// `next` goes on from a point: to which wall, and which of its ends lies there.
pub(super) fn free_ends(
    met: &[&Candidate],
    seed: usize,
    side: impl Fn(Point) -> f64,
    mut next: impl FnMut(Point) -> Option<(usize, usize)>,
) -> Option<[f64; 2]> {
    let mut sides = [0.0; 2];
    for (first_end, found) in sides.iter_mut().enumerate() {
        let (mut wall, mut end) = (seed, first_end);
        loop {
            let point = met[wall].shape.ends[end];
            *found = side(point);
            if *found != 0.0 {
                break;
            }
            let (joined, entry) = next(point)?;
            (wall, end) = (joined, 1 - entry);
        }
    }
    Some(sides)
}

fn least<const N: usize>(values: [f64; N]) -> f64 {
    values.into_iter().fold(f64::INFINITY, f64::min)
}

fn most<const N: usize>(values: [f64; N]) -> f64 {
    values.into_iter().fold(f64::NEG_INFINITY, f64::max)
}

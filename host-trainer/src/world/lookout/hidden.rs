//! Which obstacles cannot be seen from a region because walls stand before them.
//!
//! A path of connected walls hides an obstacle when every line from the region to it crosses
//! the path. Lines can be moved from any one to any other; on the way the number of crossings
//! stays odd or even as long as no line passes an end of the path. So it is enough that both
//! ends lie outside of the convex hull of region and obstacle, and that one line crosses oddly.
//!
//! What rounding computes near an end of a wall is another matter: a beam that passes any
//! listed wall's end within [`Cover::slack`] gets its answer from all obstacles instead. That
//! lets a wall be hidden by its neighbour although both meet in a corner, where each sticks out
//! a little beyond the other.

use super::rounding::Rounding;
use crate::world::shape::{Point, Rect, Shape, along, cross, hull, is_outside, length, minus};

/// Longest path of walls looked for.
const LONGEST: usize = 24;

/// Sine of the smallest angle of a corner in which one wall can hide the other.
const CORNER: f64 = 0.5;

/// An obstacle that beams from the region may meet.
#[derive(Clone, Debug)]
pub(super) struct Candidate {
    /// Its place in the world.
    pub(super) id: u32,
    pub(super) shape: Shape,
    pub(super) rounding: Rounding,
    /// Distance from the region's line of sight, see [`Shape::side`].
    pub(super) side: f64,
    /// Distance from the region, for the order.
    pub(super) distance: f64,
    /// The largest distance, likewise.
    pub(super) farthest: f64,
}

/// Decides for one region.
pub(super) struct Cover<'a> {
    from: Rect,
    candidates: &'a [Candidate],
    /// Ends of walls closer than this meet, metres.
    joint: f64,
    /// A beam that passes a wall's end within this is not to be trusted, metres.
    pub(super) slack: f64,
    ahead: f64,
    kept: Vec<usize>,
    needed: Vec<bool>,
}

impl<'a> Cover<'a> {
    pub(super) fn new(from: Rect, candidates: &'a [Candidate], joint: f64) -> Self {
        let ahead = candidates.iter().map(|c| c.rounding.ahead).fold(0.0, f64::max);
        // In a corner of angle θ, distances to the two walls are ordered as they should be for
        // beams that pass it at (2 · ahead + 2 · joint) / sin θ or more.
        let slack = (2.0 * ahead + 2.0 * joint) / CORNER + joint;
        let needed = vec![false; candidates.len()];
        Self { from, candidates, joint, slack, ahead, kept: Vec::new(), needed }
    }

    /// The candidates that can be seen, as indices in ascending order of distance, and whether
    /// any was left out.
    pub(super) fn visible(mut self) -> Vec<usize> {
        for index in 0..self.candidates.len() {
            if !self.is_hidden(index) {
                self.kept.push(index);
            }
        }
        // A wall farther off may hide a nearer one's back.
        for position in (0..self.kept.len()).rev() {
            let index = self.kept[position];
            if self.needed[index] {
                continue;
            }
            self.kept.remove(position);
            if !self.is_hidden(index) {
                self.kept.insert(position, index);
            }
        }
        self.kept
    }

    fn is_hidden(&mut self, index: usize) -> bool {
        let target = &self.candidates[index];
        if !target.rounding.distance.is_finite() {
            return false;
        }
        let mut witnesses = Vec::new();
        let lines = Lines::new(self, target, &mut witnesses);
        let Some(path) = self.path(target, &lines) else { return false };
        for witness in witnesses.into_iter().chain(path) {
            self.needed[witness] = true;
        }
        true
    }

    /// Kept walls that hide the target together. Such a path crosses the middle line, so it is
    /// grown from a wall that does, both ways until the lines are clear of its ends.
    fn path(&self, target: &Candidate, lines: &Lines) -> Option<Vec<usize>> {
        self.kept.iter().find_map(|seed| {
            let ends = [self.beyond(*seed, 0), self.beyond(*seed, 1)];
            if lines.crossings(&ends) == 0 || !self.can_hide(*seed, target) {
                return None;
            }
            let mut path = vec![*seed];
            let mut points = self.grown(&mut path, 0, target, lines)?;
            points.reverse();
            points.extend(self.candidates[*seed].shape.ends);
            points.extend(self.grown(&mut path, 1, target, lines)?);
            (lines.crossings(&points) % 2 == 1).then_some(path)
        })
    }

    /// Follows connected walls from an end of the path's first until the lines are clear of the
    /// last one's end. Adds them to the path; the corners they go through, from that first end on.
    fn grown(
        &self,
        path: &mut Vec<usize>,
        end: usize,
        target: &Candidate,
        lines: &Lines,
    ) -> Option<Vec<Point>> {
        let (mut wall, mut end) = (path[0], end);
        let mut points = Vec::new();
        loop {
            let finish = self.beyond(wall, end);
            if lines.are_clear_of(finish) {
                points.push(finish);
                return Some(points);
            }
            if path.len() == LONGEST {
                return None;
            }
            let joint = self.candidates[wall].shape.ends[end];
            let next = self.kept.iter().filter(|next| !path.contains(next)).find_map(|next| {
                let ends = self.candidates[*next].shape.ends;
                let meets = |end: &usize| length(minus(ends[*end], joint)) <= self.joint;
                let entry = [0, 1].into_iter().find(meets)?;
                self.can_hide(*next, target).then_some((*next, entry))
            });
            let (next, entry) = next?;
            let ends = self.candidates[next].shape.ends;
            points.extend([joint, ends[entry], ends[1 - entry]]);
            path.push(next);
            (wall, end) = (next, 1 - entry);
        }
    }

    /// A wall's end, moved out by half of the slack.
    fn beyond(&self, wall: usize, end: usize) -> Point {
        let shape = &self.candidates[wall].shape;
        let sign = if end == 0 { -0.5 } else { 0.5 };
        along(shape.ends[end], shape.direction, sign * self.slack)
    }

    /// Whether a beam that crosses the wall and then meets the target is sure to be computed as
    /// nearer at the wall.
    fn can_hide(&self, wall: usize, target: &Candidate) -> bool {
        let wall = &self.candidates[wall];
        if !wall.shape.is_wall() || wall.side.abs() <= self.slack {
            return false;
        }
        if target.shape.is_wall() {
            for k in [0, 1] {
                let meets = |end: Point| length(minus(end, target.shape.ends[k])) <= self.joint;
                if wall.shape.ends.into_iter().any(meets) {
                    let to_far = minus(target.shape.ends[1 - k], wall.shape.ends[0]);
                    let is_behind = cross(wall.shape.direction, to_far) * wall.side < 0.0;
                    let sine = cross(wall.shape.direction, target.shape.direction).abs();
                    return is_behind && sine >= CORNER;
                }
            }
        }
        let gap = wall.shape.gap(&target.shape);
        gap >= wall.rounding.distance + target.rounding.distance + 2.0 * self.slack
    }
}

/// Every line from the region to one obstacle.
struct Lines {
    outline: Vec<Point>,
    margin: f64,
    line: [Point; 2],
}

impl Lines {
    /// The lines that matter: those to a wall's end that meets a kept wall's end are beams
    /// within the slack of it. The kept walls this relies on are added to `witnesses`.
    fn new(cover: &Cover<'_>, target: &Candidate, witnesses: &mut Vec<usize>) -> Self {
        let shape = &target.shape;
        let mut points = cover.from.corners().to_vec();
        let to;
        if shape.is_wall() {
            let mut ends = shape.ends;
            // Longer than what sticks out through the other wall, by more than rounding.
            let shorter = 0.5 * cover.slack;
            for (end, sign) in [(0, 1.0), (1, -1.0)] {
                let meets = |kept: &usize| {
                    let kept = &cover.candidates[*kept].shape;
                    let near =
                        |other: &Point| length(minus(*other, shape.ends[end])) <= cover.joint;
                    kept.is_wall() && kept.ends.iter().any(near)
                };
                let witness = cover.kept.iter().copied().find(meets);
                if let Some(witness) = witness
                    && shape.length > 4.0 * shorter
                {
                    witnesses.push(witness);
                    ends[end] = along(shape.ends[end], shape.direction, sign * shorter);
                }
            }
            points.extend(ends);
            to = [(ends[0][0] + ends[1][0]) * 0.5, (ends[0][1] + ends[1][1]) * 0.5];
        } else {
            // Around the disc, an octagon.
            let radius = (shape.radius + target.rounding.aside) * 1.09;
            let [x, y] = shape.ends[0];
            let (near, far) = (radius * 0.415, radius);
            for (dx, dy) in [(near, far), (far, near)] {
                points.extend([
                    [x + dx, y + dy],
                    [x - dx, y + dy],
                    [x + dx, y - dy],
                    [x - dx, y - dy],
                ]);
            }
            to = [x, y];
        }
        let outline = hull(&mut points);
        Self { outline, margin: cover.ahead, line: [cover.from.middle(), to] }
    }

    fn are_clear_of(&self, point: Point) -> bool {
        is_outside(&self.outline, point, self.margin)
    }

    /// How often a path crosses the middle line.
    fn crossings(&self, path: &[Point]) -> usize {
        let [from, to] = self.line;
        let direction = minus(to, from);
        let is_left = |point: Point| cross(direction, minus(point, from)) > 0.0;
        let crosses = |piece: &[Point]| {
            let (a, b) = (piece[0], piece[1]);
            let edge = minus(b, a);
            let is_near = |point: Point| cross(edge, minus(point, a)) > 0.0;
            is_left(a) != is_left(b) && is_near(from) != is_near(to)
        };
        path.windows(2).filter(|piece| crosses(piece)).count()
    }
}

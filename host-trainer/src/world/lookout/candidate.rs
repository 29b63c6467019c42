//! Obstacles that beams from a cell may meet.

use super::grid::Arc;
use super::rounding::{Limits, Rounding};
use crate::world::Obstacles;
use crate::world::shape::{Point, Rect, Shape, cross, dot, left, minus};
use std::f64::consts::{PI, TAU};

/// An obstacle that beams from a cell may meet.
#[derive(Clone, Debug)]
pub(super) struct Candidate {
    /// Its place in the world.
    pub(super) id: u32,
    pub(super) shape: Shape,
    pub(super) rounding: Rounding,
    /// Whether it may hide others.
    pub(super) hides: bool,
    /// Distance from the cell, metres.
    pub(super) distance: f64,
    /// The wall's normal, and how far its line is from the cell's points along it.
    pub(super) normal: Point,
    pub(super) heights: [f64; 2],
    /// Directions from the cell to the obstacle: all those within `half` of `middle`, radians.
    middle: f64,
    half: f64,
}

impl Candidate {
    fn new(id: u32, shape: Shape, cell: &Rect, limits: &Limits) -> Self {
        let rounding = Rounding::new(&shape, cell);
        let distance = shape.distance(cell);
        let normal = left(shape.direction);
        let line = dot(normal, shape.ends[0]);
        let heights = [line - cell.most(normal), line + cell.most([-normal[0], -normal[1]])];
        // So wide that each wall with an end in doubt is seen.
        let aside = rounding.aside + 2.0 * limits.slack;
        let (middle, half) = directions(&shape, cell, aside);
        let hides = shape.length.max(2.0 * shape.radius) <= limits.largest;
        Self { id, shape, rounding, hides, distance, normal, heights, middle, half }
    }

    /// Whether it is a wall that may hide others.
    pub(super) fn is_hiding_wall(&self) -> bool {
        self.hides && self.shape.is_wall()
    }

    /// Whether a beam on the arc can meet it.
    pub(super) fn is_met(&self, arc: &Arc) -> bool {
        let within = |middle: f64| {
            let turn = (arc.middle - middle).abs();
            let turn = if turn > TAU { turn - TAU } else { turn };
            turn.min(TAU - turn) <= self.half + arc.half
        };
        // Rounding can bring a wall behind the car before it only if its distance is that
        // uncertain.
        within(self.middle)
            || (self.rounding.distance >= self.distance
                && within(if self.middle > PI { self.middle - PI } else { self.middle + PI }))
    }
}

/// Every direction in which a beam from the cell passes the shape within `aside` metres ahead of
/// its start: the middle one from 0 to a turn, and how far the others are from it, radians.
fn directions(shape: &Shape, cell: &Rect, aside: f64) -> (f64, f64) {
    let grown = cell.grown(aside + shape.radius);
    if shape.distance(&grown) <= 0.0 {
        return (0.0, PI);
    }
    // Seen from the origin: the obstacle, spread by the cell. It does not hold the origin, so all
    // of it lies within half a turn of its middle.
    let [a, b] = shape.ends;
    let middle = [(a[0] + b[0]) * 0.5, (a[1] + b[1]) * 0.5];
    let towards = minus(middle, grown.middle());
    let (mut rightmost, mut leftmost) = (towards, towards);
    for end in shape.ends {
        for corner in grown.corners() {
            let point = minus(end, corner);
            if cross(rightmost, point) < 0.0 {
                rightmost = point;
            }
            if cross(leftmost, point) > 0.0 {
                leftmost = point;
            }
        }
    }
    let turn = |point: Point| libm::atan2(cross(towards, point), dot(towards, point));
    let (right, left) = (turn(rightmost), turn(leftmost));
    let middle = libm::atan2(towards[1], towards[0]) + (right + left) * 0.5;
    let middle = if middle < 0.0 { middle + TAU } else { middle };
    (middle, (left - right) * 0.5 + 1.0e-9)
}

/// Everything that beams from a cell may meet, in any direction.
pub(super) fn all(
    obstacles: &Obstacles,
    cell: &Rect,
    range: f32,
    limits: &Limits,
) -> Vec<Candidate> {
    let range = f64::from(range) * (1.0 + 1.0e-6);
    let mut candidates = Vec::new();
    obstacles.each_near(cell, range, |id, shape| {
        let candidate = Candidate::new(id, shape, cell, limits);
        // The error of a wall that beams may run along has no bound; out of range it is not met.
        let error = candidate.rounding.distance;
        if candidate.distance <= range + if error.is_finite() { error } else { 0.0 } {
            candidates.push(candidate);
        }
    });
    candidates
}

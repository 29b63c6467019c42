//! The search for one path: A* over what the car can do.

use super::floor::{Distances, Floor};
use super::states::States;
use super::{Path, STEERS};
use crate::problem::Problem;
use crate::scenario::Pair;
use crate::world::distance;
use controller_core::geometry::Disc;
use controller_core::motion::Pose;
use controller_core::units::SteerAngle;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// How much the way that is left counts, against the way that lies behind: more finds a path sooner,
/// and perhaps a longer one.
const EAGER: f32 = 1.5;

/// Cells of the floor that one steer angle is held for.
const HOLD: f32 = 1.5;

/// Rank of a place: tenths of a control period.
const RANK: f32 = 10.0;

/// Where the search has been.
#[derive(Clone, Copy, Debug)]
struct Node {
    pose: Pose<f32>,
    parent: u32,
    /// Control periods from the start.
    periods: u32,
    steer: SteerAngle,
}

/// One search.
pub(super) struct Search<'a> {
    problem: &'a Problem,
    floor: &'a Floor,
    states: &'a mut States,
    distances: Distances,
    goal: [f32; 2],
    target: Disc<f32>,
    /// Metres from the goal beyond which the body cannot touch the target.
    reach: f32,
    /// Control periods in which the car may move.
    limit: u32,
    step: f32,
    hold: u32,
    steers: [SteerAngle; STEERS.len()],
    nodes: Vec<Node>,
    open: BinaryHeap<Reverse<(u32, u32)>>,
}

impl<'a> Search<'a> {
    pub(super) fn new(
        problem: &'a Problem,
        floor: &'a Floor,
        states: &'a mut States,
        pair: &Pair,
    ) -> Self {
        let scaling = problem.scaling();
        let radius = problem.world.target_radius;
        let model = problem.model();
        let body = model.body();
        // From the front axle to the farthest corner.
        let arm = distance([body.front.max(-body.rear), body.half_width], [0.0, 0.0]);
        let [x, y, heading] = pair.start;
        let start = Node {
            pose: Pose::new(x, y, heading),
            parent: 0,
            periods: 0,
            steer: SteerAngle::STRAIGHT,
        };
        states.clear();
        Self {
            problem,
            floor,
            states,
            distances: floor.distances(pair.goal, radius),
            goal: pair.goal,
            target: Disc { centre: (pair.goal[0], pair.goal[1]), radius },
            reach: radius + arm + 1e-3,
            limit: problem.scenario.episode.step_limit.saturating_sub(model.delay() as u32),
            step: scaling.step_upper,
            hold: ((HOLD * floor.cell / scaling.step_upper).ceil() as u32).clamp(1, 1000),
            steers: STEERS.map(|share| SteerAngle::from_unit(share, scaling.steer_limit)),
            nodes: vec![start],
            open: BinaryHeap::from([Reverse((0, 0))]),
        }
    }

    pub(super) fn run(mut self) -> Option<Path> {
        while let Some(Reverse((_, index))) = self.open.pop() {
            for steer in self.steers {
                if self.drive(index, steer) {
                    return Some(self.path());
                }
            }
        }
        None
    }

    /// Holds the wheels for a while, and adds where that leads to; true if it is the target.
    fn drive(&mut self, from: u32, steer: SteerAngle) -> bool {
        let model = self.problem.model();
        let limit = self.limit;
        let Node { mut pose, mut periods, .. } = self.nodes[from as usize];
        let wheelbase = self.problem.scenario.vehicle.wheelbase;
        let mut reached = false;
        for _ in 0..self.hold {
            if periods == limit {
                return false;
            }
            pose = pose.driven(steer.radians(), self.step, wheelbase);
            periods += 1;
            let is_clear = self.floor.is_roomy(model.body(), &pose)
                || self.problem.lookout().touches(model.body(), &[pose], &[1]) == [0];
            if !is_clear {
                return false;
            }
            reached = distance([pose.x, pose.y], self.goal) <= self.reach
                && model.touches_target(&pose, &self.target);
            if reached {
                break;
            }
        }
        let Some(cell) = self.floor.at(pose.x, pose.y) else { return false };
        if !reached && !self.states.visit(cell, &pose, periods) {
            return false;
        }
        let straight = (distance([pose.x, pose.y], self.goal) - self.reach).max(0.0) / self.step;
        // A little less, for the sake of rounding.
        if periods as f32 + straight * 0.999 > limit as f32 {
            return false;
        }
        let left = match self.distances.cells(cell) {
            Some(cells) => cells * self.floor.cell / self.step,
            None => straight,
        };
        let rank = (RANK * (periods as f32 + EAGER * left)) as u32;
        self.open.push(Reverse((rank, self.nodes.len() as u32)));
        self.nodes.push(Node { pose, parent: from, periods, steer });
        reached
    }

    /// The way to the last node.
    fn path(&self) -> Path {
        let mut steers = Vec::new();
        let mut index = self.nodes.len() - 1;
        while index != 0 {
            let Node { parent, periods, steer, .. } = self.nodes[index];
            let parent = parent as usize;
            steers.extend((self.nodes[parent].periods..periods).map(|_| steer));
            index = parent;
        }
        steers.reverse();
        Path { steers }
    }
}

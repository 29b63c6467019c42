//! Can a car that cannot reverse get from a start to a goal at all?
//!
//! A search over the car's own motion: from the start, the wheels are held at one of a few
//! angles for a few control periods, then at another, until the body touches the target. Every
//! period is driven by the kinematic bicycle of the simulator and every pose tested by its
//! contacts, so a path that is found is a drive: the simulated car that steers so arrives
//! without touching anything, with the same bits. Of poses that share a cell of the grid over
//! (x, y, heading), only the one that got there in fewest periods goes on. That makes the search
//! end, and makes its "no" a guess: on a finer grid, or with more angles, there might be a way.
//!
//! It looks for the car as described: wheels that turn at once, nothing left to chance; with a
//! speed that the network chooses, at full speed. Dead time only takes from the step limit.
//!
//! | look in | for |
//! | --- | --- |
//! | `floor` | how far each place is from a goal for something that can turn on the spot |
//! | `states` | which (x, y, heading) have been visited |
//! | `search` | the search |

mod floor;
mod search;
mod states;

use crate::problem::Problem;
use crate::scenario::Pair;
use controller_core::units::SteerAngle;
use floor::Floor;
use rayon::prelude::*;
use search::Search;
use states::States;

/// Steer angles that are tried, as shares of the steer limit.
const STEERS: [f32; 7] = [0.0, 0.15, -0.15, 0.4, -0.4, 1.0, -1.0];

/// A way from a start to a goal.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// How to steer in each control period.
    pub steers: Vec<SteerAngle>,
}

/// Looks for paths of one car in one world.
#[derive(Debug)]
pub struct Planner<'a> {
    problem: &'a Problem,
    floor: Floor,
}

impl<'a> Planner<'a> {
    /// Prepares for the problem's world and car.
    pub fn new(problem: &'a Problem) -> Self {
        Self { problem, floor: Floor::new(&problem.world, problem.model().body()) }
    }

    /// A path that reaches the target within the step limit; none if the search finds none.
    pub fn path(&self, pair: &Pair) -> Option<Path> {
        self.path_with(&mut States::new(&self.floor), pair)
    }

    /// The places of the pairs for which there is a path, ascending. Works on the current rayon
    /// pool.
    pub fn drivable(&self, pairs: &[Pair]) -> Vec<usize> {
        let found: Vec<bool> = pairs
            .par_iter()
            .map_init(
                || States::new(&self.floor),
                |states, pair| self.path_with(states, pair).is_some(),
            )
            .collect();
        (0..pairs.len()).filter(|index| found[*index]).collect()
    }

    fn path_with(&self, states: &mut States, pair: &Pair) -> Option<Path> {
        Search::new(self.problem, &self.floor, states, pair).run()
    }
}

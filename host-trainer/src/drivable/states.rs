//! Which cells of (x, y, heading) a search has visited, and how soon.

use super::floor::Floor;
use controller_core::motion::Pose;
use std::f32::consts::{PI, TAU};

/// Headings that are told apart: 5 degrees.
const HEADINGS: usize = 72;

/// Control periods to each state; one allocation serves many searches.
#[derive(Debug)]
pub(super) struct States {
    /// 0 where no pose has been. (Zeros cost no memory before they are written.)
    periods: Vec<u32>,
    visited: Vec<usize>,
}

impl States {
    pub(super) fn new(floor: &Floor) -> Self {
        let states = floor.width * floor.height * HEADINGS;
        Self { periods: vec![0; states], visited: Vec::new() }
    }

    /// Forgets all visits.
    pub(super) fn clear(&mut self) {
        self.visited.drain(..).for_each(|state| self.periods[state] = 0);
    }

    /// Notes that a pose in this cell of the floor was reached after `periods`, at least 1; false
    /// if some pose in the same state was so before, and no later.
    pub(super) fn visit(&mut self, cell: usize, pose: &Pose<f32>, periods: u32) -> bool {
        let turn = (pose.heading + PI) / TAU * HEADINGS as f32;
        let state = cell * HEADINGS + (turn.max(0.0) as usize) % HEADINGS;
        let before = &mut self.periods[state];
        match *before {
            0 => self.visited.push(state),
            before if before <= periods => return false,
            _ => {}
        }
        *before = periods;
        true
    }
}

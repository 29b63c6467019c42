//! What only the world itself can tell about a scenario: is its task possible at all?

use super::free_space::FreeSpace;
use super::{World, distance};
use crate::car::body_of;
use crate::scenario::{Pair, PairSource, Scenario};
use controller_core::geometry::Body;
use controller_core::motion::Pose;
use std::fmt;

/// How wide a car is taken to be, relative to its width, so that a way exactly as wide as the
/// car is never overlooked between two cells.
const NARROWER: f32 = 0.7;

/// Something in a scenario that cannot work, with the key it is about.
#[derive(Clone, Debug, PartialEq)]
pub struct Impossible {
    /// Path of the key in the scenario file, such as `pairs.list[2].start`.
    pub key: String,
    /// What is wrong and what was expected.
    pub problem: String,
}

impl fmt::Display for Impossible {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.key, self.problem)
    }
}

impl World {
    /// Everything about the scenario's listed pairs that cannot work in this world.
    ///
    /// Only what is certain: a way that is barely too narrow, or too bent for the car's turning
    /// circle, passes.
    pub fn impossibilities(&self, scenario: &Scenario) -> Vec<Impossible> {
        let PairSource::Listed(pairs) = &scenario.pairs.source else { return Vec::new() };
        let judge = Judge::new(self, scenario);
        let impossible = |(index, pair): (usize, &Pair)| {
            let (end, problem) = judge.problem(pair)?;
            Some(Impossible { key: format!("pairs.list[{index}].{end}"), problem })
        };
        pairs.iter().enumerate().filter_map(impossible).collect()
    }
}

struct Judge<'a> {
    world: &'a World,
    body: Body<f32>,
    space: Option<FreeSpace>,
    /// How near to the goal the body's middle must get, metres.
    reach: f32,
}

impl<'a> Judge<'a> {
    fn new(world: &'a World, scenario: &Scenario) -> Self {
        let body = body_of(&scenario.vehicle);
        let half_length = (body.front - body.rear) * 0.5;
        let narrow = body.half_width.min(half_length);
        let space = FreeSpace::new(world, NARROWER * narrow);
        // In a large world cells are too coarse to be sure of a "no".
        let space = (NARROWER * narrow + 0.75 * space.cell() <= narrow).then_some(space);
        let diagonal = distance([half_length, body.half_width], [0.0, 0.0]);
        Self { world, body, space, reach: world.target_radius + diagonal }
    }

    /// What is wrong with which end of a pair.
    fn problem(&self, pair: &Pair) -> Option<(&'static str, String)> {
        let Self { world, body, .. } = self;
        let [x, y, heading] = pair.start;
        let [gx, gy] = pair.goal;
        let pose = Pose::new(x, y, heading);
        let (middle_x, middle_y) = pose.to_world((body.front + body.rear) * 0.5, 0.0);
        if !world.bounds.contains([x, y]) {
            Some(("start", format!("({x}, {y}) lies outside the room")))
        } else if !world.bounds.contains(pair.goal) {
            Some(("goal", format!("({gx}, {gy}) lies outside the room")))
        } else if world.blocks(body, &pose) {
            Some(("start", format!("the car's body at ({x}, {y}) overlaps an obstacle")))
        } else if world.is_inside_obstacle(pair.goal) {
            Some(("goal", format!("({gx}, {gy}) lies inside an obstacle")))
        } else if self.is_cut_off([middle_x, middle_y], pair.goal) {
            let problem = format!(
                "({gx}, {gy}) cannot be reached from ({x}, {y}): no free way is as wide as the car"
            );
            Some(("goal", problem))
        } else {
            None
        }
    }

    fn is_cut_off(&self, start: [f32; 2], goal: [f32; 2]) -> bool {
        self.space.as_ref().is_some_and(|space| !space.connects(start, goal, self.reach))
    }
}

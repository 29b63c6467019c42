//! What only the world itself can tell about a scenario: is its task possible at all?

use super::World;
use super::free_space::FreeSpace;
use crate::car::body_of;
use crate::scenario::{Pair, PairSource, Scenario};
use controller_core::motion::Pose;
use std::fmt;

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
    pub fn impossibilities(&self, scenario: &Scenario) -> Vec<Impossible> {
        let PairSource::Listed(pairs) = &scenario.pairs.source else { return Vec::new() };
        let body = body_of(&scenario.vehicle);
        let space = FreeSpace::new(self, body.half_width);
        let check =
            |(index, pair): (usize, &Pair)| self.pair_problem(&space, index, pair, scenario);
        pairs.iter().enumerate().filter_map(check).collect()
    }

    fn pair_problem(
        &self,
        space: &FreeSpace,
        index: usize,
        pair: &Pair,
        scenario: &Scenario,
    ) -> Option<Impossible> {
        let body = body_of(&scenario.vehicle);
        let [x, y, heading] = pair.start;
        let [gx, gy] = pair.goal;
        let key = |end: &str| format!("pairs.list[{index}].{end}");
        let inside = |x: f32, y: f32| {
            let (min, max) = (self.bounds.min, self.bounds.max);
            (min[0]..=max[0]).contains(&x) && (min[1]..=max[1]).contains(&y)
        };
        let problem = |end: &str, problem: String| Some(Impossible { key: key(end), problem });
        if !inside(x, y) {
            return problem("start", format!("({x}, {y}) lies outside the world's bounds"));
        }
        if !inside(gx, gy) {
            return problem("goal", format!("({gx}, {gy}) lies outside the world's bounds"));
        }
        if self.blocks(&body, &Pose::new(x, y, heading)) {
            let problem_text = format!("the car's body at ({x}, {y}) overlaps an obstacle");
            return problem("start", problem_text);
        }
        if self.is_inside_obstacle([gx, gy]) {
            return problem("goal", format!("({gx}, {gy}) lies inside an obstacle"));
        }
        if !space.connects([x, y], [gx, gy], self.target_radius) {
            return problem(
                "goal",
                format!(
                    "({gx}, {gy}) cannot be reached from ({x}, {y}): no free way as wide as the car"
                ),
            );
        }
        None
    }
}

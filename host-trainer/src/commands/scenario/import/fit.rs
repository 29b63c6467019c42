//! Target, pairs and step limit that suit a room.

use crate::failure::Failure;
use crate::problem::Problem;
use crate::scenario::{Bounds, Scenario, StepLength};
use crate::seed::RunSeed;

/// Pairs that must be found, so that one lucky draw does not decide.
pub(super) const PROOF: u32 = 20;

/// What depends on the size of a room.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fit {
    /// Radius of the target, metres.
    pub(super) target_radius: f32,
    /// Between start and goal at least, metres.
    pub(super) min_distance: f32,
    /// Control periods.
    pub(super) step_limit: u32,
}

impl Default for Fit {
    /// Fits into every room there can be.
    fn default() -> Self {
        Self { target_radius: 0.001, min_distance: 0.0, step_limit: 1 }
    }
}

impl Fit {
    /// Follows the paper's room of 10 × 10 m: target 0.4 m, pairs 4 m apart, except that in a
    /// large hall a start is not kept 10 m away from its goal. The limit is twice the way along
    /// two sides.
    fn of(scenario: &Scenario, room: Bounds) -> Self {
        let [width, height] = room.size();
        let (StepLength::Constant(step) | StepLength::Variable { upper: step, .. }) =
            scenario.vehicle.step;
        let steps = 2.0 * (width + height) / step;
        Self {
            target_radius: twentieths((0.04 * width.min(height)).clamp(0.2, 0.5)),
            min_distance: tenths((0.4 * width.min(height)).min(8.0)),
            step_limit: (((steps / 50.0).ceil() * 50.0) as u32).clamp(200, 20_000),
        }
    }

    /// The same task made easier to place, until nothing is left to give.
    fn easier(self) -> Option<Self> {
        if self.min_distance >= 1.0 {
            Some(Self { min_distance: tenths(self.min_distance / 2.0), ..self })
        } else if self.target_radius >= 0.1 {
            Some(Self { target_radius: twentieths(self.target_radius / 2.0), ..self })
        } else {
            None
        }
    }
}

fn tenths(length: f32) -> f32 {
    (length * 10.0).round() / 10.0
}

fn twentieths(length: f32) -> f32 {
    (length * 20.0).round() / 20.0
}

/// The problem that `build` makes of the best fit in which pairs can be drawn.
///
/// # Errors
///
/// Those of `build`; bad input if no fit works.
pub(super) fn fit(
    whole: &Scenario,
    room: Bounds,
    mut build: impl FnMut(Fit) -> Result<Problem, Failure>,
) -> Result<Problem, Failure> {
    let mut candidate = Some(Fit::of(whole, room));
    while let Some(fit) = candidate {
        let problem = build(fit)?;
        let found = problem.sampler().unseen(RunSeed(1), PROOF);
        if found.is_ok() {
            return Ok(problem);
        }
        candidate = fit.easier();
    }
    let vehicle = &whole.vehicle;
    Err(Failure::bad_input(format!(
        "no start and goal found on the map for a car of {} m × {} m, expected free space to drive \
         in; is the map's resolution right, or are its unknown cells free (--unknown free)?",
        vehicle.length, vehicle.width
    )))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Preset;

    #[test]
    fn a_room_as_in_the_paper_gets_the_papers_task() {
        let scenario = Preset::Paper.scenario();
        let fit = Fit::of(&scenario, scenario.world.bounds);
        assert_eq!(fit, Fit { target_radius: 0.4, min_distance: 4.0, step_limit: 400 });
    }
}

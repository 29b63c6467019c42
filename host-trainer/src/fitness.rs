//! What drives cost, in two kinds; both are minimised.
//!
//! | kind | one drive costs | an individual costs |
//! | --- | --- | --- |
//! | [`FitnessKind::Paper`] | equation 3 of the paper | the sum over its drives |
//! | [`FitnessKind::ReachedFirst`] | 0 to 1, or a little more | 100 times the mean over its drives |

use crate::episode::Outcome;
use crate::evolve::Cost;
use crate::scenario::{FitnessKind, FitnessSpec, Pair, Scenario};

/// The cost of an individual that drove these pairs with these outcomes.
///
/// Summed in the order of the drives.
pub fn total(scenario: &Scenario, pairs: &[Pair], outcomes: &[Outcome]) -> Cost {
    let spec = &scenario.fitness;
    let mut sum = 0.0;
    match spec.kind {
        FitnessKind::Paper => {
            for outcome in outcomes {
                sum += paper(spec, outcome);
            }
            Cost::new(sum)
        }
        FitnessKind::ReachedFirst => {
            for (pair, outcome) in pairs.iter().zip(outcomes) {
                sum += reached_first(spec, scenario.episode.step_limit, pair, outcome);
            }
            Cost::new(100.0 * sum / outcomes.len() as f64)
        }
    }
}

/// `F = c1·DTT + c2·LT + c3·C − B·[reached]` of one drive.
///
/// The paper prints `+ B`; since F is minimised and B is called a bonus, it is taken off
/// (our reading).
fn paper(spec: &FitnessSpec, outcome: &Outcome) -> f64 {
    let bonus = if outcome.reached { f64::from(spec.bonus) } else { 0.0 };
    f64::from(spec.distance) * f64::from(outcome.distance_to_target)
        + f64::from(spec.length) * f64::from(outcome.path_length)
        + f64::from(spec.collision) * f64::from(outcome.collisions)
        - bonus
}

/// `time · steps/limit` of a clean drive, else `1 − progress · (1 − DTT/D)`, where D lies between
/// start and goal.
///
/// Living long earns nothing, so that circling does not pay. Ending farther away than twice D is
/// no worse than that: a start close to its goal must not outweigh all other drives.
fn reached_first(spec: &FitnessSpec, step_limit: u32, pair: &Pair, outcome: &Outcome) -> f64 {
    if outcome.clean() {
        return f64::from(spec.time) * f64::from(outcome.steps) / f64::from(step_limit);
    }
    let along = |axis: usize| f64::from(pair.start[axis]) - f64::from(pair.goal[axis]);
    let start = libm::hypot(along(0), along(1));
    let end = f64::from(outcome.distance_to_target);
    let nearer = if end < 2.0 * start { 1.0 - end / start } else { -1.0 };
    1.0 - f64::from(spec.progress) * nearer
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Preset;

    /// The goal is 5 m from the start.
    const PAIR: Pair = Pair { start: [1.0, 1.0, 0.0], goal: [4.0, 5.0] };

    fn outcome(reached: bool, collisions: u32, path_length: f32, distance: f32) -> Outcome {
        let steps = 60;
        Outcome {
            reached,
            collisions,
            steps,
            path_length,
            distance_to_target: distance,
            ..Outcome::default()
        }
    }

    fn of_one(kind: FitnessKind, outcome: Outcome) -> f64 {
        let mut scenario = Preset::Paper.scenario();
        scenario.fitness.kind = kind;
        total(&scenario, &[PAIR], &[outcome]).value()
    }

    #[test]
    fn the_four_terms_add_up_as_in_equation_3() {
        let cost = |outcome| of_one(FitnessKind::Paper, outcome);
        // 100 · 2 + 100 · 7.5 + 150 · 3, and 5000 less when the target is reached.
        assert_eq!(cost(outcome(false, 3, 7.5, 2.0)), 1400.0);
        assert_eq!(cost(outcome(true, 3, 7.5, 2.0)), -3600.0);
    }

    #[test]
    fn a_drive_that_is_reached_first_of_all_costs_its_time_and_another_its_way_left() {
        let cost = |outcome| of_one(FitnessKind::ReachedFirst, outcome);
        let near = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-5, "{found}");
        // 60 of 300 steps at 0.1; then 0.1 of the 2.5 m of 5 m that are done.
        near(cost(outcome(true, 0, 6.0, 0.4)), 2.0);
        near(cost(outcome(false, 0, 6.0, 2.5)), 95.0);
        // Touching something on the way is not reaching; nor is going away, to a limit.
        near(cost(outcome(true, 1, 6.0, 0.5)), 91.0);
        near(cost(outcome(false, 0, 6.0, 7.5)), 105.0);
        near(cost(outcome(false, 0, 6.0, 1000.0)), 110.0);
    }

    #[test]
    fn a_start_on_the_goal_has_a_cost_too() {
        let mut scenario = Preset::Paper.scenario();
        scenario.fitness.kind = FitnessKind::ReachedFirst;
        let pair = Pair { start: [1.0, 1.0, 0.0], goal: [1.0, 1.0] };
        for end in [0.0, 3.0] {
            let cost = total(&scenario, &[pair], &[outcome(false, 1, 1.0, end)]);
            assert!(cost < Cost::WORST, "{cost:?}");
        }
    }

    #[test]
    fn better_drives_cost_less() {
        let order = [
            outcome(true, 0, 6.0, 0.4),
            outcome(true, 0, 9.0, 0.4),
            outcome(true, 5, 9.0, 0.4),
            outcome(false, 5, 9.0, 0.4),
            outcome(false, 5, 9.0, 3.0),
        ];
        let cost = |outcome: &Outcome| of_one(FitnessKind::Paper, *outcome);
        assert!(order.windows(2).all(|w| cost(&w[0]) < cost(&w[1])));
        let slower = Outcome { steps: 61, ..order[0] };
        let order = [order[0], slower, order[2], order[4]];
        let cost = |outcome: &Outcome| of_one(FitnessKind::ReachedFirst, *outcome);
        assert!(order.windows(2).all(|w| cost(&w[0]) < cost(&w[1])));
    }

    #[test]
    fn an_individual_costs_the_sum_or_the_mean_of_its_drives() {
        let drives = [outcome(true, 0, 5.0, 0.0), outcome(false, 1, 30.0, 5.0)];
        let mut scenario = Preset::Paper.scenario();
        let total = |scenario: &Scenario| total(scenario, &[PAIR; 2], &drives).value();
        assert_eq!(total(&scenario), -4500.0 + 3650.0);
        scenario.fitness.kind = FitnessKind::ReachedFirst;
        assert!((total(&scenario) - 51.0).abs() < 1e-5);
    }
}

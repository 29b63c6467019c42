//! What a drive costs: the paper's equation 3, minimised.

use crate::episode::Outcome;
use crate::evolve::Cost;
use crate::scenario::FitnessSpec;

/// `F = c1·DTT + c2·LT + c3·C − B·[reached]` of one drive.
///
/// The paper prints `+ B`; since F is minimised and B is called a bonus, it is taken off
/// (our reading).
pub fn cost(spec: &FitnessSpec, outcome: &Outcome) -> f64 {
    let bonus = if outcome.reached { f64::from(spec.bonus) } else { 0.0 };
    f64::from(spec.distance) * f64::from(outcome.distance_to_target)
        + f64::from(spec.length) * f64::from(outcome.path_length)
        + f64::from(spec.collision) * f64::from(outcome.collisions)
        - bonus
}

/// The cost of an individual: the sum over its drives, in their order.
pub fn total(spec: &FitnessSpec, outcomes: &[Outcome]) -> Cost {
    let mut sum = 0.0;
    for outcome in outcomes {
        sum += cost(spec, outcome);
    }
    Cost::new(sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAPER: FitnessSpec =
        FitnessSpec { distance: 100.0, length: 100.0, collision: 150.0, bonus: 5000.0 };

    fn outcome(reached: bool, collisions: u32, path_length: f32, distance: f32) -> Outcome {
        Outcome { reached, collisions, steps: 0, path_length, distance_to_target: distance }
    }

    #[test]
    fn the_four_terms_add_up_as_in_equation_3() {
        // 100 · 2 + 100 · 7.5 + 150 · 3, and 5000 less when the target is reached.
        assert_eq!(cost(&PAPER, &outcome(false, 3, 7.5, 2.0)), 1400.0);
        assert_eq!(cost(&PAPER, &outcome(true, 3, 7.5, 2.0)), -3600.0);
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
        assert!(order.windows(2).all(|w| cost(&PAPER, &w[0]) < cost(&PAPER, &w[1])));
    }

    #[test]
    fn an_individual_costs_the_sum_of_its_drives() {
        let drives = [outcome(true, 0, 5.0, 0.0), outcome(false, 1, 30.0, 4.0)];
        assert_eq!(total(&PAPER, &drives), Cost::new(-4500.0 + 3550.0));
    }
}

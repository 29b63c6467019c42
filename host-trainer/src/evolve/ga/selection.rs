//! Who becomes a parent: indices into the judged population.
//!
//! Stochastic universal sampling lays the weights end to end on a line and reads off
//! equally spaced pointers that share one random offset, so that everyone gets the whole
//! part of their expected copies, or one more. The toolbox's weight is `1/(f − f_min + 1)`.

use super::super::{Cost, ranking};
use super::settings::{Selection, millionths};
use crate::seed::Stream;

/// Chooses `count` parents, in population order.
///
/// A [`Cost::WORST`] has no weight in [`Selection::Sus`]; if all costs are that, everyone
/// weighs the same.
pub fn select(
    selection: Selection,
    costs: &[Cost],
    count: usize,
    stream: &mut Stream,
) -> Vec<usize> {
    let weights = match selection {
        Selection::Sus => toolbox_weights(costs),
        Selection::LinearRank { pressure } => linear_rank_weights(costs, pressure.into()),
        Selection::Truncation { share } => truncation_weights(costs, share),
    };
    universal_sampling(&weights, count, stream.unit_f64())
}

/// The `count` best, best first, each once.
pub fn best(costs: &[Cost], count: usize) -> Vec<usize> {
    let mut order = ranking(costs);
    order.truncate(count);
    order
}

/// `count` members of a population of `size`, each equally likely every time.
pub fn random(size: usize, count: usize, stream: &mut Stream) -> Vec<usize> {
    (0..count).map(|_| stream.index(size)).collect()
}

fn toolbox_weights(costs: &[Cost]) -> Vec<f64> {
    match costs.iter().min() {
        Some(&least) if least < Cost::WORST => {
            costs.iter().map(|cost| 1.0 / (cost.value() - least.value() + 1.0)).collect()
        }
        _ => vec![1.0; costs.len()],
    }
}

/// From `pressure` for the best down to `2 − pressure` for the worst; equal costs share the
/// weight of their middle rank.
fn linear_rank_weights(costs: &[Cost], pressure: f64) -> Vec<f64> {
    let order = ranking(costs);
    let last = (costs.len() - 1).max(1) as f64;
    let mut weights = vec![0.0; costs.len()];
    let mut rank = 0.0;
    for equals in order.chunk_by(|&a, &b| costs[a] == costs[b]) {
        let middle = rank + (equals.len() - 1) as f64 / 2.0;
        for &index in equals {
            weights[index] = pressure - 2.0 * (pressure - 1.0) * middle / last;
        }
        rank += equals.len() as f64;
    }
    weights
}

/// One for the best `share`, rounded up to whole individuals, nothing for the others.
fn truncation_weights(costs: &[Cost], share: f32) -> Vec<f64> {
    let kept = (millionths(share) * costs.len() as u128).div_ceil(1_000_000).max(1) as usize;
    let mut weights = vec![0.0; costs.len()];
    for index in best(costs, kept) {
        weights[index] = 1.0;
    }
    weights
}

/// Reads `count` pointers off the line of weights, at least one of which is above 0;
/// `offset` in `0.0..1.0` is the first pointer's place within its interval.
fn universal_sampling(weights: &[f64], count: usize, offset: f64) -> Vec<usize> {
    // Rounding could put the last pointer at the very end of the line.
    let last = weights.iter().rposition(|&weight| weight > 0.0).unwrap_or(0);
    let spacing = weights.iter().sum::<f64>() / count as f64;
    let mut index = 0;
    let mut end = weights[0];
    (0..count)
        .map(|pointer| {
            while (pointer as f64 + offset) * spacing >= end && index < last {
                index += 1;
                end += weights[index];
            }
            index
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::statistics::chi_square;
    use crate::seed::{Purpose, RunSeed};

    fn stream(generation: u32) -> Stream {
        RunSeed(1).stream(Purpose::Breeding, generation, 0)
    }

    fn copies(chosen: &[usize], size: usize) -> Vec<usize> {
        (0..size).map(|index| chosen.iter().filter(|&&c| c == index).count()).collect()
    }

    fn costs<const N: usize>(raw: [f64; N]) -> [Cost; N] {
        raw.map(Cost::new)
    }

    /// Weights 1, 1/2, 1/4 and 1/4: of eight parents exactly 4, 2, 1 and 1, whatever the
    /// offset.
    #[test]
    fn universal_sampling_gives_whole_expectations_exactly() {
        let costs = costs([10.0, 11.0, 13.0, 13.0]);
        for generation in 0..1000 {
            let chosen = select(Selection::Sus, &costs, 8, &mut stream(generation));
            assert_eq!(chosen, [0, 0, 0, 0, 1, 1, 2, 3]);
        }
    }

    #[test]
    fn pointers_are_read_off_the_line_by_hand() {
        // Line: 0 to 1, 1 to 1, 1 to 4; pointers at (k + offset) · 4/4.
        assert_eq!(universal_sampling(&[1.0, 0.0, 3.0], 4, 0.0), [0, 2, 2, 2]);
        assert_eq!(universal_sampling(&[1.0, 0.0, 3.0], 2, 0.4), [0, 2]); // 0.8 and 2.8
        assert_eq!(universal_sampling(&[1.0, 0.0, 3.0], 2, 0.5), [2, 2]); // 1.0 and 3.0
        assert_eq!(universal_sampling(&[0.0, 2.0, 0.0], 3, 1.0 - f64::EPSILON), [1, 1, 1]);
        assert_eq!(universal_sampling(&[1.0, 1.0], 0, 0.3), [0; 0]);
    }

    /// Expected copies `count · wᵢ / Σw`, computed here from the definition alone.
    #[test]
    fn everyone_gets_their_expected_copies_rounded_down_or_up() {
        let mut cost_stream = RunSeed(2).stream(Purpose::GeneratedWorld, 0, 0);
        for generation in 0..200 {
            let raw: [f64; 40] = std::array::from_fn(|_| 4.0 * cost_stream.unit_f64() - 2.0);
            let least = raw.iter().copied().fold(f64::MAX, f64::min);
            let weights = raw.map(|f| 1.0 / (f - least + 1.0));
            let sum: f64 = weights.iter().sum();
            let chosen = select(Selection::Sus, &costs(raw), 32, &mut stream(generation));
            for (weight, copies) in weights.into_iter().zip(copies(&chosen, 40)) {
                let expected = 32.0 * weight / sum;
                assert!((copies as f64 - expected).abs() < 1.0, "{copies} for {expected}");
            }
        }
    }

    /// Mean copies over many offsets against the same expectation; limit five standard errors.
    #[test]
    fn copies_average_to_their_expectation() {
        let costs = costs([0.0, 0.5, 3.0, 9.0, 99.0]);
        let weights = [1.0, 1.0 / 1.5, 0.25, 0.1, 0.01];
        let sum: f64 = weights.iter().sum();
        let mut total = [0.0; 5];
        for generation in 0..20_000 {
            let chosen = select(Selection::Sus, &costs, 3, &mut stream(generation));
            for (total, copies) in total.iter_mut().zip(copies(&chosen, 5)) {
                *total += copies as f64;
            }
        }
        for (total, weight) in total.into_iter().zip(weights) {
            let (mean, expected) = (total / 20_000.0, 3.0 * weight / sum);
            assert!(
                (mean - expected).abs() < 5.0 * (0.25_f64 / 20_000.0).sqrt(),
                "{mean}, {expected}"
            );
        }
    }

    #[test]
    fn a_failed_evaluation_is_never_a_parent_while_one_succeeded() {
        let costs = costs([f64::NAN, 5.0, f64::INFINITY, 5.0]);
        for generation in 0..1000 {
            let chosen = select(Selection::Sus, &costs, 6, &mut stream(generation));
            assert_eq!(chosen, [1, 1, 1, 3, 3, 3]);
        }
    }

    #[test]
    fn costs_too_far_apart_for_a_number_leave_the_best_one() {
        let costs = costs([f64::MAX, f64::MIN]);
        assert_eq!(select(Selection::Sus, &costs, 3, &mut stream(0)), [1, 1, 1]);
    }

    #[test]
    fn if_all_failed_everyone_is_a_parent_alike() {
        for selection in [Selection::Sus, Selection::LinearRank { pressure: 2.0 }] {
            let chosen = select(selection, &[Cost::WORST; 4], 8, &mut stream(0));
            assert_eq!(copies(&chosen, 4), [2, 2, 2, 2]);
        }
    }

    /// By hand for pressure 2 and five ranks: 2, 1.5, 1, 0.5 and 0 expected copies.
    #[test]
    fn linear_ranks_weigh_evenly_from_best_to_worst() {
        let costs = costs([7.0, -2.0, f64::NAN, 3.0, 100.0]);
        assert_eq!(linear_rank_weights(&costs, 2.0), [1.0, 2.0, 0.0, 1.5, 0.5]);
        let chosen = select(Selection::LinearRank { pressure: 2.0 }, &costs, 10, &mut stream(0));
        assert_eq!(copies(&chosen, 5), [2, 4, 0, 3, 1]);
    }

    #[test]
    fn equal_costs_share_their_ranks() {
        assert_eq!(linear_rank_weights(&costs([1.0, 0.0, 1.0]), 1.5), [0.75, 1.5, 0.75]);
        assert_eq!(linear_rank_weights(&[Cost::new(4.0); 3], 2.0), [1.0; 3]);
    }

    #[test]
    fn truncation_keeps_the_best_share_rounded_up() {
        let costs = costs([5.0, 1.0, 4.0, 2.0, 3.0]);
        let select =
            |share, count| select(Selection::Truncation { share }, &costs, count, &mut stream(0));
        assert_eq!(select(0.4, 6), [1, 1, 1, 3, 3, 3]);
        assert_eq!(select(0.41, 6), [1, 1, 3, 3, 4, 4]);
        assert_eq!(select(0.01, 2), [1, 1]);
        assert_eq!(select(1.0, 5), [0, 1, 2, 3, 4]);
    }

    #[test]
    fn the_best_come_once_each_in_order() {
        assert_eq!(best(&costs([3.0, 1.0, f64::NAN, 1.0]), 3), [1, 3, 0]);
    }

    /// Chi-square of five equally likely cells: 99.99 % of samples stay below 23.5.
    #[test]
    fn random_members_are_equally_likely() {
        let counts = copies(&random(5, 50_000, &mut stream(0)), 5);
        assert!(chi_square(counts.clone()) < 23.5, "{counts:?}");
    }
}

//! Smaller is better, everywhere in this crate, and failure has a place: the end.

use std::cmp::Ordering;

use serde::{Deserialize, Serialize};

/// What a genome costs (the paper's fitness, which it minimises). Smaller is better.
///
/// A finite number, or [`Self::WORST`]; never `NaN`, never `-0.0`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "f64", into = "f64")]
pub struct Cost(f64);

impl Cost {
    /// Ranks behind every cost an evaluation can have.
    pub const WORST: Self = Self(f64::INFINITY);

    /// Wraps a raw cost; an evaluation that broke down (`NaN` or infinite) ranks last.
    ///
    /// Adding zero turns `-0.0` into `0.0`, so that `==` and the ordering agree.
    pub fn new(cost: f64) -> Self {
        if cost.is_finite() { Self(cost + 0.0) } else { Self::WORST }
    }

    /// The number; infinite for [`Self::WORST`].
    pub fn value(self) -> f64 {
        self.0
    }
}

impl From<f64> for Cost {
    fn from(cost: f64) -> Self {
        Self::new(cost)
    }
}

impl From<Cost> for f64 {
    fn from(cost: Cost) -> Self {
        cost.0
    }
}

impl Eq for Cost {}

impl Ord for Cost {
    fn cmp(&self, other: &Self) -> Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl PartialOrd for Cost {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// Where the smallest cost is, the lowest index among equals; none if there are no costs.
pub fn best_index(costs: &[Cost]) -> Option<usize> {
    (0..costs.len()).min_by_key(|&index| costs[index])
}

/// All indices, best first, equals by index.
pub fn ranking(costs: &[Cost]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..costs.len()).collect();
    order.sort_by_key(|&index| costs[index]);
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    fn costs<const N: usize>(raw: [f64; N]) -> [Cost; N] {
        raw.map(Cost::new)
    }

    #[test]
    fn a_broken_evaluation_ranks_behind_every_other() {
        for broken in [f64::NAN, -f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(Cost::new(broken), Cost::WORST);
        }
        assert!(Cost::new(f64::MAX) < Cost::WORST);
    }

    #[test]
    fn both_zeros_are_one_cost() {
        assert_eq!(Cost::new(-0.0).cmp(&Cost::new(0.0)), Ordering::Equal);
        assert_eq!(Cost::new(-0.0).value().to_bits(), 0.0_f64.to_bits());
    }

    #[test]
    fn equal_costs_rank_by_index() {
        let tied = costs([4.0, -1.0, f64::NAN, -1.0, 4.0]);
        assert_eq!(best_index(&tied), Some(1));
        assert_eq!(ranking(&tied), [1, 3, 0, 4, 2]);
        assert_eq!(best_index(&[]), None);
    }

    #[test]
    fn all_failures_still_have_a_first_one() {
        assert_eq!(best_index(&[Cost::WORST; 3]), Some(0));
    }

    #[test]
    fn stored_bytes_cannot_bring_in_a_broken_cost() {
        let nan = postcard::to_allocvec(&f64::NAN).unwrap();
        assert_eq!(postcard::from_bytes(&nan), Ok(Cost::WORST));
        let worst = postcard::to_allocvec(&Cost::WORST).unwrap();
        assert_eq!(postcard::from_bytes(&worst), Ok(Cost::WORST));
    }
}

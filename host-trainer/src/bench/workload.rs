//! The scenario, and the population that every simulator starts from.

use crate::episode::Outcome;
use crate::evolve::Cost;
use crate::failure::Failure;
use crate::problem::Problem;
use crate::scenario::{self, Pair, PairSource, Source};
use std::path::Path;

/// Individuals.
pub const POPULATION: usize = 160;

/// Hidden neurons per layer, and inputs.
const H: usize = 12;
const I: usize = 7;

/// The scenario, built.
///
/// # Errors
///
/// None that a release can have: the scenario is part of the program.
pub fn problem() -> Result<Problem, Failure> {
    let source = Source::new("bench.toml", include_str!("workload.toml"), Path::new(""));
    Problem::new(scenario::load(&source, None, &[])?)
}

/// The five pairs.
pub fn pairs(problem: &Problem) -> &[Pair] {
    match &problem.scenario.pairs.source {
        PairSource::Listed(pairs) => pairs,
        PairSource::Drawn { .. } => &[],
    }
}

/// The genomes of the first `individuals`, one after the other.
///
/// Gene `k` of genome `g` is `(splitmix64(g·2²⁰ + k) >> 40)/2²³ − 1`. It counts the weights of
/// W1, R1, b1, W2, R2, b2, W3, b3, each matrix neuron by neuron; a genome of ours holds them
/// input by input.
pub fn population(individuals: usize) -> Vec<f32> {
    let mut genomes = Vec::new();
    for individual in 0..individuals as u64 {
        let mut first = 0;
        let mut matrix = |inputs: usize, neurons: usize| {
            for input in 0..inputs {
                for neuron in 0..neurons {
                    let gene_number = first + (neuron * inputs + input) as u64;
                    genomes.push(gene((individual << 20) + gene_number));
                }
            }
            first += (inputs * neurons) as u64;
        };
        for inputs in [I, H] {
            matrix(inputs, H);
            matrix(H, H);
            matrix(1, H);
        }
        matrix(H, 1);
        matrix(1, 1);
    }
    genomes
}

fn gene(number: u64) -> f32 {
    const STEP: f64 = 1.0 / (1 << 23) as f64;
    ((splitmix64(number) >> 40) as f64 * STEP - 1.0) as f32
}

/// Sebastiano Vigna's generator, at its `number`-th state (public domain, 2015).
fn splitmix64(number: u64) -> u64 {
    let mut word = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    word = (word ^ (word >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    word = (word ^ (word >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    word ^ (word >> 31)
}

/// What a drive costs: the share of the way that is left, 1 more for a crash, up to 1 less the
/// earlier the target is reached.
pub fn cost(problem: &Problem, pair: &Pair, outcome: &Outcome) -> f64 {
    let [x, y, _] = pair.start;
    let whole = f64::from(crate::world::distance([x, y], pair.goal));
    let left = f64::from(outcome.distance_to_target) / whole;
    let used = f64::from(outcome.steps) / f64::from(problem.scenario.episode.step_limit);
    let crashed = if outcome.collisions > 0 { 1.0 } else { 0.0 };
    left + crashed - if outcome.reached { 1.0 - used } else { 0.0 }
}

/// What each individual costs: the mean of its drives.
pub fn costs(problem: &Problem, outcomes: &[Outcome]) -> Vec<Cost> {
    let pairs = pairs(problem);
    let of_one = |outcomes: &[Outcome]| {
        let mut sum = 0.0;
        for (pair, outcome) in pairs.iter().zip(outcomes) {
            sum += cost(problem, pair, outcome);
        }
        Cost::new(sum / pairs.len() as f64)
    };
    outcomes.chunks(pairs.len()).map(of_one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_workload_has_36_walls_5_pairs_and_553_weights() {
        let problem = problem().unwrap();
        assert_eq!(problem.world.segments().len(), 36);
        assert_eq!(pairs(&problem).len(), 5);
        assert_eq!(problem.topology().weights(), 553);
        assert_eq!(population(3).len(), 3 * 553);
    }

    /// Expected: Vigna's splitmix64.c, started at 0.
    #[test]
    fn the_generator_is_the_published_one() {
        assert_eq!(splitmix64(0), 0xe220_a839_7b1d_cdaf);
        assert_eq!(splitmix64(0x9e37_79b9_7f4a_7c15), 0x6e78_9e6a_a1b9_65f4);
    }
}

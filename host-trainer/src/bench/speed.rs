//! Steps per second, and the time of a paper-size run.

use super::workload;
use crate::evolve::ga::{Ga, GaSpec, Mutation, Selection};
use crate::evolve::{Optimizer, SearchSpace, best_index};
use crate::failure::Failure;
use crate::problem::{Problem, training_drive};
use crate::seed::RunSeed;
use crate::signals::StopFlag;
use crate::vector::Instructions;
use crate::wide::{Drives, Fleet, Tally};
use std::time::{Duration, Instant};

/// One measurement.
#[derive(Clone, Copy, Debug)]
pub struct Measurement {
    /// Control periods of all cars.
    pub steps: u64,
    /// How long they took.
    pub time: Duration,
}

impl Measurement {
    /// Control periods per second.
    pub fn steps_per_second(&self) -> f64 {
        // A clock that did not move must not make the speed infinite.
        self.steps as f64 / self.time.max(Duration::from_nanos(1)).as_secs_f64()
    }
}

/// The measurement in the middle, by speed.
///
/// # Panics
///
/// Without a measurement.
pub fn median(mut measurements: Vec<Measurement>) -> Measurement {
    measurements.sort_by(|a, b| a.steps_per_second().total_cmp(&b.steps_per_second()));
    measurements[measurements.len() / 2]
}

/// Drives the workload's first generation once, on the current rayon pool: 240 000 steps.
/// Returns the drives beside the time, for a look at what was done.
pub fn generation(
    problem: &Problem,
    genomes: &[f32],
    instructions: Instructions,
) -> (Measurement, Drives) {
    let random = |pair| training_drive(RunSeed(1), 0, pair);
    let pairs = workload::pairs(problem);
    let fleet = Fleet { problem, genomes, pairs, random: &random, again: true };
    let begun = Instant::now();
    let drives = fleet.drive(instructions, &StopFlag::default());
    let time = begun.elapsed();
    let drives = drives.expect("nobody raises this flag");
    (Measurement { steps: drives.tally.steps, time }, drives)
}

/// The same with each car alone, on one thread.
pub fn generation_alone(problem: &Problem, genomes: &[f32]) -> Measurement {
    let begun = Instant::now();
    let mut steps = 0;
    let limit = problem.scenario.episode.step_limit;
    for genome in genomes.chunks(problem.topology().weights()) {
        let mut brain = problem.brain(genome).expect("the workload's topology");
        for pair in workload::pairs(problem) {
            let mut left = limit;
            while left > 0 {
                let random = |_| training_drive(RunSeed(1), 0, 0);
                let pair = std::slice::from_ref(pair);
                let outcome = problem.drive_all(brain.as_mut(), pair, random)[0];
                left = left.saturating_sub(outcome.steps.max(1));
                steps += u64::from(outcome.steps);
            }
        }
    }
    Measurement { steps, time: begun.elapsed() }
}

/// How a paper-size run went.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    /// All of it: drives, costs and breeding.
    pub whole: Measurement,
    /// How long costs and breeding took.
    pub evolution: Duration,
    /// What happened in the drives.
    pub tally: Tally,
    /// The best cost of the last generation.
    pub best: f64,
}

/// A paper-size run: as many generations as the workload says, bred in the paper's proportions
/// (40 % crossed, 40 % mutated, 2 % kept, 18 % random).
///
/// # Errors
///
/// None that a release can have: the settings are part of the program.
pub fn run(problem: &Problem, instructions: Instructions) -> Result<Run, Failure> {
    let spec = GaSpec {
        selection: Selection::LinearRank { pressure: 2.0 },
        mutation: Mutation::Additive { amplitude: 0.5 },
        ..GaSpec::PAPER
    };
    let training = &problem.scenario.training;
    let space = SearchSpace {
        population: training.population as usize,
        genome_len: problem.topology().weights(),
        bound: training.weight_bound,
    };
    let begun = Instant::now();
    let mut search = Ga::new(space, spec, RunSeed(1))
        .map_err(|error| Failure::bad_input(format!("bench: {error}")))?;
    let (mut tally, mut evolution, mut best) = (Tally::default(), Duration::ZERO, f64::NAN);
    for _ in 0..training.generations {
        let (_, drives) = generation(problem, search.ask().genes(), instructions);
        let judged = Instant::now();
        tally.steps += drives.tally.steps;
        tally.stopped += drives.tally.stopped;
        tally.reached += drives.tally.reached;
        let costs = workload::costs(problem, &drives.outcomes);
        best = best_index(&costs).map_or(f64::NAN, |index| costs[index].value());
        search.tell(&costs);
        evolution += judged.elapsed();
    }
    let whole = Measurement { steps: tally.steps, time: begun.elapsed() };
    Ok(Run { whole, evolution, tally, best })
}

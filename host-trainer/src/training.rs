//! The training loop: ask for genomes, drive them, tell their costs. The only place that
//! joins evolution and driving.

use crate::episode::Outcome;
use crate::evolve::ga::Ga;
use crate::evolve::{Cost, Optimizer, Population, RestoreError, SearchSpace, State, best_index};
use crate::failure::Failure;
use crate::fitness;
use crate::pairs::PairSampler;
use crate::problem::{Problem, training_drive};
use crate::run_folder::MetricsRow;
use crate::scenario::Pair;
use crate::seed::RunSeed;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// The best individual so far.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Best {
    /// Its genome.
    pub genome: Vec<f32>,
    /// Its cost in the generation it was found in.
    pub cost: Cost,
    /// That generation, from 0.
    pub generation: u32,
}

/// Everything that training needs to go on, bit for bit.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Snapshot {
    search: State,
    history: Vec<MetricsRow>,
    best: Option<Best>,
}

/// A training run in memory; files are the caller's business.
pub struct Training<'a> {
    problem: &'a Problem,
    seed: RunSeed,
    sampler: PairSampler<'a>,
    search: Box<dyn Optimizer>,
    history: Vec<MetricsRow>,
    best: Option<Best>,
}

impl<'a> Training<'a> {
    /// A run at its beginning.
    ///
    /// # Errors
    ///
    /// Settings of the search that make no sense.
    pub fn new(problem: &'a Problem, seed: RunSeed) -> Result<Self, Failure> {
        let spec = &problem.scenario.training;
        let space = SearchSpace {
            population: spec.population as usize,
            genome_len: problem.topology().weights(),
            bound: spec.weight_bound,
        };
        let search = Ga::new(space, spec.ga, seed)
            .map_err(|error| Failure::bad_input(format!("training: {error}")))?;
        let sampler = PairSampler::new(&problem.world, &problem.scenario);
        let search: Box<dyn Optimizer> = Box::new(search);
        Ok(Self { problem, seed, sampler, search, history: Vec::new(), best: None })
    }

    /// The state to go on from.
    pub fn snapshot(&self) -> Snapshot {
        let Self { search, history, best, .. } = self;
        Snapshot { search: search.save(), history: history.clone(), best: best.clone() }
    }

    /// Goes on from a saved state of the same run.
    ///
    /// # Errors
    ///
    /// A state of another run.
    pub fn restore(&mut self, snapshot: Snapshot) -> Result<(), RestoreError> {
        self.search.restore(snapshot.search)?;
        self.history = snapshot.history;
        self.best = snapshot.best;
        Ok(())
    }

    /// Generations judged so far.
    pub fn generation(&self) -> u32 {
        self.search.generation()
    }

    /// One row per judged generation.
    pub fn history(&self) -> &[MetricsRow] {
        &self.history
    }

    /// The answer so far: the best of the last generation (the paper's "best individual of the
    /// P"), or of all generations where the same genome always costs the same.
    pub fn best(&self) -> Option<&Best> {
        self.best.as_ref()
    }

    /// The pairs that a generation drives.
    ///
    /// # Errors
    ///
    /// A world in which no pair is found.
    pub fn pairs(&self, generation: u32) -> Result<Vec<Pair>, Failure> {
        let pairs = self.sampler.training(&self.problem.scenario, self.seed, generation);
        pairs.map_err(|error| Failure::bad_input(error.to_string()))
    }

    /// Judges the current generation on the current rayon pool and breeds the next.
    ///
    /// # Errors
    ///
    /// A world in which no pair is found.
    pub fn step(&mut self) -> Result<&MetricsRow, Failure> {
        let generation = self.generation();
        let pairs = self.pairs(generation)?;
        let drives = judge(self.problem, self.seed, self.search.ask(), &pairs, generation);
        let fitness = &self.problem.scenario.fitness;
        let costs: Vec<Cost> =
            drives.iter().map(|drives| fitness::total(fitness, drives)).collect();
        let best = best_index(&costs).expect("a population has at least two individuals");
        let row = row(generation, &costs, &drives, best);
        self.keep(generation, costs[best], best);
        self.search.tell(&costs);
        Ok(self.history.push_mut(row))
    }

    fn keep(&mut self, generation: u32, cost: Cost, index: usize) {
        let known = self.best.as_ref().filter(|_| self.problem.is_stationary());
        if known.is_none_or(|known| cost < known.cost) {
            let genome = self.search.ask().genome(index).to_vec();
            self.best = Some(Best { genome, cost, generation });
        }
    }
}

/// Every individual's drives, in order. An indexed parallel iterator keeps that order, so
/// threads cannot change the result.
fn judge(
    problem: &Problem,
    seed: RunSeed,
    population: &Population,
    pairs: &[Pair],
    generation: u32,
) -> Vec<Vec<Outcome>> {
    let judge = |index: usize| {
        let brain = problem.brain(population.genome(index));
        let mut brain = brain.expect("genomes have the network's length");
        problem.drive_all(brain.as_mut(), pairs, |drive| training_drive(seed, generation, drive))
    };
    (0..population.size()).into_par_iter().map(judge).collect()
}

fn row(generation: u32, costs: &[Cost], drives: &[Vec<Outcome>], best: usize) -> MetricsRow {
    let (mut mean, mut worst) = (0.0, Cost::new(f64::MIN));
    for cost in costs {
        mean += cost.value() / costs.len() as f64;
        worst = worst.max(*cost);
    }
    let champion = &drives[best];
    let count = |drives: &[Outcome], counts: fn(&Outcome) -> bool| {
        drives.iter().filter(|drive| counts(drive)).count()
    };
    let share = |n: usize, of: usize| n as f64 / of as f64;
    let reached_by_all: usize =
        drives.iter().map(|drives| count(drives, |drive| drive.reached)).sum();
    let reached = count(champion, |drive| drive.reached);
    let (mut distance_to_target, mut path_length) = (0.0, 0.0);
    for drive in champion {
        distance_to_target += f64::from(drive.distance_to_target);
        path_length += f64::from(drive.path_length);
    }
    let live_steps = drives.iter().flatten().map(|drive| u64::from(drive.steps)).sum();
    MetricsRow {
        generation,
        best: costs[best].value(),
        mean,
        worst: worst.value(),
        collisions: champion.iter().map(|drive| u64::from(drive.collisions)).sum(),
        distance_to_target,
        bonus: reached as u32,
        path_length,
        reached: share(reached, champion.len()),
        clean: share(count(champion, Outcome::clean), champion.len()),
        population_reached: share(reached_by_all, champion.len() * drives.len()),
        live_steps,
    }
}

//! The training loop: ask for genomes, drive them, tell their costs. The only place that
//! joins evolution and driving.

use crate::episode::Outcome;
use crate::evolve::ga::Ga;
use crate::evolve::{Cost, Optimizer, Population, RestoreError, SearchSpace, State, best_index};
use crate::failure::Failure;
use crate::fingerprint;
use crate::fitness;
use crate::pairs::PairSampler;
use crate::problem::{Problem, topology_of, training_drive};
use crate::run_folder::MetricsRow;
use crate::scenario::{Complaint, Pair, PairSource, Scenario, TrainingSpec};
use crate::seed::RunSeed;
use crate::signals::StopFlag;
use crate::vector::Instructions;
use crate::wide::Fleet;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::fmt;

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
    run: RunId,
    search: State,
    history: Vec<MetricsRow>,
    best: Option<Best>,
}

/// What a run is: SHA-256 of its seed and its scenario, whose number of generations does not
/// count.
type RunId = [u8; 32];

/// Why a saved state is not gone on from.
#[derive(Clone, Debug, PartialEq)]
pub enum ResumeError {
    /// It was saved under another scenario or another seed.
    OtherRun,
    /// The search refuses its part.
    Search(RestoreError),
    /// It does not hold one row per judged generation.
    History {
        /// Rows.
        found: usize,
        /// Judged generations.
        expected: u32,
    },
}

impl fmt::Display for ResumeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OtherRun => f.write_str("it was saved under another scenario or seed"),
            Self::Search(error) => error.fmt(f),
            Self::History { found, expected } => {
                write!(f, "the history has {found} generations, expected {expected}")
            }
        }
    }
}

impl std::error::Error for ResumeError {}

/// A training run in memory; files are the caller's business.
pub struct Training<'a> {
    problem: &'a Problem,
    run: RunId,
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
        let sampler = problem.sampler();
        let search: Box<dyn Optimizer> = Box::new(search);
        let run = run_id(&problem.scenario, seed);
        Ok(Self { problem, run, seed, sampler, search, history: Vec::new(), best: None })
    }

    /// The state to go on from.
    pub fn snapshot(&self) -> Snapshot {
        let Self { run, search, history, best, .. } = self;
        Snapshot { run: *run, search: search.save(), history: history.clone(), best: best.clone() }
    }

    /// Goes on from a saved state of the same run.
    ///
    /// # Errors
    ///
    /// A state of another run.
    pub fn restore(&mut self, snapshot: Snapshot) -> Result<(), ResumeError> {
        if snapshot.run != self.run {
            return Err(ResumeError::OtherRun);
        }
        self.search.restore(snapshot.search).map_err(ResumeError::Search)?;
        let (found, expected) = (snapshot.history.len(), self.search.generation());
        if found as u64 != u64::from(expected) {
            return Err(ResumeError::History { found, expected });
        }
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
        pairs
            .map_err(|error| Failure::bad_input(format!("{}: {error}", self.problem.scenario.name)))
    }

    /// Judges the current generation on the current rayon pool and breeds the next.
    ///
    /// # Errors
    ///
    /// A world in which no pair is found.
    pub fn step(&mut self) -> Result<&MetricsRow, Failure> {
        let never = StopFlag::default();
        Ok(self.step_unless(&never)?.expect("nobody raises this flag"))
    }

    /// The same; none, and nothing has changed, if `stop` was raised meanwhile.
    ///
    /// # Errors
    ///
    /// A world in which no pair is found.
    pub fn step_unless(&mut self, stop: &StopFlag) -> Result<Option<&MetricsRow>, Failure> {
        let generation = self.generation();
        let pairs = self.pairs(generation)?;
        let population = self.search.ask();
        let Some(drives) = judge(self.problem, self.seed, population, &pairs, generation, stop)
        else {
            return Ok(None);
        };
        let fitness = &self.problem.scenario.fitness;
        let costs: Vec<Cost> =
            drives.chunks(pairs.len()).map(|drives| fitness::total(fitness, drives)).collect();
        let best = best_index(&costs).expect("a population has at least two individuals");
        let row = row(generation, &costs, &drives, pairs.len(), best);
        self.keep(generation, costs[best], best);
        self.search.tell(&costs);
        Ok(Some(self.history.push_mut(row)))
    }

    fn keep(&mut self, generation: u32, cost: Cost, index: usize) {
        let known = self.best.as_ref().filter(|_| self.problem.is_stationary());
        if known.is_none_or(|known| cost < known.cost) {
            let genome = self.search.ask().genome(index).to_vec();
            self.best = Some(Best { genome, cost, generation });
        }
    }
}

fn run_id(scenario: &Scenario, seed: RunSeed) -> RunId {
    let mut scenario = scenario.clone();
    scenario.training.generations = *TrainingSpec::GENERATIONS.start();
    let scenario = fingerprint::scenario(&scenario);
    Sha256::new().chain_update(seed.0.to_le_bytes()).chain_update(scenario).finalize().into()
}

/// Most weights of a population: 256 MiB, of which training holds a few copies.
const MOST_WEIGHTS: u64 = 1 << 26;

/// Most drives in one generation; their outcomes are held until it is judged.
const MOST_DRIVES: u64 = 10_000_000;

/// A search that would not fit into memory.
pub fn too_large(scenario: &Scenario) -> Option<Complaint> {
    let population = u64::from(scenario.training.population);
    let weights = topology_of(scenario).weights() as u64;
    if population * weights > MOST_WEIGHTS {
        let most = MOST_WEIGHTS / weights;
        let detail = format!(
            "found {population} individuals with {weights} weights each, expected at most {most}"
        );
        let title = "the population is too large for this network";
        return Some(Complaint::new("training.population", title, detail).or_at("network.hidden"));
    }
    let pairs = match &scenario.pairs.source {
        PairSource::Drawn { count, .. } => u64::from(*count),
        PairSource::Listed(pairs) => pairs.len() as u64,
    };
    if population * pairs > MOST_DRIVES {
        let detail = format!(
            "found {population} individuals with {pairs} pairs each, expected at most \
             {MOST_DRIVES} drives"
        );
        let complaint = Complaint::new("pairs.count", "a generation has too many drives", detail);
        return Some(complaint.or_at("training.population").or_at("pairs.list"));
    }
    None
}

/// Every individual's drives, all of the first individual, then of the second; none once `stop`
/// is raised.
fn judge(
    problem: &Problem,
    seed: RunSeed,
    population: &Population,
    pairs: &[Pair],
    generation: u32,
    stop: &StopFlag,
) -> Option<Vec<Outcome>> {
    let random = |pair| training_drive(seed, generation, pair);
    let fleet =
        Fleet { problem, genomes: population.genes(), pairs, random: &random, again: false };
    fleet.drive(Instructions::in_use(), stop).map(|drives| drives.outcomes)
}

fn row(
    generation: u32,
    costs: &[Cost],
    drives: &[Outcome],
    pairs: usize,
    best: usize,
) -> MetricsRow {
    let (mut mean, mut worst) = (0.0, Cost::new(f64::MIN));
    for cost in costs {
        mean += cost.value() / costs.len() as f64;
        worst = worst.max(*cost);
    }
    let champion = &drives[best * pairs..][..pairs];
    let count = |drives: &[Outcome], counts: fn(&Outcome) -> bool| {
        drives.iter().filter(|drive| counts(drive)).count()
    };
    let share = |n: usize, of: usize| n as f64 / of as f64;
    let reached_by_all = count(drives, |drive| drive.reached);
    let reached = count(champion, |drive| drive.reached);
    let (mut distance_to_target, mut path_length) = (0.0, 0.0);
    for drive in champion {
        distance_to_target += f64::from(drive.distance_to_target);
        path_length += f64::from(drive.path_length);
    }
    let live_steps = drives.iter().map(|drive| u64::from(drive.steps)).sum();
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
        population_reached: share(reached_by_all, drives.len()),
        live_steps,
    }
}

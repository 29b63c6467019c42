//! The training loop: ask for genomes, drive them, tell their costs. The only place that
//! joins evolution and driving.
//!
//! | look in | for |
//! | --- | --- |
//! | `scales` | how large each weight of a network is, typically |
//! | `hard` | which pairs the next generation keeps |
//! | `grounds` | the worlds that training drives in |
//! | `test_drives` | whole generations of drives, some of them with a worse car |
//! | `row` | what the metrics say of a generation |

mod grounds;
mod hard;
mod row;
mod scales;
mod test_drives;
#[cfg(test)]
mod tests;

use crate::episode::Outcome;
use crate::evolve::ga::{Ga, Outlook, SettingError, progress};
use crate::evolve::novelty::Behaviours;
use crate::evolve::{
    Cost, GenomeError, Islands, Novelty, Optimizer, RestoreError, SearchSpace, State,
};
use crate::failure::Failure;
use crate::fingerprint;
use crate::fitness;
use crate::pairs::{self, NoPair};
use crate::problem::{Problem, topology_of, training_drive, validation_drive};
use crate::run_folder::MetricsRow;
use crate::scenario::generate::Recipe;
use crate::scenario::{Complaint, Pair, PairSource, Scenario, TrainingSpec};
use crate::seed::RunSeed;
use crate::signals::StopFlag;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::fmt;
use test_drives::{Cars, TestDrives};

/// The best individual so far.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Best {
    /// Its genome.
    pub genome: Vec<f32>,
    /// Its cost on the validation pairs; without these, in the generation it was found in.
    pub cost: Cost,
    /// That generation, from 0.
    pub generation: u32,
    /// The pairs which that generation had kept from the one before.
    pub kept: Vec<Pair>,
}

/// Everything that training needs to go on, bit for bit.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Snapshot {
    run: RunId,
    search: State,
    history: Vec<MetricsRow>,
    best: Option<Best>,
    kept: Vec<Pair>,
}

/// What a run is: SHA-256 of its seed, of its scenario, whose number of generations counts only
/// where it [matters](depends_on_generations), of the worlds it begins in, and of the genome it begins with.
type RunId = [u8; 32];

/// Why a saved state is not gone on from.
#[derive(Clone, Debug, PartialEq)]
pub enum ResumeError {
    /// It was saved under another scenario or another seed, or began with another genome.
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
            Self::OtherRun => f.write_str("it was saved under another scenario, seed or beginning"),
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
    test_drives: TestDrives,
    run: RunId,
    seed: RunSeed,
    search: Box<dyn Optimizer>,
    /// What the search is told in place of costs, if anything.
    novelty: Option<Novelty>,
    /// Where the drives of the last judged generation ended.
    ends: Behaviours,
    history: Vec<MetricsRow>,
    best: Option<Best>,
    /// Pairs that the current generation keeps from the one before.
    kept: Vec<Pair>,
    /// Pairs that choose the champion among the best of each generation; none if the last
    /// generation has it.
    validation: Vec<Pair>,
}

impl<'a> Training<'a> {
    /// A run at its beginning.
    ///
    /// # Errors
    ///
    /// Settings of the search that make no sense, a world in which no pair is found, or random
    /// worlds without a way through.
    pub fn new(problem: &'a Problem, seed: RunSeed) -> Result<Self, Failure> {
        Self::begin(problem, seed, None)
    }

    /// The same; with a genome, beginning with that and mutants of it instead of with random genomes.
    ///
    /// # Errors
    ///
    /// As [`Self::new`]; a genome that is not one of the problem's network, or with a weight beyond
    /// the bound.
    pub fn begin(
        problem: &'a Problem,
        seed: RunSeed,
        genome: Option<&[f32]>,
    ) -> Result<Self, Failure> {
        let spec = &problem.scenario.training;
        let space = SearchSpace {
            population: spec.population as usize,
            genome_len: problem.topology().weights(),
            bound: spec.weight_bound,
        };
        let scales = scales::scales(problem.topology());
        let outlook = Outlook { generations: spec.generations, scales };
        let search = search(spec, space, outlook, seed, genome)?;
        let test_drives = TestDrives::new(problem, seed, 0)?;
        let validation = match problem.scenario.pairs.source {
            PairSource::Drawn { .. } if !holds_out(spec) => {
                pairs::validation_in(&test_drives.samplers(), seed, spec.validation_pairs)
            }
            _ => Ok(Vec::new()),
        };
        let validation = validation.map_err(|none| no_pair(problem, none))?;
        let run = run_id(&problem.scenario, test_drives.scenarios(), seed, genome);
        let (history, kept) = (Vec::new(), Vec::new());
        let coordinates = 2 * count_of_pairs(&problem.scenario) as usize;
        let novelty = spec.novelty.map(|novelty| Novelty::new(novelty, coordinates, seed));
        Ok(Self {
            problem,
            test_drives,
            run,
            seed,
            search,
            novelty,
            ends: Behaviours::none(coordinates),
            history,
            best: None,
            kept,
            validation,
        })
    }

    /// The state to go on from.
    pub fn snapshot(&self) -> Snapshot {
        let Self { run, search, novelty, history, best, kept, .. } = self;
        let (history, best, kept) = (history.clone(), best.clone(), kept.clone());
        let search = match novelty {
            None => search.save(),
            Some(novelty) => State::Novelty {
                search: Box::new(search.save()),
                archive: novelty.archive().clone(),
            },
        };
        Snapshot { run: *run, search, history, best, kept }
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
        let (search, archive) = match (snapshot.search, &self.novelty) {
            (State::Novelty { search, archive }, Some(_)) => (*search, Some(archive)),
            (search @ (State::Ga(_) | State::Islands(_)), None) => (search, None),
            _ => return Err(ResumeError::Search(RestoreError::Method)),
        };
        self.search.restore(search).map_err(ResumeError::Search)?;
        if let Some((novelty, archive)) = self.novelty.as_mut().zip(archive) {
            let (generation, population) = (self.search.generation(), self.search.ask().size());
            novelty.restore(archive, generation, population).map_err(ResumeError::Search)?;
        }
        let (found, expected) = (snapshot.history.len(), self.search.generation());
        if found as u64 != u64::from(expected) {
            return Err(ResumeError::History { found, expected });
        }
        self.history = snapshot.history;
        self.best = snapshot.best;
        self.kept = snapshot.kept;
        Ok(())
    }

    /// Generations judged so far.
    pub fn generation(&self) -> u32 {
        self.search.generation()
    }

    /// Whether somebody reached the targets of all pairs in a run that
    /// [ends](TrainingSpec::until_reached) with that.
    pub fn is_solved(&self) -> bool {
        self.history.last().is_some_and(|row| self.solves(row))
    }

    /// Whether the best of this generation ends the run.
    fn solves(&self, row: &MetricsRow) -> bool {
        self.problem.scenario.training.until_reached && row.reached == 1.0
    }

    /// Whether there is nothing left to do.
    pub fn is_over(&self) -> bool {
        self.generation() >= self.problem.scenario.training.generations || self.is_solved()
    }

    /// What a search by novelty remembers: where drives of earlier generations ended.
    pub fn archive(&self) -> Option<&Behaviours> {
        self.novelty.as_ref().map(Novelty::archive)
    }

    /// Where the drives of the last generation ended that was judged here: one point for each
    /// individual, with x and y of each pair.
    pub fn ends(&self) -> &Behaviours {
        &self.ends
    }

    /// One row per judged generation.
    pub fn history(&self) -> &[MetricsRow] {
        &self.history
    }

    /// The answer so far: the best of the last generation (the paper's "best individual of the
    /// P"), or of all generations where the same genome always costs the same. With validation
    /// pairs, of every generation's best the one that costs least there; with worlds held out, after the
    /// last generation, whoever of it costs least in those.
    pub fn best(&self) -> Option<&Best> {
        self.best.as_ref()
    }

    /// The pairs that the generation drove in which this best individual was found; pair `i` lies
    /// in world `i` modulo the number of [worlds](Self::worlds_in) of that generation, if the run makes
    /// any.
    ///
    /// # Errors
    ///
    /// A world in which no pair is found, or random worlds without a way through.
    pub fn pairs_of(&self, best: &Best) -> Result<Vec<Pair>, Failure> {
        let then = self.earlier(best.generation)?;
        self.pairs(then.as_ref().unwrap_or(&self.test_drives), best.generation, &best.kept)
    }

    fn pairs(
        &self,
        test_drives: &TestDrives,
        generation: u32,
        kept: &[Pair],
    ) -> Result<Vec<Pair>, Failure> {
        let (samplers, scenario) = (test_drives.samplers(), &self.problem.scenario);
        let pairs = pairs::training_in(&samplers, kept, scenario, self.seed, generation);
        pairs.map_err(|none| no_pair(self.problem, none))
    }

    /// The worlds that the run makes for itself to drive in in this generation; none if it drives in
    /// the problem's own.
    ///
    /// # Errors
    ///
    /// Random worlds without a way through.
    pub fn worlds_in(&self, generation: u32) -> Result<Vec<Recipe>, Failure> {
        let then = self.earlier(generation)?;
        Ok(then.as_ref().unwrap_or(&self.test_drives).recipes().collect())
    }

    /// The worlds of that generation, if they are no longer there.
    fn earlier(&self, generation: u32) -> Result<Option<TestDrives>, Failure> {
        let are_there = self.test_drives.are_of(self.problem, generation);
        (!are_there).then(|| TestDrives::new(self.problem, self.seed, generation)).transpose()
    }

    /// How this best individual drives the [pairs](Self::pairs_of) of its generation, each in its
    /// world, with the car as it is described; none once `stop` is raised.
    ///
    /// # Errors
    ///
    /// A world in which no pair is found, or random worlds without a way through.
    pub fn drives_of(&self, best: &Best, stop: &StopFlag) -> Result<Option<Vec<Outcome>>, Failure> {
        let (generation, seed) = (best.generation, self.seed);
        let then = self.earlier(generation)?;
        let test_drives = then.as_ref().unwrap_or(&self.test_drives);
        let pairs = self.pairs(test_drives, generation, &best.kept)?;
        let random = |pair| training_drive(seed, generation, pair);
        Ok(test_drives.of(&best.genome, Cars::AsDescribed, &pairs, &random, stop))
    }

    /// Shows that the first generation finds its pairs.
    ///
    /// # Errors
    ///
    /// A world in which no pair is found.
    pub fn can_begin(&self) -> Result<(), Failure> {
        self.pairs(&self.test_drives, 0, &[]).map(drop)
    }

    /// The cars of a generation. Where few are under stress, each kind still has its turn in some generation.
    fn cars_in(&self, generation: u32) -> Cars {
        let spec = &self.problem.scenario.training;
        let stressed = spec.stressed_share_at(progress(generation, spec.generations));
        Cars::OfTraining { stressed, first_turn: generation.into() }
    }

    /// Judges the current generation on the current rayon pool and breeds the next.
    ///
    /// # Errors
    ///
    /// A world in which no pair is found, or random worlds without a way through.
    pub fn step(&mut self) -> Result<&MetricsRow, Failure> {
        let never = StopFlag::default();
        Ok(self.step_unless(&never)?.expect("nobody raises this flag"))
    }

    /// The same; none, and nothing has been judged, if `stop` was raised meanwhile.
    ///
    /// # Errors
    ///
    /// A world in which no pair is found, or random worlds without a way through.
    pub fn step_unless(&mut self, stop: &StopFlag) -> Result<Option<&MetricsRow>, Failure> {
        let generation = self.generation();
        self.test_drives.renew(self.problem, self.seed, generation)?;
        let pairs = self.pairs(&self.test_drives, generation, &self.kept)?;
        let genomes = self.search.ask().genes();
        let random = |pair| training_drive(self.seed, generation, pair);
        let cars = self.cars_in(generation);
        let Some(drives) = self.test_drives.of(genomes, cars, &pairs, &random, stop) else {
            return Ok(None);
        };
        let scenario = &self.problem.scenario;
        let costs: Vec<Cost> = drives
            .chunks(pairs.len())
            .map(|drives| fitness::total(scenario, &pairs, drives))
            .collect();
        let best = self.best_of(&costs, &drives, pairs.len());
        let row = row::row(generation, &costs, &drives, pairs.len(), best);
        let solves = self.solves(&row);
        let spec = &scenario.training;
        let is_last = generation + 1 >= spec.generations || solves;
        let chosen = if is_last && holds_out(spec) {
            self.chosen_elsewhere(stop)?
        } else {
            self.validated(best, costs[best], stop).map(|cost| (best, cost))
        };
        let Some((chosen, cost)) = chosen else { return Ok(None) };
        self.keep(generation, cost, chosen, solves);
        self.kept = hard::hardest(&pairs, &drives, scenario.pairs.mine);
        self.ends = ends(&drives, pairs.len());
        match &mut self.novelty {
            None => self.search.tell(&costs),
            Some(novelty) => self.search.tell(&novelty.judge(generation, &self.ends)),
        }
        Ok(Some(self.history.push_mut(row)))
    }

    /// Who costs least; where the run ends with the targets reached, those who reach all of them
    /// come first, whatever they cost.
    fn best_of(&self, costs: &[Cost], drives: &[Outcome], pairs: usize) -> usize {
        let until_reached = self.problem.scenario.training.until_reached;
        let misses = |index: usize| {
            until_reached && !drives[index * pairs..][..pairs].iter().all(|drive| drive.reached)
        };
        let order = (0..costs.len()).min_by_key(|&index| (misses(index), costs[index]));
        order.expect("a population has at least two individuals")
    }

    /// What an individual costs on the validation pairs, or `cost` if there are none; none if
    /// `stop` was raised meanwhile.
    fn validated(&self, index: usize, cost: Cost, stop: &StopFlag) -> Option<Cost> {
        if self.validation.is_empty() {
            return Some(cost);
        }
        let genome = self.search.ask().genome(index);
        let costs = self.costs_of(genome, &self.test_drives, &self.validation, stop)?;
        Some(costs[0])
    }

    /// Who costs least in the worlds that are held out, and how much; none if `stop` was raised
    /// meanwhile.
    fn chosen_elsewhere(&self, stop: &StopFlag) -> Result<Option<(usize, Cost)>, Failure> {
        let Some(worlds) = TestDrives::held_out(self.problem, self.seed)? else { return Ok(None) };
        let count = self.problem.scenario.training.validation_pairs;
        let pairs = pairs::validation_in(&worlds.samplers(), self.seed, count)
            .map_err(|none| no_pair(self.problem, none))?;
        let costs = self.costs_of(self.search.ask().genes(), &worlds, &pairs, stop);
        Ok(costs.and_then(|costs| (0..).zip(costs).min_by_key(|(_, cost)| *cost)))
    }

    /// What each of these genomes costs on pairs that choose the champion; none if `stop` was raised
    /// meanwhile.
    fn costs_of(
        &self,
        genomes: &[f32],
        worlds: &TestDrives,
        pairs: &[Pair],
        stop: &StopFlag,
    ) -> Option<Vec<Cost>> {
        let (scenario, seed) = (&self.problem.scenario, self.seed);
        let random = |pair| validation_drive(seed, pair);
        let stressed = scenario.training.stressed_share.into();
        let cars = Cars::OfTraining { stressed, first_turn: 0 };
        let drives = worlds.of(genomes, cars, pairs, &random, stop)?;
        let each = drives.chunks(pairs.len());
        Some(each.map(|drives| fitness::total(scenario, pairs, drives)).collect())
    }

    fn keep(&mut self, generation: u32, cost: Cost, index: usize, solves: bool) {
        let comparable = !self.validation.is_empty()
            || (self.problem.is_stationary() && !holds_out(&self.problem.scenario.training));
        let known = self.best.as_ref().filter(|_| comparable);
        if solves || known.is_none_or(|known| cost < known.cost) {
            let genome = self.search.ask().genome(index).to_vec();
            self.best = Some(Best { genome, cost, generation, kept: self.kept.clone() });
        }
    }
}

/// The search at its beginning: random, or with a genome and mutants of it.
fn search(
    spec: &TrainingSpec,
    space: SearchSpace,
    outlook: Outlook,
    seed: RunSeed,
    genome: Option<&[f32]>,
) -> Result<Box<dyn Optimizer>, Failure> {
    let senseless = |error: SettingError| Failure::bad_input(format!("training: {error}"));
    let refused = |error: GenomeError| {
        Failure::bad_input(format!("training: the genome to begin with: {error}"))
    };
    let mut search: Box<dyn Optimizer> = if spec.islands == 1 {
        Box::new(Ga::with_outlook(space, spec.ga, outlook, seed).map_err(senseless)?)
    } else {
        let islands = Islands::new(spec.islands, space, spec.ga, outlook, seed);
        Box::new(islands.map_err(senseless)?)
    };
    if let Some(genome) = genome {
        search.begin_with(genome).map_err(refused)?;
    }
    Ok(search)
}

/// Whether the champion is chosen in worlds that nobody is trained in.
fn holds_out(spec: &TrainingSpec) -> bool {
    spec.worlds.is_some_and(|worlds| worlds.held_out > 0)
}

fn run_id<'a>(
    scenario: &Scenario,
    made: impl Iterator<Item = &'a Scenario>,
    seed: RunSeed,
    genome: Option<&[f32]>,
) -> RunId {
    let mut scenario = scenario.clone();
    if !depends_on_generations(&scenario) {
        scenario.training.generations = *TrainingSpec::GENERATIONS.start();
    }
    let scenario = fingerprint::scenario(&scenario);
    let own = Sha256::new().chain_update(seed.0.to_le_bytes()).chain_update(scenario);
    // Another version may make other worlds of the same seed.
    let of_worlds = made.map(fingerprint::scenario).fold(own, Sha256::chain_update);
    let weights = genome.into_iter().flatten().map(|weight| weight.to_le_bytes());
    weights.fold(of_worlds, Sha256::chain_update).finalize().into()
}

/// Whether another number of generations makes another run from its second generation on: some
/// setting follows a plan from the first generation to the last.
pub fn depends_on_generations(scenario: &Scenario) -> bool {
    let Scenario { pairs, training, .. } = scenario;
    let stress_changes = training.stressed_share != training.stressed_share_start;
    let plans_its_end = training.ga.sigma_end.is_some() || training.islands > 1;
    pairs.count_end.is_some() || plans_its_end || stress_changes
}

fn no_pair(problem: &Problem, none: NoPair) -> Failure {
    let Scenario { name, training, .. } = &problem.scenario;
    let place = if training.worlds.is_some() { "a world of training.worlds" } else { name };
    Failure::bad_input(format!("{place}: {none}"))
}

/// Most weights of a population, and most coordinates of an archive: 256 MiB, of which training
/// holds a few copies.
const MOST_WEIGHTS: u64 = 1 << 26;

/// Most drives in one generation; their outcomes are held until it is judged.
const MOST_DRIVES: u64 = 10_000_000;

/// A search that would not fit into memory.
pub fn too_large(scenario: &Scenario) -> Option<Complaint> {
    let (population, found) =
        (scenario.training.individuals(), scenario.training.individuals_in_words());
    let weights = topology_of(scenario).weights() as u64;
    if population * weights > MOST_WEIGHTS {
        let most = MOST_WEIGHTS / weights;
        let detail = format!("found {found} with {weights} weights each, expected at most {most}");
        let title = "the population is too large for this network";
        let complaint = Complaint::new("training.population", title, detail);
        return Some(complaint.or_at("training.islands").or_at("network.hidden"));
    }
    let pairs = count_of_pairs(scenario);
    let grows = scenario.training.novelty.map_or(0, |novelty| u64::from(novelty.archive_growth));
    let archived = grows * u64::from(scenario.training.generations);
    if archived * 2 * pairs > MOST_WEIGHTS {
        let most = MOST_WEIGHTS / 2 / pairs;
        let detail =
            format!("found {archived} individuals with {pairs} ends each, expected at most {most}");
        let title = "the archive of the novelty search grows too large";
        let complaint = Complaint::new("training.novelty.archive_growth", title, detail);
        return Some(complaint.or_at("training.generations"));
    }
    if population * pairs > MOST_DRIVES {
        let detail =
            format!("found {found} with {pairs} pairs each, expected at most {MOST_DRIVES} drives");
        let complaint = Complaint::new("pairs.count", "a generation has too many drives", detail)
            .or_at("pairs.count_end");
        let complaint = complaint.or_at("training.population").or_at("training.islands");
        return Some(complaint.or_at("pairs.list"));
    }
    None
}

/// Pairs of the generation that has most of them.
fn count_of_pairs(scenario: &Scenario) -> u64 {
    match &scenario.pairs.source {
        PairSource::Drawn { count, .. } => {
            u64::from(*count).max(scenario.pairs.count_end.unwrap_or(0).into())
        }
        PairSource::Listed(pairs) => pairs.len() as u64,
    }
}

/// What each individual did: where its drives ended.
fn ends(drives: &[Outcome], pairs: usize) -> Behaviours {
    let mut ends = Behaviours::none(2 * pairs);
    for drive in drives {
        ends.extend(&drive.end);
    }
    ends
}

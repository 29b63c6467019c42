//! The paper's genetic algorithm.
//!
//! Each generation four groups are selected from the judged population and joined, in this
//! order, into the next one (the letters are the paper's):
//!
//! | group | selected by | then |
//! | --- | --- | --- |
//! | P1 | [`Selection`] | single-point [`crossover`] |
//! | P2 | [`Selection`] | [`mutation`] |
//! | P3 | rank, best first, one copy each | copied as they are |
//! | P4 | chance, with replacement | copied as they are |
//!
//! Where the paper is silent, the operators do what the first author's Genetic Algorithm
//! Toolbox for Matlab does; each module says what that is. Equal genomes are not removed, so
//! the group sizes ([`GaSpec::group_sizes`]) alone make the population.

pub mod crossover;
pub mod groups;
pub mod mutation;
pub mod selection;
pub mod settings;

use serde::{Deserialize, Serialize};

use settings::require;

use super::{Cost, GenomeError, Optimizer, Population, RestoreError, SearchSpace, State};
use crate::seed::{Purpose, RunSeed};

pub use settings::{GaSpec, Initial, Mutation, Selection, SettingError, between};

/// Where the mutants of a first generation have their random numbers; random genomes have theirs at 0.
const MUTANTS: u32 = 1;

/// What a search may know of its run beforehand; settings say whether it uses it.
#[derive(Clone, Debug, PartialEq)]
pub struct Outlook {
    /// Generations that will be judged in all.
    pub generations: u32,
    /// How large each gene is beside the others, typically; 1 if nothing is known.
    pub scales: Vec<f32>,
}

impl Outlook {
    /// Knows nothing about genomes of this length.
    pub fn none(genome_len: usize) -> Self {
        Self { generations: 1, scales: vec![1.0; genome_len] }
    }

    /// How far a generation, counted from 0, lies on the way from the first (0) to the last (1).
    pub fn progress(&self, generation: u32) -> f64 {
        progress(generation, self.generations)
    }

    /// Whether a generation lies at this part of the run, a fraction, or past it: to the generation, where
    /// [`Self::progress`] is rounded.
    pub(super) fn is_past(&self, generation: u32, (part, of): (u32, u32)) -> bool {
        let last = last(self.generations);
        u64::from(generation.min(last)) * u64::from(of) >= u64::from(part) * u64::from(last)
    }
}

/// How far a generation, counted from 0, lies on the way from the first of `generations` (0) to
/// the last (1).
pub fn progress(generation: u32, generations: u32) -> f64 {
    let last = last(generations);
    f64::from(generation.min(last)) / f64::from(last)
}

/// The last generation, at least 1.
fn last(generations: u32) -> u32 {
    generations.saturating_sub(1).max(1)
}

/// The genetic algorithm with its settings, at some generation of some run.
#[derive(Clone, Debug)]
pub struct Ga {
    space: SearchSpace,
    spec: GaSpec,
    outlook: Outlook,
    seed: RunSeed,
    /// Which of a run's populations this is; random numbers are its own.
    island: u32,
    generation: u32,
    population: Population,
    /// Where the next generation is bred, so that none is ever allocated.
    next: Population,
}

/// What a checkpoint keeps of the genetic algorithm; its settings are the run's.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GaState {
    seed: RunSeed,
    generation: u32,
    population: Population,
}

impl Ga {
    /// Starts from a random population, knowing nothing of its run; refuses settings that make
    /// no sense.
    pub fn new(space: SearchSpace, spec: GaSpec, seed: RunSeed) -> Result<Self, SettingError> {
        Self::with_outlook(space, spec, Outlook::none(space.genome_len), seed)
    }

    /// The same with what is known of the run.
    pub fn with_outlook(
        space: SearchSpace,
        spec: GaSpec,
        outlook: Outlook,
        seed: RunSeed,
    ) -> Result<Self, SettingError> {
        Self::on_island(0, space, spec, outlook, seed)
    }

    /// The same for one of several populations of a run, counted from 0.
    pub(super) fn on_island(
        island: u32,
        space: SearchSpace,
        spec: GaSpec,
        mut outlook: Outlook,
        seed: RunSeed,
    ) -> Result<Self, SettingError> {
        space.check()?;
        spec.check()?;
        let scales = outlook.scales.len();
        require(scales == space.genome_len, "scales", scales as f64, "one per gene")?;
        if !spec.fan_in {
            outlook.scales.fill(1.0);
        }
        let population = Population::random(&space, island, spec.initial, &outlook.scales, seed);
        let next = Population::zeros(&space);
        Ok(Self { space, spec, outlook, seed, island, generation: 0, population, next })
    }

    /// The same search with the random numbers of another island.
    pub(super) fn moved_to(self, island: u32) -> Self {
        Self { island, ..self }
    }

    /// What a checkpoint keeps of it.
    pub(super) fn state(&self) -> GaState {
        let Self { seed, generation, ref population, .. } = *self;
        GaState { seed, generation, population: population.clone() }
    }
}

impl Optimizer for Ga {
    fn name(&self) -> &'static str {
        "ga"
    }

    fn generation(&self) -> u32 {
        self.generation
    }

    fn ask(&self) -> &Population {
        &self.population
    }

    /// Draws in the order of the paper's listing (2.2 to 2.7): P1, P2, P4, crossover, mutation.
    fn tell(&mut self, costs: &[Cost]) {
        let old = &self.population;
        assert_eq!(costs.len(), old.size(), "one cost per genome");
        let mut stream = self.seed.stream(Purpose::Breeding, self.generation, self.island);

        let [crossed, mutated, ranked, random] = self.spec.group_sizes(old.size());
        let mut crossed = selection::select(self.spec.selection, costs, crossed, &mut stream);
        let mutated = selection::select(self.spec.selection, costs, mutated, &mut stream);
        let ranked = selection::best(costs, ranked);
        let random = selection::random(old.size(), random, &mut stream);

        let len = self.space.genome_len;
        let (p1, rest) = self.next.genes_mut().split_at_mut(crossed.len() * len);
        let (p2, rest) = rest.split_at_mut(mutated.len() * len);
        let (p3, p4) = rest.split_at_mut(ranked.len() * len);
        crossover::single_point(old, &mut crossed, p1, &mut stream);
        copy(old, &mutated, p2);
        mutation::mutate(
            self.spec.mutation_at(self.outlook.progress(self.generation + 1)),
            self.spec.mutation_rate,
            self.space.bound,
            &self.outlook.scales,
            p2,
            &mut stream,
        );
        copy(old, &ranked, p3);
        copy(old, &random, p4);

        std::mem::swap(&mut self.population, &mut self.next);
        self.generation += 1;
    }

    fn begin_with(&mut self, genome: &[f32]) -> Result<(), GenomeError> {
        self.space.admit_genome(genome)?;
        let Self { space, spec, outlook, seed, population, island, .. } = self;
        let mut stream = seed.stream(Purpose::InitialPopulation, MUTANTS, *island);
        let mutation = spec.mutation_at(0.0);
        let copies = population.genes_mut().chunks_exact_mut(space.genome_len);
        for (number, copy) in copies.enumerate() {
            copy.copy_from_slice(genome);
            if number > 0 {
                let (rate, scales) = (spec.mutation_rate, &outlook.scales);
                mutation::mutate(mutation, rate, space.bound, scales, copy, &mut stream);
            }
        }
        Ok(())
    }

    fn save(&self) -> State {
        State::Ga(self.state())
    }

    fn restore(&mut self, state: State) -> Result<(), RestoreError> {
        let State::Ga(GaState { seed, generation, population }) = state else {
            return Err(RestoreError::Method);
        };
        if seed != self.seed {
            return Err(RestoreError::Seed { found: seed.0, expected: self.seed.0 });
        }
        self.space.admit(&population)?;
        self.generation = generation;
        self.population = population;
        Ok(())
    }
}

/// Copies the chosen genomes, one after the other.
fn copy(old: &Population, chosen: &[usize], new: &mut [f32]) {
    for (genome, &index) in new.chunks_exact_mut(old.genome_len()).zip(chosen) {
        genome.copy_from_slice(old.genome(index));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sphere(genome: &[f32]) -> Cost {
        Cost::new(genome.iter().fold(0.0, |sum, &gene| sum + f64::from(gene) * f64::from(gene)))
    }

    fn tell_spheres(ga: &mut Ga) {
        let costs: Vec<Cost> = ga.ask().genomes().map(sphere).collect();
        ga.tell(&costs);
    }

    /// CRC-32 of all genes, little-endian.
    fn fingerprint(population: &Population) -> u32 {
        let bytes: Vec<u8> = population.genes().iter().flat_map(|g| g.to_le_bytes()).collect();
        crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC).checksum(&bytes)
    }

    /// Expected: this page and its modules' words written once more in Python, over the
    /// Python ChaCha8 of the streams' own test, on a sphere function.
    #[test]
    fn a_run_breeds_the_same_genomes_in_every_release() {
        let space = SearchSpace { population: 23, genome_len: 6, bound: 2.0 };
        let mut ga = Ga::new(space, GaSpec::PAPER, RunSeed(7)).unwrap();
        let mut history = Vec::new();
        for _ in 0..=25 {
            history.push(fingerprint(ga.ask()));
            tell_spheres(&mut ga);
        }
        assert_eq!(
            [0, 1, 2, 25].map(|generation| history[generation]),
            [0x076c_c6ee, 0xdbd7_8fff, 0x570c_417a, 0xbc57_188f]
        );
    }

    /// A search with this mutation, begun with a genome of four.
    fn begun(mutation: Mutation, genome: &[f32], seed: u64) -> Result<Ga, GenomeError> {
        let space = SearchSpace { population: 80, genome_len: 4, bound: 1.0 };
        let spec = GaSpec { mutation, ..GaSpec::PAPER };
        let mut ga = Ga::new(space, spec, RunSeed(seed)).unwrap();
        ga.begin_with(genome).map(|()| ga)
    }

    #[test]
    fn a_search_can_begin_with_a_genome_and_its_mutants() {
        let mutation = Mutation::EveryGene { sigma: 0.1 };
        let genome = [0.5, -0.5, 0.0, 0.9];
        let ga = begun(mutation, &genome, 1).unwrap();
        let [first, mutants @ ..] = &ga.ask().genomes().collect::<Vec<_>>()[..] else { panic!() };
        assert_eq!(*first, genome);
        // The widest of 79 normal draws is between two and five times their spread.
        let farthest = |gene: usize| {
            mutants.iter().map(|mutant| (mutant[gene] - genome[gene]).abs()).fold(0.0, f32::max)
        };
        assert!((0..3).all(|gene| (0.2..0.5).contains(&farthest(gene))));
        assert!(mutants.iter().all(|mutant| mutant[3] <= 1.0));
        assert_ne!(ga.ask(), begun(mutation, &genome, 2).unwrap().ask());
        // As recorded: champions that began so are made again in every release.
        assert_eq!(fingerprint(ga.ask()), 0x1118_ccfb);
    }

    /// Each has at least one change. One number of changes for all together can be next to none.
    #[test]
    fn mutants_by_the_papers_mutation_differ_from_what_they_began_with() {
        for seed in 0..100 {
            let ga = begun(GaSpec::PAPER.mutation, &[0.5; 4], seed).unwrap();
            let mutants = ga.ask().genomes().filter(|genome| **genome != [0.5; 4]).count();
            assert!(mutants > 70, "seed {seed}: {mutants}");
        }
    }

    #[test]
    fn a_search_does_not_begin_with_a_genome_of_another_space() {
        let refused = |genome: &[f32]| begun(GaSpec::PAPER.mutation, genome, 1).unwrap_err();
        assert_eq!(refused(&[0.0; 3]), GenomeError::Length { found: 3, expected: 4 });
        let gene = GenomeError::Gene { gene: 2, found: 1.5, bound: 1.0 };
        assert_eq!(refused(&[0.0, 0.0, 1.5, 0.0]), gene);
        assert!(matches!(refused(&[0.0, f32::NAN, 0.0, 0.0]), GenomeError::Gene { gene: 1, .. }));
    }

    #[test]
    fn the_best_individual_outlives_every_generation() {
        let space = SearchSpace { population: 80, genome_len: 30, bound: 1.0 };
        let mut ga = Ga::new(space, GaSpec::PAPER, RunSeed(2)).unwrap();
        let mut least = Cost::WORST;
        for _ in 0..100 {
            let now = ga.ask().genomes().map(sphere).min().unwrap();
            assert!(now <= least);
            least = now;
            tell_spheres(&mut ga);
        }
    }

    #[test]
    fn the_ranked_group_stands_after_the_bred_ones_best_first() {
        let space = SearchSpace { population: 150, genome_len: 4, bound: 1.0 };
        let mut ga = Ga::new(space, GaSpec::PAPER, RunSeed(3)).unwrap();
        let costs: Vec<Cost> = ga.ask().genomes().map(sphere).collect();
        let old = ga.ask().clone();
        ga.tell(&costs);
        for (place, index) in super::super::ranking(&costs)[..3].iter().enumerate() {
            assert_eq!(ga.ask().genome(60 + 60 + place), old.genome(*index));
        }
        for copied in 123..150 {
            assert!(old.genomes().any(|genome| genome == ga.ask().genome(copied)));
        }
    }

    #[test]
    fn senseless_settings_are_refused_at_the_start() {
        let space = SearchSpace { population: 80, genome_len: 4, bound: 1.0 };
        let spec = GaSpec { mutation_rate: -0.5, ..GaSpec::PAPER };
        let refusal = Ga::new(space, spec, RunSeed(0)).unwrap_err();
        assert_eq!(refusal.to_string(), "mutation_rate is -0.5, expected a rate from 0 to 1");
    }
}

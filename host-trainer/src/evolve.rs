//! The search: knows genomes and costs, never drives.
//!
//! An [`Optimizer`] proposes a [`Population`] of genomes, is told what each one costs, and
//! proposes the next. Everything it does follows from its settings, the run's seed and the
//! costs, so a run can be repeated, spread over threads, or continued from a saved [`State`].
//!
//! | look in | for |
//! | --- | --- |
//! | [`cost`] | what is better, and what a failed evaluation counts as |
//! | [`population`] | genomes as rows of one matrix |
//! | [`state`] | what a checkpoint must keep |
//! | [`ga`] | the paper's genetic algorithm and its operators |
//! | [`islands`] | several of these, of which the worse are given up on the way |
//! | [`novelty`] | selection by what nobody has done yet, in place of cost |

pub mod cost;
pub mod ga;
pub mod islands;
pub mod novelty;
pub mod population;
pub mod state;

use crate::seed::RunSeed;
use ga::settings::require;
use ga::{Ga, GaSpec, Initial, Mutation, Outlook, Selection, SettingError};

pub use cost::{Cost, best_index, ranking};
pub use islands::Islands;
pub use novelty::{Novelty, NoveltySpec};
pub use population::Population;
pub use state::{GenomeError, RestoreError, State};

/// Proposes genomes, then learns from their costs.
pub trait Optimizer: Send {
    /// Short name of the method, for logs and refusals.
    fn name(&self) -> &'static str;

    /// Generations told so far; the one [`Self::ask`] shows, counted from 0.
    fn generation(&self) -> u32;

    /// The genomes to judge: always as long and as bounded as the [`SearchSpace`] says, as many as
    /// it says for each population that is left, and the same until [`Self::tell`].
    fn ask(&self) -> &Population;

    /// Takes the cost of every genome, in the order of [`Self::ask`], and breeds the next
    /// generation from them.
    ///
    /// # Panics
    /// When there are not exactly as many costs as genomes.
    fn tell(&mut self, costs: &[Cost]);

    /// Begins with this genome, and mutants of it in place of random genomes: the genome itself
    /// comes first in each population, the others by the first generation's mutation. To be called before
    /// [`Self::tell`].
    ///
    /// # Errors
    ///
    /// A genome of another length, or with a gene that is out of bounds.
    fn begin_with(&mut self, genome: &[f32]) -> Result<(), GenomeError>;

    /// Everything that [`Self::restore`] needs to go on bit for bit.
    fn save(&self) -> State;

    /// Goes on where `state` was saved; refused, and nothing changed, when it was saved
    /// under another seed or for another space. The settings are the caller's to keep equal.
    fn restore(&mut self, state: State) -> Result<(), RestoreError>;
}

/// How many genomes there are, how long, and in which bounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SearchSpace {
    /// Genomes per generation in each population, at least 2.
    pub population: usize,
    /// Genes per genome, at least 1.
    pub genome_len: usize,
    /// Genes are drawn in, and kept in, `-bound..=bound`; finite and above 0.
    pub bound: f32,
}

impl SearchSpace {
    /// Refuses the first part that makes no sense.
    pub fn check(&self) -> Result<(), SettingError> {
        let Self { population, genome_len, bound } = *self;
        require(population >= 2, "population", population as f64, "at least 2")?;
        require(genome_len >= 1, "genome_len", genome_len as f64, "at least 1")?;
        let bounded = bound > 0.0 && bound.is_finite();
        require(bounded, "weight_bound", bound, "a finite number above 0")
    }

    /// Refuses a saved population that is not of this space.
    fn admit(&self, saved: &Population) -> Result<(), RestoreError> {
        let (found, expected) = (saved.genome_len(), self.genome_len);
        if found != expected {
            return Err(RestoreError::GenomeLen { found, expected });
        }
        let (found, expected) = (saved.size(), self.population);
        if found != expected {
            return Err(RestoreError::Population { found, expected });
        }
        match self.beyond_bound(saved.genes()) {
            None => Ok(()),
            Some(place) => {
                let (individual, gene) = (place / self.genome_len, place % self.genome_len);
                let (found, bound) = (saved.genes()[place], self.bound);
                Err(RestoreError::Gene { individual, gene, found, bound })
            }
        }
    }

    /// The first of these genes that is out of bounds, or `NaN`.
    fn beyond_bound(&self, genes: &[f32]) -> Option<usize> {
        genes.iter().position(|gene| !(-self.bound..=self.bound).contains(gene))
    }

    /// Refuses a genome that is not of this space.
    fn admit_genome(&self, genome: &[f32]) -> Result<(), GenomeError> {
        let (found, expected) = (genome.len(), self.genome_len);
        if found != expected {
            return Err(GenomeError::Length { found, expected });
        }
        match self.beyond_bound(genome) {
            None => Ok(()),
            Some(gene) => Err(GenomeError::Gene { gene, found: genome[gene], bound: self.bound }),
        }
    }
}

/// A search method and what its settings are called in [`all`].
pub type Named = (&'static str, Box<dyn Optimizer>);

/// Every search method in the crate; a new one joins all tests below by joining this list.
pub fn all(space: SearchSpace, seed: RunSeed) -> Result<Vec<Named>, SettingError> {
    let paper = GaSpec::PAPER;
    let linear_rank = Selection::LinearRank { pressure: 1.8 };
    let additive = Mutation::Additive { amplitude: 0.2 * space.bound };
    let truncation = Selection::Truncation { share: 0.3 };
    let gaussian = Mutation::Gaussian { sigma: 0.1 * space.bound };
    let ga = |spec| -> Result<Box<dyn Optimizer>, SettingError> {
        Ok(Box::new(Ga::new(space, spec, seed)?))
    };
    Ok(vec![
        ("paper", ga(paper)?),
        ("linear rank, additive", {
            ga(GaSpec { selection: linear_rank, mutation: additive, ..paper })?
        }),
        ("truncation, gaussian", {
            ga(GaSpec { selection: truncation, mutation: gaussian, ..paper })?
        }),
        ("every gene, annealed", {
            let spec = GaSpec {
                crossover_share: 0.0,
                mutation_share: 0.99,
                ranking_share: 0.01,
                random_share: 0.0,
                selection: Selection::Truncation { share: 0.15 },
                mutation: Mutation::EveryGene { sigma: 0.1 * space.bound },
                sigma_end: Some(0.001 * space.bound),
                initial: Initial::Gaussian { sigma: 0.5 * space.bound },
                fan_in: true,
                ..paper
            };
            let scales = (0..space.genome_len).map(|gene| 0.5 + (gene % 2) as f32).collect();
            Box::new(Ga::with_outlook(space, spec, Outlook { generations: 200, scales }, seed)?)
        }),
        ("islands", {
            let spec = GaSpec { selection: truncation, mutation: gaussian, ..paper };
            let outlook = Outlook { generations: 24, ..Outlook::none(space.genome_len) };
            Box::new(Islands::new(5, space, spec, outlook, seed)?)
        }),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::Purpose;

    const SPACE: SearchSpace = SearchSpace { population: 80, genome_len: 10, bound: 3.0 };

    fn every_method(space: SearchSpace, seed: u64) -> Vec<Named> {
        all(space, RunSeed(seed)).unwrap()
    }

    fn sphere(genome: &[f32]) -> Cost {
        Cost::new(genome.iter().map(|&gene| f64::from(gene) * f64::from(gene)).sum())
    }

    fn judge(population: &Population, cost: impl Fn(&[f32]) -> Cost) -> Vec<Cost> {
        population.genomes().map(cost).collect()
    }

    fn run(method: &mut dyn Optimizer, generations: u32) {
        for _ in 0..generations {
            let costs = judge(method.ask(), sphere);
            method.tell(&costs);
        }
    }

    fn bits(population: &Population) -> Vec<u32> {
        population.genes().iter().map(|gene| gene.to_bits()).collect()
    }

    fn assert_in_space(name: &str, population: &Population, space: SearchSpace, islands: usize) {
        assert_eq!(population.size(), islands * space.population, "{name}");
        assert_eq!(population.genome_len(), space.genome_len, "{name}");
        let inside = |gene: &f32| (-space.bound..=space.bound).contains(gene);
        assert!(population.genes().iter().all(inside), "{name}: a gene left its bounds");
    }

    /// Oracle: pure chance with as many evaluations or more.
    #[test]
    fn every_method_is_far_better_than_chance_on_a_sphere() {
        let mut chance = RunSeed(1).stream(Purpose::GeneratedWorld, 0, 0);
        let by_chance = (0..80 * 300)
            .map(|_| sphere(&[(); 10].map(|()| chance.within(-3.0, 3.0))))
            .min()
            .unwrap();
        for (name, mut method) in every_method(SPACE, 1) {
            run(method.as_mut(), 199);
            let found = judge(method.ask(), sphere).into_iter().min().unwrap();
            assert!(
                found.value() < 0.05 * by_chance.value(),
                "{name}: {found:?}, chance {by_chance:?}"
            );
        }
    }

    #[test]
    fn every_method_keeps_size_and_bounds_for_every_population() {
        for population in 2..40 {
            for genome_len in [1, 2, 7] {
                let space = SearchSpace { population, genome_len, bound: 0.1 };
                for (name, mut method) in every_method(space, 5) {
                    let islands = if name == "islands" { 5 } else { 1 };
                    for _ in 0..5 {
                        assert_in_space(name, method.ask(), space, islands);
                        run(method.as_mut(), 1);
                    }
                    assert_in_space(name, method.ask(), space, islands);
                    run(method.as_mut(), 19);
                    assert_in_space(name, method.ask(), space, 1);
                }
            }
        }
    }

    #[test]
    fn one_seed_gives_one_run_and_another_seed_another() {
        let twins = every_method(SPACE, 7).into_iter().zip(every_method(SPACE, 7));
        for (((name, mut one), (_, mut twin)), (_, mut other)) in twins.zip(every_method(SPACE, 8))
        {
            run(one.as_mut(), 20);
            run(twin.as_mut(), 20);
            run(other.as_mut(), 20);
            assert_eq!(bits(one.ask()), bits(twin.ask()), "{name}");
            assert_ne!(bits(one.ask()), bits(other.ask()), "{name}");
        }
    }

    #[test]
    fn costs_that_say_nothing_are_survived() {
        let nothing = [Cost::new(0.0), Cost::new(1e300), Cost::WORST];
        for cost in nothing {
            for (name, mut method) in every_method(SPACE, 3) {
                for _ in 0..30 {
                    method.tell(&vec![cost; method.ask().size()]);
                }
                assert_in_space(name, method.ask(), SPACE, 1);
                assert_eq!(method.generation(), 30, "{name}");
                let mut distinct = bits(method.ask());
                distinct.sort_unstable();
                distinct.dedup();
                assert!(distinct.len() > 10, "{name}: the genomes became one");
            }
        }
    }

    #[test]
    fn one_good_genome_among_failures_is_found_again() {
        for (name, mut method) in every_method(SPACE, 4) {
            let mut costs = vec![Cost::WORST; method.ask().size()];
            costs[41] = Cost::new(-20_000.0);
            let good = method.ask().genome(41).to_vec();
            method.tell(&costs);
            assert!(method.ask().genomes().any(|genome| genome == good), "{name} lost it");
        }
    }

    /// The state goes through bytes, as it does in a checkpoint.
    #[test]
    fn a_saved_run_goes_on_bit_for_bit() {
        for ((name, mut one), (_, mut other)) in
            every_method(SPACE, 6).into_iter().zip(every_method(SPACE, 6))
        {
            run(one.as_mut(), 11);
            let saved = postcard::to_allocvec(&one.save()).unwrap();
            other.restore(postcard::from_bytes(&saved).unwrap()).unwrap();
            assert_eq!(other.generation(), 11, "{name}");
            for _ in 0..10 {
                assert_eq!(bits(one.ask()), bits(other.ask()), "{name}");
                run(one.as_mut(), 1);
                run(other.as_mut(), 1);
            }
            assert_eq!(one.save(), other.save(), "{name}");
        }
    }

    #[test]
    fn a_state_from_another_run_is_refused_and_changes_nothing() {
        let others = [
            (every_method(SPACE, 10), "seed"),
            (every_method(SearchSpace { population: 81, ..SPACE }, 9), "population"),
            (every_method(SearchSpace { genome_len: 11, ..SPACE }, 9), "genes"),
            (every_method(SearchSpace { bound: 5.0, ..SPACE }, 9), "bound"),
        ];
        for (strangers, word) in others {
            for ((name, mut method), (_, mut stranger)) in
                every_method(SPACE, 9).into_iter().zip(strangers)
            {
                run(stranger.as_mut(), 1);
                let before = method.save();
                let refusal = method.restore(stranger.save()).unwrap_err();
                assert!(refusal.to_string().contains(word), "{name}: {refusal}");
                assert_eq!(method.save(), before, "{name}");
            }
        }
    }

    #[test]
    fn a_senseless_space_is_refused_by_name() {
        let cases = [
            ("population", SearchSpace { population: 1, ..SPACE }),
            ("genome_len", SearchSpace { genome_len: 0, ..SPACE }),
            ("weight_bound", SearchSpace { bound: 0.0, ..SPACE }),
            ("weight_bound", SearchSpace { bound: f32::NAN, ..SPACE }),
        ];
        for (setting, space) in cases {
            assert_eq!(all(space, RunSeed(0)).err().map(|error| error.setting), Some(setting));
        }
    }
}

//! Genomes as rows of one matrix: breeding copies rows, and they lie side by side.

use serde::{Deserialize, Serialize};

use crate::seed::{Purpose, RunSeed};

use super::SearchSpace;
use super::ga::Initial;

/// Genomes of one length, in a fixed order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Stored")]
pub struct Population {
    genome_len: usize,
    genes: Vec<f32>,
}

impl Population {
    /// Genomes with all genes 0.
    pub(super) fn zeros(space: &SearchSpace) -> Self {
        let SearchSpace { population, genome_len, .. } = *space;
        Self { genome_len, genes: vec![0.0; population * genome_len] }
    }

    /// Random genomes in a population of this space, which may be one of several of a run. Each has its own
    /// stream, so that a larger population begins with the genomes of a smaller one, and several in their
    /// order are one large one. Normal draws for gene `g` are multiplied by `scales[g]`.
    pub(super) fn random(
        space: &SearchSpace,
        island: u32,
        initial: Initial,
        scales: &[f32],
        seed: RunSeed,
    ) -> Self {
        let mut drawn = Self::zeros(space);
        let first = island * space.population as u32;
        for (genome, index) in drawn.genes.chunks_exact_mut(space.genome_len).zip(first..) {
            let mut stream = seed.stream(Purpose::InitialPopulation, 0, index);
            for (gene, scale) in genome.iter_mut().zip(scales) {
                *gene = match initial {
                    Initial::Uniform => stream.within(-space.bound, space.bound),
                    Initial::Gaussian { sigma } => {
                        (sigma * scale * stream.normal()).clamp(-space.bound, space.bound)
                    }
                };
            }
        }
        drawn
    }

    /// Number of genomes.
    pub fn size(&self) -> usize {
        self.genes.len() / self.genome_len
    }

    /// Number of genes in each genome, at least 1.
    pub fn genome_len(&self) -> usize {
        self.genome_len
    }

    /// One genome.
    ///
    /// # Panics
    /// When `index` is not below [`Self::size`].
    pub fn genome(&self, index: usize) -> &[f32] {
        &self.genes[index * self.genome_len..][..self.genome_len]
    }

    /// All genomes in order.
    pub fn genomes(&self) -> std::slice::ChunksExact<'_, f32> {
        self.genes.chunks_exact(self.genome_len)
    }

    /// All genes, genome after genome.
    pub fn genes(&self) -> &[f32] {
        &self.genes
    }

    /// Becomes the genomes of all of these, which have one length, one population after the other.
    pub(super) fn copy_all<'a>(&mut self, all: impl Iterator<Item = &'a Self>) {
        self.genes.clear();
        for population in all {
            self.genome_len = population.genome_len;
            self.genes.extend_from_slice(&population.genes);
        }
    }

    /// All genes, genome after genome, for breeding into.
    pub(super) fn genes_mut(&mut self) -> &mut [f32] {
        &mut self.genes
    }
}

/// The fields as they come from a checkpoint, before anyone looked at them.
#[derive(Deserialize)]
struct Stored {
    genome_len: usize,
    genes: Vec<f32>,
}

impl TryFrom<Stored> for Population {
    type Error = String;

    fn try_from(stored: Stored) -> Result<Self, String> {
        let Stored { genome_len, genes } = stored;
        if genome_len == 0 || !genes.len().is_multiple_of(genome_len) {
            let found = genes.len();
            return Err(format!("{found} genes, expected whole genomes of {genome_len} genes"));
        }
        Ok(Self { genome_len, genes })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::statistics::follows;

    const SPACE: SearchSpace = SearchSpace { population: 5, genome_len: 3, bound: 2.0 };

    #[test]
    fn a_larger_population_begins_with_the_smaller_one() {
        for initial in [Initial::Uniform, Initial::Gaussian { sigma: 1.0 }] {
            let random = |space| Population::random(&space, 0, initial, &[1.0; 3], RunSeed(7));
            let (small, large) = (random(SPACE), random(SearchSpace { population: 9, ..SPACE }));
            assert_eq!(large.size(), 9);
            assert_eq!(large.genes()[..15], *small.genes());
        }
    }

    #[test]
    fn populations_of_one_run_are_one_large_one() {
        let random = |population, island| {
            let space = SearchSpace { population, ..SPACE };
            Population::random(&space, island, Initial::Uniform, &[1.0; 3], RunSeed(7))
        };
        let mut together = Population::zeros(&SPACE);
        together.copy_all([random(5, 0), random(5, 1)].iter());
        assert_eq!(together, random(10, 0));
    }

    #[test]
    fn first_genes_fill_their_bounds_evenly() {
        let space = SearchSpace { population: 160, genome_len: 553, bound: 2.0 };
        let drawn = Population::random(&space, 0, Initial::Uniform, &[1.0; 553], RunSeed(1));
        let genes = drawn.genes().iter().copied().map(f64::from).collect();
        assert!(follows(genes, |gene| (gene + 2.0) / 4.0));
    }

    #[test]
    fn normal_first_genes_have_the_spread_of_their_scale_within_the_bounds() {
        let space = SearchSpace { population: 4000, genome_len: 2, bound: 2.0 };
        let initial = Initial::Gaussian { sigma: 0.5 };
        let drawn = Population::random(&space, 0, initial, &[1.0, 8.0], RunSeed(1));
        let first = drawn.genomes().map(|genome| f64::from(genome[0])).collect();
        assert!(follows(first, |x| 0.5 * libm::erfc(-x / (0.5 * std::f64::consts::SQRT_2))));
        let second = || drawn.genomes().map(|genome| genome[1]);
        assert!(second().all(|gene| gene.abs() <= 2.0) && second().any(|gene| gene == 2.0));
    }

    #[test]
    fn a_stored_matrix_that_is_not_whole_is_refused() {
        for (genome_len, genes) in [(0_usize, 6_usize), (0, 0), (4, 6), (7, 6)] {
            let bytes = postcard::to_allocvec(&(genome_len, vec![0.5_f32; genes])).unwrap();
            assert!(postcard::from_bytes::<Population>(&bytes).is_err(), "{genome_len}, {genes}");
        }
        let whole = postcard::to_allocvec(&(3_usize, vec![0.5_f32; 6])).unwrap();
        assert_eq!(postcard::from_bytes::<Population>(&whole).unwrap().size(), 2);
    }
}

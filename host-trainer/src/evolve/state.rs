//! What a checkpoint keeps of a search, and why one may not fit.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::ga::GaState;
use super::islands::IslandState;
use super::novelty::Archive;

/// Everything a search method needs to go on, one variant per method.
///
/// Checkpoints store the variant's number: add new ones at the end.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum State {
    /// Of the genetic algorithm.
    Ga(GaState),
    /// Of any method that is told novelty in place of cost.
    Novelty {
        /// Of the method.
        search: Box<State>,
        /// What earlier generations did.
        archive: Archive,
    },
    /// Of several genetic algorithms: those that are left.
    Islands(Vec<IslandState>),
}

/// Why a saved state does not belong to this search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RestoreError {
    /// Saved under another seed.
    Seed {
        /// The state's seed.
        found: u64,
        /// This search's seed.
        expected: u64,
    },
    /// Another number of genomes.
    Population {
        /// In the state.
        found: usize,
        /// In this search.
        expected: usize,
    },
    /// Genomes of another length.
    GenomeLen {
        /// In the state.
        found: usize,
        /// In this search.
        expected: usize,
    },
    /// Another number of islands than are left in that generation.
    Islands {
        /// In the state.
        found: usize,
        /// That there must be.
        expected: usize,
    },
    /// An island that this search does not have, that is out of order, of another generation than the
    /// others, or more often behind than it can be.
    Island {
        /// Which.
        number: u32,
    },
    /// Of another method, such as a search by cost where this one goes by novelty.
    Method,
    /// Not what so many generations leave in the archive.
    Archive {
        /// Coordinates in the state.
        found: u64,
        /// Coordinates that there must be.
        expected: u64,
    },
    /// A gene outside the bounds, or `NaN`.
    Gene {
        /// Which genome.
        individual: usize,
        /// Which of its genes.
        gene: usize,
        /// Its value.
        found: f32,
        /// Largest magnitude in this search.
        bound: f32,
    },
}

impl fmt::Display for RestoreError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Seed { found, expected } => {
                write!(f, "the saved search has seed {found}, expected {expected}")
            }
            Self::Population { found, expected } => {
                write!(f, "the saved search has a population of {found}, expected {expected}")
            }
            Self::GenomeLen { found, expected } => {
                write!(f, "the saved search has {found} genes per genome, expected {expected}")
            }
            Self::Islands { found, expected } => {
                write!(f, "the saved search has {found} islands, expected {expected}")
            }
            Self::Island { number } => {
                write!(f, "saved island {number} is not one that such a search comes to")
            }
            Self::Method => f.write_str("the saved search is of another method"),
            Self::Archive { found, expected } => {
                write!(f, "the saved archive has {found} coordinates, expected {expected}")
            }
            Self::Gene { individual, gene, found, bound } => write!(
                f,
                "gene {gene} of saved genome {individual} is {found}, expected at most the \
                 bound {bound} in magnitude"
            ),
        }
    }
}

impl std::error::Error for RestoreError {}

/// Why a search does not begin with a genome.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GenomeError {
    /// Another number of genes.
    Length {
        /// In the genome.
        found: usize,
        /// In this search.
        expected: usize,
    },
    /// A gene outside the bounds, or `NaN`.
    Gene {
        /// Which gene.
        gene: usize,
        /// Its value.
        found: f32,
        /// Largest magnitude in this search.
        bound: f32,
    },
}

impl fmt::Display for GenomeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length { found, expected } => write!(f, "{found} genes, expected {expected}"),
            Self::Gene { gene, found, bound } => {
                write!(f, "gene {gene} is {found}, expected at most {bound} in magnitude")
            }
        }
    }
}

impl std::error::Error for GenomeError {}

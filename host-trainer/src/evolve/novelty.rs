//! Selection by novelty alone (Lehman and Stanley, "Abandoning Objectives: Evolution Through the
//! Search for Novelty Alone", Evolutionary Computation 19(2), 2011).
//!
//! What an individual did is a point, its *behaviour*: here where its drives ended. Its novelty
//! is the mean distance to the `k` nearest of all other points: of its generation, and of an
//! [`Archive`] of earlier ones, so that what was new once is not new again. A search method is
//! told the novelty in place of the cost, and breeds as ever.
//!
//! Lehman and Stanley archive what is more novel than a threshold that follows the run. Here each
//! generation gives the archive a few individuals drawn by chance, as in other work of theirs
//! ("Efficiently Evolving Programs through the Search for Novelty", GECCO 2010) and as Gomes,
//! Mariano and Christensen advise ("Devising Effective Novelty Search Algorithms: A Comprehensive
//! Empirical Study", GECCO 2015): there is no threshold to tune and to keep.
//!
//! Neighbours are found by looking at every point. A tree would have to be built anew each
//! generation, and its order among equals would become part of a run's bits; the scan is a small
//! part of the time that the drives take.

use serde::{Deserialize, Serialize};

use super::ga::SettingError;
use super::ga::settings::require;
use super::{Cost, RestoreError};
use crate::seed::{Purpose, RunSeed};

/// How novelty is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct NoveltySpec {
    /// `k`: how many nearest points count, at least 1.
    pub neighbours: u32,
    /// How many of each generation join the archive, at most the population.
    pub archive_growth: u32,
}

impl NoveltySpec {
    /// What holds where a scenario asks for novelty and says no more: 15 neighbours as Lehman and
    /// Stanley have, and about the 3 % of a generation that Gomes and others archive.
    pub const USUAL: Self = Self { neighbours: 15, archive_growth: 6 };

    /// Refuses the first setting that makes no sense in a population of this size.
    pub fn check(&self, population: u32) -> Result<(), SettingError> {
        let Self { neighbours, archive_growth } = *self;
        require(neighbours >= 1, "neighbours", neighbours, "at least 1")?;
        let expected = "at most the population";
        require(archive_growth <= population, "archive_growth", archive_growth, expected)
    }
}

/// Points of one number of coordinates, row after row.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Behaviours {
    dimensions: u32,
    coordinates: Vec<f32>,
}

impl Behaviours {
    /// None yet, each with so many coordinates, at least 1.
    pub fn none(dimensions: usize) -> Self {
        Self { dimensions: dimensions.max(1) as u32, coordinates: Vec::new() }
    }

    /// Goes on with the last point, and with another one where that is whole.
    pub fn extend(&mut self, coordinates: &[f32]) {
        self.coordinates.extend_from_slice(coordinates);
    }

    /// How many whole points.
    pub fn len(&self) -> usize {
        self.coordinates.len() / self.dimensions.max(1) as usize
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Every point, in order.
    pub fn points(&self) -> std::slice::ChunksExact<'_, f32> {
        self.coordinates.chunks_exact(self.dimensions.max(1) as usize)
    }
}

/// Points that were somebody's behaviour in an earlier generation.
pub type Archive = Behaviours;

/// Judges generations by novelty, and remembers some of each.
#[derive(Clone, Debug)]
pub struct Novelty {
    spec: NoveltySpec,
    seed: RunSeed,
    archive: Archive,
}

impl Novelty {
    /// With an empty archive of points of so many coordinates.
    pub fn new(spec: NoveltySpec, dimensions: usize, seed: RunSeed) -> Self {
        Self { spec, seed, archive: Archive::none(dimensions) }
    }

    /// What is remembered.
    pub fn archive(&self) -> &Archive {
        &self.archive
    }

    /// Minus the novelty of every individual, in order, so that the most novel costs least; then
    /// some of them join the archive.
    pub fn judge(&mut self, generation: u32, population: &Behaviours) -> Vec<Cost> {
        let mut distances = Vec::with_capacity(population.len() + self.archive.len());
        let costs = (0..population.len())
            .map(|individual| {
                let novelty = self.novelty(population, individual, &mut distances);
                Cost::new(-novelty)
            })
            .collect();
        self.remember(generation, population);
        costs
    }

    /// Mean distance to the nearest others; to all of them where there are fewer than `k`.
    fn novelty(&self, population: &Behaviours, individual: usize, nearest: &mut Vec<f64>) -> f64 {
        let points = population.points();
        let Some(own) = points.clone().nth(individual) else { return 0.0 };
        let others = points.enumerate().filter(|(index, _)| *index != individual);
        nearest.clear();
        nearest.extend(others.map(|(_, other)| squared(own, other)));
        nearest.extend(self.archive.points().map(|other| squared(own, other)));
        let count = nearest.len().min(self.spec.neighbours as usize);
        if count == 0 {
            return 0.0;
        }
        nearest.select_nth_unstable_by(count - 1, f64::total_cmp);
        // Summed nearest first, so that the sum does not depend on how the selection went.
        nearest.truncate(count);
        nearest.sort_unstable_by(f64::total_cmp);
        let mut sum = 0.0;
        for squared in nearest {
            sum += squared.sqrt();
        }
        sum / count as f64
    }

    /// Draws those that join, each at most once.
    fn remember(&mut self, generation: u32, population: &Behaviours) {
        let mut stream = self.seed.stream(Purpose::NoveltyArchive, generation, 0);
        let mut left: Vec<&[f32]> = population.points().collect();
        for _ in 0..self.spec.archive_growth.min(left.len() as u32) {
            let chosen = left.swap_remove(stream.index(left.len()));
            self.archive.extend(chosen);
        }
    }

    /// Goes on with a saved archive.
    ///
    /// # Errors
    ///
    /// One that does not hold what so many generations of such points leave behind.
    pub fn restore(
        &mut self,
        archive: Archive,
        generation: u32,
        population: usize,
    ) -> Result<(), RestoreError> {
        let growth = population.min(self.spec.archive_growth as usize) as u64;
        let points = u64::from(generation) * growth;
        let expected = points * u64::from(self.archive.dimensions);
        let found = archive.coordinates.len() as u64;
        if found != expected || archive.dimensions != self.archive.dimensions {
            return Err(RestoreError::Archive { found, expected });
        }
        self.archive = archive;
        Ok(())
    }
}

fn squared(a: &[f32], b: &[f32]) -> f64 {
    let mut sum = 0.0;
    for (a, b) in a.iter().zip(b) {
        let along = f64::from(*a) - f64::from(*b);
        sum += along * along;
    }
    sum
}

#[cfg(test)]
mod tests;

//! Drawing tasks: a start pose and a goal that are clear of obstacles and hang together.
//!
//! Both lie in the main part of the free space, the largest that a car can drive in without
//! crossing a wall: not inside a hollow pillar of a map, nor outside of the building on it. (A
//! map with more free space around a building than in it needs the room cut to the building,
//! by `world.min_m` and `world.max_m`.)

use crate::car::body_of;
use crate::evolve::ga::{between, progress};
use crate::scenario::{Pair, PairSource, PairSpec, Scenario};
use crate::seed::{Purpose, RunSeed, Stream};
use crate::world::free_space::FreeSpace;
use crate::world::{World, distance};
use controller_core::geometry::Body;
use controller_core::motion::Pose;
use std::f32::consts::PI;
use std::fmt;
use std::sync::Arc;

/// Draws before giving up on one pair.
const TRIES: u32 = 20_000;

/// Draws start/goal pairs of one scenario.
#[derive(Debug)]
pub struct PairSampler<'a> {
    world: &'a World,
    space: Arc<FreeSpace>,
    body: Body<f32>,
    min_distance: f32,
}

/// No pair was found in many tries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoPair {
    /// The distance that was asked for.
    pub min_distance: f32,
    /// How many tries there were.
    pub tries: u32,
}

impl fmt::Display for NoPair {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "no start and goal at least {} m apart, clear of obstacles and with a way between \
             them, found in {} tries: the world is too full or too small",
            self.min_distance, self.tries
        )
    }
}

impl std::error::Error for NoPair {}

impl<'a> PairSampler<'a> {
    /// A sampler for this scenario's world and car. Maps the free space, which takes as long as
    /// thousands of draws: a [`Problem`](crate::problem::Problem) has a sampler that does so once.
    pub fn new(world: &'a World, scenario: &Scenario) -> Self {
        Self::within(world, scenario, Arc::new(Self::space_of(world, scenario)))
    }

    /// The same within a free space that is mapped already, by [`Self::space_of`].
    pub fn within(world: &'a World, scenario: &Scenario, space: Arc<FreeSpace>) -> Self {
        let body = body_of(&scenario.vehicle);
        Self { world, space, body, min_distance: scenario.pairs.min_distance }
    }

    /// Where this scenario's car can be.
    pub fn space_of(world: &World, scenario: &Scenario) -> FreeSpace {
        let body = body_of(&scenario.vehicle);
        let half_length = (body.front - body.rear) * 0.5;
        FreeSpace::new(world, body.half_width.min(half_length))
    }

    /// The pairs that training drives in this generation, none of them kept from the one before.
    ///
    /// # Errors
    ///
    /// A world in which no pair is found.
    pub fn training(
        &self,
        scenario: &Scenario,
        seed: RunSeed,
        generation: u32,
    ) -> Result<Vec<Pair>, NoPair> {
        training_in(std::slice::from_ref(self), &[], scenario, seed, generation)
    }

    /// Pairs that choose the champion: neither trained on nor part of an evaluation.
    ///
    /// # Errors
    ///
    /// A world in which no pair is found.
    pub fn validation(&self, seed: RunSeed, count: u32) -> Result<Vec<Pair>, NoPair> {
        validation_in(std::slice::from_ref(self), seed, count)
    }

    /// Pairs that no training has ever seen: their random numbers serve no other purpose.
    ///
    /// # Errors
    ///
    /// A world in which no pair is found.
    pub fn unseen(&self, seed: RunSeed, count: u32) -> Result<Vec<Pair>, NoPair> {
        let stream = |index| seed.stream(Purpose::EvaluationPairs, 0, index);
        draw(std::slice::from_ref(self), count, stream)
    }

    /// One pair: body and target clear of obstacles, any heading, far enough apart, both in the
    /// main part of the free space.
    fn pair(&self, random: &mut Stream) -> Result<Pair, NoPair> {
        let (min, max) = (self.world.bounds.min, self.world.bounds.max);
        let radius = self.world.target_radius;
        for _ in 0..TRIES {
            let x = random.within(min[0], max[0]);
            let y = random.within(min[1], max[1]);
            let heading = random.within(-PI, PI);
            let goal = [random.within(min[0], max[0]), random.within(min[1], max[1])];
            if distance([x, y], goal) < self.min_distance || self.world.blocks_disc(goal, radius) {
                continue;
            }
            let pose = Pose::new(x, y, heading);
            let middle = pose.to_world((self.body.front + self.body.rear) * 0.5, 0.0);
            if !self.world.blocks(&self.body, &pose)
                && self.space.main_part_reaches([middle.0, middle.1], 0.0)
                && self.space.main_part_reaches(goal, radius)
            {
                return Ok(Pair { start: [x, y, heading], goal });
            }
        }
        Err(NoPair { min_distance: self.min_distance, tries: TRIES })
    }
}

/// The pairs that training drives in this generation where it has several worlds, each with its
/// sampler: they take turns, so that pair `i` lies in world `i` modulo their number. Kept pairs
/// take the places of the last ones.
///
/// # Errors
///
/// A world in which no pair is found.
pub fn training_in(
    worlds: &[PairSampler<'_>],
    kept: &[Pair],
    scenario: &Scenario,
    seed: RunSeed,
    generation: u32,
) -> Result<Vec<Pair>, NoPair> {
    match &scenario.pairs.source {
        PairSource::Listed(pairs) => Ok(pairs.clone()),
        PairSource::Drawn { count, resample } => {
            let generations = scenario.training.generations;
            let count = scenario.pairs.count_at(*count, progress(generation, generations));
            let kept = &kept[..kept.len().min(count as usize)];
            let generation = if *resample { generation } else { 0 };
            let mut pairs = draw(worlds, count - kept.len() as u32, |index| {
                seed.stream(Purpose::TrainingPairs, generation, index)
            })?;
            pairs.extend_from_slice(kept);
            Ok(pairs)
        }
    }
}

/// Pairs that choose the champion where training has several worlds, which take turns.
///
/// # Errors
///
/// A world in which no pair is found.
pub fn validation_in(
    worlds: &[PairSampler<'_>],
    seed: RunSeed,
    count: u32,
) -> Result<Vec<Pair>, NoPair> {
    draw(worlds, count, |index| seed.stream(Purpose::ValidationPairs, 0, index))
}

fn draw(
    worlds: &[PairSampler<'_>],
    count: u32,
    stream: impl Fn(u32) -> Stream,
) -> Result<Vec<Pair>, NoPair> {
    let taking_turns = worlds.iter().cycle();
    (0..count).zip(taking_turns).map(|(index, world)| world.pair(&mut stream(index))).collect()
}

impl PairSpec {
    /// How many pairs are drawn `progress`, 0 to 1, of the way from the first generation, which
    /// has `count`, to the last.
    fn count_at(&self, count: u32, progress: f64) -> u32 {
        let Some(end) = self.count_end else { return count };
        between(count.into(), end.into(), progress).round() as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_number_of_pairs_grows_by_equal_ratios_to_the_last_generation() {
        let spec =
            |count_end| PairSpec { count_end, ..crate::scenario::Preset::Paper.scenario().pairs };
        let counts = |spec: PairSpec| [0.0, 0.25, 0.5, 1.0].map(|at| spec.count_at(16, at));
        assert_eq!(counts(spec(None)), [16; 4]);
        // Four times as many in all, twice as many half way, the square root of that before.
        assert_eq!(counts(spec(Some(64))), [16, 23, 32, 64]);
        assert_eq!(counts(spec(Some(1))), [16, 8, 4, 1]);
    }
}

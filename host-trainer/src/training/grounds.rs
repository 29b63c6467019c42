//! The worlds that training drives in.

use crate::disturbances::Disturbances;
use crate::failure::Failure;
use crate::pairs::PairSampler;
use crate::problem::Problem;
use crate::scenario::generate::{Kind, Recipe};
use crate::scenario::{Scenario, WorldsSpec};
use crate::seed::{Purpose, RunSeed};
use crate::stress;

/// One world, for the scenario's car and for the worse ones that some drives are made with.
#[derive(Debug)]
pub(super) struct Ground {
    own: Variant,
    /// With a larger body, if some are.
    padded: Option<Variant>,
}

/// A car, and the same under stress if some drives are.
#[derive(Debug)]
struct Variant {
    calm: Problem,
    stressed: Option<Problem>,
}

impl Variant {
    fn new(calm: Problem) -> Self {
        let scenario = &calm.scenario;
        let stressed = scenario.training.has_stress().then(|| {
            let car = Disturbances::of(scenario).without_chance();
            calm.disturbed(stress::in_full(car, scenario.episode.period))
        });
        Self { calm, stressed }
    }
}

impl Ground {
    fn new(problem: Problem) -> Self {
        let padding = problem.scenario.training.footprint_padding;
        let padded = (padding > 0.0).then(|| Variant::new(problem.padded()));
        Self { own: Variant::new(problem), padded }
    }

    /// The world with the scenario's car.
    pub(super) fn as_described(&self) -> &Problem {
        &self.own.calm
    }

    /// The world with the car of a generation's `n`th drive, counted world by world, if this share of
    /// the drives is under stress: in turns as described and padded, of either as many under stress.
    pub(super) fn for_drive(&self, n: usize, share: f64) -> &Problem {
        let (car, turn) = match &self.padded {
            None => (&self.own, n),
            Some(padded) => ([&self.own, padded][n % 2], n / 2),
        };
        let stressed = car.stressed.as_ref().filter(|_| is_stressed(turn, share));
        stressed.unwrap_or(&car.calm)
    }

    /// Draws pairs in it.
    pub(super) fn sampler(&self) -> PairSampler<'_> {
        self.as_described().sampler()
    }
}

/// Whether a drive is under stress in its turn: of the first `n` of them `share * n` are, rounded
/// down.
fn is_stressed(turn: usize, share: f64) -> bool {
    let before = |turns: usize| (turns as f64 * share) as u64;
    before(turn + 1) > before(turn)
}

/// The scenario's own world, or those that its run makes for itself.
///
/// # Errors
///
/// No way through any of many random fields.
pub(super) fn grounds(problem: &Problem, seed: RunSeed) -> Result<Vec<Ground>, Failure> {
    let Some(worlds) = problem.scenario.training.worlds else {
        return Ok(vec![Ground::new(problem.clone())]);
    };
    recipes(worlds, seed).map(|recipe| Ok(Ground::new(made(&recipe, &problem.scenario)?))).collect()
}

/// What worlds the run with this seed makes.
pub(super) fn recipes(worlds: WorldsSpec, seed: RunSeed) -> impl Iterator<Item = Recipe> {
    let counts = Kind::ALL.into_iter().zip(worlds.counts());
    let kinds = counts.flat_map(|(kind, count)| (0..count).map(move |_| kind));
    (0..).zip(kinds).map(move |(index, kind)| {
        Recipe::drawn(kind, worlds.side, &mut seed.stream(Purpose::TrainingWorld, 0, index))
    })
}

/// A world for the scenario's car and target.
fn made(recipe: &Recipe, scenario: &Scenario) -> Result<Problem, Failure> {
    let made = recipe
        .scenario()
        .map_err(|error| Failure::bad_input(format!("training.worlds: {recipe}: {error}")))?;
    let mut scenario =
        Scenario { name: made.name, description: made.description, ..scenario.clone() };
    let target_radius = scenario.world.target_radius;
    scenario.world = made.world;
    scenario.world.target_radius = target_radius;
    let [width, height] = scenario.world.bounds.size();
    scenario.pairs.min_distance = scenario.pairs.min_distance.min(0.5 * width.min(height));
    Problem::new(scenario)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drives_under_stress_are_spread_evenly() {
        let turns = |share| -> String {
            (0..8).map(|turn| if is_stressed(turn, share) { '!' } else { '.' }).collect()
        };
        assert_eq!(turns(0.0), "........");
        assert_eq!(turns(0.25), "...!...!");
        assert_eq!(turns(0.5), ".!.!.!.!");
        assert_eq!(turns(1.0), "!!!!!!!!");
    }
}

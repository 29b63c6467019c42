//! The worlds that training drives in.

use crate::disturbances::Disturbances;
use crate::failure::Failure;
use crate::pairs::PairSampler;
use crate::problem::Problem;
use crate::scenario::generate::{Kind, Recipe};
use crate::scenario::{Scenario, WorldsSpec};
use crate::seed::{Purpose, RunSeed};
use crate::stress;

/// One world: for the scenario's car, and for the same under stress if some drives are.
#[derive(Debug)]
pub(super) struct Ground {
    pub(super) as_described: Problem,
    pub(super) stressed: Option<Problem>,
}

impl Ground {
    fn new(problem: Problem) -> Self {
        let scenario = &problem.scenario;
        let stressed = scenario.training.has_stress().then(|| {
            let car = Disturbances::of(scenario).without_chance();
            problem.disturbed(stress::in_full(car, scenario.episode.period))
        });
        Self { as_described: problem, stressed }
    }

    /// Draws pairs in it.
    pub(super) fn sampler(&self) -> PairSampler<'_> {
        self.as_described.sampler()
    }
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

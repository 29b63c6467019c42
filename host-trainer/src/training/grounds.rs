//! The worlds that training drives in.

use crate::disturbances::Disturbances;
use crate::failure::Failure;
use crate::pairs::PairSampler;
use crate::problem::Problem;
use crate::scenario::generate::{Kind, Recipe};
use crate::scenario::{Scenario, WorldsSpec};
use crate::seed::{Purpose, RunSeed};
use crate::stress::{self, Factor};
use std::fmt::Display;

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
    stressed: Option<Stressed>,
}

/// The cars of drives under stress. Who met dead time and a slow servo only together would steer well for
/// both at once, and for neither alone.
#[derive(Debug)]
struct Stressed {
    in_full: Problem,
    /// Those without dead time and without the slow servo, if cars take turns.
    with_less: Option<[Problem; 2]>,
}

impl Variant {
    fn new(calm: Problem) -> Self {
        let scenario = &calm.scenario;
        let stressed = scenario.training.has_stress().then(|| {
            let (car, period) =
                (Disturbances::of(scenario).without_chance(), scenario.episode.period);
            let but = |factor| calm.disturbed(stress::in_full_but(factor, car, period));
            let in_turns = scenario.training.stress_in_turns;
            Stressed {
                in_full: calm.disturbed(stress::in_full(car, period)),
                with_less: in_turns.then(|| [Factor::DeadTime, Factor::ServoTime].map(but)),
            }
        });
        Self { calm, stressed }
    }
}

impl Stressed {
    /// Whose turn it is: every other time that of all stress.
    fn in_turn(&self, turn: u64) -> &Problem {
        match (turn % 4, &self.with_less) {
            (1, Some([but_dead_time, _])) => but_dead_time,
            (3, Some([_, but_servo_time])) => but_servo_time,
            _ => &self.in_full,
        }
    }
}

impl Ground {
    /// A problem's own world.
    pub(super) fn new(problem: Problem) -> Self {
        let padding = problem.scenario.training.footprint_padding;
        let padded = (padding > 0.0).then(|| Variant::new(problem.padded()));
        Self { own: Variant::new(problem), padded }
    }

    /// The world with the scenario's car.
    pub(super) fn as_described(&self) -> &Problem {
        &self.own.calm
    }

    /// The world with the car of a generation's `n`th drive, counted world by world, if this share of
    /// the drives is under stress: in turns as described and padded, of either as many under stress. Of the
    /// cars under stress it is first the turn of number `first_turn`.
    pub(super) fn for_drive(&self, n: usize, share: f64, first_turn: u64) -> &Problem {
        let (car, n) = match &self.padded {
            None => (&self.own, n),
            Some(padded) => ([&self.own, padded][n % 2], n / 2),
        };
        match car.stressed.as_ref().zip(place_under_stress(n, share)) {
            None => &car.calm,
            Some((cars, place)) => cars.in_turn(first_turn + place),
        }
    }

    /// Draws pairs in it.
    pub(super) fn sampler(&self) -> PairSampler<'_> {
        self.as_described().sampler()
    }
}

/// Which drive under stress the `n`th drive is, from 0; none if it is calm. Of the first `n` drives `share * n`
/// are under stress, rounded down.
fn place_under_stress(n: usize, share: f64) -> Option<u64> {
    let before = |drives: usize| (drives as f64 * share) as u64;
    (before(n + 1) > before(n)).then(|| before(n))
}

/// One of the worlds that a run makes for itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Plan {
    kind: Kind,
    /// Its place among the random numbers of worlds.
    at: (u32, u32),
}

/// Worlds of the first generation, those that take their places, and those that only choose the
/// champion have random numbers of their own.
const FIRST: u32 = 0;
const LATER: u32 = 1;
const HELD_OUT: u32 = 2;

/// Numbers kept for each time that all places are held out.
const APART: u32 = 1000;

/// Draws of a world before giving up.
const TRIES: u32 = 20;

/// Pairs that must be found in a world. Where only a few places are wide enough for a car, one may be
/// found by luck, and the next one not.
const PAIRS: u32 = 20;

impl Plan {
    /// The worlds to train in in this generation. Later ones take the places of the first, and of
    /// each other, in turns.
    pub(super) fn of_generation(worlds: WorldsSpec, generation: u32) -> Vec<Self> {
        let later = generation.checked_div(worlds.renew_every).unwrap_or(0);
        let total = worlds.total();
        let newest = |place: u32| match later.checked_sub(place + 1) {
            None => (FIRST, place),
            Some(since) => (LATER, place + since / total * total),
        };
        kinds(worlds).map(|(place, kind)| Self { kind, at: newest(place) }).collect()
    }

    /// The worlds that nobody is trained in.
    pub(super) fn held_out(worlds: WorldsSpec) -> Vec<Self> {
        let at = |time: u32, (place, kind)| Self { kind, at: (HELD_OUT, time * APART + place) };
        (0..worlds.held_out).flat_map(|time| kinds(worlds).map(move |one| at(time, one))).collect()
    }

    /// Makes the world for the car and target of a problem whose run has this seed: the first that is
    /// drawn in which there are ways from starts to goals.
    ///
    /// # Errors
    ///
    /// None in many draws.
    pub(super) fn made(
        self,
        problem: &Problem,
        seed: RunSeed,
    ) -> Result<(Recipe, Ground), Failure> {
        let scenario = &problem.scenario;
        let worlds = scenario.training.worlds.expect("only such a run has plans");
        let (group, index) = self.at;
        let is_soon_left = group == HELD_OUT || worlds.renew_every > 0;
        let mut random = seed.stream(Purpose::TrainingWorld, group, index);
        let mut draw = || {
            let recipe = Recipe::drawn(self.kind, worlds.side, &mut random);
            let failed = |error: &dyn Display| {
                Failure::bad_input(format!("training.worlds: {recipe}: {error}"))
            };
            let world = recipe.scenario().map_err(|error| failed(&error))?;
            let problem = with_world(scenario, world, is_soon_left)?;
            problem.sampler().unseen(seed, PAIRS).map_err(|none| failed(&none))?;
            Ok((recipe, Ground::new(problem)))
        };
        let mut drawn = draw();
        for _ in 1..TRIES {
            if drawn.is_ok() {
                break;
            }
            drawn = draw();
        }
        drawn
    }
}

/// The kind of world in each place.
fn kinds(worlds: WorldsSpec) -> impl Iterator<Item = (u32, Kind)> {
    let counts = Kind::ALL.into_iter().zip(worlds.counts());
    (0..).zip(counts.flat_map(|(kind, count)| (0..count).map(move |_| kind)))
}

/// The scenario's car and target in a world that was made.
fn with_world(scenario: &Scenario, made: Scenario, is_soon_left: bool) -> Result<Problem, Failure> {
    let mut scenario =
        Scenario { name: made.name, description: made.description, ..scenario.clone() };
    let target_radius = scenario.world.target_radius;
    scenario.world = made.world;
    scenario.world.target_radius = target_radius;
    let [width, height] = scenario.world.bounds.size();
    scenario.pairs.min_distance = scenario.pairs.min_distance.min(0.5 * width.min(height));
    if is_soon_left { Problem::for_a_while(scenario) } else { Problem::new(scenario) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_new_world_takes_the_place_of_an_old_one_in_turns() {
        let worlds = WorldsSpec { boxes: 2, rooms: 1, renew_every: 4, ..WorldsSpec::NONE };
        let in_generation = |generation| -> Vec<(u32, u32)> {
            let plans = Plan::of_generation(worlds, generation);
            let kinds: Vec<Kind> = plans.iter().map(|plan| plan.kind).collect();
            assert_eq!(kinds, [Kind::Boxes, Kind::Boxes, Kind::Rooms]);
            plans.iter().map(|plan| plan.at).collect()
        };
        assert_eq!(in_generation(0), [(0, 0), (0, 1), (0, 2)]);
        assert_eq!(in_generation(3), [(0, 0), (0, 1), (0, 2)]);
        assert_eq!(in_generation(4), [(1, 0), (0, 1), (0, 2)]);
        assert_eq!(in_generation(8), [(1, 0), (1, 1), (0, 2)]);
        assert_eq!(in_generation(12), [(1, 0), (1, 1), (1, 2)]);
        assert_eq!(in_generation(19), [(1, 3), (1, 1), (1, 2)]);
        assert_eq!(in_generation(29), [(1, 6), (1, 4), (1, 5)]);
        let kept = WorldsSpec { renew_every: 0, ..worlds };
        assert_eq!(Plan::of_generation(kept, 29), Plan::of_generation(kept, 0));
    }

    #[test]
    fn nobody_is_trained_in_a_world_that_is_held_out() {
        let worlds =
            WorldsSpec { boxes: 2, barn_like: 1, renew_every: 1, held_out: 2, ..WorldsSpec::NONE };
        let held_out = Plan::held_out(worlds);
        let kinds: Vec<Kind> = held_out.iter().map(|plan| plan.kind).collect();
        assert_eq!(kinds, [[Kind::Boxes, Kind::Boxes, Kind::BarnLike]; 2].concat());
        for (number, plan) in held_out.iter().enumerate() {
            assert!(!held_out[..number].contains(plan), "{plan:?}");
            assert!((0..300).all(|at| !Plan::of_generation(worlds, at).contains(plan)), "{plan:?}");
        }
    }

    #[test]
    fn a_world_that_cannot_be_is_drawn_anew() {
        let mut scenario = crate::scenario::Preset::Paper.scenario();
        scenario.training.worlds =
            Some(WorldsSpec { rooms: 1, side: [14.0, 20.0], ..WorldsSpec::NONE });
        // Wider than any door.
        (scenario.vehicle.width, scenario.vehicle.length) = (1.6, 1.7);
        scenario.pairs.min_distance = 7.0;
        let problem = Problem::new(scenario).unwrap();
        let first = |seed: RunSeed| {
            let worlds = problem.scenario.training.worlds.unwrap();
            Recipe::drawn(Kind::Rooms, worlds.side, &mut seed.stream(Purpose::TrainingWorld, 0, 0))
        };
        let mut anew = 0;
        for seed in (0..12).map(RunSeed) {
            let plan = Plan::of_generation(problem.scenario.training.worlds.unwrap(), 0)[0];
            let Ok((recipe, ground)) = plan.made(&problem, seed) else { continue };
            assert!(ground.sampler().unseen(RunSeed(9), 3).is_ok(), "{recipe}");
            anew += usize::from(recipe != first(seed));
        }
        assert!(anew > 1, "{anew}");
    }

    #[test]
    fn drives_under_stress_are_spread_evenly() {
        let places = |share| -> String {
            let place = |n| place_under_stress(n, share).map_or(".".into(), |n| n.to_string());
            (0..8).map(place).collect()
        };
        assert_eq!(places(0.0), "........");
        assert_eq!(places(0.25), "...0...1");
        assert_eq!(places(0.5), ".0.1.2.3");
        assert_eq!(places(1.0), "01234567");
    }
}

use super::*;
use crate::scenario::{self, WorldsSpec};
use grounds::Plan;
use std::path::Path;

const SETTINGS: &str = "
    [episode]
    step_limit = 80
    [pairs]
    count = 4
    resample = true
    [training]
    population = 12
    generations = 3
    validation_pairs = 18
    [training.worlds]
    boxes = 1
    rooms = 1
    renew_every = 1
    held_out = 3
";

fn problem() -> Problem {
    let source = scenario::Source::new("a.toml", SETTINGS, Path::new(""));
    Problem::new(scenario::load(&source, None, &[]).unwrap()).unwrap()
}

/// The oracle drives each of the last generation alone, pair by pair.
#[test]
fn the_champion_is_whoever_of_the_last_generation_does_best_in_worlds_that_are_held_out() {
    let (problem, seed) = (problem(), RunSeed(7));
    let mut training = Training::new(&problem, seed).unwrap();
    training.step().unwrap();
    training.step().unwrap();
    let last = training.search.ask().genes().to_vec();
    training.step().unwrap();
    let plans = Plan::held_out(problem.scenario.training.worlds.unwrap());
    let worlds: Vec<_> = plans.iter().map(|plan| plan.made(&problem, seed).unwrap().1).collect();
    let samplers: Vec<_> = worlds.iter().map(|world| world.sampler()).collect();
    let pairs = pairs::validation_in(&samplers, seed, 18).unwrap();
    let cost = |genome: &[f32]| {
        let mut brain = problem.brain(genome).unwrap();
        let mut drives = Vec::new();
        for (index, pair) in (0..).zip(&pairs) {
            let world = worlds[index as usize % worlds.len()].as_described();
            let random = |_| validation_drive(seed, index);
            drives.extend(world.drive_all(&mut *brain, std::slice::from_ref(pair), random));
        }
        fitness::total(&problem.scenario, &pairs, &drives)
    };
    let length = problem.topology().weights();
    let (cheapest, genome) =
        last.chunks(length).map(|genome| (cost(genome), genome)).min_by_key(|all| all.0).unwrap();
    let best = training.best().unwrap();
    assert_eq!((best.cost, best.generation), (cheapest, 2));
    assert_eq!(best.genome, genome);
    let in_training = training.history()[2].best;
    assert_ne!(best.cost.value(), in_training, "who does best in training is another");
}

#[test]
fn worlds_that_make_way_for_new_ones_are_another_problem_in_each_generation() {
    let mut scenario = problem().scenario;
    scenario.pairs.source = PairSource::Drawn { count: 4, resample: false };
    let is_stationary = |renew_every| {
        let mut scenario = scenario.clone();
        scenario.training.worlds = Some(WorldsSpec { boxes: 2, renew_every, ..WorldsSpec::NONE });
        Problem::new(scenario).unwrap().is_stationary()
    };
    assert!(is_stationary(0));
    assert!(!is_stationary(5));
}

#[test]
fn in_each_generation_another_car_under_stress_has_its_turn_first() {
    let problem = problem();
    let training = Training::new(&problem, RunSeed(7)).unwrap();
    let first = |generation| match training.cars_in(generation) {
        Cars::OfTraining { first_turn, .. } => first_turn % 4,
        Cars::AsDescribed => panic!("training has its own cars"),
    };
    let mut turns: Vec<u64> = (0..4).map(first).collect();
    turns.sort_unstable();
    assert_eq!(turns, [0, 1, 2, 3]);
}

//! Paths that a search calls drivable are driven by the simulated car.

use crate::worlds::{always, from_toml, shipped};
use controller_core::control_loop::Actuate;
use controller_core::controller::Command;
use controller_core::motion::Pose;
use controller_core::units::StepLength;
use host_trainer::car::{CarModel, SimulatedCar};
use host_trainer::drivable::{Path, Planner};
use host_trainer::pairs::PairSampler;
use host_trainer::problem::{Problem, evaluation_drive};
use host_trainer::scenario::{Pair, PairSource, RandomiseSpec, Scenario};
use host_trainer::seed::RunSeed;

fn problem(scenario: Scenario) -> Problem {
    Problem::new(scenario).unwrap()
}

fn unseen(problem: &Problem, seed: u64, count: u32) -> Vec<Pair> {
    PairSampler::new(&problem.world, &problem.scenario).unseen(RunSeed(seed), count).unwrap()
}

/// Drives the simulator's own car along a path and says what is wrong with it.
fn complaint(problem: &Problem, pair: &Pair, path: &Path) -> Option<String> {
    let model = CarModel::new(&problem.scenario);
    let [x, y, heading] = pair.start;
    let random = evaluation_drive(RunSeed(1), 0);
    let start = Pose::new(x, y, heading);
    let lookout = model.lookout(&problem.world);
    let mut car = SimulatedCar::new(&problem.world, &lookout, &model, start, pair.goal, random);
    let step = StepLength::from_metres(problem.scaling().step_upper);
    for (period, steer) in path.steers.iter().enumerate() {
        if car.reached {
            return Some(format!("already there in period {period}"));
        }
        if steer.radians().abs() > problem.scaling().steer_limit {
            return Some(format!("steers by {steer:?} in period {period}"));
        }
        car.actuate(Command { steer: *steer, step }).unwrap();
        if car.collided {
            return Some(format!("a collision in period {period}"));
        }
    }
    // Dead time: the last commands are still on their way.
    let waits = problem.scenario.vehicle.delay_periods;
    (0..waits).for_each(|_| car.actuate(Command::STOP).unwrap());
    let is_too_long =
        usize::from(waits) + path.steers.len() > problem.scenario.episode.step_limit as usize;
    (!car.reached || is_too_long).then(|| format!("not there after {} periods", path.steers.len()))
}

/// Cars of every steer limit and step in worlds of boxes, circles and a map.
#[test]
fn the_simulated_car_follows_every_path_to_the_target_without_touching_anything() {
    let with = |name: &str, steer_limit: f32, step: f32| {
        let mut scenario = shipped(name);
        scenario.vehicle.steer_limit = steer_limit.to_radians();
        scenario.vehicle.step = host_trainer::scenario::StepLength::Constant(step);
        scenario.episode.step_limit = 600;
        scenario.episode.randomise = RandomiseSpec::default();
        problem(scenario)
    };
    let cars = [
        with("complex", 90.0, 0.1),
        with("complex", 30.0, 0.07),
        with("depot", 40.0, 0.1),
        with("barn_264", 35.0, 0.05),
        with("small-car", 28.0, 0.05),
    ];
    for problem in cars {
        let planner = Planner::new(&problem);
        let pairs = unseen(&problem, 7, 60);
        let mut found = 0;
        for pair in &pairs {
            let Some(path) = planner.path(pair) else { continue };
            found += 1;
            let complaint = complaint(&problem, pair, &path);
            assert_eq!(complaint, None, "{}: {pair:?}", problem.scenario.name);
        }
        assert!(found > 20, "{}: only {found} of 60", problem.scenario.name);
        let places = planner.drivable(&pairs);
        assert_eq!(places.len(), found, "one by one and side by side");
    }
}

fn paths(text: &str, steer_limit: f32, pair: Pair) -> Option<Path> {
    let mut scenario = from_toml(text);
    scenario.vehicle.steer_limit = steer_limit.to_radians();
    scenario.pairs.source = PairSource::Listed(vec![pair]);
    Planner::new(&problem(scenario)).path(&pair)
}

/// Facing a wall so closely that no turn clears it.
#[test]
fn a_car_in_front_of_a_wall_gets_away_only_if_its_wheels_turn_far_enough() {
    let pair = Pair { start: [9.72, 5.0, 0.0], goal: [2.0, 5.0] };
    assert_eq!(paths("", 30.0, pair), None);
    assert!(paths("", 80.0, pair).is_some());
    let farther = Pair { start: [8.5, 5.0, 0.0], ..pair };
    assert!(paths("", 30.0, farther).is_some());
}

/// A passage 0.3 m wide admits a car of 0.2 m, one of 0.19 m does not.
#[test]
fn a_passage_is_drivable_as_long_as_the_car_fits() {
    let pair = Pair { start: [2.0, 5.0, 0.0], goal: [8.0, 5.0] };
    let wall = |half: f64| {
        format!("world.boxes = [[4, -1, 6, {}], [4, {}, 6, 11]]", 5.0 - half, 5.0 + half)
    };
    assert!(paths(&wall(0.15), 40.0, pair).is_some());
    assert_eq!(paths(&wall(0.095), 40.0, pair), None);
}

#[test]
fn a_way_longer_than_the_step_limit_is_none() {
    let pair = Pair { start: [1.0, 5.0, 0.0], goal: [9.0, 5.0] };
    // 8 m less the target's radius and the overhang, at 0.1 m each.
    let limited = |steps| paths(&format!("episode.step_limit = {steps}"), 30.0, pair);
    assert_eq!(limited(75), None);
    assert_eq!(limited(76).unwrap().steers.len(), 76);
}

/// Whatever drives clean was drivable: here, cars that drive straight on.
#[test]
fn no_pair_that_a_straight_drive_reaches_is_called_undrivable() {
    for name in ["open", "obstacles"] {
        let problem = problem(shipped(name));
        let pairs = unseen(&problem, 3, 3000);
        let straight = &mut always(0.0, 0.1);
        let drives = problem.drive_all(straight, &pairs, |i| evaluation_drive(RunSeed(3), i));
        let ends = pairs.iter().zip(&drives);
        let reached: Vec<Pair> =
            ends.filter(|(_, drive)| drive.clean()).map(|(pair, _)| *pair).collect();
        assert!(reached.len() > 15, "{name}: {}", reached.len());
        assert_eq!(Planner::new(&problem).drivable(&reached).len(), reached.len(), "{name}");
    }
}

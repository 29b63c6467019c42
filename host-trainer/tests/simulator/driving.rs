//! Random drives among walls: what a collision does, and that nothing goes through a wall.

use crate::worlds::{Script, command, from_toml, random, shipped};
use controller_core::observation::Reading;
use host_trainer::car::CarModel;
use host_trainer::episode::{Outcome, Trace};
use host_trainer::problem::Problem;
use host_trainer::scenario::{OnCollision, Pair, Scenario};
use host_trainer::seed::RunSeed;
use std::f32::consts::{FRAC_PI_2, PI};

const STEP: f32 = 0.1;
const WHEELBASE: f32 = 0.3;

/// A drive whose every steer angle is drawn from the whole range.
fn random_drive(problem: &Problem, pair: &Pair, seed: u64) -> (Outcome, Trace) {
    let mut steer = random(seed);
    let mut steer = move |_: &Reading| command(steer.within(-FRAC_PI_2, FRAC_PI_2), STEP);
    problem.drive_traced(&mut Script(&mut steer), pair, random(0))
}

fn drives(scenario: Scenario) -> (Problem, Vec<(Outcome, Trace)>) {
    let problem = Problem::new(scenario).unwrap();
    let pairs = {
        let sampler = problem.sampler();
        sampler.unseen(RunSeed(51), 100).unwrap()
    };
    let drive = |(seed, pair): (u64, &Pair)| random_drive(&problem, pair, seed);
    let drives = (100..).zip(&pairs).map(drive).collect();
    (problem, drives)
}

fn with(on_collision: OnCollision) -> Scenario {
    let mut scenario = shipped("complex");
    scenario.episode.on_collision = on_collision;
    scenario.episode.step_limit = 1000;
    scenario
}

/// Angle between two headings, radians.
fn apart(a: f32, b: f32) -> f32 {
    let turn = a - b;
    (turn - (turn / (2.0 * PI)).round() * 2.0 * PI).abs()
}

#[test]
fn a_blocked_car_keeps_its_place_turns_on_and_is_counted() {
    let (problem, drives) = drives(with(OnCollision::Hold));
    let mut collisions = 0;
    for (outcome, trace) in &drives {
        let mut counted = 0;
        let mut driven = 0.0;
        let ends = trace.steps[1..].iter().map(|step| step.pose).chain([trace.end.unwrap().pose]);
        for (step, after) in trace.steps.iter().zip(ends) {
            // The formula of the specification, in 64 bits.
            let steer = f64::from(step.command.steer.radians());
            let heading = f64::from(step.pose.heading);
            let turned = heading + f64::from(STEP / WHEELBASE) * libm::sin(steer);
            assert!(apart(after.heading, turned as f32) < 1e-5);
            let x = f64::from(step.pose.x) + f64::from(STEP) * libm::cos(heading + steer);
            let y = f64::from(step.pose.y) + f64::from(STEP) * libm::sin(heading + steer);
            let far = libm::hypot(x - f64::from(after.x), y - f64::from(after.y));
            if step.collided {
                counted += 1;
                assert_eq!((after.x, after.y), (step.pose.x, step.pose.y));
            } else {
                driven += STEP;
                assert!(far < 1e-5, "{far}");
                assert!(!problem.world.touches(CarModel::new(&problem.scenario).body(), &after));
            }
            assert!(!problem.world.is_inside_obstacle([after.x, after.y]), "{after:?}");
            assert!(problem.world.bounds.contains([after.x, after.y]), "{after:?}");
        }
        assert_eq!(outcome.collisions, counted);
        assert_eq!(outcome.steps as usize, trace.steps.len());
        assert!((outcome.path_length - driven).abs() < 1e-2);
        collisions += counted;
    }
    assert!(collisions > 5_000, "{collisions} collisions are too few to tell");
}

#[test]
fn the_first_collision_ends_a_drive_that_stops_for_it() {
    let (_, drives) = drives(with(OnCollision::Stop));
    let mut crashed = 0;
    for (outcome, trace) in &drives {
        let (last, before) = trace.steps.split_last().unwrap();
        assert!(before.iter().all(|step| !step.collided));
        assert_eq!(outcome.collisions, u32::from(last.collided));
        assert!(!(outcome.reached && last.collided));
        if last.collided {
            crashed += 1;
            assert!(outcome.steps <= 1000);
        }
    }
    assert!(crashed > 50, "{crashed}");
}

/// A wall without thickness is the easiest to jump. The front axle is at the very front and a
/// step is as long as the body is wide, as far as a scenario may go. On the short wheelbase a
/// step turns the car by 82°; on the long one it moves sideways from where it was blocked with
/// the wall under its body.
#[test]
fn no_car_gets_to_the_other_side_of_a_thin_wall() {
    for wheelbase in [0.14, 0.8] {
        let mut scenario = from_toml(
            "
            [world]
            walls = [
                { points = [[5, 0], [5, 10]] },
                { points = [[0, 5], [5, 5]] },
            ]
            [vehicle]
            length_m = 0.2
            width_m = 0.2
            front_overhang_m = 0
            wheelbase_m = 0.14
            step_m = 0.2
            [episode]
            step_limit = 5000
            ",
        );
        // No scenario's wheels are that far apart; the simulator does not mind.
        scenario.vehicle.wheelbase = wheelbase;
        let problem = Problem::new(scenario).unwrap();
        let mut collisions = 0;
        for seed in 0..60 {
            // In the lower left quarter, close to both walls.
            let pair = Pair { start: [4.7, 4.7, FRAC_PI_2 * seed as f32], goal: [9.0, 9.0] };
            let mut steer = random(seed);
            let mut steer = move |_: &Reading| command(steer.within(-FRAC_PI_2, FRAC_PI_2), 0.2);
            let (outcome, trace) = problem.drive_traced(&mut Script(&mut steer), &pair, random(0));
            collisions += outcome.collisions;
            for step in &trace.steps {
                assert!(step.pose.x < 5.0 && step.pose.y < 5.0, "seed {seed}: {:?}", step.pose);
            }
        }
        assert!(collisions > 10_000, "{collisions}");
    }
}

//! What happens in a drive, on worlds simple enough to know the answer.

use crate::worlds::{Script, always, command, from_toml, random, shipped, world_of};
use controller_core::motion::Pose;
use controller_core::observation::{Echo, Reading};
use host_trainer::car::{CarModel, SimulatedCar};
use host_trainer::episode::{Outcome, Trace};
use host_trainer::problem::{Problem, training_drive};
use host_trainer::scenario::{Pair, Scenario};
use host_trainer::seed::RunSeed;
use std::f32::consts::FRAC_PI_2;

/// Eastwards along the middle of the open room: the target's near edge is 4.62 m ahead.
const EAST: Pair = Pair { start: [1.0, 5.0, 0.0], goal: [6.02, 5.0] };

fn problem(settings: &str) -> Problem {
    Problem::new(from_toml(settings)).unwrap()
}

fn straight(problem: &Problem, pair: &Pair) -> (Outcome, Trace) {
    problem.drive_traced(&mut always(0.0, 0.1), pair, random(0))
}

#[test]
fn a_straight_line_reaches_the_target_in_the_expected_number_of_steps() {
    // The bumper, 5 cm ahead, must cover 4.57 m: 46 steps of 10 cm.
    let (outcome, trace) = straight(&problem(""), &EAST);
    assert!(outcome.reached && outcome.clean());
    assert_eq!((outcome.steps, trace.steps.len()), (46, 46));
    assert!((outcome.path_length - 4.6).abs() < 1e-5, "{}", outcome.path_length);
    assert!((outcome.distance_to_target - 0.42).abs() < 1e-5, "{}", outcome.distance_to_target);
    let end = trace.end.unwrap().pose;
    assert!((end.x - 5.6).abs() < 1e-5 && end.y == 5.0 && end.heading == 0.0, "{end:?}");
}

#[test]
fn the_reference_point_needs_one_step_more_than_the_bumper() {
    let (outcome, _) = straight(&problem("episode.reached_by = 'reference-point'"), &EAST);
    assert!(outcome.reached);
    assert_eq!(outcome.steps, 47);
    assert!(outcome.distance_to_target <= 0.4);
}

#[test]
fn a_target_beside_the_body_counts_for_the_body_only() {
    // The car passes 0.47 m from the target's middle: its side, at 0.1 m, touches the disc.
    let beside = Pair { goal: [6.02, 5.47], ..EAST };
    let body = straight(&problem(""), &beside).0;
    let point = straight(&problem("episode.reached_by = 'reference-point'"), &beside).0;
    assert!(body.reached && !point.reached);
}

#[test]
fn time_runs_out_at_the_step_limit() {
    for (limit, reached) in [(45, false), (46, true)] {
        let (outcome, trace) = straight(&problem(&format!("episode.step_limit = {limit}")), &EAST);
        assert_eq!((outcome.reached, outcome.steps), (reached, limit));
        assert_eq!(trace.steps.len(), limit as usize);
    }
}

#[test]
fn an_unreached_target_is_measured_from_the_front_axle_at_the_end() {
    let (outcome, _) = straight(&problem("episode.step_limit = 20"), &EAST);
    assert!((outcome.distance_to_target - 3.02).abs() < 1e-5, "{}", outcome.distance_to_target);
    assert!((outcome.path_length - 2.0).abs() < 1e-5);
}

#[test]
fn dead_time_keeps_the_car_standing_and_then_acts_on_old_decisions() {
    let delayed = problem("vehicle.delay_periods = 3");
    let (outcome, trace) = straight(&delayed, &EAST);
    assert_eq!(outcome.steps, 46 + 3);
    assert!(trace.steps[..4].iter().all(|step| step.pose.x == 1.0));
    assert!(trace.steps[4].pose.x > 1.0);

    // The fifth decision alone is to turn; the wheels follow three periods later.
    let mut period = 0;
    let mut turn_once = Script(|_: &Reading| {
        period += 1;
        command(if period == 5 { 0.5 } else { 0.0 }, 0.1)
    });
    let (_, trace) = delayed.drive_traced(&mut turn_once, &EAST, random(0));
    let turned = |step: usize| trace.steps[step].pose.heading != 0.0;
    assert!(!turned(7) && turned(8));
    assert_eq!(trace.steps[4].command.steer.radians(), 0.5);
    assert_eq!(trace.steps[7].done.steer.radians(), 0.5);
}

#[test]
fn a_slow_servo_turns_the_wheels_bit_by_bit() {
    // 60°/s at ten periods a second: 6° a period, 45° after eight.
    let slow = problem("vehicle.servo_rate_deg_per_s = 60\nepisode.step_limit = 10");
    let goal = Pair { start: [5.0, 5.0, 0.0], goal: [9.5, 9.5] };
    let (_, trace) = slow.drive_traced(&mut always(45_f32.to_radians(), 0.1), &goal, random(0));
    let degrees: Vec<f32> =
        trace.steps.iter().map(|step| step.done.steer.radians().to_degrees()).collect();
    for (step, degrees) in degrees.iter().enumerate() {
        let expected = (6.0 * (step + 1) as f32).min(45.0);
        assert!((degrees - expected).abs() < 1e-3, "step {step}: {degrees}");
    }
    // The pose follows the wheels, not the command.
    let turn = trace.steps[1].pose.heading;
    assert!((f64::from(turn) - 0.1 / 0.3 * libm::sin(6_f64.to_radians())).abs() < 1e-6, "{turn}");
}

#[test]
fn a_network_with_a_second_output_chooses_its_speed() {
    let choosing = problem("vehicle.step_m = [0.02, 0.12]\nepisode.step_limit = 30");
    assert_eq!(choosing.topology().outputs, 2);
    let pair = Pair { start: [5.0, 5.0, 0.0], goal: [9.5, 9.5] };
    // No weight, so both outputs are 0: straight on at half speed.
    let mut genome = vec![0.0; choosing.topology().weights()];
    let drive = |genome: &[f32]| {
        let mut brain = choosing.brain(genome).unwrap();
        choosing.drive_traced(brain.as_mut(), &pair, random(0))
    };
    let (outcome, trace) = drive(&genome);
    assert!(trace.steps.iter().all(|step| (step.command.step.metres() - 0.07).abs() < 1e-7));
    assert!((outcome.path_length - 30.0 * 0.07).abs() < 1e-5);
    // Weights at random: steps differ and add up to the path.
    let mut stream = random(3);
    genome.fill_with(|| stream.within(-1.0, 1.0));
    let (outcome, trace) = drive(&genome);
    let free = trace.steps.iter().filter(|step| !step.collided);
    let path: f32 = free.map(|step| step.command.step.metres()).sum();
    assert!((outcome.path_length - path).abs() < 1e-4);
    let steps = trace.steps.iter().map(|step| step.command.step.metres());
    assert!(steps.clone().all(|step| (0.02..=0.12).contains(&step)));
    assert!(steps.clone().any(|step| step != trace.steps[0].command.step.metres()));
}

/// A car that stands still for a long time and looks around.
fn watch(settings: &str, periods: u32) -> (Vec<[Echo; 5]>, [Echo; 5]) {
    let problem = problem(&format!("episode.step_limit = {periods}\n{settings}"));
    let pair = Pair { start: [3.0, 5.0, 0.1], goal: [7.7, 6.77] };
    let (_, trace) = problem.drive_traced(&mut always(0.0, 0.0), &pair, random(71));
    (trace.steps.iter().map(|step| step.echoes).collect(), trace.end.unwrap().echoes)
}

#[test]
fn noise_is_gaussian_around_the_true_distance_with_the_given_deviation() {
    let (seen, exact) = watch("sensors.noise_m = 0.05", 4000);
    assert!(exact.iter().any(|echo| matches!(echo, Echo::Target(_))), "{exact:?}");
    let mut errors = Vec::new();
    for echoes in &seen {
        for (seen, exact) in echoes.iter().zip(&exact) {
            match (seen, exact) {
                (Echo::Wall(seen), Echo::Wall(exact))
                | (Echo::Target(seen), Echo::Target(exact)) => errors.push(f64::from(seen - exact)),
                _ => panic!("noise changed what is seen: {seen:?} for {exact:?}"),
            }
        }
    }
    let n = errors.len() as f64;
    let mean = errors.iter().sum::<f64>() / n;
    let deviation = (errors.iter().map(|e| (e - mean) * (e - mean)).sum::<f64>() / n).sqrt();
    assert_eq!(errors.len(), 20_000);
    // Four standard errors: σ/√n of the mean, σ/√2n of the deviation.
    assert!(mean.abs() < 4.0 * 0.05 / n.sqrt(), "{mean}");
    assert!((deviation - 0.05).abs() < 4.0 * 0.05 / (2.0 * n).sqrt(), "{deviation}");
    let within_one = errors.iter().filter(|e| e.abs() < 0.05).count() as f64 / n;
    assert!((within_one - 0.6827).abs() < 0.015, "{within_one}");
}

#[test]
fn noise_stays_within_the_sensors_range() {
    // The walls are 5 to 7 m away; a range just past them cuts the noise off.
    let (seen, _) = watch("sensors.noise_m = 3.0\nsensors.range_m = 7.2", 1000);
    let distances = seen.iter().flatten().filter_map(|echo| match echo {
        Echo::Nothing => None,
        Echo::Wall(distance) | Echo::Target(distance) => Some(*distance),
    });
    let distances: Vec<f32> = distances.collect();
    assert!(distances.iter().all(|distance| (0.0..=7.2).contains(distance)));
    assert!(distances.contains(&7.2) && distances.contains(&0.0));
}

#[test]
fn beams_drop_out_as_often_as_asked_and_independently() {
    let (seen, _) = watch("sensors.dropout = 0.2", 4000);
    let lost = |beam: usize| move |echoes: &[Echo; 5]| echoes[beam] == Echo::Nothing;
    for beam in 0..5 {
        let share = seen.iter().filter(|echoes| lost(beam)(echoes)).count() as f64 / 4000.0;
        // Four standard errors of a share of 0.2 in 4,000.
        assert!((share - 0.2).abs() < 4.0 * (0.16_f64 / 4000.0).sqrt(), "beam {beam}: {share}");
    }
    let both = seen.iter().filter(|e| lost(0)(e) && lost(4)(e)).count() as f64 / 4000.0;
    assert!((both - 0.04).abs() < 4.0 * (0.04_f64 * 0.96 / 4000.0).sqrt(), "{both}");
}

#[test]
fn nothing_is_random_unless_a_scenario_asks_for_it() {
    let problem = problem("");
    assert!(problem.is_stationary());
    let mut wander = always(0.2, 0.1);
    let one = problem.drive_traced(&mut wander, &EAST, random(1));
    let other = problem.drive_traced(&mut wander, &EAST, random(2));
    assert_eq!(one, other);
    // What the car reports is what an exact sensor sees.
    let model = CarModel::new(&problem.scenario);
    let lookout = model.lookout(&problem.world);
    for step in &one.1.steps {
        let car =
            SimulatedCar::new(&problem.world, &lookout, &model, step.pose, EAST.goal, random(3));
        assert_eq!(car.echoes(), step.echoes);
    }
}

const RANDOM_CAR: &str = "
    [sensors]
    noise_m = 0.02
    dropout = 0.05
    [episode]
    start_offset_m = 0.3
    start_turn_deg = 20
    randomise = { wheelbase = 0.1, step = 0.2, steer_offset_deg = 3 }
";

#[test]
fn the_same_random_numbers_give_the_same_drive_bit_for_bit() {
    let problem = problem(RANDOM_CAR);
    assert!(!problem.is_stationary());
    let drive = |seed| problem.drive_traced(&mut always(0.2, 0.1), &EAST, random(seed));
    assert_eq!(drive(1), drive(1));
    assert_ne!(drive(1), drive(2));
}

#[test]
fn a_drive_does_not_depend_on_the_drives_around_it() {
    let mut scenario = shipped("obstacles");
    scenario.sensors.noise = 0.02;
    scenario.network.recurrence = controller_core::network::RecurrenceKind::Elman;
    let problem = Problem::new(scenario).unwrap();
    let sampler = problem.sampler();
    let pairs = sampler.unseen(RunSeed(5), 8).unwrap();
    let mut stream = random(9);
    let genome: Vec<f32> =
        (0..problem.topology().weights()).map(|_| stream.within(-1.0, 1.0)).collect();
    let mut brain = problem.brain(&genome).unwrap();
    let place = |index| training_drive(RunSeed(1), 0, index);
    let together = problem.drive_all(brain.as_mut(), &pairs, place);
    // Alone, last one first, with the same brain.
    for index in (0..8).rev() {
        let pair = [pairs[index]];
        let alone = problem.drive_all(brain.as_mut(), &pair, |_| place(index as u32));
        assert_eq!(alone[0], together[index]);
    }
}

#[test]
fn shifted_starts_are_clear_of_walls_and_on_the_same_side_of_them() {
    // A narrow dead end: most shifts would end in a wall or behind it.
    let mut scenario = from_toml(
        "
        [world]
        walls = [{ points = [[4, 4], [6, 4], [6, 4.6], [4, 4.6]] }]
        [episode]
        start_offset_m = 2
        start_turn_deg = 180
        step_limit = 1
        ",
    );
    let pair = Pair { start: [5.2, 4.3, 0.0], goal: [9.0, 9.0] };
    for (outer_wall, start) in [(true, pair.start), (false, [0.5, 4.3, 0.0])] {
        scenario.world.outer_wall = outer_wall;
        let problem = Problem::new(scenario.clone()).unwrap();
        let mut starts = Vec::new();
        for seed in 0..2_000 {
            let pair = Pair { start, ..pair };
            let (_, trace) = problem.drive_traced(&mut always(0.0, 0.0), &pair, random(seed));
            let pose = trace.steps[0].pose;
            assert!(
                !problem.world.blocks(CarModel::new(&problem.scenario).body(), &pose),
                "{pose:?}"
            );
            assert!(problem.world.bounds.contains([pose.x, pose.y]), "{pose:?}");
            assert!(!problem.world.separates([start[0], start[1]], [pose.x, pose.y]), "{pose:?}");
            assert!((pose.x - start[0]).abs() <= 2.0 && (pose.y - start[1]).abs() <= 2.0);
            starts.push((pose.x.to_bits(), pose.y.to_bits()));
        }
        starts.sort_unstable();
        starts.dedup();
        assert!(starts.len() > 1_500, "{}", starts.len());
    }
}

#[test]
fn a_start_in_a_niche_without_room_to_shift_stays_where_it_is() {
    let problem = problem(
        "
        world.boxes = [[4, 4, 6, 4.85], [4, 5.15, 6, 6], [3.5, 4, 4.6, 6], [5.1, 4, 6, 6]]
        episode.start_offset_m = 3
        episode.step_limit = 1
        ",
    );
    let pair = Pair { start: [5.0, 5.0, 0.0], goal: [9.0, 9.0] };
    for seed in 0..20 {
        let (_, trace) = problem.drive_traced(&mut always(0.0, 0.0), &pair, random(seed));
        let Pose { x, y, .. } = trace.steps[0].pose;
        assert!((4.6..=5.1).contains(&x) && (4.85..=5.15).contains(&y), "{x} {y}");
    }
}

/// How one randomised car drives: metres per step, turn per step at full lock, and drift.
fn measured(scenario: &Scenario, seed: u64) -> [f64; 3] {
    let problem = Problem::new(scenario.clone()).unwrap();
    let pair = Pair { start: [5.0, 5.0, 0.0], goal: [9.5, 9.5] };
    let after = |steer: f32| {
        let (_, trace) = problem.drive_traced(&mut always(steer, 0.1), &pair, random(seed));
        trace.end.unwrap().pose
    };
    let (straight, lock) = (after(0.0), after(FRAC_PI_2));
    let step = libm::hypot(f64::from(straight.x) - 5.0, f64::from(straight.y) - 5.0);
    [step, f64::from(lock.heading), f64::from(straight.heading)]
}

#[test]
fn a_randomised_car_deviates_within_its_limits_and_uses_them() {
    let mut scenario = from_toml("episode.step_limit = 1");
    let exact = measured(&scenario, 1);
    assert!((exact[0] - 0.1).abs() < 1e-6 && exact[2] == 0.0, "{exact:?}");
    scenario.episode.randomise.step = 0.2;
    scenario.episode.randomise.wheelbase = 0.1;
    scenario.episode.randomise.steer_offset = 3_f32.to_radians();
    let cars: Vec<[f64; 3]> = (0..500).map(|seed| measured(&scenario, seed)).collect();
    let range = |values: Vec<f64>| {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        (low, values.iter().copied().fold(f64::NEG_INFINITY, f64::max))
    };
    let (low, high) = range(cars.iter().map(|car| car[0]).collect());
    assert!((0.08..0.082).contains(&low) && (0.118..0.12001).contains(&high), "{low} {high}");
    // Turn per step over step is 1/wheelbase, up to the cosine of the steering error.
    let (low, high) = range(cars.iter().map(|car| car[0] / car[1]).collect());
    assert!((0.27..0.273).contains(&low) && (0.327..0.3307).contains(&high), "{low} {high}");
    let offset = |car: &[f64; 3]| libm::asin(car[2] / car[1]).to_degrees();
    let (low, high) = range(cars.iter().map(offset).collect());
    assert!((-3.02..-2.9).contains(&low) && (2.9..3.02).contains(&high), "{low} {high}");
}

#[test]
fn beams_start_at_their_mounts() {
    let mut scenario = from_toml("");
    scenario.sensors.beams[2].x = 0.05;
    scenario.sensors.beams[0].y = -0.1;
    scenario.sensors.beams[0].angle = -FRAC_PI_2;
    let (world, model) = (world_of(&scenario), CarModel::new(&scenario));
    let lookout = model.lookout(&world);
    // Facing north from (2, 3) in the room of 10 m: 7 m to the wall ahead, 8 m to the right.
    let pose = Pose::new(2.0, 3.0, FRAC_PI_2);
    let echoes = SimulatedCar::new(&world, &lookout, &model, pose, [1.0, 1.0], random(0)).echoes();
    let Echo::Wall(ahead) = echoes[2] else { panic!("{echoes:?}") };
    let Echo::Wall(right) = echoes[0] else { panic!("{echoes:?}") };
    assert!((ahead - 6.95).abs() < 1e-5 && (right - 7.9).abs() < 1e-5, "{ahead} {right}");
}

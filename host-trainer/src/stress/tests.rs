//! Levels, changes and the weakest factor, on drives that never happened.

use super::*;
use crate::scenario::{Preset, RandomiseSpec, Scenario, VehicleSpec};

fn outcome(clean: bool) -> Outcome {
    Outcome { reached: clean, steps: 9, path_length: 1.0, ..Outcome::default() }
}

/// 1000 drives, of which this many are clean.
fn drives(clean: usize) -> Vec<Outcome> {
    (0..1000).map(|index| outcome(index < clean)).collect()
}

fn exact() -> Disturbances {
    Disturbances::of(&Preset::Paper.scenario())
}

#[test]
fn the_factor_that_costs_most_at_its_full_size_is_the_weakest() {
    let stress = Stress::of(exact(), 0.1, |car| {
        let cost = 4000.0 * car.noise + 2000.0 * car.randomise.step;
        Some(drives(900 - cost as usize))
    });
    let stress = stress.unwrap();
    assert_eq!(stress.weakest, Some(Factor::StepLength));
    let clean = |levels: &[Level]| levels.iter().map(|level| level.clean).collect::<Vec<f64>>();
    assert_eq!(clean(&stress.factors[0].levels), [0.86, 0.82, 0.74]);
    assert_eq!(clean(&stress.together), [0.76, 0.62, 0.34]);
    assert_eq!((stress.calm.clean, stress.calm.clean_change.by), (0.9, 0.0));
}

#[test]
fn a_difference_that_chance_explains_names_no_weakest_factor() {
    let of = |lost: usize| {
        let drive =
            |car: Disturbances| Some(drives(if car.noise > 0.0 { 500 - lost } else { 500 }));
        Stress::of(exact(), 0.1, drive).unwrap().weakest
    };
    assert_eq!([of(0), of(3), of(12)], [None, None, Some(Factor::DistanceNoise)]);
}

#[test]
fn without_a_clean_drive_the_reached_ones_name_the_weakest() {
    let drive = |car: Disturbances| {
        let reached = if car.delay_periods > 0 { 300 } else { 800 };
        let touched = Outcome { collisions: 1, ..outcome(true) };
        let drives = drives(reached).into_iter();
        Some(drives.map(|drive| if drive.reached { touched } else { drive }).collect())
    };
    let stress = Stress::of(exact(), 0.1, drive).unwrap();
    assert_eq!(stress.weakest, Some(Factor::DeadTime));
}

#[test]
fn a_stop_in_between_leaves_no_result() {
    let mut left = 5;
    let drive = |_| {
        left -= 1;
        (left > 0).then(|| drives(1))
    };
    assert_eq!(Stress::of(exact(), 0.1, drive), None);
}

#[test]
fn every_factor_disturbs_what_it_is_named_for_and_nothing_else() {
    let exact = exact();
    let disturbed = |factor: Factor| {
        let mut car = exact;
        factor.disturb(factor.full(), 0.1, &mut car);
        car
    };
    let randomise = exact.randomise;
    let expected = [
        Disturbances { noise: 0.02, ..exact },
        Disturbances { dropout: 0.02, ..exact },
        // 60 degrees in 0.2 s.
        Disturbances { servo_rate: Some(300_f32.to_radians()), ..exact },
        Disturbances { delay_periods: 1, ..exact },
        Disturbances {
            randomise: RandomiseSpec { steer_offset: 2_f32.to_radians(), ..randomise },
            ..exact
        },
        Disturbances { randomise: RandomiseSpec { wheelbase: 0.05, ..randomise }, ..exact },
        Disturbances { randomise: RandomiseSpec { step: 0.1, ..randomise }, ..exact },
        Disturbances { start_offset: 0.1, start_turn: 5_f32.to_radians(), ..exact },
    ];
    assert_eq!(Factor::ALL.map(disturbed), expected);
}

#[test]
fn servo_and_dead_time_add_to_what_the_car_has() {
    let mut car = Disturbances { servo_rate: Some(1.0), delay_periods: 7, ..exact() };
    Factor::ServoTime.disturb(0.2, 0.1, &mut car);
    Factor::DeadTime.disturb(0.4, 0.1, &mut car);
    assert_eq!((car.servo_rate, car.delay_periods), (Some(1.0), VehicleSpec::MAX_DELAY));
    let mut quick = exact();
    Factor::DeadTime.disturb(0.1, 0.02, &mut quick);
    assert_eq!(quick.delay_periods, 5);
}

#[test]
fn a_level_that_comes_to_nothing_is_left_out() {
    let stress = Stress::of(exact(), 0.1, |_| Some(drives(500))).unwrap();
    let scales = |alone: &Alone| alone.levels.iter().map(|level| level.scale).collect();
    let scales: Vec<Vec<f32>> = stress.factors.iter().map(scales).collect();
    let all = vec![0.5, 1.0, 2.0];
    let mut expected = vec![all; 8];
    // Half of 0.1 s is less than a control period.
    expected[3] = vec![1.0, 2.0];
    assert_eq!(scales, expected);
}

/// A champion whose weights are all 0 drives straight on.
#[test]
fn stress_leaves_the_problem_as_it_was_and_the_first_level_is_the_scenario_without_chance() {
    let mut scenario = Preset::Paper.scenario();
    scenario.episode.step_limit = 60;
    scenario.sensors.noise = 0.5;
    scenario.episode.randomise.steer_offset = 0.5;
    let calm = |scenario: &Scenario| {
        let mut calm = scenario.clone();
        Disturbances::of(scenario).without_chance().put_into(&mut calm);
        Problem::new(calm).unwrap()
    };
    let mut problem = Problem::new(scenario.clone()).unwrap();
    let genome = vec![0.0; problem.topology().weights()];
    let seed = crate::seed::RunSeed(1);
    let pairs = crate::pairs::PairSampler::new(&problem.world, &scenario).unseen(seed, 60).unwrap();
    let place = |index| crate::problem::evaluation_drive(seed, index);
    let never = StopFlag::default();
    let before = outcomes(&problem, &genome, &pairs, place, &never);
    let stress = Stress::test(&mut problem, &genome, &pairs, place, &never).unwrap();
    assert_eq!(problem.scenario, scenario);
    assert_eq!(outcomes(&problem, &genome, &pairs, place, &never), before);
    let calm = outcomes(&calm(&scenario), &genome, &pairs, place, &never).unwrap();
    assert_eq!(stress.calm, Level::new(0.0, None, &calm, &calm));
    assert!(
        stress.factors.iter().flat_map(|alone| &alone.levels).any(|l| l.clean != stress.calm.clean)
    );
}

#[test]
fn what_a_car_has_of_its_own_stays_where_that_of_stress_is_left_out() {
    let own = Disturbances { delay_periods: 1, servo_rate: Some(9.0), ..exact() };
    let of = |car: Disturbances| (car.delay_periods, car.servo_rate);
    let (delay, servo) = of(in_full(own, 0.1));
    assert!(delay == 2 && servo < Some(6.0), "{delay}, {servo:?}");
    assert_eq!(of(in_full_but(Factor::DeadTime, own, 0.1)), (1, servo));
    assert_eq!(of(in_full_but(Factor::ServoTime, own, 0.1)), (delay, Some(9.0)));
}

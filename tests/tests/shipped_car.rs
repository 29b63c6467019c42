//! What the trainer says about the shipped car is what the car does.
//!
//! The trainer has numbers of its own for the car's limits and its flash, because from host to device
//! goes a file and never a crate. Here the two meet.

use std::f32::consts::FRAC_PI_6;

use controller_core::activation::ActivationKind;
use controller_core::blob::{Aligned, Header, Provenance};
use controller_core::controller::Scaling;
use controller_core::network::{Feedforward, Network};
use controller_core::observation::{BeamMount, Encoding, INPUTS};
use firmware_example::brain::{HIDDEN, OUTPUTS};
use firmware_example::calibration::Calibration;
use firmware_example::{fit, weights};
use host_trainer::champion;
use host_trainer::evolve::Cost;
use host_trainer::export::board::{Board, ShippedCar};
use host_trainer::export::fit::Misfits;
use host_trainer::problem::Problem;
use host_trainer::scenario;
use host_trainer::seed::RunSeed;
use host_trainer::training::Best;

const CAR: Calibration = Calibration::UNFITTED;

#[test]
fn the_trainer_has_the_cars_own_limits() {
    let ShippedCar {
        hidden,
        outputs,
        periods,
        steer_limit,
        speed_limit,
        range,
        wheelbase,
        wheelbase_tolerance,
        beam_degrees,
        mount_tolerance,
        angle_tolerance,
    } = ShippedCar::PICO_2;
    assert_eq!((hidden, outputs), (HIDDEN, OUTPUTS));
    assert_eq!(periods, (*fit::PERIODS.start(), *fit::PERIODS.end()));
    assert_eq!(steer_limit, CAR.servo.steer_limit);
    assert_eq!(speed_limit, CAR.motor.speed_limit);
    assert_eq!((range, wheelbase), (CAR.range, CAR.wheelbase));
    assert_eq!(wheelbase_tolerance, fit::WHEELBASE_TOLERANCE);
    assert_eq!((mount_tolerance, angle_tolerance), (fit::MOUNT_TOLERANCE, fit::ANGLE_TOLERANCE));
    for (beam, degrees) in CAR.beams.iter().zip(beam_degrees) {
        assert_eq!((beam.x, beam.y), (0.0, 0.0));
        assert!((beam.angle - degrees.to_radians()).abs() < 1e-6, "{degrees}°");
    }
}

/// Weights at every limit of the car.
fn header() -> Header {
    Header {
        topology: Network::<Feedforward, f32, INPUTS, HIDDEN, OUTPUTS>::topology(true),
        activation: ActivationKind::Rational,
        scaling: Scaling {
            encoding: Encoding::default(),
            range: CAR.range,
            steer_limit: CAR.servo.steer_limit,
            step_lower: 0.1,
            step_upper: 0.1,
        },
        period: 0.1,
        wheelbase: CAR.wheelbase,
        beams: CAR.beams,
        self_tests: 0,
        provenance: Provenance {
            seed: 1,
            generation: 0,
            scenario_hash: [0; 8],
            tool: [0, 1, 0],
            scenario: Provenance::stored_name("test"),
        },
    }
}

/// Factors around 1, closest where limits are: a tenth of a per mille apart.
fn factors() -> impl Iterator<Item = f32> {
    (9_950..=10_050).map(|factor| factor as f32 / 10_000.0)
}

#[test]
fn export_notes_exactly_what_the_car_refuses() {
    let car = CAR.check().expect("a good calibration");
    let mut verdicts = [0; 2];
    let mut compare = |change: &dyn Fn(&mut Header)| {
        let mut header = header();
        change(&mut header);
        let refused = fit::check(&header, &car).err();
        let noted = Misfits::of(&header, &ShippedCar::PICO_2);
        assert_eq!(noted.is_some(), refused.is_some(), "{refused:?}, {noted:?}");
        verdicts[usize::from(noted.is_some())] += 1;
    };
    compare(&|_| {});
    for factor in factors() {
        compare(&|header| header.scaling.steer_limit *= factor);
        compare(&|header| header.scaling.range *= factor);
        compare(&|header| header.scaling.step_upper *= factor);
        for share in [0.9, 1.1] {
            compare(&|header| header.wheelbase *= share * factor);
        }
        for period in [*fit::PERIODS.start(), *fit::PERIODS.end()] {
            compare(&|header| {
                header.period = period * factor;
                header.scaling.step_upper = 0.5 * header.period;
            });
        }
        for beam in 0..CAR.beams.len() {
            for side in [-factor, factor] {
                compare(&|header| header.beams[beam].x += side * fit::MOUNT_TOLERANCE);
                compare(&|header| header.beams[beam].y += side * fit::MOUNT_TOLERANCE);
                compare(&|header| header.beams[beam].angle += side * fit::ANGLE_TOLERANCE);
            }
        }
    }
    compare(&|header| header.beams = [BeamMount { x: 0.0, y: 0.0, angle: FRAC_PI_6 }; 5]);
    assert!(verdicts.iter().all(|count| *count > 500), "fits and misfits: {verdicts:?}");
}

#[test]
fn champions_of_the_small_car_scenario_drive_the_shipped_car() {
    let source = scenario::find("small-car").expect("it is shipped");
    let scenario = scenario::load(&source, None, &[]).expect("a good scenario");
    assert_eq!(scenario.vehicle.wheelbase, CAR.wheelbase);
    let problem = Problem::new(scenario).expect("a room without a map");
    let genome = vec![0.25; problem.topology().weights()];
    let best = Best { genome, cost: Cost::WORST, generation: 0, kept: Vec::new() };
    let blob = champion::to_blob(&problem, RunSeed(1), &best).expect("good weights");

    let mut region = Box::new(Aligned([0xff_u8; 8192]));
    region.0[..blob.len()].copy_from_slice(&blob);
    let car = CAR.check().expect("a good calibration");
    let brain = weights::load::<HIDDEN, OUTPUTS>(&region.0, &car);
    assert!(brain.is_ok(), "{}", brain.expect_err("refused"));
}

/// A region of `memory.x`, as `NAME : ORIGIN = 0x…, LENGTH = 4M - 64K`: first address and one past the last.
fn region_of(map: &str, name: &str) -> std::ops::Range<u32> {
    let mut lines = map.lines().filter_map(|line| line.trim().strip_prefix(name)?.split_once(':'));
    let (_, line) = lines.find(|(rest, _)| rest.trim().is_empty()).expect(name);
    let (origin, length) = line.split_once(", LENGTH =").expect("a length");
    let origin = origin.trim().strip_prefix("ORIGIN = 0x").expect("an origin");
    let start = u32::from_str_radix(origin, 16).expect("a number");
    let size = |term: &str| {
        let term = term.trim();
        let (digits, unit) = term.split_at(term.len() - 1);
        let unit = match unit {
            "K" => 1 << 10,
            "M" => 1 << 20,
            other => panic!("{name}: the unit {other}"),
        };
        digits.parse::<u32>().expect("a number") * unit
    };
    let mut terms = length.split('-').map(size);
    let first = terms.next().expect("a term");
    start..start + terms.fold(first, |rest, term| rest - term)
}

#[test]
fn export_writes_where_the_pico_2_program_looks() {
    let map = include_str!("../../firmware-example/boards/pico2/memory.x");
    let weights = region_of(map, "WEIGHTS");
    assert_eq!(weights, Board::PICO_2.weights);
    let program = region_of(map, "FLASH");
    assert_eq!(program.start, Board::PICO_2.flash.start);
    assert_eq!(program.end, weights.start, "the program may not grow into the weights");
}

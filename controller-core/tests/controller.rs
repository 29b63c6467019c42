//! The fail-safe: what a bad reading does, now and later.

use controller_core::activation::Rational;
use controller_core::actuator::{Actuator, MAX_DELAY, turned};
use controller_core::control_loop::{Actuate, Decide, Sense, TickError, tick};
use controller_core::controller::{Command, Controller, RECOVERY, Scaling};
use controller_core::lane::Lanes;
use controller_core::network::{Elman, Network, Recurrence, State};
use controller_core::observation::{DistanceLaw, Echo, Encoding, Reading, ReadingError, TypeCode};
use controller_core::units::{SteerAngle, StepLength};

const RANGE: f32 = 8.0;

const SCALING: Scaling = Scaling {
    encoding: Encoding { distance: DistanceLaw::Linear, types: TypeCode::Any },
    range: RANGE,
    steer_limit: 0.5,
    step_lower: 0.0625,
    step_upper: 0.25,
};

fn genome() -> Vec<f32> {
    (0..566).map(|i| ((i * 37 % 101) as f32 - 50.0) / 64.0).collect()
}

fn controller(genome: &[f32]) -> Controller<'_, Elman, Rational, 12, 2> {
    Controller::new(Network::new(genome, true).unwrap(), Rational, SCALING)
}

/// What the sensor sees in a control period of a drive.
fn echoes(period: usize) -> [Option<Echo>; 5] {
    std::array::from_fn(|beam| {
        let distance = ((period * 29 + beam * 13) % 64) as f32 / 8.0;
        Some(if (period + beam).is_multiple_of(3) {
            Echo::Target(distance)
        } else {
            Echo::Wall(distance)
        })
    })
}

fn good(period: usize) -> Reading {
    Reading::new(echoes(period), 0, RANGE).unwrap()
}

/// One way for a beam to be bad.
const FAULTS: [Option<Echo>; 5] = [
    None,
    Some(Echo::Wall(f32::NAN)),
    Some(Echo::Target(f32::INFINITY)),
    Some(Echo::Wall(-0.5)),
    Some(Echo::Target(RANGE + 0.5)),
];

/// Every non-empty set of bad beams with every kind of fault, and a stale reading.
fn faults(period: usize) -> Vec<ReadingError> {
    let mut errors = vec![Reading::new(echoes(period), 4, RANGE).unwrap_err()];
    for bad_beams in 1..32u32 {
        for fault in FAULTS {
            let mut echoes = echoes(period);
            for (beam, echo) in echoes.iter_mut().enumerate() {
                if bad_beams >> beam & 1 == 1 {
                    *echo = fault;
                }
            }
            errors.push(Reading::new(echoes, 0, RANGE).unwrap_err());
        }
    }
    errors
}

fn bits<const H: usize>(state: &State<f32, H>) -> ([u32; H], [u32; H]) {
    (state.first.map(f32::to_bits), state.second.map(f32::to_bits))
}

fn same<R: Recurrence, const H: usize, const O: usize>(
    a: &Controller<'_, R, Rational, H, O>,
    b: &Controller<'_, R, Rational, H, O>,
) -> bool {
    bits(a.state()) == bits(b.state())
}

#[test]
fn a_bad_reading_stops_the_car_in_the_same_period_and_leaves_no_trace_in_the_memory() {
    let genome = genome();
    for start in [0, 1, 20, 39] {
        for error in faults(start) {
            let mut undisturbed = controller(&genome);
            for period in 0..start {
                undisturbed.decide(Ok(&good(period)));
            }
            let mut disturbed = undisturbed.clone();
            assert_eq!(disturbed.decide(Err(error)), Command::STOP, "{error}");
            assert!(same(&disturbed, &undisturbed), "{error} changed the state");
            for owed in 1..RECOVERY {
                assert_eq!(
                    disturbed.decide(Ok(&good(start))),
                    Command::STOP,
                    "{owed} after {error}"
                );
                assert!(same(&disturbed, &undisturbed), "{owed} after {error}");
            }
            // From the RECOVERY-th good reading on, the drive goes on bit for bit.
            for period in start..start + 10 {
                let expected = undisturbed.decide(Ok(&good(period)));
                assert_eq!(disturbed.decide(Ok(&good(period))), expected, "after {error}");
                assert!(same(&disturbed, &undisturbed));
            }
        }
    }
}

#[test]
fn another_bad_reading_while_recovering_starts_the_count_again() {
    let genome = genome();
    let mut controller = controller(&genome);
    let bad = Err(ReadingError::Missing { beam: 2 });
    controller.decide(bad);
    for _ in 0..5 {
        assert_eq!(controller.decide(Ok(&good(0))), Command::STOP);
        assert_eq!(controller.decide(Ok(&good(0))), Command::STOP);
        assert_eq!(controller.decide(bad), Command::STOP);
    }
    assert_eq!(controller.decide(Ok(&good(0))), Command::STOP);
    assert_eq!(controller.decide(Ok(&good(0))), Command::STOP);
    assert_ne!(controller.decide(Ok(&good(0))), Command::STOP);
}

#[test]
fn reset_forgets_the_drive_and_the_fault() {
    let genome = genome();
    let mut used = controller(&genome);
    for period in 0..7 {
        used.decide(Ok(&good(period)));
    }
    used.decide(Err(ReadingError::Stale { age: 9 }));
    used.reset();
    let mut fresh = controller(&genome);
    for period in 0..20 {
        assert_eq!(used.decide(Ok(&good(period))), fresh.decide(Ok(&good(period))));
        assert!(same(&used, &fresh));
    }
}

#[test]
fn an_output_that_is_no_number_stops_the_car() {
    assert_eq!(SCALING.command(&[f32::NAN, 1.0]), Command::STOP);
    assert_eq!(SCALING.command(&[1.0, f32::NAN]), Command::STOP);
    assert_eq!(SCALING.command(&[]), Command::STOP);
    let mut genome = genome();
    genome[100] = f32::NAN;
    assert_eq!(controller(&genome).decide(Ok(&good(3))), Command::STOP);
}

#[test]
fn one_output_steers_at_the_upper_step_and_two_choose_the_step() {
    let command = |outputs: &[f32]| {
        let Command { steer, step } = SCALING.command(outputs);
        (steer.radians(), step.metres())
    };
    assert_eq!(command(&[0.5]), (0.25, 0.25));
    assert_eq!(command(&[-1.0, -1.0]), (-0.5, 0.0625));
    assert_eq!(command(&[1.0, 1.0]), (0.5, 0.25));
    assert_eq!(command(&[0.0, 0.0]), (0.0, 0.156_25));
}

/// A car that reports what it was told to, writes down what it is told to do, and refuses it on
/// demand.
struct Car {
    readings: Vec<Result<Reading, ReadingError>>,
    commands: Vec<Command>,
    refuses: bool,
}

impl Sense for Car {
    fn sense(&mut self) -> Result<Reading, ReadingError> {
        self.readings.remove(0)
    }
}

impl Actuate for Car {
    type Error = &'static str;
    fn actuate(&mut self, command: Command) -> Result<(), &'static str> {
        self.commands.push(command);
        if self.refuses { Err("the servo bus is down") } else { Ok(()) }
    }
}

#[test]
fn a_bad_reading_is_reported_after_the_stop_was_commanded() {
    let genome = genome();
    let mut controller = controller(&genome);
    let error = ReadingError::Missing { beam: 3 };
    let readings = vec![Ok(good(0)), Err(error)];
    let mut car = Car { readings, commands: Vec::new(), refuses: false };
    let driven = tick(&mut car, &mut controller).unwrap();
    assert_ne!(driven, Command::STOP);
    let reported = tick(&mut car, &mut controller).unwrap_err();
    assert_eq!(reported, TickError::Sense(error));
    assert_eq!(reported.to_string(), "stopped: beam 3 did not answer");
    assert_eq!(car.commands, [driven, Command::STOP]);
}

#[test]
fn an_actuator_that_refuses_is_reported_with_its_own_words() {
    let genome = genome();
    let mut controller = controller(&genome);
    let error = ReadingError::Stale { age: 5 };
    let readings = vec![Ok(good(0)), Err(error)];
    let mut car = Car { readings, commands: Vec::new(), refuses: true };
    for _ in 0..2 {
        let reported = tick(&mut car, &mut controller).unwrap_err();
        assert_eq!(reported, TickError::Actuate("the servo bus is down"));
        assert_eq!(reported.to_string(), "the actuator refused: the servo bus is down");
    }
    assert_eq!(car.commands[1], Command::STOP);
}

fn drive(steer: f32) -> Command {
    Command { steer: SteerAngle::from_radians(steer), step: StepLength::from_metres(0.1) }
}

#[test]
fn a_command_comes_through_after_exactly_its_dead_time() {
    for delay in 0..=MAX_DELAY + 3 {
        let mut actuator = Actuator::new(delay, None);
        let done: Vec<Command> = (1..30).map(|i| actuator.act(drive(i as f32 / 64.0))).collect();
        let effective = delay.min(MAX_DELAY);
        for (period, done) in done.iter().enumerate() {
            let expected = match period.checked_sub(effective) {
                Some(sent) => drive((sent + 1) as f32 / 64.0),
                None => Command::STOP,
            };
            assert_eq!(*done, expected, "delay {delay}, period {period}");
        }
    }
}

#[test]
fn a_slow_servo_turns_by_its_rate_and_arrives_exactly() {
    let mut actuator = Actuator::new(0, Some(0.125));
    let mut turn = |to: f32| actuator.act(drive(to)).steer.radians();
    assert_eq!([0.3125; 4].map(&mut turn), [0.125, 0.25, 0.3125, 0.3125]);
    assert_eq!([-0.0625; 4].map(&mut turn), [0.1875, 0.0625, -0.0625, -0.0625]);
    // The step is not the servo's: it comes through at once.
    assert_eq!(actuator.act(Command::STOP).step, StepLength::STOP);
}

#[test]
fn a_servo_rate_that_is_no_rate_holds_the_wheels_and_never_panics() {
    for rate in [f32::NAN, -1.0, 0.0, f32::NEG_INFINITY] {
        assert_eq!(Actuator::new(0, Some(rate)).act(drive(0.4)).steer, SteerAngle::STRAIGHT);
    }
    assert_eq!(Actuator::new(0, Some(f32::INFINITY)).act(drive(0.4)), drive(0.4));
}

/// Numbers that a network or a rate may come to, good and bad.
const NUMBERS: [f32; 16] = [
    0.0,
    -0.0,
    0.25,
    -0.75,
    1.0,
    -1.0,
    1.5,
    -9.0,
    f32::NAN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::MAX,
    f32::MIN,
    1e-42,
    -1e-42,
    0.999_999_94,
];

#[test]
fn the_commands_of_many_cars_are_those_of_each_car() {
    let bits = |(steer, step): (f32, f32)| [steer.to_bits(), step.to_bits()];
    let of = |command: Command| bits((command.steer.radians(), command.step.metres()));
    let limits = [(0.5, 0.0625, 0.25), (3.0, -0.25, 0.25), (1.0, 0.5, f32::MAX)];
    for (steer_limit, step_lower, step_upper) in limits {
        let scaling = Scaling { steer_limit, step_lower, step_upper, ..SCALING };
        for speed in NUMBERS {
            let (steer, step) = scaling.commands(&[Lanes(NUMBERS), Lanes::from(speed)]);
            for (lane, output) in NUMBERS.into_iter().enumerate() {
                let alone = scaling.command(&[output, speed]);
                assert_eq!(bits((steer.0[lane], step.0[lane])), of(alone), "{output} {speed}");
            }
        }
        let (steer, step) = scaling.commands(&[Lanes(NUMBERS)]);
        for (lane, output) in NUMBERS.into_iter().enumerate() {
            assert_eq!(bits((steer.0[lane], step.0[lane])), of(scaling.command(&[output])));
        }
    }
}

#[test]
fn the_wheels_of_many_cars_turn_as_those_of_each_car() {
    for rate in [0.0, 0.3, 7.0] {
        for wanted in NUMBERS {
            let wanted = SteerAngle::from_radians(wanted);
            for from in NUMBERS {
                let from = SteerAngle::from_radians(from);
                let wide =
                    turned(Lanes::<4>::from(from.radians()), Lanes::from(wanted.radians()), rate);
                let expected = (wanted.radians() - from.radians()).clamp(-rate, rate);
                let expected = SteerAngle::from_radians(from.radians() + expected).radians();
                assert_eq!(wide.0[0].to_bits(), expected.to_bits(), "{from:?} {wanted:?} {rate}");
            }
        }
    }
}

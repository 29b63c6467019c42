//! Armed and driving: the command on the pins is the one that core computes.

use controller_core::activation::Rational;
use controller_core::blob::Blob;
use controller_core::control_loop::Decide;
use controller_core::controller::{Command, Controller};
use controller_core::network::Elman;
use controller_core::observation::{Echo, Reading};
use firmware_example::indicator::Signal;
use firmware_example::journal::Event;

use crate::blobs::{self, RANGE};
use crate::hardware::{PERIOD, STOPPED, World, arm, step};

/// Beyond the range of the weights, but not of the sensors.
const FAR: u16 = 1100;

fn good() -> blobs::Region {
    blobs::region(&blobs::header(blobs::topology::<Elman>()))
}

/// The pulses for a command, in double precision: 400 µs to each side at 0.5 rad; 1550 µs and
/// 75 µs for each metre per second.
fn expected_pulses(command: Command) -> [f64; 2] {
    let speed = f64::from(command.step.metres()) / (PERIOD as f64 / 1e6);
    [1500.0 + 800.0 * f64::from(command.steer.radians()), 1550.0 + 75.0 * speed]
}

fn assert_pulses(world: &World, command: Command) {
    for (found, expected) in world.pulses().into_iter().zip(expected_pulses(command)) {
        let found = f64::from(found.expect("a pulse"));
        assert!((found - expected).abs() <= 0.501, "{found} µs, {expected} µs expected");
    }
}

#[test]
fn an_armed_car_does_what_core_decides_step_by_step() {
    let world = World::default();
    let region = good();
    let mut car = world.boot(&region.0);
    let blob = Blob::parse_prefix(&region.0).expect("a blob");
    let network = blob.network::<Elman, 12, 1>().expect("an Elman network");
    let mut core = Controller::new(network, Rational, blob.scaling());

    let still = [400, 700, FAR, 700, 400];
    let wall = |millimetres: u16| Echo::Wall(f32::from(millimetres) / 1000.0);
    let echoes = [wall(400), wall(700), Echo::Nothing, wall(700), wall(400)];
    let reading = Reading::new(echoes.map(Some), 0, RANGE).expect("good");
    let mut decide = |reading: &Reading| core.decide(Ok(reading));

    arm(&world, &mut car, still);
    assert_eq!(car.signal(), Signal::Driving);
    assert_pulses(&world, decide(&reading));
    for _ in 0..5 {
        step(&world, &mut car, still);
        assert_pulses(&world, decide(&reading));
    }

    // The target comes into the second beam from the left; its distance passes the filter of
    // three only when it came twice.
    world.with(|outside| outside.beacon = [false, false, false, true, false]);
    let target = |millimetres: u16| {
        let mut echoes = echoes;
        echoes[3] = Echo::Target(f32::from(millimetres) / 1000.0);
        Reading::new(echoes.map(Some), 0, RANGE).expect("good")
    };
    step(&world, &mut car, [400, 700, FAR, 300, 400]);
    assert_pulses(&world, decide(&target(700)));
    step(&world, &mut car, [400, 700, FAR, 300, 400]);
    assert_pulses(&world, decide(&target(300)));
}

#[test]
fn a_beacon_behind_the_range_of_the_weights_is_nothing() {
    let world = World::default();
    let region = good();
    let mut car = world.boot(&region.0);
    let drive = |beacon: bool| {
        world.with(|outside| outside.beacon = [beacon; 5]);
        world.pulses()
    };
    arm(&world, &mut car, [FAR; 5]);
    let blob = Blob::parse_prefix(&region.0).expect("a blob");
    let network = blob.network::<Elman, 12, 1>().expect("an Elman network");
    let mut core = Controller::new(network, Rational, blob.scaling());
    let nothing = Reading::new([Some(Echo::Nothing); 5], 0, RANGE).expect("good");
    assert_pulses(&world, core.decide(Ok(&nothing)));
    drive(true);
    step(&world, &mut car, [FAR; 5]);
    assert_pulses(&world, core.decide(Ok(&nothing)));
}

#[test]
fn it_starts_when_the_button_is_let_go_and_stops_in_the_period_of_the_next_press() {
    let world = World::default();
    let region = good();
    let mut car = world.boot(&region.0);
    step(&world, &mut car, [700; 5]);
    world.with(|outside| outside.pressed = true);
    for _ in 0..=40 {
        step(&world, &mut car, [700; 5]);
        assert_eq!(world.pulses(), STOPPED);
    }
    assert_eq!(car.signal(), Signal::Ready);
    world.with(|outside| outside.pressed = false);
    step(&world, &mut car, [700; 5]);
    assert_ne!(world.pulses()[1], STOPPED[1]);
    assert!(world.events().contains(&Event::Armed));

    world.with(|outside| outside.pressed = true);
    step(&world, &mut car, [700; 5]);
    assert_eq!(world.pulses(), STOPPED);
    assert!(matches!(world.events()[..], [Event::Disarmed { .. }]));
    assert_eq!(car.signal(), Signal::Disarmed);
}

#[test]
fn every_drive_begins_with_an_empty_memory() {
    let world = World::default();
    let region = good();
    let mut car = world.boot(&region.0);
    let mut drive = || {
        arm(&world, &mut car, [500; 5]);
        let mut pulses = vec![world.pulses()];
        for _ in 0..4 {
            step(&world, &mut car, [500; 5]);
            pulses.push(world.pulses());
        }
        world.with(|outside| outside.pressed = true);
        step(&world, &mut car, [500; 5]);
        world.with(|outside| outside.pressed = false);
        pulses
    };
    let first = drive();
    assert!(first.windows(2).any(|pair| pair[0] != pair[1]), "the memory shows");
    assert_eq!(drive(), first);
}

/// Degrees and metres that a line of the log gives after these words.
fn number_after(line: &str, words: &str) -> f64 {
    let (_, rest) = line.split_once(words).unwrap_or_else(|| panic!("{line}: no {words}"));
    let end = rest.find(|c: char| !"-0123456789.".contains(c)).unwrap_or(rest.len());
    rest[..end].parse().unwrap_or_else(|_| panic!("{line}: no number after {words}"))
}

#[test]
fn the_log_tells_where_the_driven_commands_have_led_since_arming() {
    let world = World::default();
    let region = good();
    let mut car = world.boot(&region.0);
    let blob = Blob::parse_prefix(&region.0).expect("a blob");
    let network = blob.network::<Elman, 12, 1>().expect("an Elman network");
    let wheelbase = f64::from(blob.header().wheelbase);
    let reading = Reading::new([Some(Echo::Wall(0.7)); 5], 0, RANGE).expect("good");
    for drive in 0..2 {
        let mut core = Controller::new(network, Rational, blob.scaling());
        let (mut x, mut y, mut heading, mut distance) = (0.0, 0.0, 0.0, 0.0);
        arm(&world, &mut car, [700; 5]);
        for _ in 0..100 {
            let Command { steer, step } = core.decide(Ok(&reading));
            let (steer, step) = (f64::from(steer.radians()), f64::from(step.metres()));
            x += step * libm::cos(heading + steer);
            y += step * libm::sin(heading + steer);
            heading += step / wheelbase * libm::sin(steer);
            distance += step;
        }
        for _ in 1..100 {
            step(&world, &mut car, [700; 5]);
        }
        world.events();
        world.with(|outside| outside.pressed = true);
        step(&world, &mut car, [700; 5]);
        world.with(|outside| outside.pressed = false);
        let line = world.events()[0].to_string();
        assert!(distance > 1.0, "drive {drive} goes somewhere");
        for (words, exact, within) in [
            ("disarmed: ", distance, 0.006),
            ("believed at (", x, 0.02),
            (", ", y, 0.02),
            ("heading ", heading.to_degrees(), 3.0),
        ] {
            let rest = if words == ", " {
                line.split_once("believed at (").expect("a place").1
            } else {
                &line
            };
            let found = number_after(rest, words);
            assert!((found - exact).abs() <= within, "{line}: {words}{exact} expected");
        }
    }
}

#[test]
fn a_line_a_second_tells_what_it_does() {
    let world = World::default();
    let region = good();
    let mut car = world.boot(&region.0);
    arm(&world, &mut car, [700; 5]);
    world.events();
    for _ in 0..60 {
        step(&world, &mut car, [700; 5]);
    }
    let steps: Vec<u32> = world
        .events()
        .iter()
        .map(|event| match event {
            Event::Driving { step, .. } => *step,
            other => panic!("{other}"),
        })
        .collect();
    assert_eq!(steps, [21, 41, 61]);
}

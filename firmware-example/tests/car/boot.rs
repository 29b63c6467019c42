//! The first second: what comes first, what is missing, what the lamp says.

use controller_core::network::Elman;
use firmware_example::app::RESET_AFTER;
use firmware_example::drivers::rangefinder::{BusFault, SensorFault, StartError};
use firmware_example::indicator::Signal;
use firmware_example::journal::Event;

use crate::blobs;
use crate::hardware::{PERIOD, STOPPED, World, arm, step};

fn good() -> blobs::Region {
    blobs::region(&blobs::header(blobs::topology::<Elman>()))
}

#[test]
fn the_motor_is_stopped_before_weights_and_sensors_are_looked_at() {
    let world = World::default();
    world.with(|outside| outside.bus_fault = Some(embedded_hal::i2c::ErrorKind::Other));
    let region = good();
    let _car = world.boot(&region.0);
    world.with(|outside| {
        assert_eq!(outside.pulses.first(), Some(&("motor", 1500)));
        assert_eq!(outside.first_event, Some(1));
        assert!(outside.accesses > 0);
    });
    assert_eq!(world.pulses(), STOPPED);
}

#[test]
fn a_healthy_car_names_its_weights_and_waits_to_be_armed() {
    let world = World::default();
    let region = good();
    let mut car = world.boot(&region.0);
    let events = world.events();
    assert!(matches!(events[..], [Event::Weights { period: PERIOD, .. }, Event::Sensors]));
    assert_eq!(world.with(|outside| outside.watchdog), Some(RESET_AFTER));
    for _ in 0..40 {
        step(&world, &mut car, [800; 5]);
        assert_eq!(world.pulses(), STOPPED);
    }
    assert_eq!(car.signal(), Signal::Disarmed);
    assert_eq!(world.feeds(), 40);
    assert_eq!(world.events(), []);
}

#[test]
fn the_watchdog_waits_at_least_two_control_periods() {
    let world = World::default();
    let mut header = blobs::header(blobs::topology::<Elman>());
    header.period = 0.15;
    let region = blobs::region(&header);
    let _car = world.boot(&region.0);
    assert_eq!(world.with(|outside| outside.watchdog), Some(300_000));
}

#[test]
fn without_weights_it_says_why_blinks_and_cannot_be_armed() {
    let world = World::default();
    let region = blobs::erased();
    let mut car = world.boot(&region.0);
    let said: Vec<String> = world.events().iter().map(ToString::to_string).collect();
    assert_eq!(said, ["not driving: no blob here: the flash is erased", "all range sensors run"]);
    arm(&world, &mut car, [800; 5]);
    step(&world, &mut car, [800; 5]);
    assert_eq!(world.pulses(), STOPPED);
    assert_eq!(car.signal(), Signal::NoWeights);
    let again = world.events();
    assert!(matches!(again[..], [Event::Refused(_)]), "whoever tries to arm it is told again");
    assert!(world.feeds() > 40, "it stays awake to say so");
}

#[test]
fn a_sensor_that_is_missing_at_boot_is_named_and_a_held_button_restarts() {
    let world = World::default();
    world.with(|outside| outside.sensors[3].present = false);
    let region = good();
    let mut car = world.boot(&region.0);
    let fault = SensorFault::Bus(BusFault::NoAnswer);
    let missing = Event::NoSensors(StartError::Sensor { beam: 3, fault });
    assert!(world.events().contains(&missing));
    assert_eq!(car.signal(), Signal::SensorsLost);

    step(&world, &mut car, [800; 5]);
    assert!(world.feeds() > 0, "it stays awake to say so");
    arm(&world, &mut car, [800; 5]);
    assert!(world.events().contains(&Event::Restarting));
    assert_eq!(world.pulses(), STOPPED);
    world.feeds();
    step(&world, &mut car, [800; 5]);
    assert_eq!(world.feeds(), 0, "the watchdog is to reset the board");

    // The wire is back; the reset board boots again.
    world.with(|outside| outside.sensors[3].present = true);
    let car = world.boot(&region.0);
    assert_eq!(car.signal(), Signal::Disarmed);
}

#[test]
fn a_motor_channel_that_refuses_at_boot_leaves_it_to_the_watchdog() {
    let world = World::default();
    world.with(|outside| outside.motor.broken = true);
    let region = good();
    let mut car = world.boot(&region.0);
    arm(&world, &mut car, [800; 5]);
    assert_eq!(world.feeds(), 0);
    assert!(world.events().iter().any(|event| matches!(event, Event::Actuator(_))));
    assert!(!world.events().contains(&Event::Armed));
}

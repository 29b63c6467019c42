//! What goes wrong while driving, and that the car stops in the very period it shows.

use controller_core::network::Elman;
use controller_core::observation::{BEAMS, ReadingError};
use embedded_hal::i2c::ErrorKind;
use firmware_example::app::{Parts, fail_safe};
use firmware_example::chassis::ActuatorFault;
use firmware_example::clock::Micros;
use firmware_example::drivers::rangefinder::{BusFault, SensorFault};
use firmware_example::indicator::Signal;
use firmware_example::journal::Event;

use crate::blobs;
use crate::hardware::{PERIOD, STOPPED, TestCar, World, arm, calibration, step, step_silent};

const AHEAD: [u16; BEAMS] = [600; BEAMS];

/// A car that drives, with an empty log.
fn driving(then: impl FnOnce(World, &mut TestCar<'_>)) {
    let region = blobs::region(&blobs::header(blobs::topology::<Elman>()));
    let world = World::default();
    let mut car = world.boot(&region.0);
    arm(&world, &mut car, AHEAD);
    step(&world, &mut car, AHEAD);
    assert_eq!(car.signal(), Signal::Driving);
    assert!(drives(&world));
    world.events();
    world.feeds();
    then(world, &mut car);
}

fn drives(world: &World) -> bool {
    world.pulses()[1] != STOPPED[1]
}

#[test]
fn a_sensor_that_dies_stops_the_car_in_the_same_period_motor_first() {
    for beam in 0..BEAMS {
        driving(|world, car| {
            world.with(|outside| {
                outside.sensors[beam].present = false;
                outside.pulses.clear();
            });
            step(&world, car, AHEAD);
            assert_eq!(
                world.with(|outside| outside.pulses.clone()),
                [("motor", 1500), ("servo", 1500)]
            );
            let fault = SensorFault::Bus(BusFault::NoAnswer);
            assert_eq!(
                world.events(),
                [Event::Sensor { beam, fault }, Event::Stopped(ReadingError::Missing { beam }),]
            );
            assert_eq!(car.signal(), Signal::Stopped);
            assert_eq!(world.feeds(), 1, "sensors and loop ran");
        });
    }
}

#[test]
fn a_disturbed_bus_stops_the_car_and_three_good_readings_let_it_go_on() {
    driving(|world, car| {
        world.with(|outside| outside.bus_fault = Some(ErrorKind::ArbitrationLoss));
        step(&world, car, AHEAD);
        assert_eq!(world.pulses(), STOPPED);
        world.with(|outside| outside.bus_fault = None);
        for _ in 0..2 {
            step(&world, car, AHEAD);
            assert_eq!(world.pulses(), STOPPED, "not yet");
        }
        step(&world, car, AHEAD);
        assert!(drives(&world));
        assert_eq!(car.signal(), Signal::Driving);
        assert_eq!(world.events().last(), Some(&Event::Recovered));
    });
}

#[test]
fn a_sensor_that_reports_its_own_fault_stops_the_car() {
    driving(|world, car| {
        world.with(|outside| {
            for sensor in &mut outside.sensors {
                sensor.measure(11, 600);
            }
            outside.sensors[2].measure(1, 600);
        });
        step_silent(&world, car);
        assert_eq!(world.pulses(), STOPPED);
        let fault = SensorFault::Hardware { status: 1 };
        assert!(world.events().contains(&Event::Sensor { beam: 2, fault }));
    });
}

#[test]
fn a_sensor_that_falls_silent_stops_the_car_after_a_tenth_of_a_second() {
    driving(|world, car| {
        for _ in 0..2 {
            step_silent(&world, car);
            assert!(drives(&world), "measurements take a while");
        }
        step_silent(&world, car);
        assert_eq!(world.pulses(), STOPPED);
        assert_eq!(world.events(), [Event::Stopped(ReadingError::Missing { beam: 0 })]);
    });
}

#[test]
fn sensors_lost_for_a_second_disarm_until_the_car_is_restarted() {
    driving(|world, car| {
        for _ in 0..=(1_000_000 / PERIOD) + 3 {
            step_silent(&world, car);
        }
        assert!(world.events().contains(&Event::SensorsLost));
        assert_eq!(car.signal(), Signal::SensorsLost);
        for _ in 0..20 {
            step(&world, car, AHEAD);
            assert_eq!(world.pulses(), STOPPED, "good readings alone do not start it again");
        }
        arm(&world, car, AHEAD);
        assert!(world.events().contains(&Event::Restarting));
        assert_eq!(world.pulses(), STOPPED);
    });
}

#[test]
fn a_motor_channel_that_refuses_disarms_and_starves_the_watchdog() {
    driving(|world, car| {
        world.with(|outside| outside.motor.broken = true);
        step(&world, car, AHEAD);
        assert_eq!(world.events(), [Event::Actuator(ActuatorFault::Motor)]);
        assert_eq!(world.pulses()[0], STOPPED[0], "the wheels at least are straight");
        world.with(|outside| outside.motor.broken = false);
        step(&world, car, AHEAD);
        assert_eq!(world.pulses(), STOPPED);
        assert_eq!(world.feeds(), 0);
    });
}

#[test]
fn a_steering_channel_that_refuses_stops_the_motor() {
    driving(|world, car| {
        world.with(|outside| outside.servo.broken = true);
        step(&world, car, AHEAD);
        assert_eq!(world.pulses()[1], STOPPED[1]);
        assert_eq!(world.events(), [Event::Actuator(ActuatorFault::Steering)]);
        assert_eq!(world.feeds(), 0);
    });
}

#[test]
fn a_button_that_cannot_be_read_disarms() {
    driving(|world, car| {
        world.with(|outside| outside.button_broken = true);
        step(&world, car, AHEAD);
        step(&world, car, AHEAD);
        assert_eq!(world.pulses(), STOPPED);
        assert_eq!(world.events(), [Event::NoButton]);
    });
}

/// Runs the period that is due this much later, with fresh measurements.
fn late(world: &World, car: &mut TestCar<'_>, by: u64) {
    world.with(|outside| {
        for sensor in &mut outside.sensors {
            sensor.measure(11, 600);
        }
    });
    let now = Micros(car.due().0 + by);
    car.period(now);
}

#[test]
fn a_late_period_is_reported_and_too_late_a_one_stops_the_car() {
    driving(|world, car| {
        late(&world, car, PERIOD / 20);
        assert_eq!(world.events(), []);
        late(&world, car, PERIOD / 4);
        assert_eq!(world.events(), [Event::Late { by: PERIOD / 4 }]);
        assert!(drives(&world));
        late(&world, car, 4 * PERIOD);
        assert_eq!(world.pulses(), STOPPED);
        assert_eq!(
            world.events(),
            [Event::Late { by: 4 * PERIOD }, Event::Stopped(ReadingError::Stale { age: 4 })]
        );
    });
}

#[test]
fn an_armed_car_never_moves_while_any_fault_lasts() {
    let breakages: [fn(&World); 5] = [
        |world| world.with(|outside| outside.sensors[4].present = false),
        |world| world.with(|outside| outside.bus_fault = Some(ErrorKind::Overrun)),
        |world| world.with(|outside| outside.servo.broken = true),
        |world| world.with(|outside| outside.button_broken = true),
        |world| world.with(|outside| outside.pressed = true),
    ];
    for (index, breakage) in breakages.into_iter().enumerate() {
        driving(|world, car| {
            breakage(&world);
            for _ in 0..100 {
                step(&world, car, AHEAD);
                assert_eq!(world.pulses()[1], STOPPED[1], "breakage {index}");
            }
        });
    }
}

#[test]
fn a_program_that_fails_stops_the_motor_first_then_straightens_the_wheels_whichever_obeys() {
    for broken in [None, Some("motor"), Some("servo")] {
        driving(|world, _| {
            world.with(|outside| {
                outside.pulses.clear();
                outside.motor.broken = broken == Some("motor");
                outside.servo.broken = broken == Some("servo");
            });
            let Parts { mut servo, mut motor, .. } = world.parts();
            fail_safe(&mut servo, &mut motor, &calibration());
            let expected = [("motor", 1500), ("servo", 1500)];
            let told: Vec<_> =
                expected.into_iter().filter(|(channel, _)| Some(*channel) != broken).collect();
            assert_eq!(world.with(|outside| outside.pulses.clone()), told);
        });
    }
}

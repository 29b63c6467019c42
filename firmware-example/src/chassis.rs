//! The car as the control loop sees it: something that senses and acts.

use crate::clock::Micros;
use crate::drivers::motor::Motor;
use crate::drivers::rangefinder::{Range, SensorFault};
use crate::drivers::servo::Servo;
use crate::drivers::target_beacon::Beacon;
use crate::fan::Fan;
use crate::hardware::Hardware;
use controller_core::control_loop::{Actuate, Sense};
use controller_core::controller::Command;
use controller_core::observation::{BEAMS, Echo, Reading, ReadingError, STALE_AFTER};
use controller_core::units::StepLength;
use core::num::NonZeroU64;

/// Which actuator refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ActuatorFault {
    /// The motor's speed controller.
    Motor,
    /// The steering servo; the motor has been told to stop.
    Steering,
}

controller_core::sentences! { ActuatorFault {
    Self::Motor => "no pulses for the motor";
    Self::Steering => "no pulses for the steering servo";
} }

impl core::error::Error for ActuatorFault {}

/// Sensors and actuators of one car, and the control period they work in.
pub struct Chassis<H: Hardware> {
    sensors: H::Sensors,
    beacon: H::Beacon,
    servo: Servo<H::Servo>,
    motor: Motor<H::Motor>,
    fan: Fan,
    /// How far the network was trained to see, metres.
    range: f32,
    /// Length of a control period, microseconds.
    period: NonZeroU64,
    now: Micros,
    missed: u32,
    sensed: bool,
    acted: bool,
}

impl<H: Hardware> Chassis<H> {
    /// A car whose network sees `range` metres far and decides every `period` microseconds.
    pub fn new(
        sensors: H::Sensors,
        beacon: H::Beacon,
        servo: Servo<H::Servo>,
        motor: Motor<H::Motor>,
        range: f32,
        period: u64,
    ) -> Self {
        Self {
            sensors,
            beacon,
            servo,
            motor,
            fan: Fan::default(),
            range,
            period: NonZeroU64::new(period).unwrap_or(NonZeroU64::MIN),
            now: Micros(0),
            missed: 0,
            sensed: false,
            acted: false,
        }
    }

    /// The range sensors, to start them.
    pub fn sensors(&mut self) -> &mut H::Sensors {
        &mut self.sensors
    }

    /// Opens a control period at this moment, after `missed` whole periods that nobody used.
    pub fn begin(&mut self, now: Micros, missed: u32) {
        self.now = now;
        self.missed = missed;
        self.sensed = false;
        self.acted = false;
    }

    /// Whether this period has seen all sensors asked and both actuators obey.
    pub fn worked(&self) -> bool {
        self.sensed && self.acted
    }

    /// What was wrong with each sensor when it was last asked, rightmost first.
    pub fn faults(&self) -> [Option<SensorFault>; BEAMS] {
        self.fan.faults()
    }

    fn echo(&self, range: Range, target: bool) -> Echo {
        let Range::At(millimetres) = range else { return Echo::Nothing };
        let distance = f32::from(millimetres) / 1000.0;
        if distance > self.range {
            Echo::Nothing
        } else if target {
            Echo::Target(distance)
        } else {
            Echo::Wall(distance)
        }
    }

    fn stop(&mut self) -> Result<(), ActuatorFault> {
        // The motor comes first, and neither keeps the other from being told.
        let motor = self.motor.stop().map_err(|_| ActuatorFault::Motor);
        let steering = self.servo.steer(Command::STOP.steer).map_err(|_| ActuatorFault::Steering);
        motor.and(steering)
    }

    fn drive(&mut self, command: Command) -> Result<(), ActuatorFault> {
        let speed = command.step.metres() * 1e6 / self.period.get() as f32;
        let driven = match self.servo.steer(command.steer) {
            Ok(()) => self.motor.drive(speed).map_err(|_| ActuatorFault::Motor),
            Err(_) => Err(ActuatorFault::Steering),
        };
        if driven.is_err() {
            // Already reported; if this fails too, the watchdog is all that is left.
            let _ = self.stop();
        }
        driven
    }
}

impl<H: Hardware> Sense for Chassis<H> {
    fn sense(&mut self) -> Result<Reading, ReadingError> {
        self.fan.update(&mut self.sensors, self.now);
        let seen = self.beacon.seen();
        self.sensed = true;
        if self.missed > STALE_AFTER {
            return Err(ReadingError::Stale { age: self.missed });
        }
        let mut echoes = [None; BEAMS];
        for ((slot, range), target) in echoes.iter_mut().zip(self.fan.ranges(self.now)).zip(seen) {
            if let (Some(range), Some(target)) = (range, target) {
                *slot = Some(self.echo(range, target));
            }
        }
        let age = self.fan.age(self.now);
        let begun = age / self.period + u64::from(age % self.period != 0);
        Reading::new(echoes, u32::try_from(begun).unwrap_or(u32::MAX), self.range)
    }
}

impl<H: Hardware> Actuate for Chassis<H> {
    type Error = ActuatorFault;

    fn actuate(&mut self, command: Command) -> Result<(), ActuatorFault> {
        let result =
            if command.step == StepLength::STOP { self.stop() } else { self.drive(command) };
        self.acted = result.is_ok();
        result
    }
}

//! The kinds of things one car is made of.

use crate::clock::Watchdog;
use crate::drivers::rangefinder::RangeFinders;
use crate::drivers::target_beacon::Beacon;
use crate::journal::Journal;
use embedded_hal::digital::{InputPin, OutputPin};
use embedded_hal::pwm::SetDutyCycle;

/// The types of one car's parts: a board names each once, and the driving program is written for any.
///
/// It has no values; [`crate::app::Parts`] holds the parts themselves.
pub trait Hardware {
    /// The five range sensors.
    type Sensors: RangeFinders;
    /// What sees the target's beacon.
    type Beacon: Beacon;
    /// PWM channel of the steering servo.
    type Servo: SetDutyCycle;
    /// PWM channel of the motor's speed controller.
    type Motor: SetDutyCycle;
    /// The button's pin, low while it is pressed.
    type Button: InputPin;
    /// The lamp's pin, high while it is lit.
    type Lamp: OutputPin;
    /// The watchdog.
    type Watchdog: Watchdog;
    /// The log.
    type Journal: Journal;
}

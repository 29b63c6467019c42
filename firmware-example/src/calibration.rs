//! What one particular car is like: its servo, motor, beams and wheelbase.
//!
//! The numbers come from measuring the car with its wheels off the ground. They are checked
//! once, by [`Calibration::check`]; drivers take only [`Checked`] ones, so no pulse outside a
//! servo's range can be asked for later.

use controller_core::observation::{BEAMS, BeamMount};
use core::f32::consts::{FRAC_PI_2, FRAC_PI_6};

/// Shortest and longest pulse that servos and speed controllers understand, microseconds.
pub const PULSES: core::ops::RangeInclusive<u16> = 500..=2500;

/// Shortest and longest pulse frame, microseconds: 400 Hz for digital servos, 50 Hz for all.
pub const FRAMES: core::ops::RangeInclusive<u16> = 2_500..=20_000;

/// The steering servo, with pulses in microseconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ServoCalibration {
    /// From the start of one pulse to the start of the next.
    pub frame: u16,
    /// Pulse at which the wheels point straight ahead.
    pub centre: u16,
    /// Pulse at which they point [`Self::steer_limit`] to the left.
    pub left: u16,
    /// Pulse at which they point [`Self::steer_limit`] to the right.
    pub right: u16,
    /// Added to all three: corrects a servo horn that was put on again.
    pub trim: i16,
    /// Steer angle at the outer pulses, radians, above 0 and at most π/2.
    pub steer_limit: f32,
}

/// The motor's speed controller, with pulses in microseconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotorCalibration {
    /// From the start of one pulse to the start of the next.
    pub frame: u16,
    /// Pulse at which the motor stands; also what arms most speed controllers at power-up.
    pub stop: u16,
    /// Pulse at which the car just begins to move.
    pub start: u16,
    /// Pulse at which it drives at [`Self::full_speed`].
    pub full: u16,
    /// Speed at the full pulse, metres per second, above 0.
    pub full_speed: f32,
    /// Never faster than this, metres per second, above 0 and at most the full speed.
    pub speed_limit: f32,
}

/// Everything about one car that weights depend on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Calibration {
    /// The steering servo.
    pub servo: ServoCalibration,
    /// The motor.
    pub motor: MotorCalibration,
    /// Where each beam starts and points, rightmost first.
    pub beams: [BeamMount; BEAMS],
    /// Longest distance the range sensors see reliably, metres, above 0.
    pub range: f32,
    /// Front axle to rear axle, metres, above 0.
    pub wheelbase: f32,
}

impl Calibration {
    /// A 1:10 car with a standard servo, a 1500 µs speed controller and VL53L0X sensors, before
    /// anything was measured: values to begin fitting from, slow on purpose.
    pub const UNFITTED: Self = Self {
        servo: ServoCalibration {
            frame: 20_000,
            centre: 1500,
            left: 1900,
            right: 1100,
            trim: 0,
            steer_limit: 0.5,
        },
        motor: MotorCalibration {
            frame: 20_000,
            stop: 1500,
            start: 1550,
            full: 2000,
            full_speed: 6.0,
            speed_limit: 1.0,
        },
        beams: [
            BeamMount { x: 0.0, y: 0.0, angle: -FRAC_PI_6 },
            BeamMount { x: 0.0, y: 0.0, angle: -0.5 * FRAC_PI_6 },
            BeamMount { x: 0.0, y: 0.0, angle: 0.0 },
            BeamMount { x: 0.0, y: 0.0, angle: 0.5 * FRAC_PI_6 },
            BeamMount { x: 0.0, y: 0.0, angle: FRAC_PI_6 },
        ],
        range: 1.2,
        wheelbase: 0.3,
    };

    /// Accepts the numbers, or names the first that cannot be meant.
    ///
    /// # Errors
    ///
    /// A pulse or frame outside [`PULSES`] or [`FRAMES`], pulses in the wrong order, or a
    /// number that is not finite or outside its range.
    pub fn check(self) -> Result<Checked, CalibrationError> {
        let ServoCalibration { frame, centre, left, right, trim, steer_limit } = self.servo;
        frame_of("servo frame", frame)?;
        for (field, at) in [("servo centre", centre), ("servo left", left), ("servo right", right)]
        {
            pulse(field, at)?;
            pulse(field, at.saturating_add_signed(trim))?;
        }
        ordered("servo right, centre and left", [right, centre, left])?;
        number("servo steer limit", steer_limit, steer_limit > 0.0 && steer_limit <= FRAC_PI_2)?;

        let MotorCalibration { frame, stop, start, full, full_speed, speed_limit } = self.motor;
        frame_of("motor frame", frame)?;
        for (field, at) in [("motor stop", stop), ("motor start", start), ("motor full", full)] {
            pulse(field, at)?;
        }
        ordered("motor stop, start and full", [stop, start, full])?;
        number("motor full speed", full_speed, full_speed > 0.0)?;
        number("motor speed limit", speed_limit, speed_limit > 0.0 && speed_limit <= full_speed)?;

        for BeamMount { x, y, angle } in self.beams {
            number("beam x", x, true)?;
            number("beam y", y, true)?;
            number("beam angle", angle, angle.abs() <= FRAC_PI_2)?;
        }
        number("range", self.range, self.range > 0.0)?;
        number("wheelbase", self.wheelbase, self.wheelbase > 0.0)?;
        Ok(Checked(self))
    }
}

/// A calibration that [`Calibration::check`] accepted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checked(Calibration);

impl Checked {
    /// The numbers.
    pub fn get(&self) -> &Calibration {
        &self.0
    }
}

/// A calibration that cannot be meant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CalibrationError {
    /// A pulse or a frame that the hardware would not understand, microseconds.
    Time {
        /// Which number.
        field: &'static str,
        /// Its value.
        found: u16,
        /// Shortest allowed.
        shortest: u16,
        /// Longest allowed.
        longest: u16,
    },
    /// Three pulses that neither rise nor fall.
    Order {
        /// Which three, in the order of the values.
        fields: &'static str,
        /// Their values, microseconds.
        found: [u16; 3],
    },
    /// A number that is not finite or outside its range.
    Number {
        /// Which number.
        field: &'static str,
        /// Its value.
        found: f32,
    },
}

controller_core::sentences! { CalibrationError {
    Self::Time { field, found, shortest, longest } =>
        "{} is {} µs, {} to {} µs expected", field, found, shortest, longest;
    Self::Order { fields, found: [a, b, c] } =>
        "{} are {}, {} and {} µs, rising or falling pulses expected", fields, a, b, c;
    Self::Number { field, found } => "{} is {}, outside its range", field, found;
} }

impl core::error::Error for CalibrationError {}

fn pulse(field: &'static str, found: u16) -> Result<(), CalibrationError> {
    within(field, found, PULSES)
}

fn frame_of(field: &'static str, found: u16) -> Result<(), CalibrationError> {
    within(field, found, FRAMES)
}

fn within(
    field: &'static str,
    found: u16,
    allowed: core::ops::RangeInclusive<u16>,
) -> Result<(), CalibrationError> {
    if allowed.contains(&found) {
        return Ok(());
    }
    let (shortest, longest) = (*allowed.start(), *allowed.end());
    Err(CalibrationError::Time { field, found, shortest, longest })
}

fn ordered(fields: &'static str, found: [u16; 3]) -> Result<(), CalibrationError> {
    let [a, b, c] = found;
    if (a < b && b < c) || (a > b && b > c) {
        Ok(())
    } else {
        Err(CalibrationError::Order { fields, found })
    }
}

fn number(field: &'static str, found: f32, holds: bool) -> Result<(), CalibrationError> {
    if found.is_finite() && holds { Ok(()) } else { Err(CalibrationError::Number { field, found }) }
}

//! The steering servo.

use super::pulse::{PulseOutput, PwmRefused};
use crate::calibration::{Checked, ServoCalibration};
use controller_core::units::SteerAngle;
use embedded_hal::pwm::SetDutyCycle;

/// A steering servo on a PWM channel.
#[derive(Clone, Copy, Debug)]
pub struct Servo<P> {
    output: PulseOutput<P>,
    calibration: ServoCalibration,
}

impl<P: SetDutyCycle> Servo<P> {
    /// The servo on this channel, which the board has set up for the calibration's frame.
    pub fn new(pwm: P, calibration: &Checked) -> Self {
        let calibration = calibration.get().servo;
        Self { output: PulseOutput::new(pwm, calibration.frame), calibration }
    }

    /// Turns the wheels: a straight line from the centre pulse to the outer pulse of that side,
    /// and the outer pulse for every angle beyond the steer limit.
    ///
    /// # Errors
    ///
    /// The PWM channel refused.
    pub fn steer(&mut self, angle: SteerAngle) -> Result<(), PwmRefused> {
        let ServoCalibration { centre, left, right, trim, steer_limit, .. } = self.calibration;
        let share = angle.radians() / steer_limit;
        let outer = if share > 0.0 { left } else { right };
        let width = between(centre, outer, share.abs()).saturating_add_signed(trim);
        self.output.set(width)
    }
}

/// The pulse at this share of the way between two, to the nearest microsecond; a share beyond
/// `0.0..=1.0` or NaN stays at the end it is nearest to, or at `from`.
pub(super) fn between(from: u16, to: u16, share: f32) -> u16 {
    let share = share.clamp(0.0, 1.0);
    // A cast from float to integer cuts off the fraction, never overflows, and turns NaN into 0.
    let way = (share * f32::from(from.abs_diff(to)) + 0.5) as u16;
    if to > from { from.saturating_add(way) } else { from.saturating_sub(way) }
}

//! The motor behind its speed controller.

use super::pulse::{PulseOutput, PwmRefused};
use super::servo::between;
use crate::calibration::{Checked, MotorCalibration};
use embedded_hal::pwm::SetDutyCycle;

/// A speed controller on a PWM channel. It never drives backwards.
#[derive(Clone, Copy, Debug)]
pub struct Motor<P> {
    output: PulseOutput<P>,
    calibration: MotorCalibration,
}

impl<P: SetDutyCycle> Motor<P> {
    /// The motor on this channel, which the board has set up for the calibration's frame.
    pub fn new(pwm: P, calibration: &Checked) -> Self {
        let calibration = calibration.get().motor;
        Self { output: PulseOutput::new(pwm, calibration.frame), calibration }
    }

    /// Stands still.
    ///
    /// # Errors
    ///
    /// The PWM channel refused.
    pub fn stop(&mut self) -> Result<(), PwmRefused> {
        self.output.set(self.calibration.stop)
    }

    /// Drives at this speed in metres per second: a straight line from the start pulse to the
    /// full pulse, never past the speed limit. Speeds of 0 or less, and NaN, mean
    /// [`Self::stop`].
    ///
    /// # Errors
    ///
    /// The PWM channel refused.
    pub fn drive(&mut self, speed: f32) -> Result<(), PwmRefused> {
        let MotorCalibration { start, full, full_speed, speed_limit, .. } = self.calibration;
        if speed > 0.0 {
            self.output.set(between(start, full, speed.min(speed_limit) / full_speed))
        } else {
            self.stop()
        }
    }
}

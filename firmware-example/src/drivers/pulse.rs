//! Pulse widths in microseconds as duty cycles of a PWM channel.

use core::num::NonZeroU16;
use embedded_hal::pwm::SetDutyCycle;

/// The PWM channel refused. `embedded-hal` knows no finer cause.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PwmRefused;

/// A PWM channel whose frame length is known.
#[derive(Clone, Copy, Debug)]
pub(super) struct PulseOutput<P> {
    pwm: P,
    frame: NonZeroU16,
}

impl<P: SetDutyCycle> PulseOutput<P> {
    /// A channel set up by the board for frames of this many microseconds; a frame of 0, which a
    /// checked calibration never has, counts as 1.
    pub(super) fn new(pwm: P, frame: u16) -> Self {
        Self { pwm, frame: NonZeroU16::new(frame).unwrap_or(NonZeroU16::MIN) }
    }

    /// Sends pulses of this width from the next frame on; a width beyond the frame is cut to it.
    pub(super) fn set(&mut self, width: u16) -> Result<(), PwmRefused> {
        let frame = u32::from(self.frame.get());
        let width = u32::from(width).min(frame);
        // At most 65535² plus half a frame: fits.
        let duty = (width * u32::from(self.pwm.max_duty_cycle()) + frame / 2)
            / core::num::NonZeroU32::from(self.frame);
        // `width` is at most `frame`, so the duty is at most the maximum.
        let duty = u16::try_from(duty).unwrap_or(u16::MAX);
        self.pwm.set_duty_cycle(duty).map_err(|_| PwmRefused)
    }
}

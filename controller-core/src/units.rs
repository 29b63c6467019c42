//! Quantities that reach an actuator, as types whose every value is safe to send.

use core::f32::consts::FRAC_PI_2;

/// Front-wheel steer angle in radians, positive to the left; always finite and within ±π/2.
///
/// ```
/// use controller_core::units::SteerAngle;
///
/// let limit = 0.5;
/// assert_eq!(SteerAngle::from_unit(-1.0, limit).radians(), -0.5);
/// assert_eq!(SteerAngle::from_unit(7.0, limit).radians(), 0.5);
/// assert_eq!(SteerAngle::from_unit(f32::NAN, limit), SteerAngle::STRAIGHT);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SteerAngle(f32);

impl SteerAngle {
    /// Wheels straight ahead; also the fail-safe command.
    pub const STRAIGHT: Self = Self(0.0);

    /// Scales a network output in `-1.0..=1.0` by the steer limit in radians.
    ///
    /// Output beyond ±1 saturates, a limit beyond π/2 is cut to it, NaN becomes
    /// [`Self::STRAIGHT`].
    #[inline]
    pub fn from_unit(output: f32, limit: f32) -> Self {
        Self::from_radians(output.clamp(-1.0, 1.0) * limit)
    }

    /// An angle in radians, saturated to ±π/2; NaN becomes [`Self::STRAIGHT`].
    #[inline]
    pub fn from_radians(radians: f32) -> Self {
        if radians.is_nan() { Self::STRAIGHT } else { Self(radians.clamp(-FRAC_PI_2, FRAC_PI_2)) }
    }

    /// The angle in radians.
    #[inline]
    pub fn radians(self) -> f32 {
        self.0
    }
}

/// Distance to drive in one control period, metres; always finite and 0 or more.
///
/// The simulator moves by it; a car divides by its control period to get a speed.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct StepLength(f32);

impl StepLength {
    /// Stand still; also the fail-safe command.
    pub const STOP: Self = Self(0.0);

    /// A length in metres; negative or non-finite becomes [`Self::STOP`].
    #[inline]
    pub fn from_metres(metres: f32) -> Self {
        if metres.is_finite() && metres > 0.0 { Self(metres) } else { Self::STOP }
    }

    /// Between `lower` at output −1 and `upper` at output +1, metres.
    #[inline]
    pub fn from_unit(output: f32, lower: f32, upper: f32) -> Self {
        let share = (output.clamp(-1.0, 1.0) + 1.0) * 0.5;
        Self::from_metres(lower + share * (upper - lower))
    }

    /// The length in metres.
    #[inline]
    pub fn metres(self) -> f32 {
        self.0
    }
}

//! Quantities that reach an actuator, as types whose every value is safe to send.

use crate::lane::Lane;
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

    /// [`Self::from_unit`] in radians, for any number of cars.
    #[inline(always)]
    pub fn safe_from_unit<L: Lane>(output: L, limit: f32) -> L {
        Self::safe(output.held_within(1.0) * L::from(limit))
    }

    /// [`Self::from_radians`] in radians, for any number of cars.
    #[inline(always)]
    pub fn safe<L: Lane>(radians: L) -> L {
        let held = radians.held_within(FRAC_PI_2);
        L::select(held.le(held), held, L::from(0.0))
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

    /// [`Self::from_unit`] in metres, for any number of cars.
    #[inline(always)]
    pub fn safe_from_unit<L: Lane>(output: L, lower: f32, upper: f32) -> L {
        let share = (output.held_within(1.0) + L::from(1.0)) * L::from(0.5);
        Self::safe(L::from(lower) + share * L::from(upper - lower))
    }

    /// [`Self::from_metres`] in metres, for any number of cars.
    #[inline(always)]
    pub fn safe<L: Lane>(metres: L) -> L {
        let zero = L::from(0.0);
        let moves = zero.lt(metres) & metres.lt(L::from(f32::INFINITY));
        L::select(moves, metres, zero)
    }

    /// The length in metres.
    #[inline]
    pub fn metres(self) -> f32 {
        self.0
    }
}

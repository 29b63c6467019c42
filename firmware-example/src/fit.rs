//! Whether weights were trained for this car.

use crate::calibration::Checked;
use controller_core::blob::Header;

/// Control periods this program can keep, seconds: shorter ones starve the sensors, longer ones
/// outlast the watchdog.
pub const PERIODS: core::ops::RangeInclusive<f32> = 0.02..=0.2;

/// A wheelbase may differ by this share.
pub const WHEELBASE_TOLERANCE: f32 = 0.1;

/// A beam may start this many metres away from where it was trained.
pub const MOUNT_TOLERANCE: f32 = 0.05;

/// A beam may point this many radians (3°) away from where it was trained.
pub const ANGLE_TOLERANCE: f32 = 0.053;

/// Limits are compared with this allowance for rounding.
const ROUNDING: f32 = 1.001;

/// How the car that weights were trained for differs from this one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Misfit {
    /// A control period outside [`PERIODS`], seconds.
    Period {
        /// The weights'.
        found: f32,
    },
    /// The weights steer further than this car can, radians.
    SteerLimit {
        /// The weights'.
        found: f32,
        /// The car's.
        expected: f32,
    },
    /// The weights drive faster than this car may, metres per second.
    Speed {
        /// The weights'.
        found: f32,
        /// The car's.
        expected: f32,
    },
    /// The weights see further than this car's sensors, metres.
    Range {
        /// The weights'.
        found: f32,
        /// The car's.
        expected: f32,
    },
    /// Another wheelbase, metres.
    Wheelbase {
        /// The weights'.
        found: f32,
        /// The car's.
        expected: f32,
    },
    /// A beam starts elsewhere, metres in front of and to the left of the front axle's middle.
    BeamPlace {
        /// Index of the beam, rightmost is 0.
        beam: usize,
        /// The weights'.
        found: (f32, f32),
        /// The car's.
        expected: (f32, f32),
    },
    /// A beam points elsewhere, radians to the left.
    BeamAngle {
        /// Index of the beam, rightmost is 0.
        beam: usize,
        /// The weights'.
        found: f32,
        /// The car's.
        expected: f32,
    },
}

controller_core::sentences! { Misfit {
    Self::Period { found } =>
        "trained for another car: a control period of {} s, {} to {} s expected",
        found, PERIODS.start(), PERIODS.end();
    Self::SteerLimit { found, expected } =>
        "trained for another car: it steers to {} rad, this one to {} rad", found, expected;
    Self::Speed { found, expected } =>
        "trained for another car: it drives at {} m/s, this one at {} m/s at most", found, expected;
    Self::Range { found, expected } =>
        "trained for another car: it sees {} m far, this one {} m", found, expected;
    Self::Wheelbase { found, expected } =>
        "trained for another car: its wheelbase is {} m, this one's {} m", found, expected;
    Self::BeamPlace { beam, found: (x, y), expected: (own_x, own_y) } =>
        "trained for another car: its beam {} starts at ({}, {}) m, this one's at ({}, {}) m",
        beam, x, y, own_x, own_y;
    Self::BeamAngle { beam, found, expected } =>
        "trained for another car: its beam {} points to {} rad, this one's to {} rad",
        beam, found, expected;
} }

impl core::error::Error for Misfit {}

/// Compares the car in a blob's header with this one.
///
/// # Errors
///
/// The first difference that would make the car drive otherwise than it was trained to.
pub fn check(header: &Header, car: &Checked) -> Result<(), Misfit> {
    let car = car.get();
    let found = header.period;
    if !PERIODS.contains(&found) {
        return Err(Misfit::Period { found });
    }
    let (found, expected) = (header.scaling.steer_limit, car.servo.steer_limit);
    if found > expected * ROUNDING {
        return Err(Misfit::SteerLimit { found, expected });
    }
    let (found, expected) = (header.scaling.step_upper / header.period, car.motor.speed_limit);
    if found > expected * ROUNDING {
        return Err(Misfit::Speed { found, expected });
    }
    let (found, expected) = (header.scaling.range, car.range);
    if found > expected * ROUNDING {
        return Err(Misfit::Range { found, expected });
    }
    let (found, expected) = (header.wheelbase, car.wheelbase);
    if apart(found, expected) > expected * WHEELBASE_TOLERANCE {
        return Err(Misfit::Wheelbase { found, expected });
    }
    for (beam, (found, expected)) in header.beams.iter().zip(&car.beams).enumerate() {
        if apart(found.x, expected.x).max(apart(found.y, expected.y)) > MOUNT_TOLERANCE {
            let (found, expected) = ((found.x, found.y), (expected.x, expected.y));
            return Err(Misfit::BeamPlace { beam, found, expected });
        }
        if apart(found.angle, expected.angle) > ANGLE_TOLERANCE {
            let (found, expected) = (found.angle, expected.angle);
            return Err(Misfit::BeamAngle { beam, found, expected });
        }
    }
    Ok(())
}

fn apart(a: f32, b: f32) -> f32 {
    (a - b).abs()
}

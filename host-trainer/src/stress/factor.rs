//! The ways in which a real car differs from the simulated one.

use crate::disturbances::Disturbances;
use crate::scenario::VehicleSpec;
use serde::Serialize;
use std::f32::consts::FRAC_PI_3;

/// A disturbance with a size.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Factor {
    /// Gaussian noise on every distance.
    DistanceNoise,
    /// Beams that miss their echo.
    DroppedBeams,
    /// Wheels that need time to turn.
    ServoTime,
    /// Time between deciding and acting.
    DeadTime,
    /// Wheels that are not straight when they should be.
    SteerOffset,
    /// Axles that are not as far apart as described.
    Wheelbase,
    /// A motor that is faster or slower than described.
    StepLength,
    /// A start that is not where it was said to be.
    Start,
}

/// Degrees by which a start turns for each metre of its shift.
const TURN_PER_SHIFT: f32 = 50.0;

impl Factor {
    /// Every factor, in the order they are shown to people.
    pub const ALL: [Self; 8] = [
        Self::DistanceNoise,
        Self::DroppedBeams,
        Self::ServoTime,
        Self::DeadTime,
        Self::SteerOffset,
        Self::Wheelbase,
        Self::StepLength,
        Self::Start,
    ];

    /// Its name in a table.
    pub fn name(self) -> &'static str {
        match self {
            Self::DistanceNoise => "distance noise",
            Self::DroppedBeams => "dropped beams",
            Self::ServoTime => "servo time",
            Self::DeadTime => "dead time",
            Self::SteerOffset => "steering offset",
            Self::Wheelbase => "wheelbase",
            Self::StepLength => "step length",
            Self::Start => "start",
        }
    }

    /// What it does.
    pub fn about(self) -> &'static str {
        match self {
            Self::DistanceNoise => "standard deviation of every distance",
            Self::DroppedBeams => "probability that a beam sees nothing, each beam and period",
            Self::ServoTime => "for the wheels to turn by 60 degrees",
            Self::DeadTime => "between deciding and acting, rounded down to control periods",
            Self::SteerOffset => "largest constant steering error of a car",
            Self::Wheelbase => "largest relative deviation of a car's wheelbase",
            Self::StepLength => "largest relative deviation of a car's step",
            Self::Start => {
                "largest shift of a start in x and in y, with half a degree of turn per cm"
            }
        }
    }

    /// The size that a small car with range sensors and a hobby servo has to be expected to
    /// have: the stress defaults. Reasons and sources are in `docs/stress.md`.
    pub fn full(self) -> f32 {
        match self {
            Self::DistanceNoise | Self::DroppedBeams => 0.02,
            Self::ServoTime => 0.2,
            Self::DeadTime | Self::StepLength | Self::Start => 0.1,
            Self::SteerOffset => 2.0,
            Self::Wheelbase => 0.05,
        }
    }

    /// What its sizes are in.
    pub fn unit(self) -> &'static str {
        match self {
            Self::DistanceNoise | Self::Start => "m",
            Self::ServoTime | Self::DeadTime => "s",
            Self::SteerOffset => "deg",
            Self::DroppedBeams | Self::Wheelbase | Self::StepLength => "share",
        }
    }

    /// Puts this much of it on a car with this control period, seconds. A slow servo and dead time add to
    /// what the car has already.
    pub fn disturb(self, magnitude: f32, period: f32, car: &mut Disturbances) {
        match self {
            Self::DistanceNoise => car.noise = magnitude,
            Self::DroppedBeams => car.dropout = magnitude,
            Self::ServoTime => {
                let rate = FRAC_PI_3 / magnitude;
                car.servo_rate = Some(car.servo_rate.map_or(rate, |own| own.min(rate)));
            }
            Self::DeadTime => {
                // A hair more, so that 0.1 s is five periods of 0.02 s whatever they round to.
                let periods = (magnitude / period + 1e-3) as u8;
                let all = car.delay_periods.saturating_add(periods);
                car.delay_periods = all.min(VehicleSpec::MAX_DELAY);
            }
            Self::SteerOffset => car.randomise.steer_offset = magnitude.to_radians(),
            Self::Wheelbase => car.randomise.wheelbase = magnitude,
            Self::StepLength => car.randomise.step = magnitude,
            Self::Start => {
                car.start_offset = magnitude;
                car.start_turn = (TURN_PER_SHIFT * magnitude).to_radians();
            }
        }
    }
}

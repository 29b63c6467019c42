//! Where the car believes it is, reckoned from what it was told to do.
//!
//! For people who read the log, and never for driving: sine and cosine are `micromath`'s approximations, and
//! the wheels may slip. The first has a bound, [`DRIFT`]; the second shows on the floor.

use crate::figures::{degrees, rounded};
use controller_core::controller::Command;
use core::f32::consts::{PI, TAU};
use micromath::F32Ext;

/// Largest error of one step because sine and cosine are approximated: metres per metre driven, and radians
/// of heading per wheelbase driven. A heading that is off carries later positions along.
///
/// `micromath` documents an error of at most 0.002 for each; a position takes both.
pub const DRIFT: f32 = 0.003;

/// Pose and distance since the car was armed, by the commands alone.
///
/// The frame is that of the moment of arming: origin at the middle of the front axle, x forward, y to the
/// left, heading counter-clockwise. The motion is the simulator's: the front axle rolls where the wheels
/// point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Odometry {
    /// Forward of where it was armed, metres.
    pub x: f32,
    /// To the left of where it was armed, metres.
    pub y: f32,
    /// Radians to the left of where it pointed, within ±π.
    pub heading: f32,
    /// Path length, metres.
    pub distance: f32,
}

impl Odometry {
    /// Adds one control period with this command in force, for a car with this wheelbase in metres, above 0.
    pub fn follow(&mut self, command: Command, wheelbase: f32) {
        let step = command.step.metres();
        let steer = command.steer.radians();
        // By name: on a host `f32` has methods of its own that are called the same.
        self.x += step * F32Ext::cos(self.heading + steer);
        self.y += step * F32Ext::sin(self.heading + steer);
        self.heading = within_half_turn(self.heading + step * F32Ext::sin(steer) / wheelbase);
        self.distance += step;
    }
}

/// The same direction within ±π, of an angle at most one turn outside.
fn within_half_turn(angle: f32) -> f32 {
    if angle > PI {
        angle - TAU
    } else if angle < -PI {
        angle + TAU
    } else {
        angle
    }
}

controller_core::sentences! { Odometry {
    Self { x, y, heading, distance } =>
        "{} m driven, believed at ({}, {}) m, heading {}°",
        rounded(*distance, 100.0), rounded(*x, 100.0), rounded(*y, 100.0), degrees(*heading);
} }

#[cfg(test)]
mod tests {
    use super::*;
    use controller_core::units::{SteerAngle, StepLength};
    use core::f32::consts::FRAC_PI_2;

    /// What the simulator's formula says in double precision.
    #[derive(Default)]
    struct Exact {
        x: f64,
        y: f64,
        heading: f64,
    }

    impl Exact {
        fn follow(&mut self, command: Command, wheelbase: f64) {
            let (step, steer) =
                (f64::from(command.step.metres()), f64::from(command.steer.radians()));
            self.x += step * libm::cos(self.heading + steer);
            self.y += step * libm::sin(self.heading + steer);
            self.heading += step * libm::sin(steer) / wheelbase;
        }
    }

    fn command(steer: f32, step: f32) -> Command {
        Command { steer: SteerAngle::from_radians(steer), step: StepLength::from_metres(step) }
    }

    #[test]
    fn one_step_errs_by_less_than_the_stated_drift_in_every_direction() {
        let mut worst = 0.0_f64;
        for heading in -314..=314 {
            for steer in -157..=157 {
                let (heading, steer) = (heading as f32 / 100.0, steer as f32 / 100.0);
                let mut believed = Odometry { heading, ..Odometry::default() };
                let mut exact = Exact { heading: heading.into(), ..Exact::default() };
                believed.follow(command(steer, 1.0), 1.0);
                exact.follow(command(steer, 1.0), 1.0);
                let turned = libm::remainder(
                    f64::from(believed.heading) - exact.heading,
                    libm::acos(-1.0) * 2.0,
                );
                let moved =
                    libm::hypot(f64::from(believed.x) - exact.x, f64::from(believed.y) - exact.y);
                worst = worst.max(turned.abs()).max(moved);
            }
        }
        assert!(worst < f64::from(DRIFT), "{worst}");
        assert!(worst > f64::from(DRIFT) / 4.0, "a bound that loose says little: {worst}");
    }

    #[test]
    fn the_heading_stays_within_half_a_turn_over_many_rounds() {
        let mut believed = Odometry::default();
        for _ in 0..10_000 {
            believed.follow(command(-0.5, 0.05), 0.3);
            assert!(believed.heading.abs() <= PI, "{believed:?}");
        }
        assert!((believed.distance - 500.0).abs() < 0.1);
    }

    #[test]
    fn a_car_that_stands_stays_where_it_believes_to_be() {
        let before = Odometry { x: 1.0, y: -2.0, heading: 3.0, distance: 4.0 };
        let mut believed = before;
        believed.follow(Command::STOP, 0.3);
        assert_eq!(believed, before);
    }

    #[test]
    fn a_person_reads_metres_and_degrees() {
        let believed = Odometry { x: 1.0, y: -0.25, heading: -FRAC_PI_2, distance: 12.345 };
        assert_eq!(believed.to_string(), "12.35 m driven, believed at (1, -0.25) m, heading -90°");
    }
}

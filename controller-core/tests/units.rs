//! Every value of these types is safe to send to an actuator.

use controller_core::units::{SteerAngle, StepLength};
use proptest::prelude::*;
use std::f32::consts::FRAC_PI_2;

proptest! {
    #[test]
    fn any_bits_make_a_safe_steer_angle(output: u32, limit: u32) {
        let (output, limit) = (f32::from_bits(output), f32::from_bits(limit));
        for angle in [SteerAngle::from_unit(output, limit), SteerAngle::from_radians(output)] {
            prop_assert!(angle.radians().abs() <= FRAC_PI_2);
        }
    }

    #[test]
    fn any_bits_make_a_safe_step(output: u32, lower: u32, upper: u32) {
        let [output, lower, upper] = [output, lower, upper].map(f32::from_bits);
        for step in [StepLength::from_unit(output, lower, upper), StepLength::from_metres(output)] {
            prop_assert!(step.metres().is_finite() && step.metres() >= 0.0);
        }
    }

    #[test]
    fn a_step_lies_between_its_limits(output in -1.5f32..1.5, lower in 0.0f32..2.0, more in 0.0f32..2.0) {
        let upper = lower + more;
        let step = StepLength::from_unit(output, lower, upper).metres();
        prop_assert!((lower..=upper).contains(&step), "{step} outside {lower}..={upper}");
    }
}

#[test]
fn what_is_no_number_stands_still_and_straight() {
    assert_eq!(SteerAngle::from_unit(0.5, f32::NAN), SteerAngle::STRAIGHT);
    assert_eq!(SteerAngle::from_unit(0.0, f32::INFINITY), SteerAngle::STRAIGHT);
    assert_eq!(SteerAngle::from_unit(1.0, f32::INFINITY).radians(), FRAC_PI_2);
    assert_eq!(SteerAngle::from_radians(f32::NEG_INFINITY).radians(), -FRAC_PI_2);
    assert_eq!(StepLength::from_metres(-0.1), StepLength::STOP);
    assert_eq!(StepLength::from_metres(f32::INFINITY), StepLength::STOP);
    assert_eq!(StepLength::from_unit(f32::NAN, 0.1, 0.2), StepLength::STOP);
}

#[test]
fn the_ends_of_the_output_are_the_ends_of_the_range() {
    assert_eq!(SteerAngle::from_unit(1.0, 0.61), SteerAngle::from_radians(0.61));
    assert_eq!(SteerAngle::from_unit(-3.0, 0.61), SteerAngle::from_radians(-0.61));
    assert_eq!(StepLength::from_unit(-1.0, 0.1, 0.3).metres(), 0.1);
    assert_eq!(StepLength::from_unit(9.0, 0.125, 0.375).metres(), 0.375);
}

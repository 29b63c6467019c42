//! What a calibration may say.

use firmware_example::calibration::{Calibration, CalibrationError};

fn refusal(change: impl FnOnce(&mut Calibration)) -> String {
    let mut calibration = Calibration::UNFITTED;
    change(&mut calibration);
    calibration.check().expect_err("not meant").to_string()
}

#[test]
fn numbers_to_begin_with_are_accepted() {
    assert_eq!(Calibration::UNFITTED.check().map(|car| *car.get()), Ok(Calibration::UNFITTED));
}

#[test]
fn every_number_that_cannot_be_meant_is_named() {
    let refusals = [
        refusal(|car| car.servo.left = 2600),
        refusal(|car| car.servo.trim = 700),
        refusal(|car| car.servo.trim = -700),
        refusal(|car| car.servo.frame = 1900),
        refusal(|car| car.servo.centre = 1900),
        refusal(|car| car.servo.steer_limit = 1.6),
        refusal(|car| car.servo.steer_limit = f32::NAN),
        refusal(|car| car.motor.start = 1500),
        refusal(|car| car.motor.stop = 0),
        refusal(|car| car.motor.full_speed = f32::INFINITY),
        refusal(|car| car.motor.speed_limit = 6.5),
        refusal(|car| car.beams[2].angle = 2.0),
        refusal(|car| car.range = 0.0),
        refusal(|car| car.wheelbase = -0.3),
    ];
    let expected = [
        "servo left is 2600 µs, 500 to 2500 µs expected",
        "servo left is 2600 µs, 500 to 2500 µs expected",
        "servo right is 400 µs, 500 to 2500 µs expected",
        "servo frame is 1900 µs, 2500 to 20000 µs expected",
        "servo right, centre and left are 1100, 1900 and 1900 µs, rising or falling pulses expected",
        "servo steer limit is 1.6, outside its range",
        "servo steer limit is NaN, outside its range",
        "motor stop, start and full are 1500, 1500 and 2000 µs, rising or falling pulses expected",
        "motor stop is 0 µs, 500 to 2500 µs expected",
        "motor full speed is inf, outside its range",
        "motor speed limit is 6.5, outside its range",
        "beam angle is 2, outside its range",
        "range is 0, outside its range",
        "wheelbase is -0.3, outside its range",
    ];
    assert_eq!(refusals, expected);
}

#[test]
fn a_pulse_is_refused_with_the_value_that_would_have_been_sent() {
    let mut car = Calibration::UNFITTED;
    car.servo.trim = 650;
    let error = car.check().expect_err("1900 + 650 is too long");
    let CalibrationError::Time { field, found, .. } = error else { panic!("{error}") };
    assert_eq!((field, found), ("servo left", 2550));
}

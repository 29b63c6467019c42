//! Servo and motor: exact duties.

use controller_core::units::SteerAngle;
use embedded_hal_mock::eh1::MockError;
use embedded_hal_mock::eh1::pwm::{Mock, Transaction};
use firmware_example::calibration::{Calibration, Checked, MotorCalibration, ServoCalibration};
use firmware_example::drivers::motor::Motor;
use firmware_example::drivers::pulse::PwmRefused;
use firmware_example::drivers::servo::Servo;

/// A channel with this resolution that is to be set to these duties.
fn channel(max: u16, duties: &[u16]) -> Mock {
    let expected: Vec<Transaction> = duties
        .iter()
        .flat_map(|duty| [Transaction::max_duty_cycle(max), Transaction::set_duty_cycle(*duty)])
        .collect();
    Mock::new(&expected)
}

fn servo(calibration: ServoCalibration) -> Checked {
    Calibration { servo: calibration, ..Calibration::UNFITTED }.check().expect("good")
}

fn steer_all(calibration: ServoCalibration, max: u16, angles: &[f32], duties: &[u16]) {
    let mut pwm = channel(max, duties);
    let mut servo = Servo::new(pwm.clone(), &servo(calibration));
    for angle in angles {
        servo.steer(SteerAngle::from_radians(*angle)).expect("the mock obeys");
    }
    pwm.done();
}

#[test]
fn a_steer_angle_becomes_a_pulse_on_a_straight_line_with_its_ends_at_the_limit() {
    // Duty counts microseconds here.
    let angles = [0.0, 0.5, -0.5, 0.25, -0.125, 0.0, -0.0];
    let pulses = [1500, 1900, 1100, 1700, 1400, 1500, 1500];
    steer_all(Calibration::UNFITTED.servo, 20_000, &angles, &pulses);
}

#[test]
fn angles_beyond_the_limit_stay_at_the_outer_pulse() {
    let angles = [0.6, 3.0, -0.6, -3.0, f32::INFINITY, f32::NAN];
    let pulses = [1900, 1900, 1100, 1100, 1900, 1500];
    steer_all(Calibration::UNFITTED.servo, 20_000, &angles, &pulses);
}

#[test]
fn a_lopsided_reversed_servo_keeps_its_own_ends_and_trim_shifts_them_all() {
    let reversed = ServoCalibration {
        left: 1080,
        right: 1910,
        centre: 1495,
        trim: -20,
        ..Calibration::UNFITTED.servo
    };
    let angles = [0.0, 0.5, -0.5, 0.25];
    // 1495 − 20; 1080 − 20; 1910 − 20; 1495 − 415/2 − 20 = 1267.5, away from the centre.
    steer_all(reversed, 20_000, &angles, &[1475, 1060, 1890, 1267]);
}

#[test]
fn duties_are_rounded_to_the_nearest_step_of_the_channel() {
    // 1500, 1900 and 1100 µs of 20 ms at 65535: 4915.1, 6225.8, 3604.4.
    steer_all(Calibration::UNFITTED.servo, 65_535, &[0.0, 0.5, -0.5], &[4915, 6226, 3604]);
    // An 8-bit channel: 19.1, 24.2, 14.0.
    steer_all(Calibration::UNFITTED.servo, 255, &[0.0, 0.5, -0.5], &[19, 24, 14]);
}

fn drive_all(calibration: MotorCalibration, speeds: &[f32], pulses: &[u16]) {
    let car = Calibration { motor: calibration, ..Calibration::UNFITTED }.check().expect("good");
    let mut pwm = channel(20_000, pulses);
    let mut motor = Motor::new(pwm.clone(), &car);
    for speed in speeds {
        motor.drive(*speed).expect("the mock obeys");
    }
    motor.stop().expect("the mock obeys");
    pwm.done();
}

#[test]
fn speed_becomes_a_pulse_from_the_one_that_starts_the_car_to_the_speed_limit() {
    // From 1550 µs at 0 to 2000 µs at 6 m/s, cut at 1 m/s: 1550 + 450/6.
    let speeds = [0.0, -1.0, f32::NAN, 1e-6, 0.5, 1.0, 2.0, f32::INFINITY];
    let pulses = [1500, 1500, 1500, 1550, 1588, 1625, 1625, 1625, 1500];
    drive_all(Calibration::UNFITTED.motor, &speeds, &pulses);
}

#[test]
fn a_speed_controller_wired_the_other_way_round_gets_falling_pulses() {
    let falling = MotorCalibration {
        start: 1450,
        full: 1000,
        full_speed: 3.0,
        speed_limit: 3.0,
        ..Calibration::UNFITTED.motor
    };
    drive_all(falling, &[1.0, 3.0, 9.0], &[1300, 1000, 1000, 1500]);
}

#[test]
fn a_channel_that_refuses_is_reported() {
    let error = MockError::Io(std::io::ErrorKind::NotConnected);
    let expected =
        [Transaction::max_duty_cycle(20_000), Transaction::set_duty_cycle(1500).with_error(error)];
    let mut pwm = Mock::new(&expected);
    let mut servo = Servo::new(pwm.clone(), &servo(Calibration::UNFITTED.servo));
    assert_eq!(servo.steer(SteerAngle::STRAIGHT), Err(PwmRefused));
    pwm.done();
}

//! The car's motion against circles, a rear axle, and double precision.

use controller_core::lane::Lanes;
use controller_core::motion::Pose;
use controller_core::trig::{sin_cos, wrap};
use proptest::prelude::*;
use std::f32::consts::{FRAC_PI_2, PI};

/// Largest error of sine and cosine over `steps` angles within ±`limit`.
fn worst_sin_cos(limit: f64, steps: i64) -> f64 {
    (-steps..=steps)
        .map(|i| {
            let angle = (limit * i as f64 / steps as f64) as f32;
            let (sin, cos) = sin_cos(angle);
            let (exact_sin, exact_cos) = libm::sincos(f64::from(angle));
            (f64::from(sin) - exact_sin).abs().max((f64::from(cos) - exact_cos).abs())
        })
        .fold(0.0, f64::max)
}

#[test]
fn sine_and_cosine_keep_their_documented_error() {
    let few_turns = worst_sin_cos(4.0 * std::f64::consts::TAU, 1_500_000);
    let all = worst_sin_cos(100.0, 1_500_000);
    println!("worst error {few_turns:e} within four turns, {all:e} within 100 rad");
    assert!(few_turns <= 7.7e-8 && all <= 7.7e-8);
}

#[test]
fn quarter_turns_are_where_they_belong() {
    for (angle, sin, cos) in
        [(0.0, 0.0, 1.0), (FRAC_PI_2, 1.0, 0.0), (PI, 0.0, -1.0), (-FRAC_PI_2, -1.0, 0.0)]
    {
        let found = sin_cos(angle);
        assert!((found.0 - sin).abs() < 1e-7 && (found.1 - cos).abs() < 1e-7, "{angle}: {found:?}");
    }
    assert_eq!(sin_cos(0.0f32), (0.0, 1.0));
}

#[test]
fn wrapping_keeps_the_angle_and_brings_it_home() {
    for i in -30_000..=30_000i32 {
        let angle = i as f32 * (3.0 * PI / 30_000.0);
        let home = wrap(angle);
        assert!(home.abs() <= PI * (1.0 + 1e-6), "{angle} became {home}");
        let turns = (f64::from(angle) - f64::from(home)) / std::f64::consts::TAU;
        assert!((turns - turns.round()).abs() < 1e-6, "{angle} became {home}");
    }
    assert_eq!(wrap(PI), PI);
    assert_eq!(wrap(-PI), -PI);
}

proptest! {
    #[test]
    fn angles_in_lanes_are_angles_alone(angles in prop::array::uniform4(-100.0f32..100.0)) {
        let (sin, cos) = sin_cos(Lanes(angles));
        let home = wrap(Lanes(angles));
        for (lane, angle) in angles.into_iter().enumerate() {
            let (s, c) = sin_cos(angle);
            prop_assert_eq!(sin.0[lane].to_bits(), s.to_bits());
            prop_assert_eq!(cos.0[lane].to_bits(), c.to_bits());
            prop_assert_eq!(home.0[lane].to_bits(), wrap(angle).to_bits());
        }
    }

    #[test]
    fn cars_in_lanes_drive_as_they_would_alone(
        starts in prop::array::uniform4((-5.0f32..5.0, -5.0f32..5.0, -4.0f32..4.0)),
        steers in prop::collection::vec(prop::array::uniform4(-1.5f32..1.5), 1..20),
    ) {
        let lanes = |of: fn((f32, f32, f32)) -> f32| Lanes(starts.map(of));
        let mut wide = Pose::new(lanes(|s| s.0), lanes(|s| s.1), lanes(|s| s.2));
        let mut alone = starts.map(|(x, y, heading)| Pose::new(x, y, heading));
        for steer in steers {
            wide = wide.driven(Lanes(steer), Lanes::from(0.1), Lanes::from(0.3));
            for (lane, pose) in alone.iter_mut().enumerate() {
                *pose = pose.driven(steer[lane], 0.1, 0.3);
                for (wide, alone) in [
                    (wide.x, pose.x),
                    (wide.y, pose.y),
                    (wide.heading, pose.heading),
                    (wide.cos, pose.cos),
                    (wide.sin, pose.sin),
                ] {
                    prop_assert_eq!(wide.0[lane].to_bits(), alone.to_bits());
                }
            }
        }
    }

    #[test]
    fn the_bodys_frame_and_the_worlds_are_inverse(
        x in -9.0f32..9.0, y in -9.0f32..9.0, heading in -3.0f32..3.0,
        forward in -2.0f32..2.0, left in -2.0f32..2.0,
    ) {
        let pose = Pose::new(x, y, heading);
        let (wx, wy) = pose.to_world(forward, left);
        let (f, l) = pose.to_body(wx, wy);
        prop_assert!((f - forward).abs() < 1e-5 && (l - left).abs() < 1e-5);
    }
}

#[test]
fn straight_wheels_drive_a_straight_line() {
    let mut pose = Pose::new(1.0f32, 2.0, 0.0);
    for _ in 0..100 {
        pose = pose.driven(0.0, 0.125, 0.3);
    }
    assert_eq!((pose.x, pose.y, pose.heading), (13.5, 2.0, 0.0));
}

#[test]
fn constant_steer_drives_the_front_axle_round_a_circle_of_the_bicycles_radius() {
    // The front axle's circle has radius wheelbase / sin(steer); each step is a chord of it.
    let (steer, wheelbase, steps) = (0.5f64, 0.3, 4_000);
    let radius = wheelbase / libm::sin(steer);
    let step = std::f64::consts::TAU * radius / f64::from(steps);
    let mut pose = Pose::new(0.0f32, 0.0, 0.0);
    // The centre lies across the direction of travel, which is heading + steer.
    let centre = (-radius * libm::sin(steer), radius * libm::cos(steer));
    let mut worst = 0.0f64;
    for _ in 0..steps {
        pose = pose.driven(steer as f32, step as f32, wheelbase as f32);
        let from_centre = libm::hypot(f64::from(pose.x) - centre.0, f64::from(pose.y) - centre.1);
        worst = worst.max((from_centre - radius).abs());
    }
    assert!(worst < 1.5e-3, "the circle is off by {worst}");
    assert!(pose.x.abs() < 2e-3 && pose.y.abs() < 2e-3, "not closed: {pose:?}");
    assert!(pose.heading.abs() < 1e-3, "{pose:?}");
}

#[test]
fn the_rear_axle_never_slips_sideways() {
    // In the limit of small steps the rear axle's middle moves along the heading only.
    let wheelbase = 0.3f32;
    let rear = |pose: &Pose<f32>| pose.to_world(-wheelbase, 0.0);
    let mut pose = Pose::new(0.0f32, 0.0, 1.0);
    for i in 0..2_000 {
        let steer = 1.2 * libm::sinf(i as f32 * 0.01);
        let next = pose.driven(steer, 0.002, wheelbase);
        let ((x0, y0), (x1, y1)) = (rear(&pose), rear(&next));
        let sideways = -pose.sin * (x1 - x0) + pose.cos * (y1 - y0);
        assert!(sideways.abs() < 1e-5, "step {i}: {sideways} m sideways");
        pose = next;
    }
}

#[test]
fn a_long_drive_stays_with_double_precision() {
    let mut pose = Pose::new(0.0f32, 0.0, 0.3);
    let (mut x, mut y, mut heading) = (0.0f64, 0.0f64, f64::from(0.3f32));
    for i in 0..2_000u32 {
        let steer = ((i * 37 % 101) as f32 - 50.0) / 64.0;
        pose = pose.driven(steer, 0.1, 0.3);
        let direction = heading + f64::from(steer);
        x += f64::from(0.1f32) * libm::cos(direction);
        y += f64::from(0.1f32) * libm::sin(direction);
        heading += f64::from(0.1f32) / f64::from(0.3f32) * libm::sin(f64::from(steer));
    }
    let apart = libm::hypot(f64::from(pose.x) - x, f64::from(pose.y) - y);
    assert!(apart < 1e-2, "{apart} m apart after 200 m");
}

#[test]
fn a_held_car_turns_where_it_stands() {
    let here = Pose::new(1.0f32, 2.0, 0.5);
    let there = here.driven(0.4, 0.1, 0.3);
    let held = there.held_at(&here);
    assert_eq!((held.x, held.y), (1.0, 2.0));
    assert_eq!((held.heading, held.cos, held.sin), (there.heading, there.cos, there.sin));
}

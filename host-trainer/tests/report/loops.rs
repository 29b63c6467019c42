//! Which drives count as periodic loops.

use std::f32::consts::{FRAC_PI_2, PI};

use host_trainer::report::data::{Drive, Moment};
use host_trainer::report::loops::{period, period_of};

use crate::fixture;

/// A drive in free space, far from every wall, from a list of poses.
fn poses(poses: impl IntoIterator<Item = [f32; 3]>) -> Vec<Moment> {
    let mut moment = fixture::clean().moments[0];
    let place = |[x, y, heading]: [f32; 3]| {
        (moment.x, moment.y, moment.heading) = (x, y, heading);
        moment
    };
    poses.into_iter().map(place).collect()
}

/// Moves along a circle, one every `turn` radians.
fn circle(radius: f32, turn: f32, moves: usize) -> Vec<Moment> {
    poses((0..=moves).map(|k| {
        let angle = k as f32 * turn;
        [radius * libm::sinf(angle), -radius * libm::cosf(angle), angle]
    }))
}

#[test]
fn a_circle_has_the_period_of_one_lap_even_if_a_lap_is_no_whole_number_of_moves() {
    for lap in [19.0_f32, 31.5, 62.83, 63.4, 99.9] {
        let turn = 2.0 * PI / lap;
        let found = period_of(&circle(0.1 / turn, turn, 300)).expect("a circle is a loop");
        assert!((found as f32 - lap).abs() <= 0.5, "a lap of {lap} moves was read as {found}");
    }
}

#[test]
fn two_laps_are_a_loop_and_one_and_a_half_are_not() {
    let turn = 2.0 * PI / 60.0;
    assert_eq!(period_of(&circle(1.0, turn, 120)), Some(60));
    assert_eq!(period_of(&circle(1.0, turn, 119)), None);
    assert_eq!(period_of(&circle(1.0, turn, 90)), None);
}

#[test]
fn the_crossing_of_a_figure_eight_is_not_taken_for_its_period() {
    // Two circles that touch, one driven to the left, the other to the right.
    let eight = poses((0..=400).map(|k| {
        let turn = 2.0 * PI / 50.0;
        let (left, angle) = ((k / 50) % 2 == 0, (k % 50) as f32 * turn);
        let side = if left { 1.0 } else { -1.0 };
        [libm::sinf(angle), side * (1.0 - libm::cosf(angle)), side * angle]
    }));
    assert_eq!(period_of(&eight), Some(100));
}

#[test]
fn a_straight_drive_is_no_loop_however_slow() {
    for step in [0.1, 0.03, 0.004] {
        let straight = poses((0..=300).map(|k| [k as f32 * step, 0.0, 0.0]));
        assert_eq!(period_of(&straight), None, "{step} m per move");
    }
}

#[test]
fn a_spiral_and_a_drifting_circle_are_no_loops() {
    let turn = 2.0 * PI / 40.0;
    let spiral = poses((0..=400).map(|k| {
        let (angle, radius) = (k as f32 * turn, 1.0 + k as f32 * 0.005);
        [radius * libm::sinf(angle), -radius * libm::cosf(angle), angle]
    }));
    assert_eq!(period_of(&spiral), None);
    let drifting = poses((0..=400).map(|k| {
        let angle = k as f32 * turn;
        [libm::sinf(angle) + k as f32 * 0.005, -libm::cosf(angle), angle]
    }));
    assert_eq!(period_of(&drifting), None);
}

#[test]
fn passing_the_same_place_in_the_other_direction_is_no_repetition() {
    let there_and_back = poses((0..=100).map(|k| {
        let half = k % 50;
        let x = if half < 25 { half } else { 50 - half } as f32 * 0.1;
        [x, 0.0, if half < 25 { 0.0 } else { PI }]
    }));
    assert_eq!(period_of(&there_and_back), Some(50));
}

#[test]
fn a_car_held_by_a_wall_is_stuck_and_one_that_turns_on_the_spot_is_not() {
    let held = poses((0..=60).map(|k| [(k as f32 * 0.1).min(2.0), 0.0, 0.0]));
    assert_eq!(period_of(&held), Some(1));
    // Held, while the heading follows the steering: a lap in place.
    let turning = poses((0..=200).map(|k| [2.0, 0.0, k as f32 * PI / 30.0]));
    assert_eq!(period_of(&turning), Some(60));
}

#[test]
fn headings_that_grow_past_a_full_turn_are_compared_as_directions() {
    let wound_up = poses((0..=300).map(|k| {
        let angle = k as f32 * FRAC_PI_2 / 10.0;
        [libm::sinf(angle), -libm::cosf(angle), angle + 1000.0 * PI]
    }));
    assert_eq!(period_of(&wound_up), Some(40));
}

#[test]
fn the_approach_before_the_loop_does_not_matter() {
    let drive = fixture::circling();
    // Wheels at 0.3 rad turn the car by d/L · sin φ per move.
    let lap = 2.0 * PI / (0.1 / 0.3 * libm::sinf(0.3));
    assert_eq!(drive.loop_period, Some(lap.round() as usize));
}

#[test]
fn a_drive_that_reached_its_target_or_has_hardly_begun_is_no_loop() {
    let circling = circle(1.0, 2.0 * PI / 20.0, 100);
    let mut drive = Drive { moments: circling, ..fixture::wandering() };
    assert_eq!(period(&drive), Some(20));
    drive.outcome.reached = true;
    assert_eq!(period(&drive), None);
    for length in 0..=24 {
        assert_eq!(period_of(&poses(vec![[0.0; 3]; length])), None);
    }
}

#[test]
fn a_pose_that_is_not_a_number_never_repeats() {
    assert_eq!(period_of(&poses(vec![[f32::NAN, 0.0, 0.0]; 100])), None);
    assert_eq!(period_of(&poses(vec![[0.0, 0.0, f32::NAN]; 100])), None);
}

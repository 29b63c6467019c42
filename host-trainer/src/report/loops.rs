//! Did the car end up going round and round?
//!
//! The paper's typical failure (Fig. 8) is a robot that "starts to move in periodic loops".
//! The end of a drive is a loop of period `p` when every pose of its last stretch is where
//! the car was `p` moves earlier. A drive that stands still against a wall has period 1.

use std::f32::consts::PI;

use super::data::{Drive, Moment};

/// Moves the repetition must be seen for, so that a slow car is not taken for a standing one.
const SHORTEST_EVIDENCE: usize = 24;
/// How far a repeated position may lie from the original, metres.
const POSITION_SLACK: f32 = 0.01;
/// The same for the heading: two degrees.
const HEADING_SLACK: f32 = 2.0 * PI / 180.0;
/// Share of a move that may be left over besides, along the path: a lap is seldom a whole
/// number of moves.
const LEFT_OVER: f32 = 0.55;

/// The shortest period in moves of the loop a drive ended in; `None` if it reached the
/// target, ended before a loop could be told, or does not repeat.
///
/// At least the last two laps must agree, and at least the last 24 moves. Positions may
/// differ by 1 cm across the path, and by half a move more along it; headings by 2° and half
/// a move's turn.
pub fn period(drive: &Drive) -> Option<usize> {
    if drive.outcome.reached { None } else { period_of(&drive.moments) }
}

/// [`period`] for bare poses, whatever the outcome.
pub fn period_of(moments: &[Moment]) -> Option<usize> {
    let moves = moments.len().checked_sub(1)?;
    if moves < SHORTEST_EVIDENCE {
        return None;
    }
    let first = (1..=moves / 2).find(|&p| misfit(moments, p).is_some())?;
    // The neighbour may fit the lap better: 62.6 moves pass as 62 but are nearer to 63.
    let fit = |p: usize| if p <= moves / 2 { misfit(moments, p) } else { None };
    match (fit(first), fit(first + 1)) {
        (Some(here), Some(next)) if next < here => Some(first + 1),
        _ => Some(first),
    }
}

/// The largest mismatch of the last stretch with itself `period` moves earlier, as a share
/// of what is allowed; `None` if more than that.
fn misfit(moments: &[Moment], period: usize) -> Option<f32> {
    let stretch = (2 * period).max(SHORTEST_EVIDENCE);
    let window = &moments[moments.len() - stretch..];
    let mut longest_move = 0.0_f32;
    let mut largest_turn = 0.0_f32;
    for pair in window.windows(2) {
        longest_move = longest_move.max(distance(&pair[0], &pair[1]));
        largest_turn = largest_turn.max(turn(&pair[0], &pair[1]));
    }
    let along_slack = POSITION_SLACK + LEFT_OVER * longest_move;
    // Half a move along a curve leaves its tangent by this much at most.
    let across_slack = POSITION_SLACK + LEFT_OVER * longest_move * largest_turn.min(1.0);
    let heading_slack = HEADING_SLACK + LEFT_OVER * largest_turn;
    // Everything is compared with the last lap, not with the lap before it: a slow drift
    // must not pass one lap at a time.
    let last = window.len() - 1;
    let mut worst = 0.0_f32;
    for (index, moment) in window[..=last - period].iter().enumerate() {
        let original = index + (last - index) / period * period;
        let (along, across) = offset(moment, &window[original], &window[original - 1]);
        let shares = [
            along / along_slack,
            across / across_slack,
            turn(moment, &window[original]) / heading_slack,
        ];
        // Asked this way round, a pose that is not a number never counts as a repetition.
        if !shares.iter().all(|share| *share < 1.0) {
            return None;
        }
        worst = shares.into_iter().fold(worst, f32::max);
    }
    Some(worst)
}

/// How far `a` lies from `b` along the move that led to `b`, and across it. Where that
/// move went nowhere, all of the distance counts as across.
fn offset(a: &Moment, b: &Moment, before: &Moment) -> (f32, f32) {
    let moved = distance(b, before);
    let away = distance(a, b);
    if moved == 0.0 {
        return (0.0, away);
    }
    let (ux, uy) = ((b.x - before.x) / moved, (b.y - before.y) / moved);
    let (dx, dy) = (a.x - b.x, a.y - b.y);
    ((dx * ux + dy * uy).abs(), (dx * uy - dy * ux).abs())
}

fn distance(a: &Moment, b: &Moment) -> f32 {
    let (dx, dy) = (a.x - b.x, a.y - b.y);
    (dx * dx + dy * dy).sqrt()
}

/// Angle between two headings, `0..=π`.
fn turn(a: &Moment, b: &Moment) -> f32 {
    let turn = (a.heading - b.heading).rem_euclid(2.0 * PI);
    turn.min(2.0 * PI - turn)
}

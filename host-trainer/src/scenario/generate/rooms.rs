//! Rooms: a space is divided by a wall with a door, and its halves again.

use super::{Recipe, round};
use crate::scenario::{Scenario, Wall};
use crate::seed::Stream;

/// Thickness of a wall, metres.
const THICKNESS: f32 = 0.1;

/// Width of a door, metres: the car turns through it.
const DOOR: f32 = 1.0;

/// Divides the room.
pub(super) fn build(scenario: &mut Scenario, recipe: &Recipe) {
    let [width, height] = scenario.world.bounds.max;
    // A room of side s owns half of the walls around it: 2 · thickness / s of its area.
    let side = (2.0 * THICKNESS / recipe.density).max(2.0);
    let mut random = recipe.stream(0);
    divide([0.0, 0.0, width, height], side, &mut random, &mut scenario.world.walls);
    let walls = scenario.world.walls.len();
    scenario.description = format!("rooms between {walls} random pieces of wall");
}

/// A wall across the longer side, away from doors in the walls it ends at.
fn divide([x0, y0, x1, y1]: [f32; 4], side: f32, random: &mut Stream, walls: &mut Vec<Wall>) {
    let wide = x1 - x0 >= y1 - y0;
    let (low, high, from, upto) = if wide { (x0, x1, y0, y1) } else { (y0, y1, x0, x1) };
    if high - low < 2.0 * side.max(DOOR + 0.5) || upto - from < DOOR + 0.6 {
        return;
    }
    let point = |across: f32, along: f32| if wide { [across, along] } else { [along, across] };
    let margin = (high - low) * 0.35;
    let across = (0..20)
        .map(|_| round(random.within(low + margin, high - margin)))
        .find(|across| [from, upto].iter().all(|along| !in_door(point(*across, *along), walls)));
    let Some(across) = across else { return };
    let door = round(random.within(from + 0.3, upto - DOOR - 0.3));
    for (start, end) in [(from, door), (round(door + DOOR), upto)] {
        let points = vec![point(across, start), point(across, end)];
        walls.push(Wall { points, thickness: THICKNESS });
    }
    let halves = if wide {
        [[x0, y0, across, y1], [across, y0, x1, y1]]
    } else {
        [[x0, y0, x1, across], [x0, across, x1, y1]]
    };
    for half in halves {
        divide(half, side, random, walls);
    }
}

/// Whether a wall that ends here would stand in a door, or narrow one.
fn in_door([x, y]: [f32; 2], walls: &[Wall]) -> bool {
    // The two pieces of a wall lie in pairs; the door is between them.
    walls.chunks(2).any(|pieces| {
        let [Wall { points: before, .. }, Wall { points: after, .. }] = pieces else {
            return false;
        };
        let (Some([ax, ay]), Some([bx, by])) = (before.last(), after.first()) else { return false };
        let near = |value: f32, a: f32, b: f32| (a.min(b) - 0.3..=a.max(b) + 0.3).contains(&value);
        near(x, *ax, *bx) && near(y, *ay, *by)
    })
}

//! Single obstacles at random places.

use super::free_space::FreeSpace;
use super::{Recipe, round};
use crate::scenario::{Circle, Scenario};
use crate::seed::Stream;

/// Draws in a row that may fail to fit before the world counts as full.
const TRIES: u32 = 60;

/// Scatters boxes.
pub(super) fn boxes(scenario: &mut Scenario, recipe: &Recipe) {
    let [width, height] = scenario.world.bounds.max;
    let largest = 2_f32.min(width.min(height) / 4.0);
    rectangles(scenario, recipe, |random| {
        let [w, h] = [(); 2].map(|()| round(random.within(0.5, largest)).max(0.5));
        let at = |size: f32, random: &mut Stream| round(random.within(0.0, size));
        let [x, y] = [at(width - w, random), at(height - h, random)];
        [x, y, w, h]
    });
    scenario.description = format!("{} random boxes", scenario.world.boxes.len());
}

/// Thinnest and thickest partition, metres.
const THICKNESS: [f32; 2] = [0.1, 0.6];

/// Shortest and longest partition, metres.
const LENGTH: [f32; 2] = [1.0, 4.0];

/// Longest partition, as a share of the room's shorter side, so that a small one keeps a way.
const LONGEST_SHARE: f32 = 0.4;

/// Share of partitions that begin at a wall of the room.
const AT_WALL: f32 = 0.4;

/// Scatters thin walls along either side of the room.
pub(super) fn partitions(scenario: &mut Scenario, recipe: &Recipe) {
    let size = scenario.world.bounds.max;
    let longest = LENGTH[1].min(LONGEST_SHARE * size[0].min(size[1]));
    rectangles(scenario, recipe, |random| {
        let along = random.index(2);
        let sides = [random.within(LENGTH[0], longest), random.within(THICKNESS[0], THICKNESS[1])];
        let [w, h] = [sides[along], sides[1 - along]].map(round);
        let free = [size[0] - w, size[1] - h];
        let mut at = free.map(|free| random.within(0.0, free));
        if random.chance(AT_WALL) {
            at[along] = [0.0, free[along]][random.index(2)];
        }
        let [x, y] = at.map(round);
        [x, y, w, h]
    });
    scenario.description = format!("{} random partitions", scenario.world.boxes.len());
}

/// Places upright rectangles, drawn as a corner and two sides, until the density is reached or no more
/// fit.
fn rectangles(
    scenario: &mut Scenario,
    recipe: &Recipe,
    mut draw: impl FnMut(&mut Stream) -> [f32; 4],
) {
    let [width, height] = scenario.world.bounds.max;
    let mut random = recipe.stream(0);
    let mut space = FreeSpace::new([width, height], &scenario.vehicle);
    let mut left = recipe.density * width * height;
    let mut misses = 0;
    while misses < TRIES && left > 0.0 {
        let [x0, y0, w, h] = draw(&mut random);
        let [x1, y1] = [round(x0 + w), round(y0 + h)];
        let outside = |low: f32, value: f32, high: f32| (low - value).max(value - high).max(0.0);
        let distance = |[x, y]: [f32; 2]| libm::hypotf(outside(x0, x, x1), outside(y0, y, y1));
        // The last one may be too large by as much as it would be missing.
        if w * h < 2.0 * left && space.place([x0, y0, x1, y1], distance) {
            scenario.world.boxes.push([x0, y0, x1, y1]);
            left -= w * h;
            misses = 0;
        } else {
            misses += 1;
        }
    }
}

/// Scatters pillars.
pub(super) fn pillars(scenario: &mut Scenario, recipe: &Recipe) {
    let [width, height] = scenario.world.bounds.max;
    let mut random = recipe.stream(0);
    let mut space = FreeSpace::new([width, height], &scenario.vehicle);
    let mut left = recipe.density * width * height;
    let mut misses = 0;
    while misses < TRIES && left > 0.0 {
        let radius = round(random.within(0.1, 0.5));
        let [x, y] = [round(random.within(0.0, width)), round(random.within(0.0, height))];
        let distance = |[px, py]: [f32; 2]| libm::hypotf(px - x, py - y) - radius;
        let area = std::f32::consts::PI * radius * radius;
        let apart = scenario.world.circles.iter().all(|other| {
            libm::hypotf(other.centre[0] - x, other.centre[1] - y) >= other.radius + radius
        });
        let inside =
            (radius..=width - radius).contains(&x) && (radius..=height - radius).contains(&y);
        let extent = [x - radius, y - radius, x + radius, y + radius];
        if apart && inside && area < 2.0 * left && space.place(extent, distance) {
            scenario.world.circles.push(Circle { centre: [x, y], radius });
            left -= area;
            misses = 0;
        } else {
            misses += 1;
        }
    }
    scenario.description = format!("{} random pillars", scenario.world.circles.len());
}

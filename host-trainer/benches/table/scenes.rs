//! Rooms of every size to look about in.
//!
//! Two families, each with the same density of walls at every size, so that a room with more
//! walls is larger: boxes, as a person draws them, and the same boxes as a robot's map has them,
//! outlines of cells of 5 cm with ragged edges.

use host_trainer::map::{self, OccupancyMap};
use host_trainer::scenario::{Bounds, Preset};
use host_trainer::world::World;
use std::path::PathBuf;

/// Side of a room, metres. A larger floor is rooms side by side without walls between them.
const ROOM: f32 = 10.0;

/// Eight boxes in a room: middle, half sizes, and the turn in degrees.
const BOXES: [[f32; 5]; 8] = [
    [2.0, 2.0, 0.5, 0.4, 0.0],
    [3.3, 4.6, 0.45, 0.45, 45.0],
    [5.0, 1.6, 0.35, 0.7, 20.0],
    [8.0, 2.4, 0.6, 0.35, -35.0],
    [6.6, 4.8, 0.4, 0.8, 0.0],
    [1.8, 7.4, 0.7, 0.3, 15.0],
    [4.9, 7.7, 0.4, 0.4, 0.0],
    [8.1, 7.6, 0.35, 0.65, -15.0],
];

/// Cells of the map along a room.
const CELLS: u32 = 200;

/// A floor to drive on.
pub(crate) struct Scene {
    /// The family it belongs to.
    pub(crate) family: &'static str,
    /// Its walls, built.
    pub(crate) world: World,
    boxes: &'static [[f32; 5]],
}

impl Scene {
    /// Whether a point is clear of all boxes.
    pub(crate) fn is_free(&self, [x, y]: [f32; 2]) -> bool {
        let point = [x % ROOM, y % ROOM];
        self.boxes.iter().all(|one| beyond(one, point) > 0.05)
    }

    fn new(
        family: &'static str,
        side: f32,
        boxes: &'static [[f32; 5]],
        solids: Vec<Vec<[f32; 2]>>,
    ) -> Self {
        let mut scenario = Preset::Paper.scenario();
        scenario.world.bounds = Bounds { min: [0.0, 0.0], max: [side, side] };
        scenario.world.outer_wall = true;
        scenario.world.polygons = solids;
        Self { family, world: World::new(&scenario).expect("no map is read"), boxes }
    }
}

/// Every floor with at most `max` walls, smallest first.
pub(crate) fn all(max: usize) -> impl Iterator<Item = Scene> {
    const BOXED: [usize; 6] = [36, 132, 1_156, 10_000, 100_000, 1_000_000];
    const MAPPED: [usize; 4] = [1_000, 10_000, 100_000, 1_000_000];
    let small = [(4, 3.3, 0), (12, 5.8, 2)].into_iter().map(|(_, side, boxes)| {
        let boxes = &BOXES[..boxes];
        Scene::new("boxes", side, boxes, boxes.iter().map(|one| corners(one).into()).collect())
    });
    let boxed = BOXED.into_iter().filter(move |walls| *walls <= max).map(|walls| {
        let outlines: Vec<_> = BOXES.iter().map(|one| corners(one).into()).collect();
        floor("boxes", &outlines, walls)
    });
    let mapped = MAPPED.into_iter().filter(move |walls| *walls <= max);
    small.chain(boxed).chain(mapped.map(|walls| floor("map cells", &ragged(), walls)))
}

/// Rooms in a square, about as many as these walls are.
fn floor(family: &'static str, outlines: &[Vec<[f32; 2]>], walls: usize) -> Scene {
    let per_room: usize = outlines.iter().map(Vec::len).sum();
    let rooms = ((walls.saturating_sub(4) as f32 / per_room as f32).sqrt().round() as usize).max(1);
    let mut solids = Vec::with_capacity(rooms * rooms * outlines.len());
    for room in 0..rooms * rooms {
        let (dx, dy) = (ROOM * (room % rooms) as f32, ROOM * (room / rooms) as f32);
        let moved =
            |outline: &Vec<[f32; 2]>| outline.iter().map(|[x, y]| [x + dx, y + dy]).collect();
        solids.extend(outlines.iter().map(moved));
    }
    Scene::new(family, ROOM * rooms as f32, &BOXES, solids)
}

fn corners(of: &[f32; 5]) -> [[f32; 2]; 4] {
    let [x, y, w, h, degrees] = *of;
    let (sin, cos) = libm::sincosf(degrees.to_radians());
    [[-w, -h], [w, -h], [w, h], [-w, h]]
        .map(|[dx, dy]| [x + cos * dx - sin * dy, y + sin * dx + cos * dy])
}

/// How far a point lies beyond a box's nearest side, metres; negative inside.
fn beyond([x, y, w, h, degrees]: &[f32; 5], point: [f32; 2]) -> f32 {
    let (sin, cos) = libm::sincosf(degrees.to_radians());
    let (dx, dy) = (point[0] - x, point[1] - y);
    ((cos * dx + sin * dy).abs() - w).max((cos * dy - sin * dx).abs() - h)
}

/// The boxes of a room as loops around the cells of a map.
fn ragged() -> Vec<Vec<[f32; 2]>> {
    let resolution = f64::from(ROOM) / f64::from(CELLS);
    let cell = |index: u32| {
        let at = |index: u32| (f64::from(index) + 0.5) * resolution;
        let point = [at(index % CELLS) as f32, at(index / CELLS) as f32];
        // Knuth's multiplicative hash: an edge that wavers by a cell, as a laser leaves it.
        let waver = (index.wrapping_mul(2_654_435_761) >> 24) as f32 / 255.0 * 0.05;
        if BOXES.iter().any(|one| beyond(one, point) < waver - 0.025) {
            map::OCCUPIED
        } else {
            map::FREE
        }
    };
    let map = OccupancyMap {
        width: CELLS,
        height: CELLS,
        resolution,
        origin: [0.0; 3],
        cells: (0..CELLS * CELLS).map(cell).collect(),
        image: PathBuf::new(),
        unknown_keys: Vec::new(),
    };
    map::loops(&map::trace(&map, false, 50))
}

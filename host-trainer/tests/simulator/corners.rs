//! Beams aimed exactly at corners: none may slip between the two walls that meet there.

use crate::worlds::{from_toml, random, scenario_file, shipped, world_of};
use controller_core::geometry::{Ray, Segment};
use host_trainer::map;
use host_trainer::scenario::Scenario;
use host_trainer::seed::Stream;
use host_trainer::world::{Obstacles, World, distance};
use std::f32::consts::TAU;

const SHOTS: usize = 20_000;

/// Star-shaped polygons of 3 to 14 corners, in a grid without overlaps; `scale` metres apart.
fn polygons(scale: f32, random: &mut Stream) -> Vec<Vec<[f32; 2]>> {
    let mut polygons = Vec::new();
    for row in 0..5 {
        for column in 0..5 {
            let middle = [(row as f32 + 0.5) * scale, (column as f32 + 0.5) * scale];
            let count = 3 + random.index(12);
            let first = random.within(0.0, TAU);
            let corner = |index: usize| {
                let radius = random.within(0.2, 0.4) * scale;
                let angle = first + TAU * index as f32 / count as f32;
                [middle[0] + radius * libm::cosf(angle), middle[1] + radius * libm::sinf(angle)]
            };
            polygons.push((0..count).map(corner).collect());
        }
    }
    polygons
}

fn walls_of(polygon: &[[f32; 2]]) -> impl Iterator<Item = [[f32; 2]; 2]> {
    let next = polygon.iter().cycle().skip(1);
    polygon.iter().zip(next).map(|(a, b)| [*a, *b])
}

/// A shot at a corner that goes from the free side to the solid side, or back.
struct Shot {
    ray: Ray<f32>,
    distance: f32,
}

/// Shots from random places at random corners that change sides there: those that pass it have
/// gone through a wall.
fn shots(
    corners: &[[f32; 2]],
    place: impl Fn(&mut Stream) -> [f32; 2],
    is_solid: impl Fn([f32; 2]) -> bool,
    beyond: f32,
    random: &mut Stream,
) -> Vec<Shot> {
    let mut shots = Vec::new();
    while shots.len() < SHOTS {
        let origin = place(random);
        let corner = corners[random.index(corners.len())];
        let length = distance(origin, corner);
        let direction = [(corner[0] - origin[0]) / length, (corner[1] - origin[1]) / length];
        let along = |t: f32| [origin[0] + direction[0] * t, origin[1] + direction[1] * t];
        let aside = |t: f32, to: f32| {
            let [x, y] = along(t);
            [x - direction[1] * to, y + direction[0] * to]
        };
        // Clearly on the other side, and not along an edge.
        let (before, after) = (length - beyond, length + beyond);
        let sides = |t: f32| [0.0, -0.2, 0.2].map(|to| is_solid(aside(t, to * beyond)));
        let changes =
            sides(before) == [is_solid(origin); 3] && sides(after) == [!is_solid(origin); 3];
        if length > 4.0 * beyond && changes {
            let ray =
                Ray { origin: (origin[0], origin[1]), direction: (direction[0], direction[1]) };
            shots.push(Shot { ray, distance: length });
        }
    }
    shots
}

/// How many shots pass, and how many end at their corner rather than before it.
fn passing(shots: &[Shot], see: impl Fn(&Ray<f32>) -> f32) -> (usize, usize) {
    let (mut passed, mut at_the_corner) = (0, 0);
    for shot in shots {
        let (seen, slack) = (see(&shot.ray), 1e-4 * shot.distance.max(1.0));
        passed += usize::from(seen > shot.distance + slack);
        at_the_corner += usize::from((seen - shot.distance).abs() <= slack);
    }
    (passed, at_the_corner)
}

fn scene(polygons: &[Vec<[f32; 2]>], size: f32, range: f32) -> (Scenario, World) {
    let mut scenario = from_toml("");
    scenario.world.outer_wall = false;
    scenario.world.bounds.max = [size, size];
    scenario.world.polygons = polygons.to_vec();
    scenario.sensors.range = range;
    let world = world_of(&scenario);
    (scenario, world)
}

#[test]
fn no_beam_passes_a_polygons_corner_from_outside_or_inside_near_or_far() {
    for (scale, range) in [(2.0, 10.0), (100.0, 1000.0)] {
        let mut random = random(41);
        let polygons = polygons(scale, &mut random);
        let corners: Vec<[f32; 2]> = polygons.concat();
        let size = 5.0 * scale;
        let (_, world) = scene(&polygons, size, range);
        let place = |random: &mut Stream| [random.within(0.0, size), random.within(0.0, size)];
        let solid = |point| world.is_inside_obstacle(point);
        let shots = shots(&corners, place, solid, 5e-4 * scale, &mut random);
        let (passed, at_the_corner) = passing(&shots, |ray| world.distance(ray, range));
        assert_eq!(passed, 0, "of {at_the_corner} beams that met their corner, scale {scale}");
        assert!(at_the_corner > SHOTS / 8, "{at_the_corner}");
    }
}

#[test]
fn without_the_overlap_some_beams_would_pass() {
    let mut random = random(41);
    let polygons = polygons(2.0, &mut random);
    let (_, world) = scene(&polygons, 10.0, 10.0);
    let exact = polygons.iter().flat_map(|polygon| walls_of(polygon));
    let exact = exact.map(|[a, b]| Segment { a: (a[0], a[1]), b: (b[0], b[1]) });
    let exact = Obstacles::new(exact.collect(), Vec::new());
    let place = |random: &mut Stream| [random.within(0.0, 10.0), random.within(0.0, 10.0)];
    let solid = |point| world.is_inside_obstacle(point);
    let shots = shots(&polygons.concat(), place, solid, 1e-3, &mut random);
    let (passed, _) = passing(&shots, |ray| exact.distance(ray, 10.0));
    println!("{passed} of {SHOTS} beams pass corners without the overlap");
    assert!(passed > 10, "{passed}");
}

#[test]
fn no_beam_passes_a_corner_of_a_maps_outline() {
    for name in ["depot", "tb3_sandbox"] {
        let scenario = shipped(name);
        let world = world_of(&scenario);
        let map = map::load(&scenario_file(&format!("worlds/nav2/{name}.yaml"))).unwrap();
        let corners: Vec<[f32; 2]> = map::trace(&map, true, 100).into_iter().flatten().collect();
        let inside = |corner: &[f32; 2]| world.bounds.contains(*corner);
        let corners: Vec<[f32; 2]> = corners.into_iter().filter(inside).collect();
        let solid = |point| world.is_inside_obstacle(point);
        // A place in the open within 3 m of a corner, so that most beams get to theirs.
        let place = |random: &mut Stream| loop {
            let near = corners[random.index(corners.len())];
            let point = [near[0] + random.within(-2.0, 2.0), near[1] + random.within(-2.0, 2.0)];
            if world.bounds.contains(point) && !solid(point) {
                return point;
            }
        };
        let shots = shots(&corners, place, solid, 0.01, &mut random(42));
        let (passed, at_the_corner) = passing(&shots, |ray| world.distance(ray, 40.0));
        assert_eq!(passed, 0, "{name}: of {at_the_corner}");
        println!("{name}: {at_the_corner} beams ended at their corner");
        assert!(at_the_corner > 200, "{name}: {at_the_corner}");
    }
}

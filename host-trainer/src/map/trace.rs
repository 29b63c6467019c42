//! From obstacle cells to the line segments between them and the free cells.

use super::OccupancyMap;

/// From the first point to the second, metres; free space is on the left.
pub type Segment = [[f32; 2]; 2];

/// The outline of all obstacle cells in world coordinates.
///
/// Every edge between an obstacle cell and one that is none belongs to exactly one segment,
/// and so does every edge between an obstacle cell and the outside of the map. Edges in
/// line with the same side free are one segment, so a segment always ends at a corner of
/// the outline. Free space is on the left when going from a segment's first point to its
/// second: outlines run clockwise around obstacles and counter-clockwise around rooms.
/// Segments that meet share a corner bit for bit.
///
/// The arguments are those of [`OccupancyMap::is_obstacle`]. Takes time and memory in
/// proportion to the cells and the segments.
pub fn trace(map: &OccupancyMap, unknown_is_obstacle: bool, lethal: u8) -> Vec<Segment> {
    trace_within(map, unknown_is_obstacle, lethal, usize::MAX).unwrap_or_default()
}

/// The same outline if it has at most `most` segments, else none: a map of noise has nearly as
/// many as cells, and this gives up on it early.
pub fn trace_within(
    map: &OccupancyMap,
    unknown_is_obstacle: bool,
    lethal: u8,
    most: usize,
) -> Option<Vec<Segment>> {
    let width = map.width as usize;
    let mut outline = Outline { map, segments: Vec::new() };
    // One more column than the map has stands for the outside at both ends: index 0 is left
    // of the map (or, read backwards by one, right of it).
    let mut below = vec![false; width + 2];
    let mut here = vec![false; width + 2];
    let mut upright = vec![None; width + 1];

    for y in 0..=map.height {
        for x in 0..map.width {
            here[x as usize + 1] =
                y < map.height && map.is_obstacle(x, y, unknown_is_obstacle, lethal);
        }
        let mut level = None;
        for x in 0..=width {
            // The line below this row: obstacle above it means free below.
            let side = Side::between(below[x + 1], here[x + 1]);
            outline.extend(&mut level, side, x as u32, y, Axis::Level);
            // The line left of cell x.
            let side = Side::between(here[x], here[x + 1]);
            outline.extend(&mut upright[x], side, x as u32, y, Axis::Upright);
        }
        if outline.segments.len() > most {
            return None;
        }
        std::mem::swap(&mut below, &mut here);
    }
    Some(outline.segments)
}

/// Which side of a grid line is obstacle.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    /// The side with the smaller coordinate.
    Before,
    /// The side with the larger coordinate.
    After,
}

impl Side {
    fn between(before: bool, after: bool) -> Option<Self> {
        match (before, after) {
            (true, false) => Some(Self::Before),
            (false, true) => Some(Self::After),
            _ => None,
        }
    }
}

/// Direction of a grid line.
#[derive(Clone, Copy)]
enum Axis {
    Level,
    Upright,
}

/// A segment that may go on: where it began and its obstacle side.
type Open = Option<(u32, Side)>;

struct Outline<'map> {
    map: &'map OccupancyMap,
    segments: Vec<Segment>,
}

impl Outline<'_> {
    /// Moves along a grid line by one cell, which starts at corner (`x`, `y`) and has `side`.
    fn extend(&mut self, open: &mut Open, side: Option<Side>, x: u32, y: u32, axis: Axis) {
        if open.map(|(_, side)| side) == side {
            return;
        }
        let along = match axis {
            Axis::Level => x,
            Axis::Upright => y,
        };
        if let Some((start, side)) = open.take() {
            let end = self.map.corner(x, y);
            let (start, free_on_left_as_is) = match axis {
                Axis::Level => (self.map.corner(start, y), side == Side::Before),
                Axis::Upright => (self.map.corner(x, start), side == Side::After),
            };
            self.segments.push(if free_on_left_as_is { [start, end] } else { [end, start] });
        }
        *open = side.map(|side| (along, side));
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::f64::consts::FRAC_PI_2;

    use proptest::prelude::*;

    use super::*;
    use crate::map::{FREE, OCCUPIED, UNKNOWN};
    use crate::scenario::Bounds;

    /// A map drawn with `#` occupied, `?` unknown, `.` free; the last line is the bottom row.
    fn drawn(drawing: &[&str], resolution: f64, origin: [f64; 3]) -> OccupancyMap {
        let cell = |character| match character {
            '#' => OCCUPIED,
            '?' => UNKNOWN,
            _ => FREE,
        };
        OccupancyMap {
            width: drawing[0].len() as u32,
            height: drawing.len() as u32,
            resolution,
            origin,
            cells: drawing.iter().rev().flat_map(|row| row.chars().map(cell)).collect(),
            image: "drawn".into(),
            unknown_keys: Vec::new(),
        }
    }

    /// The outline in whole metres, sorted.
    fn outline(drawing: &[&str]) -> Vec<[[i32; 2]; 2]> {
        let map = drawn(drawing, 1.0, [0.0; 3]);
        let mut segments: Vec<_> =
            trace(&map, false, 100).iter().map(|ends| ends.map(|p| p.map(|v| v as i32))).collect();
        segments.sort();
        segments
    }

    #[test]
    fn a_block_is_four_segments_clockwise_with_free_space_on_the_left() {
        assert_eq!(
            outline(&["....", ".##.", ".##.", "...."]),
            [[[1, 1], [1, 3]], [[1, 3], [3, 3]], [[3, 1], [1, 1]], [[3, 3], [3, 1]]]
        );
    }

    #[test]
    fn obstacles_at_the_border_of_the_map_are_closed_there() {
        assert_eq!(
            outline(&["#."]),
            [[[0, 0], [0, 1]], [[0, 1], [1, 1]], [[1, 0], [0, 0]], [[1, 1], [1, 0]]]
        );
    }

    #[test]
    fn a_room_has_an_outer_outline_clockwise_and_an_inner_one_counter_clockwise() {
        assert_eq!(
            outline(&["###", "#.#", "###"]),
            [
                [[0, 0], [0, 3]],
                [[0, 3], [3, 3]],
                [[1, 1], [2, 1]],
                [[1, 2], [1, 1]],
                [[2, 1], [2, 2]],
                [[2, 2], [1, 2]],
                [[3, 0], [0, 0]],
                [[3, 3], [3, 0]],
            ]
        );
    }

    #[test]
    fn cells_that_touch_at_a_corner_have_separate_segments_that_meet_there() {
        assert_eq!(
            outline(&[".#", "#."]),
            [
                [[0, 0], [0, 1]],
                [[0, 1], [1, 1]],
                [[1, 0], [0, 0]],
                [[1, 1], [1, 0]],
                [[1, 1], [1, 2]],
                [[1, 2], [2, 2]],
                [[2, 1], [1, 1]],
                [[2, 2], [2, 1]],
            ]
        );
    }

    #[test]
    fn unknown_cells_count_on_request_and_lethal_sets_the_least_occupancy() {
        let mut map = drawn(&["?.#"], 1.0, [0.0; 3]);
        map.cells[1] = 40;
        let count = |unknown, lethal| trace(&map, unknown, lethal).len();
        assert_eq!([count(false, 100), count(true, 100), count(false, 40)], [4, 8, 4]);
        assert_eq!(count(true, 0), 4, "everything is one block");
    }

    #[test]
    fn resolution_origin_and_yaw_place_the_outline_in_the_world() {
        // One cell of 0.5 m, one cell to the right of the lower left corner (2, 3), turned by
        // a quarter: its corners are 0.5 and 1 m up from there, and 0 and 0.5 m to the left.
        let map = drawn(&["..", ".#"], 0.5, [2.0, 3.0, FRAC_PI_2]);
        let mut found: Vec<_> = trace(&map, false, 100).into_iter().flatten().collect();
        found.sort_by(|a, b| a.partial_cmp(b).unwrap());
        found.dedup();
        let expected = [[1.5, 3.5], [1.5, 4.0], [2.0, 3.5], [2.0, 4.0]];
        for (found, expected) in found.iter().zip(expected) {
            assert!((found[0] - expected[0]).abs() < 1e-6, "{found:?} {expected:?}");
            assert!((found[1] - expected[1]).abs() < 1e-6, "{found:?} {expected:?}");
        }
        assert_eq!(found.len(), 4);
        assert_eq!(map.cell_at([1.75, 3.75]), Some((1, 0)));
        assert_eq!(map.cell_at([2.25, 3.75]), None);
        let Bounds { min, max } = map.bounds();
        assert!((min[0] - 1.0).abs() < 1e-6 && (min[1] - 3.0).abs() < 1e-6, "{min:?}");
        assert!((max[0] - 2.0).abs() < 1e-6 && (max[1] - 4.0).abs() < 1e-6, "{max:?}");
    }

    prop_compose! {
        fn any_map()(width in 1..12u32, height in 1..12u32)(
            width in Just(width),
            height in Just(height),
            cells in prop::collection::vec(
                prop::sample::select(vec![UNKNOWN, FREE, OCCUPIED]),
                (width * height) as usize,
            ),
            resolution in 0.01..2.0f64,
            origin in prop::array::uniform3(-20.0..20.0f64),
        ) -> OccupancyMap {
            let image = "drawn".into();
            OccupancyMap { width, height, resolution, origin, cells, image, unknown_keys: vec![] }
        }
    }

    fn length([from, to]: &Segment) -> f64 {
        libm::hypot(f64::from(to[0] - from[0]), f64::from(to[1] - from[1]))
    }

    proptest! {
        #[test]
        fn the_outline_encloses_exactly_the_area_of_the_obstacle_cells(map in any_map()) {
            let count = map.cells.iter().filter(|&&cell| cell == OCCUPIED).count() as f64;
            // Shoelace formula, from a point of the map against cancellation.
            let [x0, y0, _] = map.origin;
            let twice: f64 = trace(&map, false, 100)
                .iter()
                .map(|ends| ends.map(|[x, y]| [f64::from(x) - x0, f64::from(y) - y0]))
                .map(|[[x1, y1], [x2, y2]]| x1 * y2 - x2 * y1)
                .sum();
            let expected = count * map.resolution * map.resolution;
            prop_assert!((-twice / 2.0 - expected).abs() < 1e-3, "{} {expected}", -twice / 2.0);
        }

        #[test]
        fn every_edge_between_obstacle_and_free_is_covered_once(map in any_map()) {
            let solid = |x: i64, y: i64| {
                let inside = u32::try_from(x).ok().zip(u32::try_from(y).ok());
                inside.is_some_and(|(x, y)| map.cell(x, y) == Some(OCCUPIED))
            };
            let (width, height) = (i64::from(map.width), i64::from(map.height));
            let mut edges = 0;
            for y in 0..=height {
                for x in 0..=width {
                    edges += u32::from(solid(x, y) != solid(x - 1, y));
                    edges += u32::from(solid(x, y) != solid(x, y - 1));
                }
            }
            let total: f64 = trace(&map, false, 100).iter().map(length).sum();
            let expected = f64::from(edges) * map.resolution;
            prop_assert!((total - expected).abs() < 1e-3 * expected.max(1.0), "{total} {expected}");
        }

        #[test]
        fn the_outline_is_closed_bit_for_bit(map in any_map()) {
            let mut balance = BTreeMap::new();
            for [from, to] in trace(&map, false, 100) {
                prop_assert_ne!(from, to);
                *balance.entry(from.map(f32::to_bits)).or_insert(0) += 1;
                *balance.entry(to.map(f32::to_bits)).or_insert(0) -= 1;
            }
            prop_assert!(balance.values().all(|&surplus| surplus == 0));
        }

        #[test]
        fn a_step_to_the_left_of_a_segment_is_free_and_to_the_right_an_obstacle(map in any_map()) {
            let occupied = |point| {
                map.cell_at(point).is_some_and(|(x, y)| map.cell(x, y) == Some(OCCUPIED))
            };
            for ends in trace(&map, false, 100) {
                let [[x1, y1], [x2, y2]] = ends;
                let reach = 0.25 * map.resolution as f32 / length(&ends) as f32;
                let (dx, dy) = ((x2 - x1) * reach, (y2 - y1) * reach);
                // A quarter cell along and a quarter cell aside.
                prop_assert!(!occupied([x1 + dx - dy, y1 + dy + dx]));
                prop_assert!(occupied([x1 + dx + dy, y1 + dy - dx]));
            }
        }
    }
}

//! From an outline's line segments to closed loops, which a picture can fill.

use std::collections::HashMap;

use super::Segment;

/// Joins segments end to end to closed loops, each without its first point repeated.
///
/// The segments are those of [`trace`](super::trace), in any order. A point lies in an obstacle
/// exactly if the loops together wind around it (the even-odd rule): which way a loop goes on
/// where two obstacles touch at a corner makes no difference to that.
pub fn loops(segments: &[Segment]) -> Vec<Vec<[f32; 2]>> {
    let bits = |point: [f32; 2]| point.map(f32::to_bits);
    let mut leaving: HashMap<[u32; 2], Vec<usize>> = HashMap::with_capacity(segments.len());
    for (index, [from, _]) in segments.iter().enumerate().rev() {
        leaving.entry(bits(*from)).or_default().push(index);
    }
    let mut used = vec![false; segments.len()];
    let mut loops = Vec::new();
    for first in 0..segments.len() {
        let mut next = Some(first);
        let mut corners = Vec::new();
        while let Some(index) = next.filter(|index| !used[*index]) {
            used[index] = true;
            let [from, to] = segments[index];
            corners.push(from);
            next = leaving.get_mut(&bits(to)).and_then(|indices| {
                while indices.last().is_some_and(|index| used[*index]) {
                    indices.pop();
                }
                indices.last().copied()
            });
        }
        if !corners.is_empty() {
            loops.push(corners);
        }
    }
    loops
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_room_with_a_pillar_is_three_loops() {
        // A wall of one cell around 3 × 3 free ones, the middle one solid: cells of 1 m.
        let ring = |low: f32, high: f32, clockwise: bool| {
            let mut corners = [[low, low], [low, high], [high, high], [high, low]];
            if !clockwise {
                corners.reverse();
            }
            (0..4).map(|i| [corners[i], corners[(i + 1) % 4]]).collect::<Vec<_>>()
        };
        let mut segments =
            [ring(0.0, 5.0, true), ring(1.0, 4.0, false), ring(2.0, 3.0, true)].concat();
        segments.swap(1, 9);
        segments.swap(2, 6);
        let mut lengths: Vec<_> = loops(&segments).iter().map(Vec::len).collect();
        lengths.sort_unstable();
        assert_eq!(lengths, [4, 4, 4]);
    }

    /// Crossings of a ray to the right with the loops, counted as a picture's filler does.
    fn fills(loops: &[Vec<[f32; 2]>], [x, y]: [f32; 2]) -> bool {
        let crossings = loops.iter().flat_map(|corners| {
            let next = corners.iter().cycle().skip(1);
            corners.iter().zip(next).filter(|(a, b)| (a[1] > y) != (b[1] > y) && a[0] > x)
        });
        crossings.count() % 2 == 1
    }

    #[test]
    fn the_even_odd_rule_fills_exactly_the_obstacles_of_a_shipped_map() {
        let yaml = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenarios/worlds/nav2/depot.yaml");
        let map = crate::map::load(yaml.as_ref()).unwrap();
        let loops = loops(&crate::map::trace(&map, true, 100));
        for row in (0..map.height).step_by(7) {
            for column in (0..map.width).step_by(5) {
                let ([x0, y0], [x1, y1]) =
                    (map.corner(column, row), map.corner(column + 1, row + 1));
                let middle = [(x0 + x1) / 2.0, (y0 + y1) / 2.0];
                let solid = map.is_obstacle(column, row, true, 100);
                assert_eq!(fills(&loops, middle), solid, "column {column}, row {row}");
            }
        }
    }
}

//! The pieces that the free space falls into.

use super::FreeSpace;
use crate::scenario::Bounds;
use crate::world::World;

/// A connected part of the free space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// Its share of the bounds, by area: of the places where the disc's middle can be.
    pub share: f32,
    /// The rectangle around those places, metres.
    pub around: Bounds,
    /// Whether it comes up to the edge of the bounds.
    pub at_edge: bool,
}

/// What is known of a part while its cells are counted.
#[derive(Clone, Copy)]
struct Tally {
    cells: usize,
    /// Some cell of it.
    example: [usize; 2],
    low: [usize; 2],
    high: [usize; 2],
}

impl FreeSpace {
    /// The parts that are not inside something solid, the largest first; none where the world is
    /// too large for a map of it.
    pub fn parts(&self, world: &World) -> Vec<Part> {
        self.parts_on(world, |_| true)
    }

    /// The same, except that only places where `counts` says so add to a part's share.
    pub fn parts_on(&self, world: &World, counts: impl Fn([f32; 2]) -> bool) -> Vec<Part> {
        let mut tallies: Vec<Option<Tally>> = Vec::new();
        for (index, label) in self.labels.iter().enumerate().filter(|(_, label)| **label != 0) {
            let at = [index % self.width, index / self.width];
            let slot = *label as usize;
            if slot >= tallies.len() {
                tallies.resize(slot + 1, None);
            }
            let fresh = Tally { cells: 0, example: at, low: at, high: at };
            let tally = tallies[slot].get_or_insert(fresh);
            tally.cells += usize::from(counts(self.middle(at[0], at[1])));
            tally.low = [tally.low[0].min(at[0]), tally.low[1].min(at[1])];
            tally.high = [tally.high[0].max(at[0]), tally.high[1].max(at[1])];
        }
        let in_the_open = |tally: &Tally| {
            let [i, j] = tally.example;
            !world.is_inside_obstacle(self.middle(i, j))
        };
        let mut tallies: Vec<Tally> = tallies.into_iter().flatten().filter(in_the_open).collect();
        tallies.sort_by_key(|tally| std::cmp::Reverse(tally.cells));
        tallies.iter().map(|tally| self.part(tally)).collect()
    }

    fn part(&self, tally: &Tally) -> Part {
        let Tally { cells, low, high, .. } = *tally;
        let half = self.cell / 2.0;
        let min = self.middle(low[0], low[1]).map(|middle| middle - half);
        let max = self.middle(high[0], high[1]).map(|middle| middle + half);
        Part {
            share: cells as f32 / self.labels.len() as f32,
            around: Bounds { min, max },
            at_edge: low.contains(&0) || high[0] + 1 == self.width || high[1] + 1 == self.height,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::{Preset, Wall};

    #[test]
    fn a_wall_across_the_room_leaves_two_parts_and_the_inside_of_a_box_is_none() {
        let mut scenario = Preset::Paper.scenario();
        scenario.world.boxes.push([6.0, 6.0, 8.0, 8.0]);
        let points = vec![[3.0, 0.0], [3.0, 10.0]];
        scenario.world.walls.push(Wall { points, thickness: 0.0 });
        scenario.world.outer_wall = false;
        let world = World::new(&scenario).unwrap();
        let parts = FreeSpace::new(&world, 0.1).parts(&world);
        // 7 × 10 m less the box of 2 × 2 m, and 3 × 10 m; a band of 0.1 m on each wall is lost.
        let areas: Vec<f32> = parts.iter().map(|part| (part.share * 100.0).round()).collect();
        assert_eq!(areas, [64.0, 29.0]);
        assert!((parts[1].around.max[0] - 2.9).abs() < 0.06, "{:?}", parts[1]);
        assert!(parts.iter().all(|part| part.at_edge));
    }
}

//! Where a car can be: a coarse map of the free space and which parts of it hang together.

mod parts;

use super::{World, distance};
use std::collections::VecDeque;

pub use parts::Part;

/// Most cells of the coarse map.
const MAX_CELLS: usize = 1 << 22;

/// Cells in which a disc of a given radius is clear of obstacles, labelled by connected part.
///
/// A world too large for cells as fine as the disc has no such map: everything in it counts as
/// connected.
#[derive(Debug)]
pub struct FreeSpace {
    origin: [f32; 2],
    cell: f32,
    width: usize,
    height: usize,
    /// 0 is blocked; equal labels hang together. Empty in a world that is too large.
    labels: Vec<u32>,
    /// The label of the largest part outside of solid things, or 0 if there is none.
    main: u32,
}

impl FreeSpace {
    /// Maps a world's bounds for a disc of this radius, metres. Cells are half a radius large.
    pub fn new(world: &World, radius: f32) -> Self {
        let [x0, y0] = world.bounds.min;
        let (w, h) = (world.bounds.max[0] - x0, world.bounds.max[1] - y0);
        let cell = (radius * 0.5).max((w * h / MAX_CELLS as f32).sqrt());
        let width = ((w / cell).ceil() as usize).max(1);
        let height = ((h / cell).ceil() as usize).max(1);
        let mut space = Self { origin: [x0, y0], cell, width, height, labels: Vec::new(), main: 0 };
        // A wall blocks a band of two radii; cells wider than that could lie on either side.
        if cell <= 2.0 * radius {
            space.labels = vec![u32::MAX; width * height];
            space.block(world, radius);
            space.label(world);
        }
        space
    }

    /// Blocks every cell whose middle is within `reach` of a wall or disc.
    fn block(&mut self, world: &World, reach: f32) {
        for wall in world.segments() {
            let ((ax, ay), (bx, by)) = (wall.a, wall.b);
            // Long walls are walked piece by piece, so that a diagonal does not visit its whole box.
            let pieces = (distance([ax, ay], [bx, by]) / (8.0 * self.cell)).ceil().max(1.0);
            for piece in 0..pieces as u32 {
                let at = |i: u32| {
                    let share = i as f32 / pieces;
                    (ax + (bx - ax) * share, ay + (by - ay) * share)
                };
                let (p, q) = (at(piece), at(piece + 1));
                let low = [p.0.min(q.0) - reach, p.1.min(q.1) - reach];
                let high = [p.0.max(q.0) + reach, p.1.max(q.1) + reach];
                self.block_where(low, high, |middle| super::obstacles::away(wall, middle) <= reach);
            }
        }
        for disc in world.discs() {
            let (x, y) = disc.centre;
            let far = disc.radius + reach;
            self.block_where([x - far, y - far], [x + far, y + far], |middle| {
                distance(middle, [x, y]) <= far
            });
        }
    }

    fn block_where(&mut self, low: [f32; 2], high: [f32; 2], blocked: impl Fn([f32; 2]) -> bool) {
        let clamp = |value: f32, most: usize| (value.max(0.0) as usize).min(most - 1);
        let column = |x: f32| clamp((x - self.origin[0]) / self.cell, self.width);
        let row = |y: f32| clamp((y - self.origin[1]) / self.cell, self.height);
        for j in row(low[1])..=row(high[1]) {
            for i in column(low[0])..=column(high[0]) {
                if blocked(self.middle(i, j)) {
                    self.labels[j * self.width + i] = 0;
                }
            }
        }
    }

    /// Labels the parts and finds the main one.
    fn label(&mut self, world: &World) {
        let mut parts = Vec::new();
        for start in 0..self.labels.len() {
            if self.labels[start] == u32::MAX {
                let size = self.fill(start, parts.len() as u32 + 1);
                parts.push((size, start));
            }
        }
        // A sort that keeps the order of equals: of two parts alike, the lower one wins.
        parts.sort_by_key(|(size, _)| std::cmp::Reverse(*size));
        let in_the_open = |cell: usize| {
            let middle = self.middle(cell % self.width, cell / self.width);
            !world.is_inside_obstacle(middle)
        };
        let main = parts.iter().find(|(_, cell)| in_the_open(*cell));
        self.main = main.map_or(0, |(_, cell)| self.labels[*cell]);
    }

    /// Labels everything that hangs together with a cell, and counts it.
    fn fill(&mut self, start: usize, label: u32) -> usize {
        let mut queue = VecDeque::from([start]);
        self.labels[start] = label;
        let mut size = 0;
        while let Some(cell) = queue.pop_front() {
            size += 1;
            let (i, j) = (cell % self.width, cell / self.width);
            let neighbours = [
                (i > 0).then(|| cell - 1),
                (i + 1 < self.width).then(|| cell + 1),
                (j > 0).then(|| cell - self.width),
                (j + 1 < self.height).then(|| cell + self.width),
            ];
            for neighbour in neighbours.into_iter().flatten() {
                if self.labels[neighbour] == u32::MAX {
                    self.labels[neighbour] = label;
                    queue.push_back(neighbour);
                }
            }
        }
        size
    }

    fn middle(&self, column: usize, row: usize) -> [f32; 2] {
        let at = |origin: f32, index: usize| origin + (index as f32 + 0.5) * self.cell;
        [at(self.origin[0], column), at(self.origin[1], row)]
    }

    /// The labels of the free cells whose middles lie within `radius` of a point (or of the
    /// cell that holds it).
    fn parts_near(&self, [x, y]: [f32; 2], radius: f32) -> Vec<u32> {
        let reach = radius.max(self.cell);
        let mut parts = Vec::new();
        let cells = (reach / self.cell).ceil() as i64 + 1;
        let (ci, cj) = (
            ((x - self.origin[0]) / self.cell).floor() as i64,
            ((y - self.origin[1]) / self.cell).floor() as i64,
        );
        for j in (cj - cells).max(0)..=(cj + cells).min(self.height as i64 - 1) {
            for i in (ci - cells).max(0)..=(ci + cells).min(self.width as i64 - 1) {
                let label = self.labels[j as usize * self.width + i as usize];
                let near = distance(self.middle(i as usize, j as usize), [x, y]) <= reach;
                if label != 0 && near && !parts.contains(&label) {
                    parts.push(label);
                }
            }
        }
        parts
    }

    /// Size of a cell, metres.
    pub fn cell(&self) -> f32 {
        self.cell
    }

    /// Whether the disc could get from `start` to within `reach` of `goal`. "No" is certain for
    /// a disc whose radius is three quarters of a [`Self::cell`] larger.
    pub fn connects(&self, start: [f32; 2], goal: [f32; 2], reach: f32) -> bool {
        if self.labels.is_empty() {
            return true;
        }
        let goal_parts = self.parts_near(goal, reach);
        self.parts_near(start, 0.0).iter().any(|part| goal_parts.contains(part))
    }

    /// Whether the main part, the largest that is not inside something solid, comes within
    /// `reach` of a point.
    pub fn main_part_reaches(&self, point: [f32; 2], reach: f32) -> bool {
        self.labels.is_empty() || self.parts_near(point, reach).contains(&self.main)
    }
}

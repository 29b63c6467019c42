//! Where a car can be: a coarse map of the free space and which parts of it hang together.

use super::{World, distance};
use std::collections::VecDeque;

/// Most cells of the coarse map.
const MAX_CELLS: usize = 1 << 22;

/// Cells where a disc of the car's half width is clear of obstacles, labelled by connected part.
#[derive(Debug)]
pub struct FreeSpace {
    origin: [f32; 2],
    cell: f32,
    width: usize,
    height: usize,
    /// 0 is blocked; equal labels hang together.
    labels: Vec<u32>,
}

impl FreeSpace {
    /// Maps a world's bounds for a car of this half width, metres.
    ///
    /// Cells are half a half width large, or larger in worlds past four million such cells.
    pub fn new(world: &World, half_width: f32) -> Self {
        let [x0, y0] = world.bounds.min;
        let (w, h) = (world.bounds.max[0] - x0, world.bounds.max[1] - y0);
        let cell = (half_width * 0.5).max((w * h / MAX_CELLS as f32).sqrt());
        let width = ((w / cell).ceil() as usize).max(1);
        let height = ((h / cell).ceil() as usize).max(1);
        let mut space =
            Self { origin: [x0, y0], cell, width, height, labels: vec![u32::MAX; width * height] };
        space.block(world, half_width);
        space.label();
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
                self.block_where(low, high, |middle| super::walls::away(wall, middle) <= reach);
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

    fn label(&mut self) {
        let mut next = 0;
        let mut queue = VecDeque::new();
        for start in 0..self.labels.len() {
            if self.labels[start] != u32::MAX {
                continue;
            }
            next += 1;
            self.labels[start] = next;
            queue.push_back(start);
            while let Some(cell) = queue.pop_front() {
                let (i, j) = (cell % self.width, cell / self.width);
                let neighbours = [
                    (i > 0).then(|| cell - 1),
                    (i + 1 < self.width).then(|| cell + 1),
                    (j > 0).then(|| cell - self.width),
                    (j + 1 < self.height).then(|| cell + self.width),
                ];
                for neighbour in neighbours.into_iter().flatten() {
                    if self.labels[neighbour] == u32::MAX {
                        self.labels[neighbour] = next;
                        queue.push_back(neighbour);
                    }
                }
            }
        }
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

    /// Whether a car's middle could get from `start` to within `radius` of `goal`, turning on
    /// the spot. A "no" is certain up to one cell; a "yes" ignores the turning circle.
    pub fn connects(&self, start: [f32; 2], goal: [f32; 2], radius: f32) -> bool {
        let goal_parts = self.parts_near(goal, radius);
        self.parts_near(start, 0.0).iter().any(|part| goal_parts.contains(part))
    }

    /// Share of the bounds that is free.
    pub fn free_share(&self) -> f32 {
        let free = self.labels.iter().filter(|label| **label != 0).count();
        free as f32 / self.labels.len() as f32
    }
}

//! Where the car fits while a world is being made.

use std::ops::Range;

use crate::scenario::VehicleSpec;

/// Edge of a cell, metres.
const CELL: f32 = 0.1;

/// Cells whose middle the car's middle can be at, whatever its heading.
pub(super) struct FreeSpace {
    columns: usize,
    rows: usize,
    free: Vec<bool>,
    /// Obstacles keep this far from the car's middle, metres.
    reach: f32,
}

impl FreeSpace {
    /// An empty room with walls all around.
    pub(super) fn new([width, height]: [f32; 2], vehicle: &VehicleSpec) -> Self {
        let diagonal = libm::hypotf(vehicle.length, vehicle.width);
        // Half a cell more, so that the way between two middles is clear too.
        let reach = diagonal / 2.0 + CELL / 2.0;
        let (columns, rows) = ((width / CELL) as usize, (height / CELL) as usize);
        let mut space = Self { columns, rows, free: vec![true; columns * rows], reach };
        for cell in 0..space.free.len() {
            let [x, y] = space.middle(cell);
            let to_wall = x.min(y).min(width - x).min(height - y);
            space.free[cell] = to_wall > reach;
        }
        space
    }

    fn middle(&self, cell: usize) -> [f32; 2] {
        let at = |index: usize| (index as f32 + 0.5) * CELL;
        [at(cell % self.columns), at(cell / self.columns)]
    }

    /// Places an obstacle within a rectangle, unless that cut the free space in two or took
    /// the last of it; `distance` is that of a point to the obstacle. Whether it was placed.
    pub(super) fn place(
        &mut self,
        [x0, y0, x1, y1]: [f32; 4],
        distance: impl Fn([f32; 2]) -> f32,
    ) -> bool {
        let first = |low: f32| ((low - self.reach) / CELL - 1.0).max(0.0) as usize;
        let last = |high: f32, count: usize| {
            (((high + self.reach) / CELL).max(0.0) as usize + 2).min(count)
        };
        let window = [first(x0)..last(x1, self.columns), first(y0)..last(y1, self.rows)];
        let mut taken = Vec::new();
        for cell in self.cells_of(&window) {
            if self.free[cell] && distance(self.middle(cell)) <= self.reach {
                self.free[cell] = false;
                taken.push(cell);
            }
        }
        // Who could pass the window before can pass it still if what is left of it hangs
        // together; only if not, the way around is looked for.
        let whole = [0..self.columns, 0..self.rows];
        let fits = self.in_one_piece(&window) || self.in_one_piece(&whole);
        if !fits {
            for cell in taken {
                self.free[cell] = true;
            }
        }
        fits
    }

    fn cells_of(&self, [columns, rows]: &Window) -> impl Iterator<Item = usize> + use<> {
        let (width, columns) = (self.columns, columns.clone());
        rows.clone().flat_map(move |row| columns.clone().map(move |column| row * width + column))
    }

    /// Blocks a disc, whatever that does to the free space.
    pub(super) fn block_disc(&mut self, centre: [f32; 2], radius: f32) {
        let reach = self.reach + radius;
        let column = |x: f32| (x / CELL).max(0.0) as usize;
        for row in column(centre[1] - reach)..=column(centre[1] + reach).min(self.rows - 1) {
            for column in
                column(centre[0] - reach)..=column(centre[0] + reach).min(self.columns - 1)
            {
                let cell = row * self.columns + column;
                let [x, y] = self.middle(cell);
                if libm::hypotf(x - centre[0], y - centre[1]) <= reach {
                    self.free[cell] = false;
                }
            }
        }
    }

    /// Whether the car gets from one point to another.
    pub(super) fn connects(&self, from: [f32; 2], to: [f32; 2]) -> bool {
        let cell = |[x, y]: [f32; 2]| (y / CELL) as usize * self.columns + (x / CELL) as usize;
        let whole = [0..self.columns, 0..self.rows];
        self.free[cell(from)] && self.reachable(cell(from), &whole)[cell(to)]
    }

    /// Whether the window's free cells hang together within it, and there are any.
    fn in_one_piece(&self, window: &Window) -> bool {
        let Some(start) = self.cells_of(window).find(|cell| self.free[*cell]) else { return false };
        let reached = self.reachable(start, window);
        self.cells_of(window).all(|cell| self.free[cell] == reached[cell])
    }

    /// The free cells of a window that hang together with one of them.
    fn reachable(&self, start: usize, [columns, rows]: &Window) -> Vec<bool> {
        let mut reached = vec![false; self.free.len()];
        reached[start] = true;
        let mut open = vec![start];
        while let Some(cell) = open.pop() {
            let (column, row) = (cell % self.columns, cell / self.columns);
            let neighbours = [
                (column > columns.start).then(|| cell - 1),
                (column + 1 < columns.end).then_some(cell + 1),
                (row > rows.start).then(|| cell - self.columns),
                (row + 1 < rows.end).then_some(cell + self.columns),
            ];
            for neighbour in neighbours.into_iter().flatten() {
                if self.free[neighbour] && !reached[neighbour] {
                    reached[neighbour] = true;
                    open.push(neighbour);
                }
            }
        }
        reached
    }
}

/// Ranges of columns and rows.
type Window = [Range<usize>; 2];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Preset;

    #[test]
    fn a_wall_across_the_room_is_refused_and_one_with_a_door_is_placed() {
        let mut space = FreeSpace::new([6.0, 4.0], &Preset::Paper.scenario().vehicle);
        let wall =
            |upto: f32| move |[x, y]: [f32; 2]| libm::hypotf((x - 3.0).abs(), (y - upto).max(0.0));
        assert!(!space.place([3.0, 0.0, 3.0, 4.0], wall(4.0)));
        assert!(space.connects([1.0, 1.0], [5.0, 1.0]), "a refused wall leaves no trace");
        assert!(!space.place([3.0, 0.0, 3.0, 3.7], wall(3.7)), "a door of 0.3 m is too narrow");
        assert!(space.place([3.0, 0.0, 3.0, 3.0], wall(3.0)));
        assert!(space.connects([1.0, 1.0], [5.0, 1.0]));
        assert!(!space.connects([1.0, 1.0], [3.0, 1.0]), "inside the wall");
    }

    #[test]
    fn discs_in_a_row_close_the_way() {
        let mut space = FreeSpace::new([6.0, 4.0], &Preset::Paper.scenario().vehicle);
        for step in 0..=7 {
            assert!(space.connects([1.0, 2.0], [5.0, 2.0]));
            space.block_disc([3.0, step as f32 * 0.5], 0.075);
        }
        assert!(!space.connects([1.0, 2.0], [5.0, 2.0]));
    }
}

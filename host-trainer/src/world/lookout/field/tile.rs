//! Some cells of a field, looked at together.

use super::CLOSE;
use crate::world::Obstacles;
use crate::world::lookout::beams::{self, Row};
use crate::world::lookout::grid::{Grid, TILE};
use crate::world::shape::{Rect, Shape};

/// Cells around a tile in which obstacles are looked for. Clearances are no larger than they span.
const AROUND: usize = 32;

/// Cells along the tile and its surroundings.
const WIDE: usize = TILE + 2 * AROUND;

/// Larger than the square of any distance here, in cells.
const FAR: u32 = u32::MAX / 4;

/// What is known of a tile's cells.
#[derive(Debug)]
pub(super) struct Tile {
    /// Metres, by place in the tile.
    clearances: Box<[f32]>,
    /// Where each cell's list ends among the rows.
    ends: Box<[u32]>,
    rows: Box<[Row]>,
}

impl Tile {
    /// Looks at the obstacles in and around a tile, but for walls longer than the `longest`, metres.
    pub(super) fn new(grid: &Grid, tile: usize, obstacles: &Obstacles, longest: f64) -> Self {
        let inner = grid.tile_rect(tile);
        let first = grid.first_of_tile(tile);
        let clearances = clearances(grid, &first, obstacles, longest);

        let mut lists: Vec<Vec<Row>> = vec![Vec::new(); TILE * TILE];
        let close = f64::from(CLOSE);
        obstacles.each_near(&inner, 2.0 * close, |place, shape| {
            if shape.length > longest {
                return;
            }
            let row = row(obstacles, place);
            for (x, y) in Block::new(grid, &first, 0).touched(&shape, close) {
                lists[y * TILE + x].push(row);
            }
        });
        let mut end = 0;
        let ends = lists.iter().map(|list| {
            end += list.len() as u32;
            end
        });
        Self { clearances, ends: ends.collect(), rows: lists.concat().into() }
    }

    /// How far a beam may go from anywhere in one of its cells, metres.
    pub(super) fn clearance(&self, place: usize) -> f32 {
        self.clearances[place]
    }

    /// The obstacles close to one of its cells.
    #[inline(always)]
    pub(super) fn close_by(&self, place: usize) -> &[Row] {
        let first = if place == 0 { 0 } else { self.ends[place - 1] };
        &self.rows[first as usize..self.ends[place] as usize]
    }
}

fn row(obstacles: &Obstacles, place: u32) -> Row {
    let (walls, place) = (obstacles.walls(), place as usize);
    match walls.get(place) {
        Some(wall) => beams::edge(wall),
        None => beams::disc(&obstacles.discs()[place - walls.len()]),
    }
}

/// Cells of a tile and so many around it.
struct Block {
    /// The first cell.
    first: Rect,
    side: f64,
    cells: usize,
}

impl Block {
    fn new(grid: &Grid, first: &Rect, around: usize) -> Self {
        let side = grid.side();
        let first = first.moved([-(around as f64) * side; 2]);
        Self { first, side, cells: TILE + 2 * around }
    }

    fn rect(&self) -> Rect {
        let Rect { low, high } = self.first;
        let span = (self.cells - 1) as f64 * self.side;
        Rect { low, high: high.map(|high| high + span) }
    }

    /// The cells beyond which a shape comes into the square that goes so far.
    fn touched(&self, shape: &Shape, close: f64) -> impl Iterator<Item = (usize, usize)> {
        let range = |axis: usize| {
            let ends = shape.ends.map(|end| end[axis]);
            let reach = shape.radius + close;
            let (least, most) = (ends[0].min(ends[1]) - reach, ends[0].max(ends[1]) + reach);
            let cell = |at: f64| ((at - self.first.low[axis]) / self.side).floor();
            // One more on either side: cells overlap a little.
            let first = (cell(least) - 1.0).clamp(0.0, self.cells as f64) as usize;
            let past = (cell(most) + 2.0).clamp(0.0, self.cells as f64) as usize;
            first..past
        };
        let cell = move |x: usize, y: usize| {
            self.first.moved([x as f64 * self.side, y as f64 * self.side])
        };
        let (xs, ys) = (range(0), range(1));
        ys.flat_map(move |y| xs.clone().map(move |x| (x, y)))
            .filter(move |(x, y)| shape.distance(&cell(*x, *y).grown(close)) <= 0.0)
    }
}

/// How far a beam may go from anywhere in each cell of a tile: the distance between the cell and
/// the nearest with an obstacle in it, and at least [`CLOSE`], to which the cell has a list.
///
/// Of the gaps between two cells along x and y the squares add up, so the nearest is found along
/// x first, then along y (P. Felzenszwalb and D. Huttenlocher, 2012; in so few cells the plain minimum
/// is quick enough).
fn clearances(grid: &Grid, first: &Rect, obstacles: &Obstacles, longest: f64) -> Box<[f32]> {
    let block = Block::new(grid, first, AROUND);
    let mut is_taken = vec![[false; WIDE]; WIDE];
    obstacles.each_near(&block.rect(), 0.0, |_, shape| {
        if shape.length > longest {
            return;
        }
        for (x, y) in block.touched(&shape, 0.0) {
            is_taken[y][x] = true;
        }
    });
    let gap = |a: usize, b: usize| (a.abs_diff(b).max(1) - 1) as u32;
    let along_x: Vec<[u32; TILE]> = is_taken
        .iter()
        .map(|row| {
            let taken = (0..WIDE).filter(|x| row[*x]);
            let mut least = [FAR; TILE];
            for other in taken {
                for (x, least) in least.iter_mut().enumerate() {
                    *least = (*least).min(gap(AROUND + x, other).pow(2));
                }
            }
            least
        })
        .collect();
    let square = |x: usize, y: usize| {
        let rows = along_x.iter().enumerate();
        let least = rows.map(|(other, least)| least[x] + gap(AROUND + y, other).pow(2)).min();
        least.map_or(FAR, |least| least.min((AROUND as u32).pow(2)))
    };
    let cells = (0..TILE).flat_map(|y| (0..TILE).map(move |x| (x, y)));
    let clearance = |(x, y)| (grid.side() * f64::from(square(x, y)).sqrt()) as f32;
    cells.map(|cell| clearance(cell).max(CLOSE)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::{Purpose, RunSeed};
    use crate::world::shape::{dot, length, minus};
    use controller_core::geometry::{Disc, Segment};

    /// Between convex shapes that do not meet, some corner or end is nearest.
    fn distance(shape: &Shape, rect: &Rect) -> f64 {
        let [a, b] = shape.ends;
        let to_shape = rect.corners().map(|corner| {
            let along = dot(minus(corner, a), shape.direction).clamp(0.0, shape.length);
            let foot = [a[0] + along * shape.direction[0], a[1] + along * shape.direction[1]];
            length(minus(corner, foot))
        });
        let to_rect = [a, b].map(|end| {
            let beyond = |axis: usize| {
                (rect.low[axis] - end[axis]).max(end[axis] - rect.high[axis]).max(0.0)
            };
            length([beyond(0), beyond(1)])
        });
        to_shape.into_iter().chain(to_rect).fold(f64::INFINITY, f64::min) - shape.radius
    }

    /// The oracle measures every obstacle from every cell, but for the wall that is too long.
    #[test]
    fn clearances_are_not_too_large_and_lists_are_complete() {
        const LONGEST: f64 = 3.0;
        let mut random = RunSeed(5).stream(Purpose::Episode, 0, 0);
        let mut wall = |reach: f32| {
            let (x, y) = (random.within(0.0, 7.0), random.within(0.0, 5.0));
            let end = (x + random.within(-reach, reach), y + random.within(-reach, reach));
            Segment { a: (x, y), b: end }
        };
        let walls: Vec<_> = (0..40).map(|n| wall([9.0, 2.0, 0.1][n.min(2)])).collect();
        let discs = vec![Disc { centre: (1.0, 4.0), radius: 0.4 }];
        let shapes: Vec<Shape> =
            walls.iter().map(Shape::from).chain(discs.iter().map(Shape::from)).collect();
        let too_long = shapes.iter().filter(|shape| shape.length > LONGEST).count();
        assert!(too_long == 1 && shapes[0].length > LONGEST && shapes[1].length > 1.0);
        let obstacles = Obstacles::new(walls, discs);
        let [low, high] = obstacles.bounds();
        let grid = Grid::of_side(low, high, 0.1);
        let (mut free, mut listed) = (0, 0);
        for tile in 0..grid.tiles() {
            let known = Tile::new(&grid, tile, &obstacles, LONGEST);
            for (cell, place) in grid.cells_of_tile(tile) {
                let rect = grid.rect(cell);
                let shapes = || (0..).zip(&shapes).filter(|(_, shape)| shape.length <= LONGEST);
                let distances = shapes().map(|(_, shape)| distance(shape, &rect));
                let nearest = distances.fold(f64::INFINITY, f64::min);
                let clearance = f64::from(known.clearance(place));
                if clearance > f64::from(CLOSE) {
                    // Cells overlap by what rounding makes of them.
                    assert!(clearance <= nearest + 1e-5, "cell {cell}: {clearance}, {nearest}");
                    assert!(clearance > 0.6 * nearest - 0.3, "cell {cell}: {clearance}, {nearest}");
                    free += 1;
                } else {
                    let square = rect.grown(f64::from(CLOSE) - 1e-5);
                    let list = known.close_by(place);
                    for (place, shape) in shapes() {
                        let is_listed = list.contains(&row(&obstacles, place));
                        assert!(is_listed || shape.distance(&square) > 0.0, "cell {cell}: {place}");
                    }
                    assert!(!list.contains(&row(&obstacles, 0)), "cell {cell}");
                    listed += list.len();
                }
            }
        }
        assert!(
            free > 1000 && listed > 200,
            "{free} cells are free, {listed} obstacles are listed"
        );
    }
}

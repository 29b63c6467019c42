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
    /// Looks at the obstacles in and around a tile.
    pub(super) fn new(grid: &Grid, tile: usize, obstacles: &Obstacles) -> Self {
        let inner = grid.tile_rect(tile);
        let first = grid.first_of_tile(tile);
        let clearances = clearances(grid, &first, obstacles);

        let mut lists: Vec<Vec<Row>> = vec![Vec::new(); TILE * TILE];
        let close = f64::from(CLOSE);
        obstacles.each_near(&inner, 2.0 * close, |place, shape| {
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
fn clearances(grid: &Grid, first: &Rect, obstacles: &Obstacles) -> Box<[f32]> {
    let block = Block::new(grid, first, AROUND);
    let mut is_taken = vec![[false; WIDE]; WIDE];
    obstacles.each_near(&block.rect(), 0.0, |_, shape| {
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

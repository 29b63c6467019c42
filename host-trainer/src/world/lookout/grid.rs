//! Which cell a point lies in, and which of some equal parts of a turn an angle.

use crate::vector::{MOST_LANES, Vector};
use crate::world::shape::{Point, Rect};
use std::f32::consts::TAU;

/// Side of a cell, metres.
const FINE_SIDE: f32 = 0.125;

/// Side of a larger one.
const COARSE_SIDE: f32 = 0.25;

/// Cells along a tile.
pub(super) const TILE: usize = 16;

/// Most cells; a larger world has larger ones.
const MOST_CELLS: usize = 1 << 23;

/// Adding and taking away 1.5·2²³ rounds an `f32` to the nearest integer.
const ROUND: f32 = 12_582_912.0;

/// Directions lie this much further out than their part of a turn says, radians: many times what
/// `sin_cos`, `wrap`, turning by a mount and the choice of a part, of which heading and mount are rounded
/// each by itself, round away.
const TURN_MARGIN: f64 = 1.0e-5;

/// How closely a world is looked at.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cells {
    /// Short lists, of many cells: for a world that is driven in again and again.
    Fine,
    /// Longer lists of a quarter of the cells, to be found sooner: for a world that is soon left, or
    /// has so many obstacles that it takes long to look around.
    Coarse,
}

/// Upright square cells around points that are whole sides from the origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    origin: [f32; 2],
    side: f32,
    per_metre: f32,
    columns: usize,
    rows: usize,
}

impl Grid {
    /// Cells over a rectangle, metres.
    pub(super) fn new(low: [f32; 2], high: [f32; 2], cells: Cells) -> Self {
        let side = match cells {
            Cells::Fine => FINE_SIDE,
            Cells::Coarse => COARSE_SIDE,
        };
        Self::of_side(low, high, side)
    }

    /// The same, of this side or a larger one.
    pub(super) fn of_side(low: [f32; 2], high: [f32; 2], mut side: f32) -> Self {
        let size = [high[0] - low[0], high[1] - low[1]].map(|size| size.max(f32::MIN_POSITIVE));
        let count = |side: f32| size.map(|size| (size / side).ceil() + 1.0);
        while count(side)[0] * count(side)[1] > MOST_CELLS as f32 {
            side *= 1.25;
        }
        let [columns, rows] = count(side).map(|count| count as usize);
        Self { origin: low, side, per_metre: 1.0 / side, columns, rows }
    }

    /// How many cells there are; their numbers go from 0, row by row.
    pub(super) fn cells(&self) -> usize {
        self.columns * self.rows
    }

    /// How many tiles there are, squares of cells; their numbers go from 0, row by row.
    pub(super) fn tiles(&self) -> usize {
        self.columns.div_ceil(TILE) * self.rows.div_ceil(TILE)
    }

    /// The tile of a cell.
    pub(super) fn tile(&self, cell: usize) -> usize {
        let (column, row) = (cell % self.columns, cell / self.columns);
        row / TILE * self.columns.div_ceil(TILE) + column / TILE
    }

    /// The tile of the cell in this column and row, and where it is in that, counted row by row.
    #[inline(always)]
    pub(super) fn in_tile(&self, column: u32, row: u32) -> (usize, usize) {
        let (column, row) = (column as usize, row as usize);
        let tile = row / TILE * self.columns.div_ceil(TILE) + column / TILE;
        (tile, row % TILE * TILE + column % TILE)
    }

    /// The cells of a tile and their places in it.
    pub(super) fn cells_of_tile(&self, tile: usize) -> impl Iterator<Item = (usize, usize)> {
        let across = self.columns.div_ceil(TILE);
        let (column, row) = (tile % across * TILE, tile / across * TILE);
        let columns = column..(column + TILE).min(self.columns);
        let rows = row..(row + TILE).min(self.rows);
        let cells = rows.flat_map(move |row| columns.clone().map(move |column| (column, row)));
        cells.map(|(column, row)| (row * self.columns + column, row % TILE * TILE + column % TILE))
    }

    /// Every point in the first cell of a tile.
    pub(super) fn first_of_tile(&self, tile: usize) -> Rect {
        let across = self.columns.div_ceil(TILE);
        self.rect(tile / across * TILE * self.columns + tile % across * TILE)
    }

    /// Every point in the cells of a tile.
    pub(super) fn tile_rect(&self, tile: usize) -> Rect {
        let across = self.columns.div_ceil(TILE);
        let (column, row) = (tile % across * TILE, tile / across * TILE);
        let last = (column + TILE).min(self.columns) - 1
            + ((row + TILE).min(self.rows) - 1) * self.columns;
        let (low, high) = (self.rect(column + row * self.columns), self.rect(last));
        Rect { low: low.low, high: high.high }
    }

    /// Side of a cell, metres.
    pub(super) fn side(&self) -> f64 {
        f64::from(self.side)
    }

    /// From corner to corner of a cell, metres.
    pub(super) fn diagonal(&self) -> f64 {
        f64::from(self.side) * std::f64::consts::SQRT_2
    }

    /// The cell of each point; [`Self::cells`] for those outside of the grid.
    #[inline(always)]
    pub(super) fn locate<V: Vector>(&self, point: (V, V)) -> V {
        let (cells, ..) = self.locate_in(point);
        cells
    }

    /// The same, and in which column and row it is.
    #[inline(always)]
    pub(super) fn locate_in<V: Vector>(&self, (x, y): (V, V)) -> (V, V, V) {
        let per_metre = V::from(self.per_metre);
        let (columns, rows) = (V::from(self.columns as f32), V::from(self.rows as f32));
        let column = nearest_integer((x - V::from(self.origin[0])) * per_metre);
        let row = nearest_integer((y - V::from(self.origin[1])) * per_metre);
        let zero = V::from(0.0);
        let is_inside = zero.le(column) & column.lt(columns) & zero.le(row) & row.lt(rows);
        let cells = V::select(is_inside, row * columns + column, V::from(self.cells() as f32));
        (cells, column, row)
    }

    /// The middle of a cell.
    #[inline(always)]
    pub(super) fn centre<V: Vector>(&self, column: V, row: V) -> (V, V) {
        let (side, [x, y]) = (V::from(self.side), self.origin);
        (V::from(x) + column * side, V::from(y) + row * side)
    }

    /// Every point that [`Self::locate`] puts in this cell, and a little more.
    pub(super) fn rect(&self, cell: usize) -> Rect {
        let unit = f64::from(f32::EPSILON);
        let side = f64::from(self.side);
        let axis = |axis: usize, index: usize| {
            let origin = f64::from(self.origin[axis]);
            let cells = index as f64;
            // Rounding of the difference, of the side's inverse, of the product, and of the
            // number before it becomes an integer.
            let half = 0.5 * side + 4.0 * unit * (cells + 1.0) * side;
            (origin + cells * side - half, origin + cells * side + half)
        };
        let (column, row) = (cell % self.columns, cell / self.columns);
        let ((x0, x1), (y0, y1)) = (axis(0, column), axis(1, row));
        Rect { low: [x0, y0], high: [x1, y1] }
    }
}

/// Angles in parts of a turn of which there are `PARTS`, up to half a turn to either side.
#[derive(Clone, Copy)]
pub(super) struct Turned<V, const PARTS: u32>(V);

impl<V: Vector, const PARTS: u32> Turned<V, PARTS> {
    /// Angles in radians within ±10; NaN is anywhere.
    #[inline(always)]
    pub(super) fn by(angle: V) -> Self {
        const { assert!(PARTS.is_power_of_two()) };
        let parts = PARTS as f32;
        let turned = angle * V::from(parts / TAU);
        let rest = turned - nearest_integer(turned * V::from(1.0 / parts)) * V::from(parts);
        let is_within = rest.abs().le(V::from(0.5 * parts));
        Self(V::select(is_within, rest, V::from(0.0)))
    }

    /// The place of each angle's part, where places of all parts follow a base. Part 0 has angle 0 in its middle.
    #[inline(always)]
    pub(super) fn places(self, bases: &[u32; MOST_LANES]) -> [u32; MOST_LANES] {
        self.places_beside(0.0, bases)
    }

    /// The same of angles that are so many [parts](parts_of_turn) to the left.
    #[inline(always)]
    pub(super) fn places_beside(self, parts: f32, bases: &[u32; MOST_LANES]) -> [u32; MOST_LANES] {
        (self.0 + V::from(parts)).places_around(PARTS, bases)
    }
}

impl<const PARTS: u32> Turned<f32, PARTS> {
    /// Which part an angle lies in that is so many [parts](parts_of_turn) to the left.
    pub(super) fn part_beside(self, parts: f32) -> u32 {
        self.places_beside(parts, &[0; MOST_LANES])[0]
    }
}

/// An angle in parts of a turn, up to half a turn to either side, radians.
pub(super) fn parts_of_turn(angle: f32, parts: u32) -> f32 {
    let turns = f64::from(angle) / std::f64::consts::TAU;
    ((turns - libm::round(turns)) * f64::from(parts)) as f32
}

/// The nearest integer, for numbers up to 2²²; what is farther out comes out as some other
/// number that far out, and NaN as NaN.
#[inline(always)]
fn nearest_integer<V: Vector>(value: V) -> V {
    (value + V::from(ROUND)) - V::from(ROUND)
}

/// The directions of one of `parts` parts of a turn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arc {
    /// Its middle, radians.
    pub(super) middle: f64,
    /// From its middle to its edge, radians, and the cosine of that.
    pub(super) half: f64,
    pub(super) cos_half: f64,
    /// Its right and its left edge, unit vectors.
    pub(super) edges: [Point; 2],
}

impl Arc {
    /// Every direction that [`Turned::places_beside`] puts in this part, and a little more.
    pub(super) fn new(part: usize, parts: u32) -> Self {
        let whole = std::f64::consts::TAU;
        let middle = part as f64 * whole / f64::from(parts);
        Self::of(middle, 0.5 * whole / f64::from(parts) + TURN_MARGIN)
    }

    /// Every direction of some parts that follow each other, less than half a turn in all.
    pub(super) fn around(parts: &[Self]) -> Self {
        let [first, .., last] = parts else { return parts[0] };
        let middle = 0.5 * (first.middle + last.middle);
        Self::of(middle, last.middle - middle + last.half)
    }

    fn of(middle: f64, half: f64) -> Self {
        let at = |angle: f64| [libm::cos(angle), libm::sin(angle)];
        let edges = [at(middle - half), at(middle + half)];
        Self { middle, half, cos_half: libm::cos(half), edges }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::TAU as TURN;

    const PARTS: u32 = 128;

    fn part(heading: f32, mount: f32) -> u32 {
        Turned::<f32, PARTS>::by(heading).part_beside(parts_of_turn(mount, PARTS))
    }

    /// By how much a direction lies outside of its part, radians; negative inside.
    fn outside(heading: f32, mount: f32) -> f64 {
        let part = part(heading, mount);
        assert!(part < PARTS, "{part} at {heading} and {mount}");
        let Arc { middle, half, .. } = Arc::new(part as usize, PARTS);
        let turns = (f64::from(heading) + f64::from(mount) - middle) / TURN;
        (turns - libm::round(turns)).abs() * TURN - (half - TURN_MARGIN)
    }

    proptest! {
        #[test]
        fn a_direction_lies_in_its_part_but_for_half_the_margin(
            heading in -10.0_f32..10.0,
            mount in -std::f32::consts::PI..=std::f32::consts::PI,
        ) {
            prop_assert!(outside(heading, mount) < 0.5 * TURN_MARGIN);
        }

        #[test]
        fn so_does_one_near_the_edge_of_a_part(
            edge in -128_i16..=128,
            aside in -2.0e-5_f64..2.0e-5,
            mount in -std::f32::consts::PI..=std::f32::consts::PI,
        ) {
            let at = (f64::from(edge) + 0.5) / f64::from(PARTS) * TURN - f64::from(mount);
            prop_assert!(outside((at + aside) as f32, mount) < 0.5 * TURN_MARGIN);
        }
    }

    #[test]
    fn what_is_no_angle_lies_in_some_part() {
        for heading in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX] {
            assert!(part(heading, 1.0) < PARTS, "{heading}");
        }
    }
}

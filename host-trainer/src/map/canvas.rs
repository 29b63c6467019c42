//! Cells being filled from an image, whichever format it has.

use super::error::MapProblem;
use super::shade::{CellRule, Pixel, UNKNOWN};
use super::{MAX_CELLS, MAX_SIDE};

/// A grid of cells under construction; row 0 is the bottom one, as in `OccupancyGrid`.
#[derive(Debug)]
pub(super) struct Canvas {
    width: u32,
    height: u32,
    rule: CellRule,
    cells: Vec<i8>,
    painted: u64,
    /// The pixel before, and its cell: neighbours are mostly alike.
    last: Option<(Pixel, i8)>,
}

impl Canvas {
    /// An empty grid. Refuses absurd sizes before any memory is asked for.
    pub(super) fn new(width: u32, height: u32, rule: CellRule) -> Result<Self, MapProblem> {
        let fits = |side| (1..=MAX_SIDE).contains(&side);
        let count = u64::from(width) * u64::from(height);
        if !fits(width) || !fits(height) || count > MAX_CELLS {
            return Err(MapProblem::Size { width, height });
        }
        let count = usize::try_from(count).map_err(|_| MapProblem::Size { width, height })?;
        let mut cells = Vec::new();
        cells.try_reserve_exact(count).map_err(|_| MapProblem::Memory { bytes: count })?;
        cells.resize(count, UNKNOWN);
        Ok(Self { width, height, rule, cells, painted: 0, last: None })
    }

    /// Sets the cell of one pixel, counted from the top left; outside the grid does nothing.
    pub(super) fn paint(&mut self, x: u32, row: u32, pixel: Pixel) {
        if x >= self.width || row >= self.height {
            return;
        }
        let y = self.height - 1 - row;
        let index = y as usize * self.width as usize + x as usize;
        let cell = match self.last {
            Some((known, cell)) if known == pixel => cell,
            _ => self.rule.cell(pixel),
        };
        self.last = Some((pixel, cell));
        self.cells[index] = cell;
        self.painted += 1;
    }

    /// Columns.
    pub(super) fn width(&self) -> u32 {
        self.width
    }

    /// Rows.
    pub(super) fn height(&self) -> u32 {
        self.height
    }

    /// The finished cells, row by row from the bottom; refuses a grid with gaps.
    pub(super) fn finish(self) -> Result<Vec<i8>, MapProblem> {
        let expected = self.cells.len() as u64;
        if self.painted < expected {
            let found = self.painted;
            return Err(MapProblem::Truncated { found, expected, unit: "pixels" });
        }
        Ok(self.cells)
    }
}

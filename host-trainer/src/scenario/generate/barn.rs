//! A field of cylinders like those of the BARN benchmark (Perille, Truong, Xiao and Stone,
//! SSRR 2020): random cells, smoothed by a cellular automaton.

use super::free_space::FreeSpace;
use super::{Recipe, RecipeError, round};
use crate::scenario::{Circle, Pair, PairSource, Scenario};
use crate::seed::Stream;

/// Edge of a cell, metres, and twice the radius of a cylinder.
const CELL: f32 = 0.15;

/// Rounds of smoothing.
const SMOOTHING: u32 = 2;

/// Fields to try.
const TRIES: u32 = 100;

/// Grows a field between a start at the lower edge and a goal at the upper one.
pub(super) fn grow(scenario: &mut Scenario, recipe: &Recipe) -> Result<(), RecipeError> {
    let [width, height] = scenario.world.bounds.max;
    let start = [round(width / 2.0), round(0.12 * height).max(0.5)];
    let goal = [start[0], round(height - start[1])];
    let columns = (width / CELL) as usize;
    let low = start[1] + 0.5;
    let rows = ((goal[1] - 0.5 - low) / CELL) as usize;
    for attempt in 0..TRIES {
        let field = Field::random(columns, rows, recipe.density, &mut recipe.stream(attempt));
        let mut space = FreeSpace::new([width, height], &scenario.vehicle);
        let cylinders: Vec<Circle> = field
            .edge_cells()
            .map(|[column, row]| {
                let at = |index: usize| ((index as f32 + 0.5) * CELL * 1000.0).round() / 1000.0;
                let y = ((low + at(row)) * 1000.0).round() / 1000.0;
                Circle { centre: [at(column), y], radius: CELL / 2.0 }
            })
            .collect();
        for cylinder in &cylinders {
            space.block_disc(cylinder.centre, cylinder.radius);
        }
        if space.connects(start, goal) {
            scenario.description = format!("a random field of {} cylinders", cylinders.len());
            scenario.world.circles = cylinders;
            let heading = std::f32::consts::FRAC_PI_2;
            let pair = Pair { start: [start[0], start[1], heading], goal };
            scenario.pairs.source = PairSource::Listed(vec![pair]);
            return Ok(());
        }
    }
    Err(RecipeError::Blocked { tries: TRIES })
}

struct Field {
    columns: usize,
    cells: Vec<bool>,
}

impl Field {
    fn random(columns: usize, rows: usize, share: f32, random: &mut Stream) -> Self {
        let cells = (0..columns * rows).map(|_| random.chance(share)).collect();
        let mut field = Self { columns, cells };
        for _ in 0..SMOOTHING {
            // Most neighbours make a cell solid; a cell with few dissolves.
            let smooth = |cell: usize| match field.neighbours(cell) {
                0..3 => false,
                3..5 => field.cells[cell],
                _ => true,
            };
            let cells = (0..field.cells.len()).map(smooth).collect();
            field = Self { columns, cells };
        }
        field
    }

    fn solid(&self, column: Option<usize>, row: Option<usize>) -> bool {
        let (Some(column), Some(row)) = (column, row) else { return false };
        column < self.columns && self.cells.get(row * self.columns + column).is_some_and(|c| *c)
    }

    /// Solid cells among the eight around one.
    fn neighbours(&self, cell: usize) -> usize {
        let (column, row) = (cell % self.columns, cell / self.columns);
        let near = |index: usize| [index.checked_sub(1), Some(index), Some(index + 1)];
        let around = near(row).into_iter().flat_map(|row| {
            near(column).into_iter().filter(move |column| self.solid(*column, row))
        });
        around.count() - usize::from(self.cells[cell])
    }

    /// Solid cells that something free touches: the inside of a lump needs no cylinders.
    fn edge_cells(&self) -> impl Iterator<Item = [usize; 2]> {
        let solid = (0..self.cells.len()).filter(|cell| self.cells[*cell]);
        solid
            .filter(|cell| self.neighbours(*cell) < 8)
            .map(|cell| [cell % self.columns, cell / self.columns])
    }
}

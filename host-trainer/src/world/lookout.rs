//! What one car's beams see and its body touches, from wherever it stands.
//!
//! Positions are divided into cells and headings into sectors. For each pair, the obstacles that
//! the beams can meet and those that the body can touch are found once: those out of range,
//! outside of the fan, or hidden behind others are left out. The rest is tested with the same
//! arithmetic as ever, so distances and contacts are those of a test of all obstacles, to the
//! last bit. One thing is left to rounding: a wall that lies along a beam's line, to the last digit of
//! both, behind the car or out of range; a test of all obstacles may compute it as met.

mod beams;
mod cell;
mod fan;
mod grid;
mod hidden;
mod region;
mod rounding;
mod view;

use super::obstacles::Obstacles;
use crate::vector::Eight;
use beams::Beams;
use cell::{Cell, Choice, Table, table_of_all};
use controller_core::geometry::{Body, Ray};
use controller_core::motion::Pose;
use controller_core::observation::BEAMS;
use grid::Grid;
use std::sync::atomic::{AtomicU32, AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

pub use fan::Fan;

/// Side of a cell, metres.
const CELL: f32 = 0.35;

/// Most cells of a grid; a larger world has larger cells.
const MAX_CELLS: usize = 1 << 26;

/// Cells in a row and rows in a block, which is allocated at the first visit.
const BLOCK: usize = 8;

/// Visits of a cell before it is looked at closely: that costs as much as answering about so many
/// questions without.
const VISITS: u32 = 24;

/// Cells take at most about this much memory; where there is none yet when it is used up, all
/// obstacles are asked.
const MAX_BYTES: usize = 256 << 20;

/// Distances and contacts of one car in one world.
#[derive(Debug)]
pub struct Lookout {
    obstacles: Arc<Obstacles>,
    fan: Fan,
    body: Body<f32>,
    joint: f64,
    table: Option<Table>,
    grid: Grid,
    blocks_per_row: usize,
    blocks: Box<[OnceLock<Box<Block>>]>,
    bytes: AtomicUsize,
    visits: u32,
}

type Block = [Place; BLOCK * BLOCK];

/// Where a cell is kept once it is made.
#[derive(Debug, Default)]
struct Place {
    cell: OnceLock<Box<Cell>>,
    visits: AtomicU32,
}

/// How much the cells of a [`Lookout`] hold.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Survey {
    /// Memory that they take, with the places they are kept in, bytes.
    pub bytes: usize,
    /// Obstacles in sight, for each cell made and each sector, ascending.
    pub seen: Vec<usize>,
    /// Obstacles within the body's reach, likewise.
    pub near: Vec<usize>,
}

impl Lookout {
    /// Prepares for a car with these beams and this body. Costs next to nothing: cells are
    /// looked at where the car turns up.
    pub fn new(obstacles: Arc<Obstacles>, fan: Fan, body: Body<f32>) -> Self {
        let [low, high] = obstacles.bounds();
        let grid = Grid::new(low, high, CELL, MAX_CELLS);
        let blocks_per_row = grid.columns.div_ceil(BLOCK);
        let blocks = blocks_per_row * grid.rows.div_ceil(BLOCK);
        Self {
            joint: f64::from(obstacles.joint(fan.range())),
            table: table_of_all(&obstacles),
            obstacles,
            fan,
            body,
            grid,
            blocks_per_row,
            blocks: (0..blocks).map(|_| OnceLock::new()).collect(),
            bytes: AtomicUsize::new(0),
            visits: VISITS,
        }
    }

    /// The same, but each cell is looked at closely at its first visit: for measurements and
    /// tests.
    #[must_use]
    pub fn eager(self) -> Self {
        Self { visits: 0, ..self }
    }

    /// How far each beam of a car at this pose reaches, metres: the distance to the nearest
    /// obstacle, or infinity if there is none within range.
    ///
    /// The pose's heading, cosine and sine must belong together, as they do in every pose made
    /// by [`Pose::new`] and [`Pose::driven`].
    ///
    /// Inlined into its caller, and as fast as the caller's vectors of eight.
    #[inline(always)]
    pub fn fan<E: Eight>(&self, pose: &Pose<f32>) -> [f32; BEAMS] {
        let Some((cell, sector)) = self.cell(pose) else { return self.fan_of_all(pose) };
        let mut beams = Beams::<E>::new(self.fan.turned(pose));
        match cell.choice(sector) {
            Choice::Named(named) => {
                for edge in named.seen() {
                    beams = beams.wall(edge);
                }
            }
            Choice::Long(view) => {
                for edge in &view.edges {
                    beams = beams.wall(edge);
                }
                for disc in &view.discs {
                    beams = beams.disc(disc);
                }
            }
        }
        let near = beams.nearest(self.fan.range());
        if beams.are_doubtful(cell.slack) {
            return self.settled(pose, near, beams.past(), cell.slack);
        }
        near
    }

    /// Whether the body at this pose touches an obstacle's edge, or lies inside a disc.
    #[inline(always)]
    pub fn touches(&self, pose: &Pose<f32>) -> bool {
        let Some((cell, sector)) = self.cell(pose) else { return self.touches_any(pose) };
        let body = &self.body;
        match cell.choice(sector) {
            Choice::Named(named) => named.near().any(|wall| body.touches_segment(pose, wall)),
            Choice::Long(view) => {
                view.walls_near.iter().any(|wall| body.touches_segment(pose, wall))
                    || view.discs_near.iter().any(|disc| body.touches_disc(pose, disc))
            }
        }
    }

    /// The cells made so far.
    pub fn survey(&self) -> Survey {
        let places = self.blocks.iter().filter_map(OnceLock::get).flat_map(|block| block.iter());
        let counts = places.filter_map(|place| place.cell.get()).flat_map(|cell| cell.counts());
        let (mut seen, mut near): (Vec<_>, Vec<_>) = counts.unzip();
        seen.sort_unstable();
        near.sort_unstable();
        Survey { bytes: self.bytes.load(Ordering::Relaxed), seen, near }
    }

    #[inline(always)]
    fn cell(&self, pose: &Pose<f32>) -> Option<(&Cell, usize)> {
        let (column, row, sector) = self.grid.locate(pose)?;
        let block = self.blocks.get(row / BLOCK * self.blocks_per_row + column / BLOCK)?.get();
        let index = row % BLOCK * BLOCK + column % BLOCK;
        let cell = match block.and_then(|block| block[index].cell.get()) {
            Some(cell) => cell,
            None => self.visit(column, row)?,
        };
        Some((cell, sector))
    }

    /// Counts a visit; makes the cell when there have been enough.
    #[cold]
    #[inline(never)]
    fn visit(&self, column: usize, row: usize) -> Option<&Cell> {
        let block =
            self.blocks[row / BLOCK * self.blocks_per_row + column / BLOCK].get_or_init(|| {
                self.bytes.fetch_add(size_of::<Block>(), Ordering::Relaxed);
                Box::new(std::array::from_fn(|_| Place::default()))
            });
        let place = &block[row % BLOCK * BLOCK + column % BLOCK];
        let visits = place.visits.fetch_add(1, Ordering::Relaxed);
        if visits < self.visits || self.bytes.load(Ordering::Relaxed) > MAX_BYTES {
            return None;
        }
        Some(place.cell.get_or_init(|| {
            let regions = self.grid.regions(column, row);
            let Self { obstacles, fan, body, joint, table, .. } = self;
            let cell = Cell::new(obstacles, &regions, fan, body, *joint, table.as_ref());
            self.bytes.fetch_add(cell.bytes(table.is_some()), Ordering::Relaxed);
            Box::new(cell)
        }))
    }

    /// Asks all obstacles about the beams in doubt.
    #[cold]
    #[inline(never)]
    fn settled(
        &self,
        pose: &Pose<f32>,
        mut near: [f32; BEAMS],
        past: [f32; BEAMS],
        slack: f32,
    ) -> [f32; BEAMS] {
        let rays = self.fan.rays(pose);
        for ((near, past), ray) in near.iter_mut().zip(past).zip(&rays) {
            if past <= slack {
                *near = self.nearest_of_all(ray);
            }
        }
        near
    }

    #[cold]
    #[inline(never)]
    fn fan_of_all(&self, pose: &Pose<f32>) -> [f32; BEAMS] {
        self.fan.rays(pose).map(|ray| self.nearest_of_all(&ray))
    }

    fn nearest_of_all(&self, ray: &Ray<f32>) -> f32 {
        let range = self.fan.range();
        let distance = self.obstacles.distance(ray, range);
        if distance <= range { distance } else { f32::INFINITY }
    }

    #[cold]
    #[inline(never)]
    fn touches_any(&self, pose: &Pose<f32>) -> bool {
        self.obstacles.touch(&self.body, pose)
    }
}

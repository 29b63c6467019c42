//! What beams from one cell can meet in each direction, and what a body there can touch.

use super::candidate;
use super::cone::Cone;
use super::grid::Arc;
use super::reach::Reach;
use super::rounding::{Limits, Rounding};
use crate::world::Obstacles;
use crate::world::shape::Rect;
use controller_core::geometry::Body;

/// Parts of a turn for beams; a power of two.
pub(super) const BINS: u32 = 128;

/// Bins that are looked at together first.
const TOGETHER: usize = 8;

/// Parts of a turn for headings; a power of two.
pub(super) const SECTORS: u32 = 32;

/// What does not change from cell to cell.
#[derive(Debug)]
pub(super) struct Surroundings {
    pub(super) range: f32,
    pub(super) body: Body<f32>,
    pub(super) limits: Limits,
    bins: Box<[Arc]>,
    sectors: Box<[Arc]>,
}

impl Surroundings {
    pub(super) fn new(range: f32, body: Body<f32>, limits: Limits) -> Self {
        let arcs = |parts: u32| (0..parts as usize).map(|part| Arc::new(part, parts)).collect();
        Self { range, body, limits, bins: arcs(BINS), sectors: arcs(SECTORS) }
    }

    /// Calls `f` for each bin with the places of the obstacles that a beam from the cell may meet
    /// first, and whether what is left out stands behind walls that meet.
    pub(super) fn seen(
        &self,
        obstacles: &Obstacles,
        cell: &Rect,
        mut f: impl FnMut(u32, &[u32], bool),
    ) {
        let candidates = candidate::all(obstacles, cell, self.range, &self.limits);
        let (mut around, mut met, mut places) = (Vec::new(), Vec::new(), Vec::new());
        for (few, first) in self.bins.chunks(TOGETHER).zip((0..).step_by(TOGETHER)) {
            let all = Arc::around(few);
            around.clear();
            around.extend(candidates.iter().filter(|candidate| candidate.is_met(&all)));
            let joined_in_all = match around.len() {
                0 | 1 => Vec::new(),
                _ => Cone::new(cell, &all, &self.limits).keep_in_sight(&mut around),
            };
            for (bin, arc) in (first..).zip(few) {
                met.clear();
                met.extend(around.iter().filter(|candidate| candidate.is_met(arc)));
                let mut joint = !joined_in_all.is_empty();
                if met.len() > 1 {
                    let cone = Cone::new(cell, arc, &self.limits);
                    let joined = cone.keep_in_sight(&mut met);
                    let is_joined = |id| joined.contains(&id) || joined_in_all.contains(&id);
                    let any_in_shade = cone.leave_out_shaded(&mut met, is_joined);
                    joint |= !joined.is_empty() || any_in_shade;
                }
                places.clear();
                places.extend(met.iter().map(|candidate| candidate.id));
                f(bin, &places, joint);
            }
        }
    }

    /// Calls `f` for each sector with the places of the obstacles that the body may touch.
    pub(super) fn near(&self, obstacles: &Obstacles, cell: &Rect, mut f: impl FnMut(u32, &[u32])) {
        let around = Reach::new(*cell, &self.sectors[0], &self.body).around();
        let mut close = Vec::new();
        obstacles.each_near(&around, 0.0, |id, shape| {
            let margin = Rounding::new(&shape, &around).contact();
            if shape.distance(&around) <= margin {
                close.push((id, shape, margin));
            }
        });
        let mut places = Vec::new();
        for (sector, headings) in (0..).zip(&self.sectors) {
            places.clear();
            if !close.is_empty() {
                let reach = Reach::new(*cell, headings, &self.body);
                let near = close.iter().filter(|(_, shape, margin)| reach.meets(shape, *margin));
                places.extend(near.map(|(id, ..)| *id));
            }
            f(sector, &places);
        }
    }
}

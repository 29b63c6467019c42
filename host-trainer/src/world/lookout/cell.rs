//! What beams from one cell can meet in each direction, and what a body there can touch.

use super::candidate::{self, Candidate};
use super::cone::{Cone, Hidden};
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

/// What beams from a cell in one bin may meet, by places in the world.
pub(super) struct Sight<'a> {
    /// What they may meet first.
    pub(super) first: &'a [u32],
    /// That, and what stands in its shade.
    pub(super) all: &'a [u32],
    /// No distance to anything else is computed as less than this, metres.
    pub(super) beyond: f32,
    /// Whether what is not among the first stands behind walls that meet, or discs that touch.
    pub(super) joint: bool,
}

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

    /// Calls `f` for each bin with what a beam from the cell may meet first.
    pub(super) fn seen(
        &self,
        obstacles: &Obstacles,
        cell: &Rect,
        mut f: impl FnMut(u32, &Sight<'_>),
    ) {
        let candidates = candidate::all(obstacles, cell, self.range, &self.limits);
        let mut nearest_first: Vec<&Candidate> = candidates.iter().collect();
        nearest_first
            .sort_unstable_by(|a, b| a.distance.total_cmp(&b.distance).then(a.id.cmp(&b.id)));
        let (mut around, mut met, mut walked) = (Vec::new(), Vec::new(), Vec::new());
        let (mut in_sight, mut in_light) = (Vec::new(), Vec::new());
        let write = |places: &mut Vec<u32>, met: &[&Candidate]| {
            places.clear();
            places.extend(met.iter().map(|candidate| candidate.id));
        };
        for (few, first) in self.bins.chunks(TOGETHER).zip((0..).step_by(TOGETHER)) {
            let all = Arc::around(few);
            around.clear();
            around.extend(nearest_first.iter().filter(|candidate| candidate.is_met(&all)));
            let hidden_in_all = match around.len() {
                0 | 1 => Hidden::nothing(),
                _ => Cone::new(cell, &all, &self.limits).keep_in_sight(&mut around, &mut walked),
            };
            for (bin, arc) in (first..).zip(few) {
                met.clear();
                met.extend(around.iter().filter(|candidate| candidate.is_met(arc)));
                let cone = Cone::new(cell, arc, &self.limits);
                let hidden = match met.len() {
                    0 | 1 => Hidden::nothing(),
                    _ => cone.keep_in_sight(&mut met, &mut walked),
                };
                write(&mut in_sight, &met);
                let joined = || hidden.joined.iter().chain(&hidden_in_all.joined);
                let any_in_shade =
                    cone.leave_out_shaded(&mut met, |id| joined().any(|joined| *joined == id));
                write(&mut in_light, &met);
                let beyond = hidden.beyond.min(hidden_in_all.beyond) as f32;
                let joint = any_in_shade || joined().next().is_some();
                f(bin, &Sight { first: &in_light, all: &in_sight, beyond, joint });
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

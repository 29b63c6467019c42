//! Obstacles to see and to touch that are too many, or too round, for a short record.

use super::beams::Edge;
use crate::world::Obstacles;
use controller_core::geometry::{Disc, Segment};

/// Copies of the obstacles.
#[derive(Debug)]
pub(super) struct View {
    /// What beams can meet.
    pub(super) edges: Box<[Edge]>,
    pub(super) discs: Box<[Disc<f32>]>,
    /// What the body can touch.
    pub(super) walls_near: Box<[Segment<f32>]>,
    pub(super) discs_near: Box<[Disc<f32>]>,
}

impl View {
    /// Obstacles by their places.
    pub(super) fn new(obstacles: &Obstacles, seen: &[u32], near: &[u32]) -> Self {
        let count = obstacles.walls().len();
        let split = |places: &[u32]| -> (Vec<usize>, Vec<usize>) {
            places.iter().map(|place| *place as usize).partition(|place| *place < count)
        };
        let wall = |place: usize| obstacles.walls()[place];
        let disc = |place: usize| obstacles.discs()[place - count];
        let (walls, discs) = split(seen);
        let (walls_near, discs_near) = split(near);
        Self {
            edges: walls.into_iter().map(|place| Edge::from(&wall(place))).collect(),
            discs: discs.into_iter().map(disc).collect(),
            walls_near: walls_near.into_iter().map(wall).collect(),
            discs_near: discs_near.into_iter().map(disc).collect(),
        }
    }

    /// How many obstacles are seen, and how many are near.
    pub(super) fn counts(&self) -> (usize, usize) {
        let Self { edges, discs, walls_near, discs_near } = self;
        (edges.len() + discs.len(), walls_near.len() + discs_near.len())
    }

    /// Bytes it takes, all told.
    pub(super) fn bytes(&self) -> usize {
        let Self { edges, discs, walls_near, discs_near } = self;
        size_of::<Self>()
            + size_of_val(&**edges)
            + size_of_val(&**discs)
            + size_of_val(&**walls_near)
            + size_of_val(&**discs_near)
    }
}

//! From a scenario's shapes to walls, discs and solid insides.

use super::{CORNER_OVERLAP, Solid, World};
use crate::map::{self, MapError};
use crate::scenario::{Scenario, Wall, WorldSpec};
use controller_core::geometry::{Disc, Segment};
use parry2d::math::Vector;
use std::fmt;

/// Why a scenario has no world.
#[derive(Debug)]
pub enum WorldError {
    /// Its map cannot be read.
    Map(MapError),
}

impl fmt::Display for WorldError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Map(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for WorldError {}

impl From<WorldError> for crate::failure::Failure {
    fn from(error: WorldError) -> Self {
        match error {
            WorldError::Map(error) => error.into(),
        }
    }
}

impl World {
    /// Builds the scenario's world, reading its map if it has one.
    ///
    /// # Errors
    ///
    /// A map that cannot be read.
    pub fn new(scenario: &Scenario) -> Result<Self, WorldError> {
        let spec = &scenario.world;
        let mut parts = Parts::default();
        if spec.outer_wall {
            let [x0, y0] = spec.bounds.min;
            let [x1, y1] = spec.bounds.max;
            parts.loop_of(&[[x0, y0], [x1, y0], [x1, y1], [x0, y1]]);
        }
        parts.shapes(spec);
        if let Some(map_spec) = &spec.map {
            let map = map::load(&map_spec.yaml).map_err(WorldError::Map)?;
            let (unknown_is_obstacle, lethal) = (map_spec.unknown_is_obstacle, map_spec.lethal);
            for [a, b] in map::trace(&map, unknown_is_obstacle, lethal) {
                parts.sheet(a, b);
            }
            parts.solids.push(Solid::Map { map: Box::new(map), unknown_is_obstacle, lethal });
        }
        Ok(Self {
            bounds: spec.bounds,
            target_radius: spec.target_radius,
            walls: super::Walls::new(parts.segments),
            discs: parts.discs,
            solids: parts.solids,
            sheets: parts.sheets,
        })
    }
}

#[derive(Default)]
struct Parts {
    segments: Vec<Segment<f32>>,
    discs: Vec<Disc<f32>>,
    solids: Vec<Solid>,
    sheets: Vec<[f32; 4]>,
}

impl Parts {
    fn shapes(&mut self, spec: &WorldSpec) {
        for [x0, y0, x1, y1] in &spec.boxes {
            self.polygon(&[[*x0, *y0], [*x1, *y0], [*x1, *y1], [*x0, *y1]]);
        }
        for corners in &spec.polygons {
            self.polygon(corners);
        }
        for circle in &spec.circles {
            let [x, y] = circle.centre;
            self.discs.push(Disc { centre: (x, y), radius: circle.radius });
        }
        for wall in &spec.walls {
            self.wall(wall);
        }
    }

    fn polygon(&mut self, corners: &[[f32; 2]]) {
        self.loop_of(corners);
        let corners = corners.iter().map(|[x, y]| Vector::new(*x, *y)).collect();
        self.solids.push(Solid::Polygon(corners));
    }

    fn loop_of(&mut self, corners: &[[f32; 2]]) {
        for (i, corner) in corners.iter().enumerate() {
            self.line(*corner, corners[(i + 1) % corners.len()]);
        }
    }

    /// A thick wall is a rectangle per piece and a disc at each inner joint, so that a bend has
    /// no notch on its outside.
    fn wall(&mut self, wall: &Wall) {
        let half = wall.thickness * 0.5;
        for piece in wall.points.windows(2) {
            let ([ax, ay], [bx, by]) = (piece[0], piece[1]);
            if half == 0.0 {
                self.sheet(piece[0], piece[1]);
                continue;
            }
            let (dx, dy) = (bx - ax, by - ay);
            let scale = half / (dx * dx + dy * dy).sqrt();
            let (nx, ny) = (-dy * scale, dx * scale);
            self.polygon(&[
                [ax + nx, ay + ny],
                [ax - nx, ay - ny],
                [bx - nx, by - ny],
                [bx + nx, by + ny],
            ]);
        }
        if half > 0.0 {
            let joints = wall.points.iter().skip(1).take(wall.points.len().saturating_sub(2));
            self.discs.extend(joints.map(|[x, y]| Disc { centre: (*x, *y), radius: half }));
        }
    }

    fn sheet(&mut self, a: [f32; 2], b: [f32; 2]) {
        self.sheets.push([a[0], a[1], b[0], b[1]]);
        self.line(a, b);
    }

    /// One wall, lengthened at both ends by [`CORNER_OVERLAP`], or by a few units in the last
    /// place where coordinates are so large that the overlap would round away.
    fn line(&mut self, [ax, ay]: [f32; 2], [bx, by]: [f32; 2]) {
        let (dx, dy) = (bx - ax, by - ay);
        let length = (dx * dx + dy * dy).sqrt();
        let largest = [ax, ay, bx, by].into_iter().map(f32::abs).fold(1.0, f32::max);
        let overlap = CORNER_OVERLAP.max(8.0 * f32::EPSILON * largest);
        let (ux, uy) = (dx / length * overlap, dy / length * overlap);
        self.segments.push(Segment { a: (ax - ux, ay - uy), b: (bx + ux, by + uy) });
    }
}

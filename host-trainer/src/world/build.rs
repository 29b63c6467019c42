//! From a scenario's shapes to walls, discs and solid insides.

use super::{CORNER_OVERLAP, Solid, World};
use crate::map::{self, MapError};
use crate::scenario::{Scenario, Wall, WorldSpec};
use controller_core::geometry::{Disc, Segment};
use parry2d::math::Vector;
use std::fmt;
use std::path::PathBuf;
use std::sync::Arc;

/// Most straight pieces of a map's outline. A clean map of a building has thousands.
pub const MAX_OUTLINE: usize = 1 << 20;

/// Why a scenario has no world.
#[derive(Debug)]
pub enum WorldError {
    /// Its map cannot be read.
    Map(MapError),
    /// Its map's outline has more than [`MAX_OUTLINE`] straight pieces.
    TooRough {
        /// The map's YAML file.
        yaml: PathBuf,
    },
}

impl fmt::Display for WorldError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Map(error) => error.fmt(f),
            Self::TooRough { yaml } => write!(
                f,
                "{}: the outline of the map's obstacles has more than {MAX_OUTLINE} straight \
                 pieces, expected fewer: remove the noise, coarsen the map or crop it",
                yaml.display()
            ),
        }
    }
}

impl std::error::Error for WorldError {}

impl From<WorldError> for crate::failure::Failure {
    fn from(error: WorldError) -> Self {
        match error {
            WorldError::Map(error) => error.into(),
            WorldError::TooRough { .. } => Self::bad_input(error.to_string()),
        }
    }
}

impl World {
    /// Builds the scenario's world, reading its map if it has one.
    ///
    /// # Errors
    ///
    /// A map that cannot be read, or whose outline is too rough to drive in.
    pub fn new(scenario: &Scenario) -> Result<Self, WorldError> {
        let spec = &scenario.world;
        let mut parts = Parts { range: scenario.sensors.range, ..Parts::default() };
        if spec.outer_wall {
            let [x0, y0] = spec.bounds.min;
            let [x1, y1] = spec.bounds.max;
            parts.loop_of(&[[x0, y0], [x1, y0], [x1, y1], [x0, y1]]);
        }
        parts.shapes(spec);
        if let Some(map_spec) = &spec.map {
            let map = map::load(&map_spec.yaml).map_err(WorldError::Map)?;
            let (unknown_is_obstacle, lethal) = (map_spec.unknown_is_obstacle, map_spec.lethal);
            let outline = map::trace_within(&map, unknown_is_obstacle, lethal, MAX_OUTLINE);
            let too_rough = || WorldError::TooRough { yaml: map_spec.yaml.clone() };
            for [a, b] in outline.ok_or_else(too_rough)? {
                parts.line(a, b);
            }
            parts.solids.push(Solid::Map { map: Box::new(map), unknown_is_obstacle, lethal });
        }
        Ok(Self {
            bounds: spec.bounds,
            target_radius: spec.target_radius,
            obstacles: Arc::new(super::Obstacles::new(parts.segments, parts.discs)),
            solids: parts.solids,
            sheets: parts.sheets,
        })
    }
}

#[derive(Default)]
struct Parts {
    /// How far beams reach, metres.
    range: f32,
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
            let length = (dx * dx + dy * dy).sqrt();
            if length == 0.0 {
                continue;
            }
            let scale = half / length;
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

    /// One wall, lengthened at both ends by [`CORNER_OVERLAP`], or by some units in the last
    /// place of the coordinates and distances met there, where that is more.
    ///
    /// A wall so short that its length rounds to zero is left out: nothing passes between the
    /// walls that meet in it.
    fn line(&mut self, [ax, ay]: [f32; 2], [bx, by]: [f32; 2]) {
        let (dx, dy) = (bx - ax, by - ay);
        let length = (dx * dx + dy * dy).sqrt();
        if length == 0.0 {
            return;
        }
        let largest = [ax, ay, bx, by].into_iter().map(f32::abs).fold(self.range, f32::max);
        let overlap = CORNER_OVERLAP.max(8.0 * f32::EPSILON * largest);
        let (ux, uy) = (dx / length * overlap, dy / length * overlap);
        self.segments.push(Segment { a: (ax - ux, ay - uy), b: (bx + ux, by + uy) });
    }
}

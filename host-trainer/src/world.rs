//! The scenario's obstacles as the simulated car meets them.
//!
//! Everything solid becomes straight walls and discs. The tests that decide a drive are the
//! generic ones in [`controller_core::geometry`]; `parry2d` supplies the tree that finds
//! which walls to test in a large world, and the oracle that the tests compare with.

mod build;
pub mod check;
pub mod free_space;
mod lookout;
mod obstacles;
mod packs;
mod shape;

use crate::map;
use crate::scenario::Bounds;
use controller_core::geometry::{Body, Disc, Ray, Segment};
use controller_core::motion::Pose;
use parry2d::math::Vector;
use parry2d::utils::point_in_poly2d;
use std::sync::Arc;

pub use build::{MAX_OUTLINE, WorldError};
pub use lookout::{Cells, Fan, Glance, Lookout, Rays, Survey};
pub use obstacles::Obstacles;

/// Walls are lengthened by this much at both ends, metres, so that a beam aimed exactly at a
/// corner cannot slip between the two walls that meet there.
///
/// Of 20,000 beams aimed at the corners of polygons 70 pass without it, none with it.
pub const CORNER_OVERLAP: f32 = 1.0e-5;

/// Obstacles, ready for beams and bodies.
#[derive(Debug)]
pub struct World {
    /// The room; starts and goals are drawn inside it.
    pub bounds: Bounds,
    /// Radius of the target disc, metres.
    pub target_radius: f32,
    obstacles: Arc<Obstacles>,
    solids: Vec<Solid>,
    sheets: Vec<[f32; 4]>,
}

/// The inside of an obstacle, where its walls are out of a beam's sight.
#[derive(Debug)]
enum Solid {
    Polygon(Vec<Vector>),
    Map { map: Box<map::OccupancyMap>, unknown_is_obstacle: bool, lethal: u8 },
}

impl World {
    /// Distance along the ray to the nearest obstacle, metres; infinity, or anything past
    /// `range`, if there is none within it.
    #[inline]
    pub fn distance(&self, ray: &Ray<f32>, range: f32) -> f32 {
        self.obstacles.distance(ray, range)
    }

    /// Whether the body at this pose touches an obstacle's edge.
    #[inline]
    pub fn touches(&self, body: &Body<f32>, pose: &Pose<f32>) -> bool {
        self.obstacles.touch(body, pose)
    }

    /// The world as cars with beams of this range and with this body see and touch it: quicker
    /// than [`Self::distance`] and [`Self::touches`], with the same bits.
    pub fn lookout(&self, range: f32, body: Body<f32>) -> Lookout {
        self.lookout_in(Cells::Fine, range, body)
    }

    /// The same, by cells of this kind.
    pub fn lookout_in(&self, cells: Cells, range: f32, body: Body<f32>) -> Lookout {
        Lookout::new(Arc::clone(&self.obstacles), range, body, cells)
    }

    /// Whether an obstacle's edge lies between two points.
    pub fn separates(&self, from: [f32; 2], to: [f32; 2]) -> bool {
        let length = distance(from, to);
        if length == 0.0 {
            return false;
        }
        let direction = ((to[0] - from[0]) / length, (to[1] - from[1]) / length);
        let ray = Ray { origin: (from[0], from[1]), direction };
        self.distance(&ray, length) <= length
    }

    /// Whether a body at this pose overlaps an obstacle, edge or inside.
    pub fn blocks(&self, body: &Body<f32>, pose: &Pose<f32>) -> bool {
        let middle = pose.to_world((body.front + body.rear) * 0.5, 0.0);
        self.touches(body, pose) || self.is_inside_obstacle([middle.0, middle.1])
    }

    /// Whether a disc overlaps an obstacle, edge or inside.
    pub fn blocks_disc(&self, centre: [f32; 2], radius: f32) -> bool {
        self.clearance(centre, radius) < radius || self.is_inside_obstacle(centre)
    }

    /// Distance from a point to the nearest obstacle's edge, metres; not looked for beyond
    /// `most`, which is then the answer.
    pub fn clearance(&self, point: [f32; 2], most: f32) -> f32 {
        self.obstacles.clearance(point, most)
    }

    /// Whether a point lies inside something solid.
    pub fn is_inside_obstacle(&self, point: [f32; 2]) -> bool {
        let in_disc =
            |disc: &Disc<f32>| distance([disc.centre.0, disc.centre.1], point) <= disc.radius;
        self.discs().iter().any(in_disc) || self.solids.iter().any(|solid| solid.contains(point))
    }

    /// Every wall, lengthened by [`CORNER_OVERLAP`].
    pub fn segments(&self) -> &[Segment<f32>] {
        self.obstacles.walls()
    }

    /// Every solid polygon: boxes, polygons and the pieces of thick walls.
    pub fn polygons(&self) -> Vec<Vec<[f32; 2]>> {
        let corners = |solid: &Solid| match solid {
            Solid::Polygon(corners) => Some(corners.iter().map(|c| [c.x, c.y]).collect()),
            Solid::Map { .. } => None,
        };
        self.solids.iter().filter_map(corners).collect()
    }

    /// Every wall without an inside, as `[x0, y0, x1, y1]`.
    pub fn sheets(&self) -> &[[f32; 4]] {
        &self.sheets
    }

    /// Closed loops around the solid cells of the map; a point lies in one by the even-odd rule.
    pub fn outlines(&self) -> Vec<Vec<[f32; 2]>> {
        let outline = |solid: &Solid| match solid {
            Solid::Polygon(_) => Vec::new(),
            Solid::Map { map, unknown_is_obstacle, lethal } => {
                map::loops(&map::trace(map, *unknown_is_obstacle, *lethal))
            }
        };
        self.solids.iter().flat_map(outline).collect()
    }

    /// Every disc.
    pub fn discs(&self) -> &[Disc<f32>] {
        self.obstacles.discs()
    }
}

impl Solid {
    fn contains(&self, [x, y]: [f32; 2]) -> bool {
        match self {
            Self::Polygon(corners) => point_in_poly2d(Vector::new(x, y), corners),
            Self::Map { map, unknown_is_obstacle, lethal } => {
                map.cell_at([x, y]).is_some_and(|(column, row)| {
                    map.is_obstacle(column, row, *unknown_is_obstacle, *lethal)
                })
            }
        }
    }
}

/// Distance between two points, metres; the square root is exact, so bits agree everywhere.
pub fn distance(a: [f32; 2], b: [f32; 2]) -> f32 {
    let (dx, dy) = (a[0] - b[0], a[1] - b[1]);
    (dx * dx + dy * dy).sqrt()
}

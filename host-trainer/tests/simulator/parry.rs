//! The same obstacles in parry2d, the oracle.

use controller_core::geometry::{Body, Disc, Ray, Segment};
use controller_core::motion;
use host_trainer::world::World;
use parry2d::math::{Pose, Vector};
use parry2d::query::{self, RayCast};
use parry2d::shape::{Ball, Compound, Cuboid, SharedShape};

/// A hit in the oracle's eyes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hit {
    /// Metres along the ray.
    pub(crate) distance: f32,
    /// Sine of the angle between ray and surface.
    pub(crate) incidence: f32,
}

/// A world's walls and discs as parry's compound shape.
pub(crate) fn compound(world: &World) -> Compound {
    let walls = world.segments().iter().map(|wall| {
        let ((ax, ay), (bx, by)) = (wall.a, wall.b);
        (Pose::IDENTITY, SharedShape::segment(Vector::new(ax, ay), Vector::new(bx, by)))
    });
    let discs = world.discs().iter().map(|disc| {
        (Pose::translation(disc.centre.0, disc.centre.1), SharedShape::ball(disc.radius))
    });
    Compound::new(walls.chain(discs).collect())
}

/// The nearest hit on any shape within `range`.
pub(crate) fn cast(shape: &dyn RayCast, at: &Pose, ray: &Ray<f32>, range: f32) -> Option<Hit> {
    let direction = Vector::new(ray.direction.0, ray.direction.1);
    let beam = query::Ray::new(Vector::new(ray.origin.0, ray.origin.1), direction);
    let hit = shape.cast_ray_and_get_normal(at, &beam, range, false)?;
    let incidence = direction.dot(hit.normal).abs();
    Some(Hit { distance: hit.time_of_impact, incidence })
}

/// The nearest hit on a disc within `range`.
pub(crate) fn cast_at_disc(disc: &Disc<f32>, ray: &Ray<f32>, range: f32) -> Option<Hit> {
    let at = Pose::translation(disc.centre.0, disc.centre.1);
    cast(&Ball::new(disc.radius), &at, ray, range)
}

/// Whether the body touches a wall. Takes up to 0.3 mm apart for touching in one of ten thousand
/// cases.
pub(crate) fn touches_wall(
    body: &Body<f32>,
    pose: &motion::Pose<f32>,
    wall: &Segment<f32>,
) -> bool {
    let (a, b) = (Vector::new(wall.a.0, wall.a.1), Vector::new(wall.b.0, wall.b.1));
    touches(body, pose, &parry2d::shape::Segment::new(a, b), Pose::IDENTITY, 0.0)
}

/// Whether the body, grown by `more` on every side, touches a disc.
pub(crate) fn touches_disc(
    body: &Body<f32>,
    pose: &motion::Pose<f32>,
    disc: &Disc<f32>,
    more: f32,
) -> bool {
    let at = Pose::translation(disc.centre.0, disc.centre.1);
    touches(body, pose, &Ball::new(disc.radius), at, more)
}

fn touches(
    body: &Body<f32>,
    pose: &motion::Pose<f32>,
    shape: &dyn parry2d::shape::Shape,
    at: Pose,
    more: f32,
) -> bool {
    let half_length = (body.front - body.rear) * 0.5;
    let cuboid = Cuboid::new(Vector::new(half_length + more, body.half_width + more));
    let middle = (body.front + body.rear) * 0.5;
    let forward = Vector::new(libm::cosf(pose.heading), libm::sinf(pose.heading));
    let body_at = Pose::new(Vector::new(pose.x, pose.y) + forward * middle, pose.heading);
    query::intersection_test(&body_at, &cuboid, &at, shape).unwrap().intersecting
}

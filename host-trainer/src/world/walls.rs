//! Many walls, one question: which is the nearest along this beam, does any touch this body?
//!
//! A small world tests all walls, eight side by side. A large one asks parry's bounding-volume
//! tree which walls to test. Both answer with the same bits, since each wall's distance comes
//! from the same arithmetic and the nearest is a plain minimum.

use controller_core::geometry::{Body, Ray, Segment};
use controller_core::lane::{Lane, Lanes};
use controller_core::motion::Pose;
use parry2d::bounding_volume::Aabb;
use parry2d::math::Vector;
use parry2d::partitioning::{Bvh, BvhBuildStrategy};

/// Walls tested side by side.
const WIDTH: usize = 8;

/// Above this many walls the tree is faster than testing them all.
const TREE_FROM: usize = 96;

/// Boxes in the tree are this much larger than their walls, metres, so that rounding in the
/// tree's own arithmetic never hides a wall.
const MARGIN: f32 = 1.0e-3;

/// Where a lane without a wall keeps its point: far outside every world.
const NOWHERE: f32 = 1.0e9;

/// The walls of a world.
#[derive(Debug)]
pub struct Walls {
    segments: Vec<Segment<f32>>,
    packs: Vec<Segment<Lanes<WIDTH>>>,
    tree: Option<Bvh>,
}

impl Walls {
    /// Walls in any order.
    pub fn new(segments: Vec<Segment<f32>>) -> Self {
        let tree = (segments.len() > TREE_FROM).then(|| {
            let boxes: Vec<Aabb> = segments.iter().map(bounding_box).collect();
            Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes)
        });
        let packs = if tree.is_some() { Vec::new() } else { pack(&segments) };
        Self { segments, packs, tree }
    }

    /// Every wall.
    pub fn segments(&self) -> &[Segment<f32>] {
        &self.segments
    }

    /// Distance to the nearest wall along the ray, or infinity if there is none within `range`.
    #[inline]
    pub fn distance(&self, ray: &Ray<f32>, range: f32) -> f32 {
        match &self.tree {
            None => self.distance_by_packs(ray),
            Some(tree) => self.distance_by_tree(tree, ray, range),
        }
    }

    #[inline]
    fn distance_by_packs(&self, ray: &Ray<f32>) -> f32 {
        let splat = |(x, y): (f32, f32)| (Lanes::from(x), Lanes::from(y));
        let wide = Ray { origin: splat(ray.origin), direction: splat(ray.direction) };
        let mut nearest = Lanes::from(f32::INFINITY);
        for pack in &self.packs {
            nearest = wide.to_segment(pack).min(nearest);
        }
        nearest.0.into_iter().fold(f32::INFINITY, |a, b| if b < a { b } else { a })
    }

    fn distance_by_tree(&self, tree: &Bvh, ray: &Ray<f32>, range: f32) -> f32 {
        let beam = parry2d::query::Ray::new(
            Vector::new(ray.origin.0, ray.origin.1),
            Vector::new(ray.direction.0, ray.direction.1),
        );
        let test = |wall: u32, _: f32| {
            let distance = ray.to_segment(&self.segments[wall as usize]);
            distance.is_finite().then_some(distance)
        };
        // parry drops a hit exactly at the limit; a wall exactly at `range` is a hit for us.
        let limit = range.next_up() + MARGIN;
        tree.cast_ray(&beam, limit, test).map_or(f32::INFINITY, |(_, distance)| distance)
    }

    /// Whether the body at this pose touches a wall.
    #[inline]
    pub fn touch(&self, body: &Body<f32>, pose: &Pose<f32>) -> bool {
        match &self.tree {
            None => self.touch_by_packs(body, pose),
            Some(tree) => tree
                .intersect_aabb(&body_box(body, pose))
                .any(|wall| body.touches_segment(pose, &self.segments[wall as usize])),
        }
    }

    #[inline]
    fn touch_by_packs(&self, body: &Body<f32>, pose: &Pose<f32>) -> bool {
        let body = Body {
            rear: Lanes::from(body.rear),
            front: Lanes::from(body.front),
            half_width: Lanes::from(body.half_width),
        };
        let pose = Pose {
            x: Lanes::from(pose.x),
            y: Lanes::from(pose.y),
            heading: Lanes::from(pose.heading),
            cos: Lanes::from(pose.cos),
            sin: Lanes::from(pose.sin),
        };
        self.packs.iter().any(|pack| body.touches_segment(&pose, pack).0.contains(&true))
    }

    /// Distance from a point to the nearest wall, at most `most`.
    pub fn clearance(&self, point: [f32; 2], most: f32) -> f32 {
        match &self.tree {
            None => self.segments.iter().fold(most, |near, wall| near.min(away(wall, point))),
            Some(tree) => {
                let [x, y] = point;
                let around =
                    Aabb::new(Vector::new(x - most, y - most), Vector::new(x + most, y + most));
                tree.intersect_aabb(&around)
                    .fold(most, |near, wall| near.min(away(&self.segments[wall as usize], point)))
            }
        }
    }
}

/// Distance from a point to a wall.
pub(super) fn away(wall: &Segment<f32>, [x, y]: [f32; 2]) -> f32 {
    use parry2d::query::PointQuery;
    let (a, b) = (Vector::new(wall.a.0, wall.a.1), Vector::new(wall.b.0, wall.b.1));
    parry2d::shape::Segment::new(a, b).distance_to_local_point(Vector::new(x, y), true)
}

fn bounding_box(wall: &Segment<f32>) -> Aabb {
    let ((ax, ay), (bx, by)) = (wall.a, wall.b);
    Aabb::new(
        Vector::new(ax.min(bx) - MARGIN, ay.min(by) - MARGIN),
        Vector::new(ax.max(bx) + MARGIN, ay.max(by) + MARGIN),
    )
}

fn body_box(body: &Body<f32>, pose: &Pose<f32>) -> Aabb {
    let corners = [
        pose.to_world(body.front, body.half_width),
        pose.to_world(body.front, -body.half_width),
        pose.to_world(body.rear, body.half_width),
        pose.to_world(body.rear, -body.half_width),
    ];
    let least = |f: fn(&(f32, f32)) -> f32| corners.iter().map(f).fold(f32::INFINITY, f32::min);
    let most = |f: fn(&(f32, f32)) -> f32| corners.iter().map(f).fold(f32::NEG_INFINITY, f32::max);
    Aabb::new(
        Vector::new(least(|c| c.0), least(|c| c.1)),
        Vector::new(most(|c| c.0), most(|c| c.1)),
    )
}

fn pack(segments: &[Segment<f32>]) -> Vec<Segment<Lanes<WIDTH>>> {
    let lanes = |chunk: &[Segment<f32>], f: fn(&Segment<f32>) -> f32| {
        Lanes(std::array::from_fn(|lane| chunk.get(lane).map_or(NOWHERE, f)))
    };
    segments
        .chunks(WIDTH)
        .map(|chunk| Segment {
            a: (lanes(chunk, |s| s.a.0), lanes(chunk, |s| s.a.1)),
            b: (lanes(chunk, |s| s.b.0), lanes(chunk, |s| s.b.1)),
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::{Purpose, RunSeed, Stream};

    fn random_walls(stream: &mut Stream, count: usize, size: f32) -> Vec<Segment<f32>> {
        let mut point = || (stream.within(0.0, size), stream.within(0.0, size));
        (0..count)
            .map(|_| {
                let (a, end) = (point(), point());
                let b = (a.0 + (end.0 - a.0) * 0.1, a.1 + (end.1 - a.1) * 0.1);
                Segment { a, b }
            })
            .collect()
    }

    fn random_ray(stream: &mut Stream, size: f32) -> Ray<f32> {
        let pose =
            Pose::new(stream.within(0.0, size), stream.within(0.0, size), stream.within(-3.1, 3.1));
        Ray { origin: (pose.x, pose.y), direction: (pose.cos, pose.sin) }
    }

    /// The same walls as packs and as a tree.
    fn both_ways(walls: &[Segment<f32>]) -> [Walls; 2] {
        let packed = Walls { segments: walls.to_vec(), packs: pack(walls), tree: None };
        let boxes: Vec<Aabb> = walls.iter().map(bounding_box).collect();
        let tree = Some(Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes));
        [packed, Walls { segments: walls.to_vec(), packs: Vec::new(), tree }]
    }

    #[test]
    fn packs_and_tree_see_the_same_distance_to_the_last_bit() {
        let mut stream = RunSeed(1).stream(Purpose::Episode, 0, 0);
        for count in [1, 7, 8, 40, 700] {
            let walls = random_walls(&mut stream, count, 20.0);
            let [packed, tree] = both_ways(&walls);
            for _ in 0..4000 {
                let ray = random_ray(&mut stream, 20.0);
                let near = |distance: f32| if distance <= 10.0 { distance } else { f32::INFINITY };
                let one_by_one =
                    walls.iter().map(|wall| ray.to_segment(wall)).fold(f32::INFINITY, f32::min);
                let a = near(packed.distance(&ray, 10.0));
                let b = near(tree.distance(&ray, 10.0));
                assert_eq!(a.to_bits(), near(one_by_one).to_bits());
                assert_eq!(b.to_bits(), near(one_by_one).to_bits());
            }
        }
    }

    #[test]
    fn packs_and_tree_feel_the_same_contacts() {
        let mut stream = RunSeed(2).stream(Purpose::Episode, 0, 0);
        let walls = random_walls(&mut stream, 300, 12.0);
        let [packed, tree] = both_ways(&walls);
        let body = Body { rear: -0.35, front: 0.05, half_width: 0.1 };
        let mut contacts = 0;
        for _ in 0..20_000 {
            let ray = random_ray(&mut stream, 12.0);
            let heading = stream.within(-3.1, 3.1);
            let pose = Pose::new(ray.origin.0, ray.origin.1, heading);
            let touching = walls.iter().any(|wall| body.touches_segment(&pose, wall));
            contacts += usize::from(touching);
            assert_eq!(packed.touch(&body, &pose), touching);
            assert_eq!(tree.touch(&body, &pose), touching);
        }
        assert!((1_000..19_000).contains(&contacts), "{contacts}");
    }

    #[test]
    fn a_wall_exactly_at_the_range_is_seen_by_the_tree() {
        let mut walls = random_walls(&mut RunSeed(3).stream(Purpose::Episode, 0, 0), 200, 1.0);
        for wall in &mut walls {
            wall.a.1 += 50.0;
            wall.b.1 += 50.0;
        }
        walls.push(Segment { a: (10.0, -1.0), b: (10.0, 1.0) });
        let walls = Walls::new(walls);
        assert!(walls.tree.is_some());
        let ray = Ray { origin: (0.0, 0.0), direction: (1.0, 0.0) };
        assert_eq!(walls.distance(&ray, 10.0), 10.0);
    }
}

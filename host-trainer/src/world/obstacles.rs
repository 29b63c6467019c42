//! Many obstacles, one question: which is the nearest along this beam, does any touch this body?
//!
//! A small world tests all obstacles, eight side by side. A large one asks parry's
//! bounding-volume tree which to test. Both answer with the same bits, since each obstacle's
//! distance comes from the same arithmetic and the nearest is a plain minimum.

use super::packs::{self, DiscPack, WallPack};
use super::shape::{Rect, Shape};
use controller_core::geometry::{Body, Disc, Ray, Segment};
use controller_core::motion::Pose;
use parry2d::bounding_volume::Aabb;
use parry2d::math::Vector;
use parry2d::partitioning::{Bvh, BvhBuildStrategy, BvhNode};

/// Above this many obstacles the tree is faster than testing them all.
const TREE_FROM: usize = 96;

/// Boxes in the tree are at least this much larger than their obstacles, metres, so that
/// rounding in the tree's own arithmetic never hides one.
const MARGIN: f32 = 1.0e-3;

/// The walls and discs of a world.
#[derive(Debug)]
pub struct Obstacles {
    walls: Vec<Segment<f32>>,
    discs: Vec<Disc<f32>>,
    search: Search,
}

/// How the obstacles that matter are found.
#[derive(Debug)]
enum Search {
    All {
        walls: Box<[WallPack]>,
        discs: Box<[DiscPack]>,
    },
    /// Leaves are walls first, then discs.
    Tree {
        tree: Bvh,
        margin: f32,
    },
}

impl Obstacles {
    /// Obstacles in any order.
    pub fn new(walls: Vec<Segment<f32>>, discs: Vec<Disc<f32>>) -> Self {
        let search = if walls.len() + discs.len() > TREE_FROM {
            Search::tree(&walls, &discs)
        } else {
            Search::all(&walls, &discs)
        };
        Self { walls, discs, search }
    }

    /// Every wall.
    pub fn walls(&self) -> &[Segment<f32>] {
        &self.walls
    }

    /// Every disc.
    pub fn discs(&self) -> &[Disc<f32>] {
        &self.discs
    }

    /// Distance to the nearest obstacle along the ray, metres; infinity, or anything past
    /// `range`, if there is none within it.
    #[inline]
    pub fn distance(&self, ray: &Ray<f32>, range: f32) -> f32 {
        // Which zero is least depends on the order of walls; the sum is the positive one.
        let distance = match &self.search {
            Search::All { walls, discs } => packs::nearest_of_all(ray, walls, discs),
            Search::Tree { tree, margin } => self.distance_by_tree(tree, ray, range + margin),
        };
        distance + 0.0
    }

    /// Tests every obstacle whose box the beam meets, those behind a hit too: for a beam that
    /// runs along a wall, rounding may compute the farther of two hits as the nearer.
    fn distance_by_tree(&self, tree: &Bvh, ray: &Ray<f32>, range: f32) -> f32 {
        let beam = Beam::new(ray, range);
        let leaves = tree.leaves(|node| beam.meets(node));
        leaves.fold(f32::INFINITY, |near, leaf| {
            let distance = match self.leaf(leaf) {
                Leaf::Wall(wall) => ray.to_segment(wall),
                Leaf::Disc(disc) => ray.to_disc(disc),
            };
            distance.min(near)
        })
    }

    /// Whether the body at this pose touches an obstacle's edge, or lies inside a disc.
    #[inline]
    pub fn touch(&self, body: &Body<f32>, pose: &Pose<f32>) -> bool {
        match &self.search {
            Search::All { walls, discs } => packs::any_touches(body, pose, walls, discs),
            Search::Tree { tree, .. } => {
                tree.intersect_aabb(&body_box(body, pose)).any(|leaf| match self.leaf(leaf) {
                    Leaf::Wall(wall) => body.touches_segment(pose, wall),
                    Leaf::Disc(disc) => body.touches_disc(pose, disc),
                })
            }
        }
    }

    /// Distance from a point to the nearest edge, 0 inside a disc, at most `most`.
    pub fn clearance(&self, point: [f32; 2], most: f32) -> f32 {
        let nearer = |near: f32, leaf: Leaf<'_>| match leaf {
            Leaf::Wall(wall) => near.min(away(wall, point)),
            Leaf::Disc(disc) => near.min(away_from_disc(disc, point)),
        };
        match &self.search {
            Search::All { .. } => {
                let leaves = self.walls.len() + self.discs.len();
                (0..leaves as u32).fold(most, |near, leaf| nearer(near, self.leaf(leaf)))
            }
            Search::Tree { tree, .. } => {
                let [x, y] = point;
                let around =
                    Aabb::new(Vector::new(x - most, y - most), Vector::new(x + most, y + most));
                tree.intersect_aabb(&around).fold(most, |near, leaf| nearer(near, self.leaf(leaf)))
            }
        }
    }

    /// Calls `f` with the place and shape of every obstacle near a rectangle: of all within
    /// `distance` metres of it, and perhaps of more.
    ///
    /// Places count walls first, then discs.
    pub(super) fn each_near(&self, rect: &Rect, distance: f64, mut f: impl FnMut(u32, Shape)) {
        let mut visit = |leaf: u32| match self.leaf(leaf) {
            Leaf::Wall(wall) => f(leaf, Shape::from(wall)),
            Leaf::Disc(disc) => f(leaf, Shape::from(disc)),
        };
        match &self.search {
            Search::All { .. } => {
                (0..(self.walls.len() + self.discs.len()) as u32).for_each(&mut visit);
            }
            Search::Tree { tree, margin } => {
                let Rect { low, high } = rect.grown(distance + f64::from(*margin));
                let point = |[x, y]: [f64; 2]| Vector::new(x as f32, y as f32);
                tree.intersect_aabb(&Aabb::new(point(low), point(high))).for_each(&mut visit);
            }
        }
    }

    /// The smallest upright rectangle around all obstacles: its low and its high corner.
    pub(super) fn bounds(&self) -> [[f32; 2]; 2] {
        let boxes = self.walls.iter().map(wall_box).chain(self.discs.iter().map(disc_box));
        let around =
            boxes.reduce(|a, b| [a[0].min(b[0]), a[1].min(b[1]), a[2].max(b[2]), a[3].max(b[3])]);
        let [x0, y0, x1, y1] = around.unwrap_or_default();
        [[x0, y0], [x1, y1]]
    }

    /// The longest wall or the widest disc, metres.
    pub(super) fn largest(&self) -> f64 {
        self.largest_within(f64::INFINITY)
    }

    /// The same of those that are no larger than this.
    pub(super) fn largest_within(&self, most: f64) -> f64 {
        let walls = self.walls.iter().map(|wall| Shape::from(wall).length);
        let discs = self.discs.iter().map(|disc| 2.0 * f64::from(disc.radius));
        walls.chain(discs).filter(|size| *size <= most).fold(0.0, f64::max)
    }

    /// How far apart the ends of walls that meet may lie, metres: both are lengthened there, by
    /// `super::CORNER_OVERLAP` or by 8 units in the last place of the largest number in play.
    pub(super) fn joint(&self, range: f32) -> f32 {
        let numbers = self.bounds().into_iter().flatten();
        let largest = numbers.map(f32::abs).fold(range, f32::max);
        2.5 * super::CORNER_OVERLAP.max(8.0 * f32::EPSILON * largest)
    }

    fn leaf(&self, leaf: u32) -> Leaf<'_> {
        let leaf = leaf as usize;
        match self.walls.get(leaf) {
            Some(wall) => Leaf::Wall(wall),
            None => Leaf::Disc(&self.discs[leaf - self.walls.len()]),
        }
    }
}

enum Leaf<'a> {
    Wall(&'a Segment<f32>),
    Disc(&'a Disc<f32>),
}

impl Search {
    fn all(walls: &[Segment<f32>], discs: &[Disc<f32>]) -> Self {
        Self::All { walls: WallPack::all(walls), discs: DiscPack::all(discs) }
    }

    fn tree(walls: &[Segment<f32>], discs: &[Disc<f32>]) -> Self {
        let boxes: Vec<[f32; 4]> =
            walls.iter().map(wall_box).chain(discs.iter().map(disc_box)).collect();
        let largest = boxes.iter().flatten().fold(0.0, |most: f32, value| most.max(value.abs()));
        let margin = MARGIN.max(64.0 * f32::EPSILON * largest);
        let boxes: Vec<Aabb> = boxes
            .into_iter()
            .map(|[x0, y0, x1, y1]| {
                Aabb::new(
                    Vector::new(x0 - margin, y0 - margin),
                    Vector::new(x1 + margin, y1 + margin),
                )
            })
            .collect();
        Self::Tree { tree: Bvh::from_leaves(BvhBuildStrategy::Binned, &boxes), margin }
    }
}

/// A stretch of a ray, for the boxes of the tree.
struct Beam {
    middle: (f32, f32),
    half: (f32, f32),
    direction: (f32, f32),
}

impl Beam {
    fn new(ray: &Ray<f32>, range: f32) -> Self {
        let ((x, y), (dx, dy)) = (ray.origin, ray.direction);
        // Past these numbers nothing is a distance any more.
        let reach = range.min(1.0e18) * 0.5;
        Self {
            middle: (x + dx * reach, y + dy * reach),
            half: (dx.abs() * reach, dy.abs() * reach),
            direction: (dx, dy),
        }
    }

    /// Separating axes of a box and the stretch.
    #[inline]
    fn meets(&self, node: &BvhNode) -> bool {
        let (low, high) = (node.mins(), node.maxs());
        let half = ((high.x - low.x) * 0.5, (high.y - low.y) * 0.5);
        let apart =
            ((low.x + high.x) * 0.5 - self.middle.0, (low.y + high.y) * 0.5 - self.middle.1);
        let (dx, dy) = self.direction;
        apart.0.abs() <= half.0 + self.half.0
            && apart.1.abs() <= half.1 + self.half.1
            && (apart.0 * dy - apart.1 * dx).abs() <= half.0 * dy.abs() + half.1 * dx.abs()
    }
}

/// Distance from a point to a wall.
pub(super) fn away(wall: &Segment<f32>, [x, y]: [f32; 2]) -> f32 {
    use parry2d::query::PointQuery;
    let (a, b) = (Vector::new(wall.a.0, wall.a.1), Vector::new(wall.b.0, wall.b.1));
    parry2d::shape::Segment::new(a, b).distance_to_local_point(Vector::new(x, y), true)
}

/// Distance from a point to a disc, 0 inside.
fn away_from_disc(disc: &Disc<f32>, point: [f32; 2]) -> f32 {
    (super::distance([disc.centre.0, disc.centre.1], point) - disc.radius).max(0.0)
}

fn wall_box(wall: &Segment<f32>) -> [f32; 4] {
    let ((ax, ay), (bx, by)) = (wall.a, wall.b);
    [ax.min(bx), ay.min(by), ax.max(bx), ay.max(by)]
}

fn disc_box(disc: &Disc<f32>) -> [f32; 4] {
    let Disc { centre: (x, y), radius } = disc;
    [x - radius, y - radius, x + radius, y + radius]
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

    fn random_discs(stream: &mut Stream, count: usize, size: f32) -> Vec<Disc<f32>> {
        (0..count)
            .map(|_| Disc {
                centre: (stream.within(0.0, size), stream.within(0.0, size)),
                radius: stream.within(0.01, 0.3),
            })
            .collect()
    }

    /// The same obstacles all side by side and as a tree.
    fn both_ways(walls: &[Segment<f32>], discs: &[Disc<f32>]) -> [Obstacles; 2] {
        [Search::all(walls, discs), Search::tree(walls, discs)].map(|search| Obstacles {
            walls: walls.to_vec(),
            discs: discs.to_vec(),
            search,
        })
    }

    #[test]
    fn side_by_side_and_tree_see_the_same_distance_to_the_last_bit() {
        let mut stream = RunSeed(1).stream(Purpose::Episode, 0, 0);
        for (walls, discs) in [(1, 0), (0, 1), (7, 9), (8, 8), (40, 0), (0, 300), (700, 60)] {
            let walls = random_walls(&mut stream, walls, 20.0);
            let discs = random_discs(&mut stream, discs, 20.0);
            let both = both_ways(&walls, &discs);
            for _ in 0..4000 {
                let ray = random_ray(&mut stream, 20.0);
                let near = |distance: f32| if distance <= 10.0 { distance } else { f32::INFINITY };
                let to_walls = walls.iter().map(|wall| ray.to_segment(wall));
                let to_discs = discs.iter().map(|disc| ray.to_disc(disc));
                let one_by_one = to_walls.chain(to_discs).fold(f32::INFINITY, f32::min);
                for obstacles in &both {
                    let found = near(obstacles.distance(&ray, 10.0));
                    assert_eq!(found.to_bits(), near(one_by_one).to_bits());
                }
            }
        }
    }

    #[test]
    fn side_by_side_and_tree_feel_the_same_contacts() {
        let mut stream = RunSeed(2).stream(Purpose::Episode, 0, 0);
        let walls = random_walls(&mut stream, 200, 12.0);
        let discs = random_discs(&mut stream, 60, 12.0);
        let both = both_ways(&walls, &discs);
        let body = Body { rear: -0.35, front: 0.05, half_width: 0.1 };
        let mut contacts = 0;
        for _ in 0..20_000 {
            let ray = random_ray(&mut stream, 12.0);
            let heading = stream.within(-3.1, 3.1);
            let pose = Pose::new(ray.origin.0, ray.origin.1, heading);
            let touching = walls.iter().any(|wall| body.touches_segment(&pose, wall))
                || discs.iter().any(|disc| body.touches_disc(&pose, disc));
            contacts += usize::from(touching);
            for obstacles in &both {
                assert_eq!(obstacles.touch(&body, &pose), touching);
            }
        }
        assert!((1_000..19_000).contains(&contacts), "{contacts}");
    }

    /// Ten kilometres out, coordinates are a millimetre apart.
    #[test]
    fn the_tree_overlooks_nothing_far_from_the_origin() {
        let mut stream = RunSeed(4).stream(Purpose::Episode, 0, 0);
        let far = |(x, y): (f32, f32)| (x + 9_990.0, y - 9_980.0);
        let walls: Vec<_> = random_walls(&mut stream, 200, 10.0)
            .into_iter()
            .map(|wall| Segment { a: far(wall.a), b: far(wall.b) })
            .collect();
        let both = both_ways(&walls, &[]);
        let body = Body { rear: -0.35, front: 0.05, half_width: 0.1 };
        for _ in 0..20_000 {
            let mut ray = random_ray(&mut stream, 10.0);
            ray.origin = far(ray.origin);
            let pose = Pose::new(ray.origin.0, ray.origin.1, stream.within(-3.1, 3.1));
            let [all, tree] = both.each_ref().map(|o| o.distance(&ray, 30.0).to_bits());
            assert_eq!(all, tree);
            let [all, tree] = both.each_ref().map(|o| o.touch(&body, &pose));
            assert_eq!(all, tree);
        }
    }

    #[test]
    fn clearance_is_the_same_either_way_and_never_more_than_asked_for() {
        let mut stream = RunSeed(5).stream(Purpose::Episode, 0, 0);
        let walls = random_walls(&mut stream, 60, 10.0);
        let discs = random_discs(&mut stream, 30, 10.0);
        let both = both_ways(&walls, &discs);
        for _ in 0..5_000 {
            let point = [stream.within(0.0, 10.0), stream.within(0.0, 10.0)];
            let most = stream.within(0.0, 2.0);
            let [all, tree] = both.each_ref().map(|o| o.clearance(point, most));
            assert_eq!(all.to_bits(), tree.to_bits());
            assert!((0.0..=most).contains(&all));
        }
    }

    #[test]
    fn a_hundred_thousand_obstacles_in_one_place_are_no_trouble() {
        let walls = vec![Segment { a: (1.0, -1.0), b: (1.0, 1.0) }; 100_000];
        let obstacles = Obstacles::new(walls, Vec::new());
        let ray = Ray { origin: (0.0, 0.0), direction: (1.0, 0.0) };
        assert_eq!(obstacles.distance(&ray, 10.0), 1.0);
    }

    #[test]
    fn an_obstacle_exactly_at_the_range_is_seen_by_the_tree() {
        let mut walls = random_walls(&mut RunSeed(3).stream(Purpose::Episode, 0, 0), 200, 1.0);
        for wall in &mut walls {
            wall.a.1 += 50.0;
            wall.b.1 += 50.0;
        }
        walls.push(Segment { a: (10.0, -1.0), b: (10.0, 1.0) });
        let obstacles = Obstacles::new(walls, Vec::new());
        assert!(matches!(obstacles.search, Search::Tree { .. }));
        let ray = Ray { origin: (0.0, 0.0), direction: (1.0, 0.0) };
        assert_eq!(obstacles.distance(&ray, 10.0), 10.0);
    }

    #[test]
    fn a_world_without_obstacles_is_empty_air() {
        let air = Obstacles::new(Vec::new(), Vec::new());
        let ray = Ray { origin: (0.0, 0.0), direction: (1.0, 0.0) };
        assert_eq!(air.distance(&ray, 10.0), f32::INFINITY);
        let body = Body { rear: -0.35, front: 0.05, half_width: 0.1 };
        assert!(!air.touch(&body, &Pose::new(0.0, 0.0, 0.0)));
        assert_eq!(air.clearance([0.0, 0.0], 3.0), 3.0);
    }
}

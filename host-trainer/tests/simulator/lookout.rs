//! What a car sees and touches through a lookout, bit by bit what a test of every single
//! obstacle says.

use crate::worlds::{PAPER, random, random_pose, shipped, world_of};
use controller_core::geometry::{Body, Disc, Ray, Segment};
use controller_core::motion::Pose;
use controller_core::observation::{BEAMS, BeamMount};
use host_trainer::car::body_of;
use host_trainer::seed::Stream;
use host_trainer::vector::{Instructions, Kernel, Vector};
use host_trainer::world::{Cells, Fan, Glance, Lookout, Obstacles};
use proptest::prelude::*;
use std::cell::RefCell;
use std::f32::consts::{PI, TAU};
use std::sync::Arc;

const BODY: Body<f32> = Body { rear: -0.35, front: 0.05, half_width: 0.1 };

/// Every obstacle for itself, with nothing but the arithmetic of the core.
struct OneByOne {
    walls: Vec<Segment<f32>>,
    discs: Vec<Disc<f32>>,
}

impl OneByOne {
    fn distance(&self, ray: &Ray<f32>, range: f32) -> f32 {
        let to_walls = self.walls.iter().map(|wall| ray.to_segment(wall));
        let to_discs = self.discs.iter().map(|disc| ray.to_disc(disc));
        let nearest = to_walls.chain(to_discs).fold(f32::INFINITY, f32::min);
        // Either zero may be the least of two; distances have the positive one.
        if nearest <= range { nearest + 0.0 } else { f32::INFINITY }
    }

    /// The same without walls that lie along the beam's line, behind the car, out of range or beyond
    /// what the beam is said to meet, where that may be `seen`. Whether such a wall is met, and where, is decided by rounding
    /// alone, which may say: before it begins. An index that knows where the wall lies may have the
    /// better answer.
    fn distance_within_reach(&self, ray: &Ray<f32>, range: f32, seen: f32) -> f32 {
        let reach = range.min(seen);
        let counts = |wall: &&Segment<f32>| is_in_reach(ray, wall, reach) || !lies_along(ray, wall);
        let walls = self.walls.iter().filter(counts).copied().collect();
        Self { walls, discs: self.discs.clone() }.distance(ray, range)
    }

    fn touches(&self, body: &Body<f32>, pose: &Pose<f32>) -> bool {
        self.walls.iter().any(|wall| body.touches_segment(pose, wall))
            || self.discs.iter().any(|disc| body.touches_disc(pose, disc))
    }
}

/// Whether the beam's line passes both of the wall's ends, as far as `f32` can tell there.
fn lies_along(ray: &Ray<f32>, wall: &Segment<f32>) -> bool {
    let wide = |(x, y): (f32, f32)| (f64::from(x), f64::from(y));
    let ((x, y), (dx, dy)) = (wide(ray.origin), wide(ray.direction));
    [wide(wall.a), wide(wall.b)].into_iter().all(|(ax, ay)| {
        let largest =
            [x, y, ax, ay].into_iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        ((ax - x) * dy - (ay - y) * dx).abs() <= 4.0 * f64::from(f32::EPSILON) * largest
    })
}

/// Whether any of the wall lies before the beam's start and within its range.
fn is_in_reach(ray: &Ray<f32>, wall: &Segment<f32>, range: f32) -> bool {
    let ahead = [wall.a, wall.b]
        .map(|(x, y)| (x - ray.origin.0) * ray.direction.0 + (y - ray.origin.1) * ray.direction.1);
    let [near, far] = [ahead[0].min(ahead[1]), ahead[0].max(ahead[1])];
    far >= 0.0 && near <= range
}

/// A lookout beside the obstacles it is made of.
struct Pair {
    lookout: Lookout,
    truth: OneByOne,
    fan: Fan,
    /// Kept, as drives keep it: what one pose leaves behind must not matter to the next.
    glance: RefCell<Glance<f32, 1, BEAMS>>,
    body: Body<f32>,
    seen: usize,
    touched: usize,
}

impl Pair {
    fn new(walls: Vec<Segment<f32>>, discs: Vec<Disc<f32>>, fan: Fan, body: Body<f32>) -> Self {
        Self::by(Cells::Fine, walls, discs, fan, body)
    }

    fn by(
        cells: Cells,
        walls: Vec<Segment<f32>>,
        discs: Vec<Disc<f32>>,
        fan: Fan,
        body: Body<f32>,
    ) -> Self {
        let obstacles = Arc::new(Obstacles::new(walls.clone(), discs.clone()));
        let lookout = Lookout::new(obstacles, fan.range(), body, cells);
        let (truth, glance) = (OneByOne { walls, discs }, RefCell::default());
        Self { lookout, truth, fan, glance, body, seen: 0, touched: 0 }
    }

    fn look(&self, pose: &Pose<f32>) -> [f32; BEAMS] {
        let mut glance = self.glance.borrow_mut();
        self.lookout.look(&self.fan, &[*pose], &[1], &mut glance);
        glance.distances[0]
    }

    fn feel(&self, body: &Body<f32>, pose: &Pose<f32>) -> bool {
        self.lookout.touches(body, &[*pose], &[1]) != [0]
    }

    fn compare(&mut self, pose: &Pose<f32>) {
        let seen = self.look(pose);
        // The first car in a cell has it looked at; others read what was written down.
        assert_eq!(self.look(pose).map(f32::to_bits), seen.map(f32::to_bits), "again at {pose:?}");
        for (beam, (ray, seen)) in self.fan.rays(pose).iter().zip(seen).enumerate() {
            let expected = self.truth.distance(ray, self.fan.range());
            let said = if self.lookout.beams_walk() { seen } else { f32::INFINITY };
            let same = seen.to_bits() == expected.to_bits()
                || seen.to_bits()
                    == self.truth.distance_within_reach(ray, self.fan.range(), said).to_bits();
            assert!(same, "beam {beam} at {pose:?} sees {seen}, not {expected}");
            self.seen += usize::from(seen.is_finite());
        }
        let Body { rear, front, half_width } = self.body;
        let half = Body { rear: 0.5 * rear, front: 0.5 * front, half_width: 0.5 * half_width };
        for body in [self.body, half] {
            let touched = self.feel(&body, pose);
            assert_eq!(touched, self.truth.touches(&body, pose), "{body:?} at {pose:?}");
            self.touched += usize::from(touched);
        }
    }
}

/// Cars side by side, in a lookout of their own.
const CARS: usize = 3;

/// The same poses in lanes of cars, some of which are not asked for, in a lookout that has not seen them.
struct SideBySide<'a>(&'a Pair, &'a [Pose<f32>]);

impl Kernel for SideBySide<'_> {
    type Output = usize;

    #[inline(always)]
    fn run<V: Vector>(self) -> usize {
        let Self(pair, poses) = self;
        let OneByOne { walls, discs } = &pair.truth;
        let obstacles = Arc::new(Obstacles::new(walls.clone(), discs.clone()));
        let lookout = Lookout::new(obstacles, pair.fan.range(), pair.body, Cells::Fine);
        let mut glance = Glance::<V, CARS, { CARS * BEAMS }>::default();
        let zero = V::from(0.0);
        let mut cars = [Pose { x: zero, y: zero, heading: zero, cos: zero, sin: zero }; CARS];
        let all = (1 << V::WIDTH) - 1;
        let mut compared = 0;
        for (turn, poses) in poses.chunks_exact(CARS * V::WIDTH).enumerate() {
            // Bits of no lane mean nothing.
            let live = [u32::MAX, if turn % 3 == 0 { 0 } else { all }, 0x6d6d >> (turn % 7) & all];
            for (place, pose) in poses.iter().enumerate() {
                let (car, lane) = (&mut cars[place / V::WIDTH], place % V::WIDTH);
                // What nobody asks for may be anything.
                let is_live = live[place / V::WIDTH] >> lane & 1 == 1;
                let of = |number: f32| if is_live { number } else { f32::NAN };
                car.x.lanes_mut()[lane] = of(pose.x);
                car.y.lanes_mut()[lane] = of(pose.y);
                car.heading.lanes_mut()[lane] = of(pose.heading);
                car.cos.lanes_mut()[lane] = of(pose.cos);
                car.sin.lanes_mut()[lane] = of(pose.sin);
            }
            lookout.look(&pair.fan, &cars, &live, &mut glance);
            let touched = lookout.touches(&pair.body, &cars, &live);
            for (place, pose) in poses.iter().enumerate() {
                let (car, lane) = (place / V::WIDTH, place % V::WIDTH);
                let touches = touched[car] >> lane & 1 == 1;
                if live[car] >> lane & 1 == 0 {
                    assert!(!touches, "nobody asked at {pose:?}");
                    continue;
                }
                assert_eq!(touches, pair.feel(&pair.body, pose), "at {pose:?}");
                for (beam, alone) in pair.look(pose).into_iter().enumerate() {
                    let found = glance.distances[car][beam].lanes()[lane];
                    assert_eq!(found.to_bits(), alone.to_bits(), "beam {beam} at {pose:?}");
                    compared += 1;
                }
            }
        }
        compared
    }
}

/// Rows of posts, far apart, of which a beam may meet any number first, and a long body touch many at once.
#[test]
fn lanes_see_and_feel_what_a_car_alone_does_however_many_obstacles_may_be_first() {
    const LORRY: Body<f32> = Body { rear: -2.2, front: 0.4, half_width: 0.5 };
    for (has_discs, is_large) in [(false, false), (true, false), (false, true), (true, true)] {
        let (mut walls, mut discs) = (Vec::new(), Vec::new());
        for (row, across) in
            [12.0, 15.0, 18.0].into_iter().flat_map(|row| (-16..16).map(move |at| (row, at)))
        {
            let (x, y) = (row, 0.25 * across as f32);
            if has_discs && across % 3 == 0 {
                discs.push(Disc { centre: (x, y), radius: 0.02 });
            } else {
                walls.push(Segment { a: (x, y), b: (x + 0.01, y + 0.03) });
            }
        }
        if is_large {
            let far = |at: i16| Segment { a: (at.into(), 90.0), b: (f32::from(at) + 0.5, 90.0) };
            walls.extend((0..300).map(far));
        }
        let mut mounts = mounts([-50.0, -9.0, 0.0, 4.0, 75.0]);
        if has_discs {
            (mounts[1].y, mounts[3].x) = (-0.2, 0.3);
        }
        let mut pair = Pair::new(walls, discs, Fan::new(&mounts, 25.0), LORRY);
        assert!(!pair.lookout.beams_walk());
        let mut random = random(75);
        let mut poses = Vec::new();
        for _ in 0..3_000 {
            let x = if random.chance(0.2) {
                random.within(11.0, 19.0)
            } else {
                random.within(0.0, 3.0)
            };
            poses.push(Pose::new(x, random.within(-1.5, 1.5), random.within(-0.4, 0.4)));
            pair.compare(&poses[poses.len() - 1]);
        }
        let survey = pair.lookout.survey();
        for names in [0, 1, 2, 4, 5, 7] {
            assert!(survey.seen.contains(&names), "no list of {names} for beams");
        }
        assert!(survey.seen.last() > Some(&7), "no list that is too long for a word");
        assert!(survey.near.last() > Some(&4), "contacts have {:?} at most", survey.near.last());
        for set in Instructions::available() {
            let compared = set.run(SideBySide(&pair, &poses));
            assert!(compared > 8_000, "{set}: {compared} beams");
        }
        assert!(pair.seen > 1_500 && pair.touched > 200, "{}, {}", pair.seen, pair.touched);
    }
}

/// Whoever comes first to a place has it looked at, and others may come while that goes on.
#[test]
fn threads_that_come_to_new_places_together_see_what_one_alone_does() {
    for posts in [40_u16, 700] {
        let mut random = random(posts.into());
        let mut wall = |length: f32| {
            let (x, y) = (random.within(0.0, 25.0), random.within(0.0, 25.0));
            let turn = random.within(-PI, PI);
            Segment { a: (x, y), b: (x + length * libm::cosf(turn), y + length * libm::sinf(turn)) }
        };
        let walls: Vec<_> = (0..posts).map(|_| wall(0.4)).collect();
        let mut pair = Pair::new(walls, Vec::new(), Fan::new(&mounts(USUAL), 12.0), BODY);
        assert!(!pair.lookout.beams_walk());
        let mut poses = Vec::new();
        for _ in 0..600 {
            let (x, y) = (random.within(8.0, 10.0), random.within(8.0, 10.0));
            poses.push(Pose::new(x, y, random.within(-PI, PI)));
        }
        let obstacles = Arc::new(Obstacles::new(pair.truth.walls.clone(), Vec::new()));
        let shared = Lookout::new(obstacles, pair.fan.range(), BODY, Cells::Fine);
        let (fan, cars) = (&pair.fan, &poses);
        let visit = |first: usize| {
            let mut glance = Glance::<f32, 1, BEAMS>::default();
            let mut seen = vec![([0; BEAMS], [0]); cars.len()];
            for at in 0..cars.len() {
                // All begin in the same places, then go on in different ones.
                let at = if at < 50 { at } else { (at + first) % cars.len() };
                let car = &[cars[at]];
                // Some look around first, some feel.
                let felt_first = (first > 200).then(|| shared.touches(&BODY, car, &[1]));
                shared.look(fan, car, &[1], &mut glance);
                let touched = felt_first.unwrap_or_else(|| shared.touches(&BODY, car, &[1]));
                seen[at] = (glance.distances[0].map(f32::to_bits), touched);
            }
            seen
        };
        let by_all: Vec<_> = std::thread::scope(|scope| {
            let threads = [0, 150, 300, 450].map(|first| scope.spawn(move || visit(first)));
            threads.into_iter().map(|thread| thread.join().unwrap()).collect()
        });
        for (at, pose) in poses.iter().enumerate() {
            pair.compare(pose);
            let alone = (pair.look(pose).map(f32::to_bits), [u32::from(pair.feel(&BODY, pose))]);
            let seen = by_all.iter().map(|seen| seen[at]).filter(|(seen, _)| *seen != [0; BEAMS]);
            assert!(seen.clone().count() > 0 && seen.into_iter().all(|seen| seen == alone));
        }
        assert!(posts == 40 || pair.touched > 50, "{} touches", pair.touched);
    }
}

fn mounts(degrees: [f32; BEAMS]) -> [BeamMount; BEAMS] {
    degrees.map(|degrees| BeamMount { x: 0.0, y: 0.0, angle: degrees.to_radians() })
}

const USUAL: [f32; BEAMS] = [-30.0, -15.0, 0.0, 15.0, 30.0];

#[test]
fn in_every_shipped_world_a_lookout_sees_and_feels_what_every_obstacle_says() {
    let scenes = ["depot", "tb3_sandbox", "barn_000", "barn_264", "medium_maze"];
    for name in PAPER.into_iter().chain(scenes) {
        let scenario = shipped(name);
        let world = world_of(&scenario);
        let fan = Fan::new(&scenario.sensors.beams, scenario.sensors.range);
        let (walls, discs) = (world.segments().to_vec(), world.discs().to_vec());
        let poses = 1_600;
        let mut pair = Pair::new(walls, discs, fan, body_of(&scenario.vehicle));
        let mut random = random(71);
        // Many poses in each of a few places, so that cells are used as well as made.
        for _ in 0..poses / 40 {
            let Pose { x, y, .. } = random_pose(&world, &mut random);
            for _ in 0..40 {
                let mut near = || random.within(-0.1, 0.1);
                let (x, y) = (x + near(), y + near());
                pair.compare(&Pose::new(x, y, random.within(-PI, PI)));
            }
        }
        let cells = pair.lookout.survey().cells;
        println!("{name}: {} beams met something, {} touches", pair.seen, pair.touched);
        assert!(pair.seen > poses && pair.touched > 0 && cells > 20, "{name}: {cells} cells");
    }
}

/// Of many long walls only some are left out of the field that beams walk through.
#[test]
fn long_walls_in_a_crowd_are_seen_and_felt_however_many_there_are() {
    for long in [3, 16, 17, 40] {
        let mut random = random(long);
        let mut wall = |from: f32, to: f32| {
            let (x, y) = (random.within(0.0, 8.0), random.within(0.0, 8.0));
            let (length, turn) = (random.within(from, to), random.within(-PI, PI));
            Segment { a: (x, y), b: (x + length * libm::cosf(turn), y + length * libm::sinf(turn)) }
        };
        let mut walls: Vec<_> = (0..400).map(|_| wall(0.02, 0.2)).collect();
        walls.extend((0..long).map(|_| wall(3.1, 7.0)));
        let mut pair = Pair::new(walls, Vec::new(), Fan::new(&mounts(USUAL), 10.0), BODY);
        for _ in 0..400 {
            let (x, y) = (random.within(0.0, 8.0), random.within(0.0, 8.0));
            pair.compare(&Pose::new(x, y, random.within(-PI, PI)));
        }
        assert!(pair.lookout.beams_walk());
        assert!(pair.seen > 1000 && pair.touched > 100, "{long}: {}, {}", pair.seen, pair.touched);
    }
}

/// Points, sizes and directions that come out exact more often than chance would have it.
struct Scene {
    stream: Stream,
    size: f32,
    offset: (f32, f32),
}

impl Scene {
    fn place(&mut self) -> (f32, f32) {
        let mut coordinate = |offset: f32| {
            let value = self.stream.within(0.0, self.size);
            // On a coarse lattice, on the borders of cells, or anywhere.
            let step = [self.size / 8.0, 0.175, 0.0][self.stream.index(3)];
            offset + if step > 0.0 { (value / step).round() * step } else { value }
        };
        (coordinate(self.offset.0), coordinate(self.offset.1))
    }

    /// Walls of a closed outline, lengthened as in a world, or not.
    fn outline(&mut self, corners: &[(f32, f32)], walls: &mut Vec<Segment<f32>>) {
        let lengthened = self.stream.chance(0.7);
        let next = corners.iter().cycle().skip(1);
        for (a, b) in corners.iter().zip(next) {
            let (dx, dy) = (b.0 - a.0, b.1 - a.1);
            let length = libm::hypotf(dx, dy);
            if length == 0.0 {
                continue;
            }
            let largest = [a.0, a.1, b.0, b.1].into_iter().map(f32::abs).fold(10.0, f32::max);
            let by =
                if lengthened { 1e-5_f32.max(8.0 * f32::EPSILON * largest) / length } else { 0.0 };
            let (ux, uy) = (dx * by, dy * by);
            walls.push(Segment { a: (a.0 - ux, a.1 - uy), b: (b.0 + ux, b.1 + uy) });
        }
    }

    fn walls(&mut self) -> Vec<Segment<f32>> {
        let mut walls = Vec::new();
        if self.stream.chance(0.3) {
            // So many that a tree finds those that matter.
            for _ in 0..100 {
                let (x, y) = self.place();
                let mut step = || self.stream.within(-0.03, 0.03) * self.size;
                walls.push(Segment { a: (x, y), b: (x + step(), y + step()) });
            }
        }
        for _ in 0..2 + self.stream.index(8) {
            let (x, y) = self.place();
            let (w, h) = (
                self.stream.within(0.0, self.size * 0.2),
                self.stream.within(0.0, self.size * 0.2),
            );
            match self.stream.index(5) {
                0 => self.outline(&[(x, y), (x + w, y), (x + w, y + h), (x, y + h)], &mut walls),
                1 => {
                    let turn = self.stream.within(0.0, TAU);
                    let count = 3 + self.stream.index(9);
                    let corner = |index: usize| {
                        let angle = turn + TAU * index as f32 / count as f32;
                        (x + w * libm::cosf(angle), y + w * libm::sinf(angle))
                    };
                    let corners: Vec<_> = (0..count).map(corner).collect();
                    self.outline(&corners, &mut walls);
                }
                2 => {
                    // One straight wall in pieces.
                    let pieces = 1 + self.stream.index(12);
                    let at = |i: usize| {
                        let share = i as f32 / pieces as f32;
                        (x + w * share, y + h * share)
                    };
                    for piece in 0..pieces {
                        walls.push(Segment { a: at(piece), b: at(piece + 1) });
                    }
                }
                3 => walls.push(Segment { a: (x, y), b: self.place() }),
                _ => {
                    let (a, b) = (self.place(), self.place());
                    walls.extend([Segment { a: (x, y), b: a }, Segment { a, b }]);
                }
            }
        }
        walls
    }

    /// A row of posts along one side: more than there are names.
    fn posts(&self) -> impl Iterator<Item = Segment<f32>> {
        let (size, (x, y)) = (self.size, self.offset);
        (0..260).map(move |post| {
            let (x, y) = (x + size * post as f32 / 260.0, y + size * 1.2);
            Segment { a: (x, y), b: (x + 1e-3 * size, y) }
        })
    }

    fn discs(&mut self) -> Vec<Disc<f32>> {
        let count = self.stream.index(4);
        (0..count)
            .map(|_| Disc {
                centre: self.place(),
                radius: self.stream.within(0.0, self.size * 0.1),
            })
            .collect()
    }

    /// A pose from which one beam goes exactly through a wall's end, along a wall, across a
    /// corner, or anywhere; positions and headings often lie exactly on borders.
    fn pose(&mut self, walls: &[Segment<f32>], mounts: &[BeamMount; BEAMS]) -> Pose<f32> {
        let wall = walls[self.stream.index(walls.len())];
        let mount = mounts[self.stream.index(BEAMS)];
        let (mut x, mut y) = self.place();
        let (dx, dy) = (wall.b.0 - wall.a.0, wall.b.1 - wall.a.1);
        let heading = match self.stream.index(5) {
            0 => self.stream.within(-PI, PI),
            1 => (self.stream.within(-8.5, 8.5)).round() * (PI / 8.0),
            2 => {
                // Half a sector off.
                (self.stream.within(-8.5, 8.5).round() + 0.5) * (PI / 8.0)
            }
            3 => libm::atan2f(wall.a.1 - y, wall.a.0 - x) - mount.angle,
            _ => {
                let beyond = self.stream.within(0.0, 3.0);
                (x, y) = (wall.a.0 - dx * beyond, wall.a.1 - dy * beyond);
                libm::atan2f(dy, dx) - mount.angle
            }
        };
        let nudge = |value: f32, by: usize| match by {
            0 => value.next_up(),
            1 => value.next_down(),
            _ => value,
        };
        x = nudge(x, self.stream.index(6));
        let heading = nudge(heading, self.stream.index(6));
        Pose::new(x, y, heading)
    }
}

proptest! {
    #[test]
    fn in_any_scene_a_lookout_sees_and_feels_what_every_obstacle_says(
        seed: u64,
        size in prop_oneof![Just(10.0_f32), 0.01_f32..3.0, 3.0_f32..60.0, 60.0_f32..3000.0],
        far in prop_oneof![Just(0.0_f32), -20_000.0_f32..20_000.0],
        range in prop_oneof![Just(10.0_f32), 0.1_f32..80.0],
        degrees in prop_oneof![
            Just(USUAL),
            Just([-90.0, -45.0, 0.0, 45.0, 90.0]),
            Just([0.0, 0.0, 72.0, 144.0, -144.0]),
        ],
        offset in prop_oneof![Just((0.0_f32, 0.0_f32)), (-0.4_f32..0.4, -0.2_f32..0.2)],
        crowded: bool,
        outside in proptest::bool::weighted(0.2),
        coarse: bool,
    ) {
        let mut random = random(!seed);
        let mut scene = Scene { stream: crate::worlds::random(seed), size, offset: (far, -0.5 * far) };
        let (mut walls, discs) = (scene.walls(), scene.discs());
        if crowded {
            walls.extend(scene.posts());
        }
        let mut mounts = mounts(degrees);
        mounts[0].x = offset.0;
        mounts[3].x = 0.5 * offset.0;
        mounts[4].y = offset.1;
        let cells = if coarse { Cells::Coarse } else { Cells::Fine };
        let mut pair = Pair::by(cells, walls.clone(), discs, Fan::new(&mounts, range), BODY);
        for _ in 0..80 {
            let mut pose = scene.pose(&walls, &mounts);
            if outside {
                // Beside all of it, within a car's length.
                pose.y = scene.offset.1 + 1.2 * size + random.within(-0.4, 0.4);
            }
            pair.compare(&pose);
        }
    }
}

/// Walls are lengthened where they meet: by how much beams pass a corner decides which they meet.
#[test]
fn a_beam_that_passes_a_corner_by_a_hair_meets_what_every_obstacle_says() {
    let mut random = random(5);
    let places = [
        (0.0_f32, Cells::Fine),
        (30.0, Cells::Coarse),
        (600.0, Cells::Fine),
        (20_000.0, Cells::Fine),
        (20_000.0, Cells::Coarse),
    ];
    for (far, cells) in places {
        let overlap = 1e-5_f32.max(8.0 * f32::EPSILON * far);
        for (crowded, large) in [(false, false), (true, false), (false, true)] {
            let mut scene =
                Scene { stream: crate::worlds::random(9), size: 6.0, offset: (far, -0.7 * far) };
            let mut walls = Vec::new();
            let mut corners = Vec::new();
            for corner in [90.0_f32, 90.0, 40.0, 140.0].into_iter().cycle().take(12) {
                let (x, y) = scene.place();
                let degrees = random.within(0.0, 360.0);
                let at = |degrees: f32, length: f32| {
                    let (sin, cos) = libm::sincosf(degrees.to_radians());
                    (x + length * cos, y + length * sin)
                };
                // Two that share a corner, and the line of a side.
                for (side, other) in [(degrees, corner), (degrees + 180.0, -corner)] {
                    let outline = [(x, y), at(side, 0.9), at(side + other, 0.7)];
                    scene.outline(&outline, &mut walls);
                    corners.extend(outline);
                }
            }
            if crowded {
                walls.extend(scene.posts());
            }
            if large {
                // So many, all out of range, that names mean something else from place to place.
                let (x, y) = scene.offset;
                let post = |n: u16| {
                    let (x, y) = (x + f32::from(n), y + 60.0);
                    Segment { a: (x, y), b: (x + 0.5, y) }
                };
                walls.extend((0..300).map(post));
                // In sight, and so long that it hides nothing, nor makes others doubtful.
                walls.push(Segment { a: (x - 30.0, y + 5.5), b: (x + 30.0, y + 6.5) });
            }
            let fan = Fan::new(&mounts(USUAL), 10.0);
            let mut pair = Pair::by(cells, walls, Vec::new(), fan, BODY);
            assert!(!(large && pair.lookout.beams_walk()), "{far}: no crowd");
            let mut poses = Vec::new();
            for _ in 0..4_000 {
                let (x, y) = scene.place();
                let corner = corners[random.index(corners.len())];
                let way = libm::hypotf(corner.0 - x, corner.1 - y);
                let aside = random.within(-9.0, 9.0) * overlap / way.max(overlap);
                let heading = libm::atan2f(corner.1 - y, corner.0 - x) + aside;
                poses.push(Pose::new(x, y, heading));
                pair.compare(&poses[poses.len() - 1]);
            }
            for set in Instructions::available() {
                let compared = set.run(SideBySide(&pair, &poses));
                assert!(compared > 9_000, "{far}, {set}: {compared} beams");
            }
            assert!(pair.seen > 10_000, "{far}: {} beams met something", pair.seen);
        }
    }
}

/// In a large world, one with more obstacles than names.
#[test]
fn a_place_with_as_many_obstacles_around_it_as_there_are_names_is_like_any_other() {
    for around in [254, 255, 256] {
        let post = |at: usize, y: f32| {
            let x = at as f32 * 0.03;
            Segment { a: (x, y), b: (x + 0.01, y) }
        };
        let near = (0..around).map(|at| post(at, 2.0));
        let walls = near.chain((0..300).map(|at| post(at, 60.0))).collect();
        let mut pair = Pair::new(walls, Vec::new(), Fan::new(&mounts(USUAL), 10.0), BODY);
        for step in 0..100 {
            let x = step as f32 * 0.07;
            pair.compare(&Pose::new(x, (step % 5) as f32 * 0.6, 0.5 + 0.02 * step as f32));
        }
        assert!(pair.seen > 50, "{around}: {} beams met something", pair.seen);
    }
}

/// Discs that touch, overlap or just miss each other: a field of cells like BARN's, and strings of
/// beads.
fn touching_discs(offset: f32, random: &mut Stream) -> Vec<Disc<f32>> {
    let mut discs = Vec::new();
    let radius = [0.075, 0.05, 0.2][random.index(3)];
    for cell in 0..400 {
        if random.chance(0.35) {
            let at = |index: usize| offset + (index as f32 + 0.5) * 2.0 * radius;
            discs.push(Disc { centre: (at(cell % 20), at(cell / 20)), radius });
        }
    }
    for _ in 0..random.index(6) {
        let (mut x, mut y) = (random.within(-3.0, 6.0), random.within(-3.0, 6.0));
        let turn = random.within(-PI, PI);
        let (dx, dy) = (libm::cosf(turn), libm::sinf(turn));
        let radius = random.within(0.02, 0.5);
        let apart = radius * [2.0, 2.0, 1.7, 2.0001][random.index(4)];
        for _ in 0..1 + random.index(9) {
            let radius = if random.chance(0.2) { radius * 0.5 } else { radius };
            discs.push(Disc { centre: (offset + x, offset + y), radius });
            (x, y) = (x + dx * apart, y + dy * apart);
        }
    }
    discs
}

/// Between rows of beads, lists hold those of the nearest row, unless beams pass between them.
#[test]
fn discs_that_touch_hide_what_is_behind_them() {
    // No crowd, in which beams would walk.
    let listed = |radius: f32| {
        let bead = |y: f32| (-15..15).map(move |n| Disc { centre: (n as f32 * 0.4, y), radius });
        let rows = [-4.0, -3.0, -2.0, 2.0, 3.0, 4.0];
        let discs = rows.into_iter().flat_map(bead).collect();
        let mut pair = Pair::new(Vec::new(), discs, Fan::new(&mounts(USUAL), 10.0), BODY);
        for step in 0..20 {
            pair.compare(&Pose::new(step as f32 * 0.05, 0.0, PI / 2.0 + step as f32 * 0.01));
        }
        pair.lookout.survey().seen.iter().sum::<usize>()
    };
    let [touching, apart] = [0.2, 0.16].map(listed);
    assert!(touching * 2 < apart, "{touching} where they touch, {apart} where they do not");
}

proptest! {
    /// Beams go anywhere, between two neighbours, or along a disc's edge.
    #[test]
    fn in_any_field_of_discs_a_lookout_sees_and_feels_what_every_disc_says(
        seed: u64,
        offset in prop_oneof![Just(0.0_f32), -300.0_f32..300.0],
        range in prop_oneof![Just(10.0_f32), 0.5_f32..40.0],
    ) {
        let mut random = random(seed);
        let discs = touching_discs(offset, &mut random);
        prop_assume!(!discs.is_empty());
        let mounts = mounts(USUAL);
        let mut walls = Vec::new();
        for _ in 0..random.index(3) {
            let mut place = || offset + random.within(-3.0, 7.0);
            walls.push(Segment { a: (place(), place()), b: (place(), place()) });
        }
        let mut pair = Pair::new(walls, discs.clone(), Fan::new(&mounts, range), BODY);
        for _ in 0..80 {
            let (mut x, mut y) =
                (offset + random.within(-3.0, 7.0), offset + random.within(-3.0, 7.0));
            let disc = discs[random.index(discs.len())];
            let (cx, cy) = disc.centre;
            let nearest = |other: &&Disc<f32>| {
                let apart = libm::hypotf(other.centre.0 - cx, other.centre.1 - cy);
                if apart == 0.0 { u32::MAX } else { apart.to_bits() }
            };
            let (nx, ny) = discs.iter().min_by_key(nearest).unwrap().centre;
            let heading = match random.index(5) {
                0 => random.within(-PI, PI),
                1 => libm::atan2f((cy + ny) * 0.5 - y, (cx + nx) * 0.5 - x),
                3 => {
                    // Square to both, so that it grazes both.
                    let away = random.within(0.0, 5.0);
                    let (ux, uy) = (ny - cy, cx - nx);
                    let apart = libm::hypotf(ux, uy).max(1e-3);
                    (x, y) = ((cx + nx) * 0.5 + ux / apart * away, (cy + ny) * 0.5 + uy / apart * away);
                    libm::atan2f(-uy, -ux)
                }
                2 => {
                    let half = libm::asinf((disc.radius / libm::hypotf(cx - x, cy - y)).min(1.0));
                    libm::atan2f(cy - y, cx - x) + if random.chance(0.5) { half } else { -half }
                }
                _ => random.within(-8.5, 8.5).round() * (PI / 8.0),
            };
            pair.compare(&Pose::new(x, y, heading - mounts[random.index(BEAMS)].angle));
        }
    }
}

#[test]
fn a_pose_outside_of_every_cell_or_not_a_number_is_answered_like_any_other() {
    let walls = vec![Segment { a: (0.0, 0.0), b: (1.0, 0.0) }];
    let mut pair = Pair::new(walls, Vec::new(), Fan::new(&mounts(USUAL), 10.0), BODY);
    for (x, y, heading) in [(-5.0, -5.0, 0.8), (0.5, 5.0, -1.6), (1e9, -1e9, 0.0), (0.5, 0.3, -1.5)]
    {
        pair.compare(&Pose::new(x, y, heading));
    }
    assert!(pair.seen > 3);
    for lost in [f32::NAN, f32::INFINITY] {
        let pose = Pose::new(lost, 0.0, 0.0);
        assert_eq!(pair.look(&pose), [f32::INFINITY; BEAMS]);
        assert!(!pair.feel(&pair.body, &pose));
    }
}

#[test]
fn a_wall_exactly_at_the_range_is_seen_from_anywhere_in_a_cell() {
    let mut random = random(72);
    for _ in 0..60 {
        // So that x + 10 is exact.
        let x = (random.within(0.0, 3.0) * 64.0).round() / 64.0;
        let wall = |x: f32| Segment { a: (x, -9.0), b: (x, 9.0) };
        let walls = vec![wall(-3.0), wall(x + 10.0)];
        let mut pair = Pair::new(walls, Vec::new(), Fan::new(&mounts([0.0; BEAMS]), 10.0), BODY);
        let pose = Pose::new(x, 0.0, 0.0);
        pair.compare(&pose);
        pair.compare(&Pose { x: x.next_down(), ..pose });
        assert!(pair.seen >= BEAMS, "{x}");
    }
}

/// Past the corner of a box some beams meet its near side and others the room's wall; none is left
/// for the far side that begins at that corner.
#[test]
fn of_a_box_only_the_near_sides_are_tested() {
    let square = |low: f32, high: f32| {
        let corners = [(low, low), (high, low), (high, high), (low, high)];
        [0, 1, 2, 3].map(|side| Segment { a: corners[side], b: corners[(side + 1) % 4] })
    };
    let walls = [square(0.0, 9.0), square(4.0, 5.0)].concat();
    let mut pair = Pair::new(walls, Vec::new(), Fan::new(&mounts(USUAL), 20.0), BODY);
    for (x, y) in [(2.0, 1.2), (4.4, 2.0), (7.5, 6.1)] {
        for heading in 0..720 {
            pair.compare(&Pose::new(x, y, 0.008_726_6 * (heading - 360) as f32));
        }
    }
    let survey = pair.lookout.survey();
    assert_eq!((survey.cells, survey.seen.last()), (3, Some(&2)));
}

/// A beam that runs along a wall meets it, by rounding, at any distance: before the wall that
/// hides it, too. Strange, but what the arithmetic says.
#[test]
fn a_hidden_wall_that_a_beam_runs_along_is_tested_all_the_same() {
    let mut random = random(73);
    let mut strange = 0;
    for _ in 0..3_000 {
        let angle = random.within(-PI, PI);
        let (sin, cos) = libm::sincosf(angle);
        let at = |ahead: f32, aside: f32| (cos * ahead - sin * aside, sin * ahead + cos * aside);
        let screen = Segment { a: at(3.0, -2.0), b: at(3.0, 2.0) };
        let hidden = Segment { a: at(6.0, 0.0), b: at(9.5, 0.0) };
        let walls = vec![screen, hidden, Segment { a: at(-3.0, -3.0), b: at(-3.0, 3.0) }];
        let fan = Fan::new(&mounts([0.0; BEAMS]), 20.0);
        let mut pair = Pair::new(walls, Vec::new(), fan, BODY);
        for _ in 0..8 {
            let mut near = || random.within(-3e-7, 3e-7);
            let pose = Pose::new(near(), near(), angle + near());
            pair.compare(&pose);
            let ray = pair.fan.rays(&pose)[0];
            let nearest = pair.truth.distance(&ray, 20.0);
            strange += usize::from(nearest < ray.to_segment(&screen));
        }
    }
    println!("{strange} beams met the hidden wall first");
    assert!(strange > 10, "{strange}");
}

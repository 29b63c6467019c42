//! What a beam costs, against the number of obstacles: `cargo bench -p host-trainer --bench beams
//! [-- --max OBSTACLES]`.
//!
//! Each line is one world. Cars drive about in it at random from five places; the same poses are
//! then answered by the lookout, by testing obstacles as `World::distance` does, and by parry2d.
//! Times are medians of rounds that take turns, so that what else the machine does falls on all
//! alike; trust the ratios.

use controller_core::geometry::{Body, Segment};
use controller_core::lane::Lanes;
use controller_core::motion::Pose;
use controller_core::observation::BeamMount;
use host_trainer::car::body_of;
use host_trainer::scenario;
use host_trainer::seed::{Purpose, RunSeed, Stream};
use host_trainer::world::{CORNER_OVERLAP, Fan, Lookout, Obstacles, World};
use parry2d::math::{Pose as At, Vector};
use parry2d::query::RayCast;
use parry2d::shape::{Compound, SharedShape};
use std::f32::consts::PI;
use std::hint::black_box;
use std::sync::Arc;
use std::time::{Duration, Instant};

const ROUNDS: usize = 5;
const CARS: usize = 80;
const STEPS: usize = 3000;
/// Steps after which a car starts again.
const EPISODE: usize = 300;
const RANGE: f32 = 10.0;

/// Eight boxes in a room of 10 m × 10 m: middle, half sizes, and the turn in degrees.
const BOXES: [[f32; 5]; 8] = [
    [2.0, 2.0, 0.5, 0.4, 0.0],
    [5.0, 1.6, 0.35, 0.7, 20.0],
    [8.0, 2.4, 0.6, 0.35, -35.0],
    [3.3, 4.6, 0.45, 0.45, 45.0],
    [6.6, 4.8, 0.4, 0.8, 0.0],
    [1.8, 7.4, 0.7, 0.3, 15.0],
    [4.9, 7.7, 0.4, 0.4, 0.0],
    [8.1, 7.6, 0.35, 0.65, -15.0],
];

/// One line of the table.
struct Case {
    name: String,
    walls: Vec<Segment<f32>>,
    obstacles: Obstacles,
    fan: Fan,
    body: Body<f32>,
    size: ([f32; 2], [f32; 2]),
    is_free: Box<dyn Fn([f32; 2]) -> bool>,
}

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    let max = arguments.iter().position(|argument| argument == "--max").map(|at| {
        let value = arguments.get(at + 1).and_then(|value| value.parse().ok());
        value.unwrap_or_else(|| {
            eprintln!("--max: expected a number of obstacles");
            std::process::exit(2)
        })
    });
    let max: usize = max.unwrap_or(100_000);
    println!(
        "{:<22} {:>9} {:>10} {:>9} {:>9} {:>9} {:>8} {:>7} {:>9}",
        "world", "obstacles", "start, ms", "lookout", "all", "parry2d", "touch", "seen", "KiB"
    );
    println!("{:<22} {:>9} {:>10} {:>39} ns per step", "", "", "", "ns per beam");
    let mut first = None;
    for case in cases(max) {
        let beam = case.measure();
        let reference = *first.get_or_insert(beam);
        println!("{:<22} {:>9} {:>10.1}× the first", "", "", beam / reference);
    }
}

fn cases(max: usize) -> impl Iterator<Item = Case> {
    let counts = std::iter::successors(Some(100_usize), |count| count.checked_mul(10));
    let counts: Vec<usize> = counts.take_while(|count| *count <= max).collect();
    let wider = counts.clone().into_iter().map(|count| floor("wider", tiles_for(count), 1));
    let finer = counts.into_iter().map(|count| floor("finer", 1, count / 36));
    let maps = ["depot", "tb3_sandbox", "barn_000", "medium_maze"].map(shipped);
    [empty(), floor("eight boxes", 1, 1)].into_iter().chain(wider).chain(finer).chain(maps)
}

/// How many rooms in a row make a square of about this many walls.
fn tiles_for(count: usize) -> usize {
    ((count as f32 / 32.0).sqrt().ceil() as usize).max(1)
}

fn usual_fan() -> Fan {
    let angles = [-30.0_f32, -15.0, 0.0, 15.0, 30.0].map(f32::to_radians);
    Fan::new(&angles.map(|angle| BeamMount { x: 0.0, y: 0.0, angle }), RANGE)
}

const BODY: Body<f32> = Body { rear: -0.35, front: 0.05, half_width: 0.1 };

fn corners(of: &[f32; 5]) -> [[f32; 2]; 4] {
    let [x, y, w, h, degrees] = *of;
    let (sin, cos) = libm::sincosf(degrees.to_radians());
    [[-w, -h], [w, -h], [w, h], [-w, h]]
        .map(|[dx, dy]| [x + cos * dx - sin * dy, y + sin * dx + cos * dy])
}

fn outline(corners: &[[f32; 2]], pieces: usize, walls: &mut Vec<Segment<f32>>) {
    for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        let at = |piece: usize| {
            let share = piece as f32 / pieces as f32;
            [a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share]
        };
        for piece in 0..pieces {
            let ([ax, ay], [bx, by]) = (at(piece), at(piece + 1));
            let length = libm::hypotf(bx - ax, by - ay);
            let largest = [ax, ay, bx, by].into_iter().map(f32::abs).fold(RANGE, f32::max);
            let overlap = CORNER_OVERLAP.max(8.0 * f32::EPSILON * largest) / length;
            let (ux, uy) = ((bx - ax) * overlap, (by - ay) * overlap);
            walls.push(Segment { a: (ax - ux, ay - uy), b: (bx + ux, by + uy) });
        }
    }
}

/// Rooms side by side without walls between them, their walls cut into pieces.
fn floor(kind: &str, rooms: usize, pieces: usize) -> Case {
    let pieces = pieces.max(1);
    let side = 10.0 * rooms as f32;
    let mut walls = Vec::new();
    outline(&[[0.0, 0.0], [side, 0.0], [side, side], [0.0, side]], pieces, &mut walls);
    for room in 0..rooms * rooms {
        let (dx, dy) = (10.0 * (room % rooms) as f32, 10.0 * (room / rooms) as f32);
        for shape in &BOXES {
            let corners = corners(shape).map(|[x, y]| [x + dx, y + dy]);
            outline(&corners, pieces, &mut walls);
        }
    }
    let is_free = |[x, y]: [f32; 2]| {
        let (x, y) = (x % 10.0, y % 10.0);
        !BOXES.iter().any(|[cx, cy, w, h, degrees]| {
            let (sin, cos) = libm::sincosf(degrees.to_radians());
            let (dx, dy) = (x - cx, y - cy);
            (cos * dx + sin * dy).abs() <= *w && (cos * dy - sin * dx).abs() <= *h
        })
    };
    Case {
        name: kind.to_owned(),
        obstacles: Obstacles::new(walls.clone(), Vec::new()),
        walls,
        fan: usual_fan(),
        body: BODY,
        size: ([0.0, 0.0], [side, side]),
        is_free: Box::new(is_free),
    }
}

/// Four walls around nothing.
fn empty() -> Case {
    let mut case = floor("empty room", 1, 1);
    case.walls.truncate(4);
    case.obstacles = Obstacles::new(case.walls.clone(), Vec::new());
    case.is_free = Box::new(|_| true);
    case
}

/// The walls of a shipped scenario.
fn shipped(name: &str) -> Case {
    let source = scenario::find(name).expect("a shipped scenario");
    let scenario = scenario::load(&source, None, &[]).expect("a shipped scenario");
    let world = World::new(&scenario).expect("a shipped world");
    let (walls, discs) = (world.segments().to_vec(), world.discs().to_vec());
    Case {
        name: name.to_owned(),
        obstacles: Obstacles::new(walls.clone(), discs),
        walls,
        fan: Fan::new(&scenario.sensors.beams, scenario.sensors.range),
        body: body_of(&scenario.vehicle),
        size: (world.bounds.min, world.bounds.max),
        is_free: Box::new(move |point| !world.is_inside_obstacle(point)),
    }
}

impl Case {
    /// Measures, prints the line, and returns nanoseconds per beam of the lookout.
    fn measure(self) -> f64 {
        let Self { name, walls, obstacles, fan, body, size, is_free } = self;
        let begin = Instant::now();
        let built = Obstacles::new(walls.clone(), obstacles.discs().to_vec());
        let lookout = Lookout::new(Arc::new(built), fan.clone(), body);
        let start = begin.elapsed();
        let poses = drives(&obstacles, &body, size, &is_free);
        let shapes = walls.iter().map(|wall| {
            let point = |(x, y): (f32, f32)| Vector::new(x, y);
            (At::IDENTITY, SharedShape::segment(point(wall.a), point(wall.b)))
        });
        let compound = Compound::new(shapes.collect());

        let look = |poses: &[Pose<f32>]| {
            for pose in poses {
                black_box(lookout.fan::<Lanes<8>>(black_box(pose)));
            }
        };
        let touch = |poses: &[Pose<f32>]| {
            for pose in poses {
                black_box(lookout.touches(black_box(pose)));
            }
        };
        let all = |poses: &[Pose<f32>]| {
            for ray in poses.iter().flat_map(|pose| fan.rays(pose)) {
                black_box(obstacles.distance(&ray, fan.range()));
            }
        };
        let parry = |poses: &[Pose<f32>]| {
            for ray in poses.iter().flat_map(|pose| fan.rays(pose)) {
                let point = |(x, y): (f32, f32)| Vector::new(x, y);
                let ray = parry2d::query::Ray::new(point(ray.origin), point(ray.direction));
                black_box(compound.cast_ray(&At::IDENTITY, &ray, fan.range(), false));
            }
        };
        // Until every cell that will be made is made.
        for _ in 0..3 {
            look(&poses);
        }
        let few = &poses[..poses.len() / 20];
        let mut times: [Vec<f64>; 4] = Default::default();
        for _ in 0..ROUNDS {
            times[0].push(nanoseconds(poses.len() * 5, || look(&poses)));
            times[1].push(nanoseconds(few.len() * 5, || all(few)));
            times[2].push(nanoseconds(few.len() * 5, || parry(few)));
            times[3].push(nanoseconds(poses.len(), || touch(&poses)));
        }
        let [beam, all, parry, touch] = times.map(median);
        let survey = lookout.survey();
        let middle = survey.seen.get(survey.seen.len() / 2).copied().unwrap_or(0);
        println!(
            "{name:<22} {:>9} {:>10.1} {beam:>9.1} {all:>9.1} {parry:>9.1} {touch:>8.1} {middle:>7} {:>9}",
            walls.len() + obstacles.discs().len(),
            milliseconds(start),
            survey.bytes / 1024,
        );
        beam
    }
}

/// Cars that steer at random, and start again where they touch something or after a while.
fn drives(
    obstacles: &Obstacles,
    body: &Body<f32>,
    (low, high): ([f32; 2], [f32; 2]),
    is_free: &dyn Fn([f32; 2]) -> bool,
) -> Vec<Pose<f32>> {
    let mut random = RunSeed(1).stream(Purpose::Episode, 0, 0);
    let mut start = || loop {
        let (x, y) = (random.within(low[0], high[0]), random.within(low[1], high[1]));
        let pose = Pose::new(x, y, random.within(-PI, PI));
        if is_free([x, y]) && !obstacles.touch(body, &pose) {
            return pose;
        }
    };
    let starts: [Pose<f32>; 5] = std::array::from_fn(|_| start());
    let mut cars: Vec<(Pose<f32>, f32)> =
        (0..CARS).map(|car| (starts[car % starts.len()], 0.0)).collect();
    let mut poses = Vec::with_capacity(CARS * STEPS);
    let steer = |random: &mut Stream| random.within(-0.6, 0.6);
    for step in 0..STEPS {
        for (car, (pose, angle)) in cars.iter_mut().enumerate() {
            if random.index(20) == 0 {
                *angle = steer(&mut random);
            }
            let moved = pose.driven(*angle, 0.1, 0.3);
            let again = step % EPISODE == EPISODE - 1 || obstacles.touch(body, &moved);
            *pose = if again { starts[car % starts.len()] } else { moved };
            poses.push(*pose);
        }
    }
    poses
}

fn nanoseconds(count: usize, work: impl FnOnce()) -> f64 {
    let begin = Instant::now();
    work();
    begin.elapsed().as_secs_f64() * 1e9 / count.max(1) as f64
}

fn milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1e3
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

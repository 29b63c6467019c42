//! The body against walls and discs: an exact cut and parry2d's rectangle as oracles.

use crate::parry::{touches_disc, touches_wall};
use crate::worlds::random;
use controller_core::geometry::{Body, Disc, Segment};
use controller_core::motion::Pose;
use host_trainer::seed::Stream;
use std::f32::consts::PI;

const BODY: Body<f32> = Body { rear: -0.35, front: 0.05, half_width: 0.1 };

/// Bodies that are nearer to touching than this may be judged either way, metres.
const DOUBT: f32 = 1.0e-5;

/// Fails unless `ours` is the oracle's answer for a body at most [`DOUBT`] larger or smaller.
fn agree(ours: bool, touches: impl Fn(f32) -> bool) {
    let (larger, smaller) = (touches(DOUBT), touches(-DOUBT));
    assert!(
        if ours { larger } else { !smaller },
        "ours {ours}, larger {larger}, smaller {smaller}"
    );
}

/// Whether any part of a wall is left when it is cut off at the body's four sides, in 64 bits
/// (Liang and Barsky); the body is grown by `more` on every side.
fn cut(body: &Body<f32>, pose: &Pose<f32>, wall: &Segment<f32>, more: f32) -> bool {
    let heading = f64::from(pose.heading);
    let (sin, cos) = (libm::sin(heading), libm::cos(heading));
    let in_body = |(x, y): (f32, f32)| {
        let (dx, dy) = (f64::from(x) - f64::from(pose.x), f64::from(y) - f64::from(pose.y));
        [cos * dx + sin * dy, cos * dy - sin * dx]
    };
    let (a, b, more) = (in_body(wall.a), in_body(wall.b), f64::from(more));
    let half_width = f64::from(body.half_width);
    let sides = [(f64::from(body.rear), f64::from(body.front)), (-half_width, half_width)];
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    for (axis, (low, high)) in sides.into_iter().enumerate() {
        let (from, along) = (a[axis], b[axis] - a[axis]);
        let [t, u] = [(low - more - from) / along, (high + more - from) / along];
        (first, last) = (first.max(t.min(u)), last.min(t.max(u)));
    }
    first <= last
}

/// Random walls, bodies and poses: ours must be exact; parry nearly always agrees. Returns how
/// many touch.
fn compare(seed: u64, count: u32, body: impl Fn(&mut Stream) -> Body<f32>) -> u32 {
    let mut random = random(seed);
    let (mut touching, mut parry_differs) = (0, 0);
    for _ in 0..count {
        let body = body(&mut random);
        let mut place = |size: f32| (random.within(-size, size), random.within(-size, size));
        let ((x, y), wall) = (place(0.5), Segment { a: place(1.0), b: place(1.0) });
        let pose = Pose::new(x, y, random.within(-PI, PI));
        let ours = body.touches_segment(&pose, &wall);
        touching += u32::from(ours);
        agree(ours, |more| cut(&body, &pose, &wall, more));
        parry_differs += u32::from(ours != touches_wall(&body, &pose, &wall));
    }
    println!("parry differs in {parry_differs} of {count}");
    assert!(parry_differs * 1000 < count, "{parry_differs} of {count}");
    touching
}

#[test]
fn a_body_touches_a_wall_exactly_when_a_part_of_the_wall_lies_in_it() {
    let touching = compare(21, 200_000, |_| BODY);
    assert!((20_000..180_000).contains(&touching), "{touching}");
}

#[test]
fn every_shape_of_body_is_judged_alike() {
    compare(23, 200_000, |random| {
        let front = random.within(0.0, 0.3);
        let rear = front - random.within(0.01, 1.0);
        Body { rear, front, half_width: random.within(0.005, 0.4) }
    });
}

#[test]
fn a_body_touches_a_disc_exactly_when_parry_says_so() {
    let mut random = random(22);
    let mut touching = 0;
    for _ in 0..200_000 {
        let mut place = |size: f32| (random.within(-size, size), random.within(-size, size));
        let ((x, y), centre) = (place(0.3), place(0.5));
        let disc = Disc { centre, radius: random.within(0.001, 0.5) };
        let pose = Pose::new(x, y, random.within(-PI, PI));
        let ours = BODY.touches_disc(&pose, &disc);
        touching += usize::from(ours);
        agree(ours, |more| touches_disc(&BODY, &pose, &disc, more));
    }
    assert!((40_000..160_000).contains(&touching), "{touching}");
}

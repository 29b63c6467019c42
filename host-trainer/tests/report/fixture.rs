//! Drives to draw, without a simulator: a kinematic car that follows waypoints among the
//! boxes of the paper's Fig. 4, with beams cast by hand.

use std::f32::consts::PI;

use host_trainer::report::data::{
    BEAMS, BeamMount, BodyShape, Drive, Echo, Generation, Moment, Outcome, ReportData, Scene,
};
use host_trainer::report::loops;

pub(crate) const BODY: BodyShape =
    BodyShape { length: 0.4, width: 0.2, front_overhang: 0.05, wheelbase: 0.3 };
const BOXES: [[f32; 4]; 5] = [
    [2.0, 2.0, 3.0, 4.0],
    [5.0, 1.0, 6.0, 3.0],
    [7.0, 5.0, 9.0, 6.0],
    [3.0, 6.0, 4.0, 9.0],
    [5.5, 7.0, 6.5, 8.0],
];
const ROOM: f32 = 10.0;
const RANGE: f32 = 3.0;
const STEP: f32 = 0.1;
const TARGET: f32 = 0.4;

/// A page's worth: five drives that end in five different ways, and sixty generations.
pub(crate) fn report() -> ReportData {
    ReportData {
        title: "obstacles, seed 1".to_owned(),
        summary: "Champion of 60 generations of 120 individuals, 7-12-12-1, Elman recurrence."
            .to_owned(),
        scene: scene(),
        body: BODY,
        beams: beams(),
        beam_range: RANGE,
        period: 0.1,
        drives: vec![clean(), scraping(), circling(), stuck(), wandering()],
        history: history(),
        settings: serde_json::json!({
            "world": { "outer_wall": true, "target_radius": 0.4_f32, "boxes": BOXES },
            "vehicle": { "length": 0.4_f32, "width": 0.2_f32, "step": { "constant": 0.1_f32 } },
            "training": { "population": 120, "generations": 60,
                "ga": { "mutation_rate": 0.1_f32, "selection": "sus" } },
            "name": "obstacles",
        }),
        provenance: vec![
            ("Seed".to_owned(), "1".to_owned()),
            ("Program".to_owned(), "evosteer 0.1.0".to_owned()),
            ("Champion".to_owned(), "sha256 5f3b9c0e8d5a4c1b".to_owned()),
        ],
    }
}

/// The room of the paper's Fig. 4.
pub(crate) fn scene() -> Scene {
    let polygon = |[x0, y0, x1, y1]: [f32; 4]| vec![[x0, y0], [x1, y0], [x1, y1], [x0, y1]];
    Scene {
        name: "obstacles".to_owned(),
        bounds: [[0.0, 0.0], [ROOM, ROOM]],
        outer_wall: true,
        target_radius: TARGET,
        polygons: BOXES.map(polygon).to_vec(),
        circles: Vec::new(),
        segments: Vec::new(),
        outlines: Vec::new(),
    }
}

/// Between the boxes to the target.
pub(crate) fn clean() -> Drive {
    let by = [[3.7, 1.6], [4.3, 4.6], [5.4, 6.3], [7.0, 6.7], [8.6, 8.8]];
    drive([1.0, 1.0, 0.4], [8.6, 8.8], 300, towards(&by))
}

/// To the target, touching a box on the way.
pub(crate) fn scraping() -> Drive {
    let mut at_the_box = towards(&[[5.5, 3.0]]);
    let mut past_it = towards(&[[4.4, 4.0], [6.6, 4.2], [9.5, 4.4], [9.5, 6.6], [7.5, 9.0]]);
    drive([4.2, 0.8, 0.5], [7.5, 9.0], 300, move |k, pose| {
        if k < 17 { at_the_box(k, pose) } else { past_it(k, pose) }
    })
}

/// Misses the target and circles in free space (the paper's Fig. 8).
pub(crate) fn circling() -> Drive {
    let mut approach = towards(&[[4.5, 4.8], [6.8, 4.2]]);
    drive(
        [1.0, 5.2, 0.0],
        [9.2, 9.2],
        300,
        move |k, pose| {
            if k < 45 { approach(k, pose) } else { 0.3 }
        },
    )
}

/// Straight into a box.
pub(crate) fn stuck() -> Drive {
    drive([4.5, 5.0, PI], [1.0, 9.0], 300, |_, pose| 0.5 * angle(PI - 0.55 - pose[2]))
}

/// Never finds the target and never repeats itself.
pub(crate) fn wandering() -> Drive {
    let by = [
        [8.5, 1.2],
        [9.2, 3.4],
        [6.6, 4.4],
        [4.6, 5.0],
        [1.4, 5.2],
        [1.0, 7.6],
        [1.8, 8.8],
        [2.3, 5.4],
        [4.8, 5.4],
        [5.0, 8.6],
        [8.0, 9.0],
    ];
    drive([7.0, 1.2, 0.0], [1.0, 1.0], 300, towards(&by))
}

/// Any kinematic drive: `steer` sees the number of moves made and the pose.
pub(crate) fn drive(
    start: [f32; 3],
    goal: [f32; 2],
    limit: usize,
    mut steer: impl FnMut(usize, [f32; 3]) -> f32,
) -> Drive {
    let mut pose = start;
    let mut moments = Vec::new();
    let (mut collided, mut collisions, mut length) = (false, 0, 0.0);
    let reached = loop {
        let phi = steer(moments.len(), pose);
        let reached = away(pose, goal) < TARGET;
        let ended = reached || moments.len() == limit;
        let step = if ended { 0.0 } else { STEP };
        let beams = read_beams(pose, goal);
        let [x, y, heading] = pose;
        moments.push(Moment { x, y, heading, steer: phi, step, beams, collided });
        if ended {
            break reached;
        }
        let next = [
            x + STEP * libm::cosf(heading + phi),
            y + STEP * libm::sinf(heading + phi),
            heading + STEP / BODY.wheelbase * libm::sinf(phi),
        ];
        collided = touches(next);
        // `hold`: the position is kept, the heading still follows.
        pose = if collided { [x, y, next[2]] } else { next };
        collisions += u32::from(collided);
        length += if collided { 0.0 } else { STEP };
    };
    let steps = moments.len() as u32 - 1;
    let distance = away(pose, goal);
    let outcome = Outcome { reached, collisions, length, distance, steps };
    let mut drive = Drive { start, goal, outcome, moments, loop_period: None };
    drive.loop_period = loops::period(&drive);
    drive
}

/// Steers to each waypoint in turn.
fn towards(waypoints: &[[f32; 2]]) -> impl FnMut(usize, [f32; 3]) -> f32 {
    let mut left: Vec<_> = waypoints.iter().rev().copied().collect();
    move |_, pose| {
        if left.len() > 1 && away(pose, left[left.len() - 1]) < 0.35 {
            left.pop();
        }
        let [x, y] = left[left.len() - 1];
        angle(libm::atan2f(y - pose[1], x - pose[0]) - pose[2]).clamp(-1.0, 1.0)
    }
}

pub(crate) fn beams() -> [BeamMount; BEAMS] {
    [-30.0_f32, -15.0, 0.0, 15.0, 30.0].map(|degrees| BeamMount {
        x: 0.05,
        y: degrees / 400.0,
        angle: degrees.to_radians(),
    })
}

fn read_beams(pose: [f32; 3], goal: [f32; 2]) -> [Echo; BEAMS] {
    beams().map(|mount| {
        let (sin, cos) = libm::sincosf(pose[2]);
        let from =
            [pose[0] + mount.x * cos - mount.y * sin, pose[1] + mount.x * sin + mount.y * cos];
        let along = [libm::cosf(pose[2] + mount.angle), libm::sinf(pose[2] + mount.angle)];
        // Marching in centimetres is exact enough to look at.
        for centimetre in 0..(RANGE * 100.0) as usize {
            let distance = centimetre as f32 / 100.0;
            let point = [from[0] + along[0] * distance, from[1] + along[1] * distance];
            if libm::hypotf(point[0] - goal[0], point[1] - goal[1]) < TARGET {
                return Echo::Target(distance);
            }
            if solid(point) {
                return Echo::Wall(distance);
            }
        }
        Echo::Nothing
    })
}

fn touches([x, y, heading]: [f32; 3]) -> bool {
    let (sin, cos) = libm::sincosf(heading);
    let rear = BODY.front_overhang - BODY.length;
    (0..=20).any(|i| {
        let along = rear + BODY.length * i as f32 / 20.0;
        [-0.5, 0.0, 0.5].iter().any(|side| {
            let across = BODY.width * side;
            solid([x + along * cos - across * sin, y + along * sin + across * cos])
        })
    })
}

fn solid([x, y]: [f32; 2]) -> bool {
    let room = 0.0..=ROOM;
    !room.contains(&x)
        || !room.contains(&y)
        || BOXES.iter().any(|b| (b[0]..=b[2]).contains(&x) && (b[1]..=b[3]).contains(&y))
}

fn away(pose: [f32; 3], goal: [f32; 2]) -> f32 {
    libm::hypotf(pose[0] - goal[0], pose[1] - goal[1])
}

/// An angle between −π and π.
fn angle(radians: f32) -> f32 {
    (radians + PI).rem_euclid(2.0 * PI) - PI
}

/// A run as it usually goes: the best falls in steps, the mean follows, the worst does not.
fn history() -> Vec<Generation> {
    (0..=60)
        .map(|number| {
            let progress = f64::from(number) / 60.0;
            let reached = (progress * 7.0).floor().min(4.0);
            let wobble = f64::from((number * 37) % 11);
            let best = 21_000.0 - 9_000.0 * progress - 7_500.0 * reached;
            Generation {
                number,
                best,
                mean: best + 24_000.0 - 8_000.0 * progress + 900.0 * wobble,
                worst: 196_000.0 + 4_000.0 * f64::from((number * 53) % 13),
                collisions: (38.0 * (1.0 - progress) * (1.0 - progress) - wobble / 3.0)
                    .max(0.0)
                    .floor(),
                distance: 22.0 - 5.0 * reached + wobble / 10.0,
                reached: reached as u32,
                pairs: 5,
                length: 118.0 - 14.0 * reached - wobble,
            }
        })
        .collect()
}

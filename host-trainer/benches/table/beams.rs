//! What a beam and a contact cost, against the number of walls; parry2d beside them.

use crate::poses;
use crate::row::Row;
use crate::scenes::{self, Scene};
use crate::timing::{median, nanoseconds};
use controller_core::geometry::Body;
use controller_core::motion::Pose;
use controller_core::observation::BEAMS;
use host_trainer::bench::parts;
use host_trainer::bench::reference::Reference;
use host_trainer::car::body_of;
use host_trainer::problem::Problem;
use host_trainer::vector::Instructions;
use host_trainer::world::{Fan, Lookout, World};
use std::hint::black_box;
use std::time::{Duration, Instant};

const ROUNDS: usize = 5;

/// parry2d is asked from one pose of this many.
const SPARSE: usize = 20;

/// Longest time to get to know a world.
const MOST_READY: Duration = Duration::from_secs(2);

/// From this many walls on, beams are also compared with those among 36.
const LARGE: usize = 50_000;

/// Distances may differ by this much, metres, but for beams at a wall's very end.
const TOLERANCE: f32 = 1e-3;

/// Nanoseconds of our beams and contacts in one world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cost {
    /// Per beam.
    pub(crate) beam: f64,
    /// Per body.
    pub(crate) contact: f64,
}

/// The lines of the table, and what a beam and a contact cost in the workload's own world.
pub(crate) fn measure(problem: &Problem, max: usize) -> (Vec<Row>, Cost) {
    let sensors = &problem.scenario.sensors;
    let (fan, body) = (Fan::new(&sensors.beams, sensors.range), body_of(&problem.scenario.vehicle));
    let mut rows = Vec::new();
    let poses = parts::poses(problem, 16, 300);
    let here = compare("workload", &problem.world, &fan, body, &poses, &mut rows);
    let mut at_36 = None;
    for scene in scenes::all(max) {
        let Scene { family, world, .. } = &scene;
        let poses = poses::random_drives(&scene, &body);
        let walls = world.segments().len();
        let cost = compare(family, world, &fan, body, &poses, &mut rows);
        if walls == 36 {
            at_36 = Some(cost.beam);
        } else if let (true, Some(few)) = (walls > LARGE, at_36) {
            let times = cost.beam / few;
            rows.push(Row::new(
                "beam",
                format!("{walls} walls in {family}, to 36"),
                times,
                "times",
            ));
        }
    }
    (rows, here)
}

fn compare(
    family: &str,
    world: &World,
    fan: &Fan,
    body: Body<f32>,
    poses: &[Pose<f32>],
    rows: &mut Vec<Row>,
) -> Cost {
    let set = Instructions::in_use();
    let begun = Instant::now();
    let lookout = world.lookout(fan.range(), body);
    let known = visit(&lookout, fan, &body, poses, set);
    let poses = &poses[..known];
    let ready = begun.elapsed().as_secs_f64() * 1e3;
    let begun = Instant::now();
    let reference = Reference::new(world.segments(), &body);
    let their_ready = begun.elapsed().as_secs_f64() * 1e3;

    let few: Vec<Pose<f32>> = poses.iter().step_by(SPARSE).copied().collect();
    agree(&lookout, &reference, fan, &few);
    let mut times: [Vec<f64>; 4] = Default::default();
    for _ in 0..ROUNDS {
        let (beams, few_beams) = (poses.len() * BEAMS, few.len() * BEAMS);
        times[0].push(nanoseconds(beams, || parts::look(&lookout, fan, poses, set)));
        times[1].push(nanoseconds(few_beams, || {
            for ray in few.iter().flat_map(|pose| fan.rays(pose)) {
                black_box(reference.distance(&ray, fan.range()));
            }
        }));
        times[2].push(nanoseconds(poses.len(), || parts::touch(&lookout, &body, poses, set)));
        times[3].push(nanoseconds(few.len(), || {
            few.iter().for_each(|pose| _ = black_box(reference.touches(black_box(pose))));
        }));
    }
    let [beam, their_beam, contact, their_contact] = times.map(median);
    let case = format!("{} walls in {family}", world.segments().len());
    rows.push(Row::new("beam", case.clone(), beam, "ns").beside_time("parry2d", their_beam));
    rows.push(
        Row::new("contact", case.clone(), contact, "ns").beside_time("parry2d", their_contact),
    );
    rows.push(Row::new("ready", case, ready, "ms").beside_time("parry2d", their_ready));
    Cost { beam, contact }
}

/// Poses visited at a time: any number of cars side by side.
const FEW: usize = 960;

/// Visits every place, since places are looked at closely where cars turn up; gives up after [`MOST_READY`]. Returns how many poses were visited at all.
fn visit(
    lookout: &Lookout,
    fan: &Fan,
    body: &Body<f32>,
    poses: &[Pose<f32>],
    set: Instructions,
) -> usize {
    let begun = Instant::now();
    let mut known = 0;
    for few in poses.chunks(FEW) {
        parts::look(lookout, fan, few, set);
        parts::touch(lookout, body, few, set);
        known += few.len();
        if begun.elapsed() > MOST_READY {
            break;
        }
    }
    known
}

/// # Panics
///
/// If many distances are not parry2d's.
fn agree(lookout: &Lookout, reference: &Reference, fan: &Fan, poses: &[Pose<f32>]) {
    let (mut beams, mut differing) = (0, 0);
    for pose in poses {
        for (ours, ray) in parts::distances(lookout, fan, pose).into_iter().zip(fan.rays(pose)) {
            let theirs = reference.distance(&ray, fan.range());
            beams += 1;
            // Both may be infinite.
            let same = ours == theirs || (ours - theirs).abs() <= TOLERANCE;
            differing += usize::from(!same);
        }
    }
    assert!(differing * 500 <= beams, "{differing} of {beams} beams end elsewhere than parry2d's");
}

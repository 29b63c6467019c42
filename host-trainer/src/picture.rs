//! From simulated drives to what the report draws.

use crate::episode::{Outcome, Trace};
use crate::problem::Problem;
use crate::report::data::{self, BodyShape, Drive, Generation, Moment, ReportData, Scene};
use crate::report::loops;
use crate::run_folder::MetricsRow;
use crate::scenario::Pair;
use crate::seed::Stream;

/// The problem's world as the report draws it.
pub fn scene(problem: &Problem) -> Scene {
    let spec = &problem.scenario.world;
    let discs = problem.world.discs().iter();
    Scene {
        name: problem.scenario.name.clone(),
        bounds: [problem.world.bounds.min, problem.world.bounds.max],
        outer_wall: spec.outer_wall,
        target_radius: spec.target_radius,
        polygons: problem.world.polygons(),
        circles: discs.map(|disc| [disc.centre.0, disc.centre.1, disc.radius]).collect(),
        segments: problem.world.sheets().to_vec(),
        outlines: problem.world.outlines(),
    }
}

/// The car's rectangle.
pub fn body(problem: &Problem) -> BodyShape {
    let vehicle = &problem.scenario.vehicle;
    BodyShape {
        length: vehicle.length,
        width: vehicle.width,
        front_overhang: vehicle.front_overhang,
        wheelbase: vehicle.wheelbase,
    }
}

/// Steps that a page shows, all drives together: beyond them a browser no longer keeps up.
const MOST_MOMENTS: usize = 200_000;

/// Drives the pairs with the controller over `genome` and keeps what there is to see. Drive
/// `i` gets the random numbers of `place(i)`.
///
/// Ends early, after at least one drive, where there would be more steps than a page can show.
pub fn drives(
    problem: &Problem,
    genome: &[f32],
    pairs: &[Pair],
    place: impl Fn(u32) -> Stream,
) -> Vec<Drive> {
    let mut brain = problem.brain(genome).expect("the problem's topology");
    let mut film = |(index, pair): (u32, &Pair)| {
        let (outcome, trace) = problem.drive_traced(brain.as_mut(), pair, place(index));
        drive(pair, &outcome, &trace)
    };
    let mut drives = Vec::new();
    let mut moments = 0;
    for numbered in (0..).zip(pairs) {
        let drive = film(numbered);
        moments += drive.moments.len();
        if moments > MOST_MOMENTS && !drives.is_empty() {
            break;
        }
        drives.push(drive);
    }
    drives
}

fn drive(pair: &Pair, outcome: &Outcome, trace: &Trace) -> Drive {
    let mut collided = false;
    let mut moments: Vec<Moment> = Vec::with_capacity(trace.steps.len() + 1);
    for step in &trace.steps {
        moments.push(Moment {
            x: step.pose.x,
            y: step.pose.y,
            heading: step.pose.heading,
            steer: step.done.steer.radians(),
            step: step.done.step.metres(),
            beams: step.echoes,
            collided,
        });
        collided = step.collided;
    }
    if let Some(end) = trace.end {
        moments.push(Moment {
            x: end.pose.x,
            y: end.pose.y,
            heading: end.pose.heading,
            steer: moments.last().map_or(0.0, |last| last.steer),
            step: 0.0,
            beams: end.echoes,
            collided,
        });
    }
    let mut drive = Drive {
        start: pair.start,
        goal: pair.goal,
        outcome: data::Outcome {
            reached: outcome.reached,
            collisions: outcome.collisions,
            length: outcome.path_length,
            distance: outcome.distance_to_target,
            steps: outcome.steps,
        },
        moments,
        loop_period: None,
    };
    drive.loop_period = loops::period(&drive);
    drive
}

/// The metrics as the report plots them.
pub fn history(rows: &[MetricsRow], pairs: usize) -> Vec<Generation> {
    let generation = |row: &MetricsRow| Generation {
        number: row.generation,
        best: row.best,
        mean: row.mean,
        worst: row.worst,
        collisions: row.collisions as f64,
        distance: row.distance_to_target,
        reached: row.bonus,
        pairs: pairs as u32,
        length: row.path_length,
    };
    rows.iter().map(generation).collect()
}

/// The page's data: the world, the car, its drives, and where all that comes from.
pub fn report(
    problem: &Problem,
    title: String,
    summary: String,
    drives: Vec<Drive>,
    history: Vec<Generation>,
    provenance: Vec<(String, String)>,
) -> ReportData {
    let scenario = &problem.scenario;
    ReportData {
        title,
        summary,
        scene: scene(problem),
        body: body(problem),
        beams: scenario.sensors.beams,
        beam_range: scenario.sensors.range,
        period: scenario.episode.period,
        drives,
        history,
        settings: serde_json::to_value(scenario).unwrap_or_default(),
        provenance,
    }
}

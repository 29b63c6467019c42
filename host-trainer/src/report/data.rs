//! What a report is made from: metres, radians counter-clockwise, x forward, y left.

pub use controller_core::observation::{BEAMS, BeamMount, Echo};

/// Everything on one page.
#[derive(Clone, Debug)]
pub struct ReportData {
    /// Heading of the page.
    pub title: String,
    /// A sentence or two under the heading; may be empty.
    pub summary: String,
    /// The world every drive took place in.
    pub scene: Scene,
    /// The car.
    pub body: BodyShape,
    /// Where the beams start and point, in the frame of the front axle, rightmost first.
    pub beams: [BeamMount; BEAMS],
    /// Longest distance a beam reports, metres.
    pub beam_range: f32,
    /// Control period, seconds, above 0; sets what "real time" means in the replay.
    pub period: f32,
    /// The champion's drives, in the order of the start/goal pairs.
    pub drives: Vec<Drive>,
    /// One row per generation, oldest first; empty where nothing was trained.
    pub history: Vec<Generation>,
    /// The resolved settings, nested as in the scenario; `Null` where there are none.
    pub settings: serde_json::Value,
    /// Where the result comes from, as name and value: seed, versions, hashes.
    pub provenance: Vec<(String, String)>,
}

/// The obstacles and the size of the target.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Scene {
    /// The scenario's name.
    pub name: String,
    /// Lower left and upper right corner of the room.
    pub bounds: [[f32; 2]; 2],
    /// Whether the room's edge is a wall.
    pub outer_wall: bool,
    /// Radius of the target disc.
    pub target_radius: f32,
    /// Solid polygons, boxes among them.
    pub polygons: Vec<Vec<[f32; 2]>>,
    /// Solid discs as `[x, y, radius]`.
    pub circles: Vec<[f32; 3]>,
    /// Walls without thickness as `[x0, y0, x1, y1]`.
    pub segments: Vec<[f32; 4]>,
    /// Closed loops around the solid cells of an occupancy grid: what they wind around an odd
    /// number of times is solid.
    pub outlines: Vec<Vec<[f32; 2]>>,
}

/// The car's rectangle. The reference point is the middle of the front axle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyShape {
    /// Body length.
    pub length: f32,
    /// Body width.
    pub width: f32,
    /// From the front axle to the front bumper.
    pub front_overhang: f32,
    /// Between the axles.
    pub wheelbase: f32,
}

/// One task to show on a map.
#[derive(Clone, Debug, PartialEq)]
pub struct Task {
    /// A short name, written at start and goal.
    pub label: String,
    /// Start pose of the front axle: x, y, heading.
    pub start: [f32; 3],
    /// Centre of the target disc.
    pub goal: [f32; 2],
}

/// One task, and how the car did.
#[derive(Clone, Debug, PartialEq)]
pub struct Drive {
    /// Start pose of the front axle: x, y, heading.
    pub start: [f32; 3],
    /// Centre of the target disc.
    pub goal: [f32; 2],
    /// How it ended.
    pub outcome: Outcome,
    /// The drive itself: entry `k` is the moment after `k` moves, entry 0 the start.
    pub moments: Vec<Moment>,
    /// Length in moves of the loop the car ended up in, if it did; see
    /// [`loops::period`](super::loops::period). 1 means it stood still.
    pub loop_period: Option<usize>,
}

impl Drive {
    /// How it ended, in words: `reached, clean`, `not reached, loop of 63 moves`.
    pub fn verdict(&self) -> String {
        let Outcome { reached, collisions, .. } = self.outcome;
        let collisions = match collisions {
            0 => String::new(),
            1 => ", 1 collision".to_owned(),
            n => format!(", {n} collisions"),
        };
        match (reached, self.loop_period) {
            (true, _) if collisions.is_empty() => "reached, clean".to_owned(),
            (true, _) => format!("reached{collisions}"),
            (false, Some(1)) => format!("not reached, stuck{collisions}"),
            (false, Some(moves)) => format!("not reached, loop of {moves} moves{collisions}"),
            (false, None) => format!("not reached{collisions}"),
        }
    }
}

/// How a drive ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// Whether the target was touched within the step limit.
    pub reached: bool,
    /// Moves that touched an obstacle.
    pub collisions: u32,
    /// Length of the path, metres.
    pub length: f32,
    /// Between car and target at the end, metres.
    pub distance: f32,
    /// Moves made.
    pub steps: u32,
}

impl Outcome {
    /// Reached without one collision.
    pub fn clean(&self) -> bool {
        self.reached && self.collisions == 0
    }
}

/// One control period of a drive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// Front axle, metres.
    pub x: f32,
    /// Front axle, metres.
    pub y: f32,
    /// Heading of the body.
    pub heading: f32,
    /// Angle of the front wheels, positive to the left.
    pub steer: f32,
    /// Length of the move that starts here, metres; 0 at the end.
    pub step: f32,
    /// What the beams read here, in the order of the mounts.
    pub beams: [Echo; BEAMS],
    /// Whether the move that led here touched an obstacle.
    pub collided: bool,
}

/// One generation of a training run. Fitness is minimised.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Generation {
    /// Counted from 0, the random population.
    pub number: u32,
    /// Lowest fitness.
    pub best: f64,
    /// Mean fitness.
    pub mean: f64,
    /// Highest fitness.
    pub worst: f64,
    /// Collisions of the best individual, summed over its pairs.
    pub collisions: f64,
    /// Distance to the target at the end, of the best individual, metres, summed.
    pub distance: f64,
    /// Pairs on which the best individual reached the target.
    pub reached: u32,
    /// Pairs it was judged on.
    pub pairs: u32,
    /// Path length of the best individual, metres, summed.
    pub length: f64,
}

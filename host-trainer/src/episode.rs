//! One drive: from a start towards a goal, until it is reached, time is up, or a crash ends it.

use crate::brain::Brain;
use crate::car::{CarModel, SimulatedCar};
use crate::scenario::{EpisodeSpec, OnCollision, Pair};
use crate::seed::Stream;
use crate::world::{Lookout, World};
use controller_core::control_loop::tick;
use controller_core::controller::Command;
use controller_core::motion::Pose;
use controller_core::observation::{BEAMS, Echo};
use serde::{Deserialize, Serialize};

/// How a drive went.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    /// Whether the target was touched within the step limit.
    pub reached: bool,
    /// Control periods in which the body touched an obstacle.
    pub collisions: u32,
    /// Control periods driven.
    pub steps: u32,
    /// Metres driven.
    pub path_length: f32,
    /// Metres between front axle and target at the end.
    pub distance_to_target: f32,
    /// Where the front axle was at the end: x and y, metres.
    pub end: [f32; 2],
}

impl Outcome {
    /// Reached without one collision.
    pub fn clean(&self) -> bool {
        self.reached && self.collisions == 0
    }
}

/// One control period of a recorded drive.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// Where the car stood when it looked.
    pub pose: Pose<f32>,
    /// What the beams reported then.
    pub echoes: [Echo; BEAMS],
    /// What the controller decided.
    pub command: Command,
    /// What the car did, after dead time, servo and stops.
    pub done: Command,
    /// All hidden outputs after deciding.
    pub hidden: Vec<f32>,
    /// Whether acting on it ended in a collision.
    pub collided: bool,
}

/// A drive, step by step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trace {
    /// Every control period.
    pub steps: Vec<Step>,
    /// The end; none only before the drive.
    pub end: Option<End>,
}

/// Where a drive ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct End {
    /// Where the car stood.
    pub pose: Pose<f32>,
    /// What an exact sensor would have seen from there.
    pub echoes: [Echo; BEAMS],
}

/// What all drives of a scenario share.
#[derive(Clone, Copy, Debug)]
pub struct Stage<'a> {
    /// The obstacles.
    pub world: &'a World,
    /// The same as this car sees and touches them.
    pub lookout: &'a Lookout,
    /// The car.
    pub model: &'a CarModel,
    /// How a drive goes and ends.
    pub spec: &'a EpisodeSpec,
}

/// Drives one pair.
///
/// `random` belongs to this drive alone: it decides offsets, noise and the randomised vehicle.
pub fn drive(stage: Stage<'_>, pair: &Pair, brain: &mut dyn Brain, random: Stream) -> Outcome {
    run(stage, pair, brain, random, |_, _, _, _| ())
}

/// The same drive, remembered step by step.
pub fn drive_traced(
    stage: Stage<'_>,
    pair: &Pair,
    brain: &mut dyn Brain,
    random: Stream,
) -> (Outcome, Trace) {
    let mut steps = Vec::new();
    let mut end = None;
    let outcome = run(stage, pair, brain, random, |pose, car, command, brain| {
        steps.push(Step {
            pose,
            echoes: car.reported,
            command,
            done: car.done,
            hidden: brain.hidden(),
            collided: car.collided,
        });
        end = Some(End { pose: *car.pose(), echoes: car.echoes() });
    });
    (outcome, Trace { steps, end })
}

fn run(
    stage: Stage<'_>,
    pair: &Pair,
    brain: &mut dyn Brain,
    mut random: Stream,
    mut remember: impl FnMut(Pose<f32>, &SimulatedCar<'_>, Command, &dyn Brain),
) -> Outcome {
    let Stage { world, lookout, model, spec } = stage;
    let start = start_pose(world, model, spec, pair, &mut random);
    let mut car = SimulatedCar::new(world, lookout, model, start, pair.goal, random);
    brain.reset();
    let mut steps = 0;
    while steps < spec.step_limit {
        let before = *car.pose();
        // A simulated reading is always good and a simulated actuator never refuses; were
        // either to fail, the car has been told to stop and the drive goes on.
        let command = tick(&mut car, brain).unwrap_or(Command::STOP);
        steps += 1;
        remember(before, &car, command, brain);
        if car.reached || (car.collided && spec.on_collision == OnCollision::Stop) {
            break;
        }
    }
    Outcome {
        reached: car.reached,
        collisions: car.collisions,
        steps,
        path_length: car.path_length,
        distance_to_target: car.distance_to_target(),
        end: [car.pose().x, car.pose().y],
    }
}

/// Tries of a random offset before the exact start is used.
const OFFSET_TRIES: u32 = 32;

/// The pair's start, shifted and turned at random where the scenario says so. A shifted start
/// that overlaps an obstacle, leaves the room or lies behind a wall is drawn again.
pub(crate) fn start_pose(
    world: &World,
    model: &CarModel,
    spec: &EpisodeSpec,
    pair: &Pair,
    random: &mut Stream,
) -> Pose<f32> {
    let [x, y, heading] = pair.start;
    let exact = Pose::new(x, y, heading);
    let (shift, turn) = (spec.start_offset, spec.start_turn);
    if shift == 0.0 && turn == 0.0 {
        return exact;
    }
    for _ in 0..OFFSET_TRIES {
        let pose = Pose::new(
            x + random.within(-shift, shift),
            y + random.within(-shift, shift),
            heading + random.within(-turn, turn),
        );
        if world.bounds.contains([pose.x, pose.y])
            && !world.blocks(model.body(), &pose)
            && !world.separates([x, y], [pose.x, pose.y])
        {
            return pose;
        }
    }
    exact
}

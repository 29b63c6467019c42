//! What the host computes with many drives side by side, one in each lane.

use std::fmt;

use controller_core::blob::{Blob, Header, Provenance};
use controller_core::controller::{Command, RECOVERY};
use controller_core::lane::{Lane, Lanes};
use controller_core::motion::Pose;
use controller_core::network::{
    Elman, Feedforward, Network, Recurrence, RecurrenceKind, SelfLoop, State,
};
use controller_core::observation::{BEAMS, INPUTS, Reading, ReadingError, Sight};

use crate::closed_loop::{self, HIDDEN, OUTPUTS};
use crate::compare::{Drive, Tally};
use crate::course::Course;
use crate::on_host;
use crate::room;

/// A lane type whose lanes can be filled and read one by one.
pub trait Wide: Lane + fmt::Debug {
    /// Lanes.
    const COUNT: usize;

    /// Asks for the number of each lane.
    fn gather(number: impl FnMut(usize) -> f32) -> Self;

    /// One lane's number; NaN for a lane that there is not.
    fn lane(&self, index: usize) -> f32;
}

impl<const N: usize> Wide for Lanes<N> {
    const COUNT: usize = N;

    fn gather(number: impl FnMut(usize) -> f32) -> Self {
        Self(std::array::from_fn(number))
    }

    fn lane(&self, index: usize) -> f32 {
        self.0.get(index).copied().unwrap_or(f32::NAN)
    }
}

/// Drives all, as many at once as `L` has lanes, and compares every lane with the same drive alone.
///
/// Drives that follow each other share lanes if their cars, networks and lengths are alike; what is left of the
/// lanes repeats the last of them.
pub fn compare<L: Wide>(drives: &[Drive]) -> Tally {
    let mut tally = Tally::default();
    let alike =
        |one: &Drive, other: &Drive| one.case.steps == other.case.steps && car(one) == car(other);
    for alike in drives.chunk_by(alike) {
        for lanes in alike.chunks(L::COUNT) {
            let recurrence = lanes[0].weights.blob().header().topology.recurrence;
            tally.add(match recurrence {
                RecurrenceKind::Feedforward => compare_lanes::<Feedforward, L>(lanes),
                RecurrenceKind::SelfLoop => compare_lanes::<SelfLoop, L>(lanes),
                RecurrenceKind::Elman => compare_lanes::<Elman, L>(lanes),
            });
        }
    }
    tally
}

/// What has to be the same in all lanes: everything but weights and where they come from.
fn car(drive: &Drive) -> Header {
    let nowhere = Provenance {
        seed: 0,
        generation: 0,
        scenario_hash: [0; 8],
        tool: [0; 3],
        scenario: [0; 32],
    };
    Header { provenance: nowhere, self_tests: 0, ..*drive.weights.blob().header() }
}

fn compare_lanes<R: Recurrence, L: Wide>(drives: &[Drive]) -> Tally {
    let blobs: Vec<Blob<'_>> = drives.iter().map(|drive| drive.weights.blob()).collect();
    let header = blobs[0].header();
    let last = drives.len() - 1;
    let genome: Vec<L> = (0..header.topology.weights())
        .map(|weight| L::gather(|lane| blobs[lane.min(last)].weights()[weight]))
        .collect();
    let network = Network::<R, L, INPUTS, HIDDEN, OUTPUTS>::new(&genome, header.topology.biases)
        .expect("a weight set is of the right size");
    let mut alone: Vec<_> = drives
        .iter()
        .zip(&blobs)
        .map(|(drive, blob)| on_host::steps(blob, drive.case).expect("as above"))
        .collect();

    let mut tally = Tally::default();
    let mut car = Cars::<L>::new(header, drives);
    let mut state = State::<L, HIDDEN>::reset();
    let mut outputs = [L::from(0.0); OUTPUTS];
    for step in 0..drives[0].case.steps {
        let acts = car.look(step);
        let inputs = header.scaling.encoding.inputs(&car.sight, header.scaling.range);
        let mut next = state;
        let computed = network.step(header.activation, &mut next, &inputs);
        // The state rule: a lane that stops for its reading keeps its memory.
        let keep = |old: &L, new: &L| {
            L::gather(|lane| if acts[lane] { new.lane(lane) } else { old.lane(lane) })
        };
        let merge = |old: &mut [L], new: &[L]| {
            for (old, new) in old.iter_mut().zip(new) {
                *old = keep(old, new);
            }
        };
        merge(&mut state.first, &next.first);
        merge(&mut state.second, &next.second);
        merge(&mut outputs, &computed);
        let commands: Vec<Command> = (0..L::COUNT)
            .map(|lane| match acts[lane] {
                true => header.scaling.command(&outputs.map(|output| output.lane(lane))),
                false => Command::STOP,
            })
            .collect();
        car.drive(&commands);
        for (lane, (drive, alone)) in drives.iter().zip(&mut alone).enumerate() {
            let of_lane = |values: &[L; HIDDEN]| values.map(|value| value.lane(lane));
            let hidden = State { first: of_lane(&state.first), second: of_lane(&state.second) };
            let found = closed_loop::bits(
                commands[lane],
                &outputs.map(|output| output.lane(lane)),
                &hidden,
                &pose_of(&car.pose, lane),
            );
            let expected = alone.next().expect("it goes on for ever");
            tally.step(drive.weights.name(), drive.case.seed, step, &found, &expected);
        }
    }
    tally
}

/// One car in each lane.
struct Cars<'a, L> {
    header: &'a Header,
    courses: Vec<Course>,
    pose: Pose<L>,
    sight: Sight<L>,
    good_readings_owed: Vec<u32>,
}

impl<'a, L: Wide> Cars<'a, L> {
    fn new(header: &'a Header, drives: &[Drive]) -> Self {
        let last = drives.len() - 1;
        let zero = L::from(0.0);
        Self {
            header,
            courses: (0..L::COUNT)
                .map(|lane| Course::Seeded(drives[lane.min(last)].case.seed))
                .collect(),
            pose: Pose::new(zero, zero, zero),
            sight: Sight { distance: [zero; BEAMS], wall: [zero; BEAMS], target: [zero; BEAMS] },
            good_readings_owed: vec![0; L::COUNT],
        }
    }

    /// Looks around in every lane; says which lanes act on what they see.
    fn look(&mut self, step: u32) -> Vec<bool> {
        let before = self.pose;
        let poses: Vec<Pose<f32>> = (0..L::COUNT)
            .map(|lane| self.courses[lane].start(step).unwrap_or_else(|| pose_of(&before, lane)))
            .collect();
        self.pose = Pose {
            x: L::gather(|lane| poses[lane].x),
            y: L::gather(|lane| poses[lane].y),
            heading: L::gather(|lane| poses[lane].heading),
            cos: L::gather(|lane| poses[lane].cos),
            sin: L::gather(|lane| poses[lane].sin),
        };
        let range = self.header.scaling.range;
        let distances = room::distances(&self.pose, &self.header.beams);
        let readings: Vec<Result<Reading, ReadingError>> = (0..L::COUNT)
            .map(|lane| {
                let echoes = distances.map(|(wall, target)| {
                    Some(room::echo(wall.lane(lane), target.lane(lane), range))
                });
                let (echoes, age) = self.courses[lane].faults(step, echoes, range);
                Reading::new(echoes, age, range)
            })
            .collect();
        let sights: Vec<Sight<f32>> = readings
            .iter()
            .map(|reading| match reading {
                Ok(reading) => reading.sight(),
                Err(_) => Sight { distance: [0.0; 5], wall: [0.0; 5], target: [0.0; 5] },
            })
            .collect();
        let beams = |of: fn(&Sight<f32>) -> &[f32; BEAMS]| {
            std::array::from_fn(|beam| L::gather(|lane| of(&sights[lane])[beam]))
        };
        self.sight = Sight {
            distance: beams(|sight| &sight.distance),
            wall: beams(|sight| &sight.wall),
            target: beams(|sight| &sight.target),
        };
        readings
            .iter()
            .zip(&mut self.good_readings_owed)
            .map(|(reading, owed)| {
                *owed = match reading {
                    Err(_) => RECOVERY,
                    Ok(_) => owed.saturating_sub(1),
                };
                *owed == 0
            })
            .collect()
    }

    fn drive(&mut self, commands: &[Command]) {
        let steer = L::gather(|lane| commands[lane].steer.radians());
        let step = L::gather(|lane| commands[lane].step.metres());
        self.pose = room::drive_lanes(&self.pose, steer, step, self.header.wheelbase);
    }
}

fn pose_of<L: Wide>(pose: &Pose<L>, lane: usize) -> Pose<f32> {
    Pose {
        x: pose.x.lane(lane),
        y: pose.y.lane(lane),
        heading: pose.heading.lane(lane),
        cos: pose.cos.lane(lane),
        sin: pose.sin.lane(lane),
    }
}

//! One drive, from weights to the bytes of its blob and its recording.

use controller_core::blob::{Blob, Header};
use controller_core::control_loop::Decide;
use controller_core::controller::Controller;
use controller_core::motion::Pose;
use controller_core::network::{Network, Recurrence};
use controller_core::observation::{BEAMS, Echo, INPUTS, Reading};
use controller_core::recording;

use crate::closed_loop::{HIDDEN, OUTPUTS};
use crate::room;
use crate::weight_sets::{self, SelfTest};

/// Steps of a drive.
pub const STEPS: u32 = 200;

/// A drive as bytes, words first so that they can be read in place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Recorded {
    /// The weight blob, as words.
    pub blob: Vec<u32>,
    /// The recording, as words.
    pub recording: Vec<u32>,
}

impl Recorded {
    /// The weight blob's bytes.
    pub fn blob(&self) -> &[u8] {
        bytemuck::cast_slice(&self.blob)
    }

    /// The recording's bytes.
    pub fn recording(&self) -> &[u8] {
        bytemuck::cast_slice(&self.recording)
    }
}

/// Drives [`STEPS`] steps, faults of the sensors included, and writes everything down.
///
/// # Panics
///
/// If the header does not describe these weights: the drives are fixed, so a test fails.
pub fn record<R: Recurrence>(
    header: &Header,
    weights: &[f32],
    self_tests: &[SelfTest],
) -> Recorded {
    let blob = weight_sets::build(header, weights, self_tests);
    let network = Network::<R, f32, INPUTS, HIDDEN, OUTPUTS>::new(weights, header.topology.biases)
        .expect("weights fit the network");
    let check =
        Blob::parse(bytemuck::cast_slice(&blob)).expect("what was written can be read").check();

    let mut controller = Controller::new(network, header.activation, header.scaling);
    let mut words = recording::header::<HIDDEN, OUTPUTS>(STEPS, check).to_vec();
    let mut pose = Pose::new(0.0, 0.0, 0.0);
    for step in 0..STEPS {
        pose = room::start(step).unwrap_or(pose);
        let sight = room::look(&pose, &header.beams, header.scaling.range);
        let (echoes, age) = with_faults(step, sight);
        let reading = Reading::new(echoes, age, header.scaling.range);
        let command = controller.decide(reading.as_ref().map_err(|error| *error));
        words.extend(recording::sensed(&echoes, age));
        words.extend(recording::values(command, controller.outputs(), controller.state()));
        pose = room::drive(&pose, command, header.wheelbase);
    }
    words.extend(recording::check(&words));
    Recorded { blob, recording: words }
}

/// Every kind of bad reading once, and readings of every age that is still good.
fn with_faults(step: u32, mut echoes: [Option<Echo>; BEAMS]) -> ([Option<Echo>; BEAMS], u32) {
    let mut age = 0;
    match step {
        20 | 21 => echoes[2] = None,
        50 => echoes[0] = Some(Echo::Wall(f32::NAN)),
        70 => echoes[4] = Some(Echo::Target(room::RANGE + 0.001)),
        90 => echoes[1] = Some(Echo::Wall(-0.1)),
        110 => age = 4,
        130..133 => age = step - 129,
        _ => {}
    }
    (echoes, age)
}

//! Drives a recorded drive again and compares every bit with the recording.

use controller_core::activation::{Activation, ActivationKind, Libm, Micromath, Rational};
use controller_core::blob::{Blob, BlobError, SelfTestError, WrongTopology};
use controller_core::control_loop::Decide;
use controller_core::controller::Controller;
use controller_core::network::{Elman, Feedforward, Recurrence, RecurrenceKind, SelfLoop};
use controller_core::recording::{Difference, Recording, RecordingError};
use core::fmt;

/// Width of the hidden layers this program has code for.
pub const HIDDEN: usize = 12;

/// Outputs of the networks this program has code for.
pub const OUTPUTS: usize = 1;

/// Why a replay did not end with equal bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ReplayError {
    /// The weights are no blob.
    Blob(BlobError),
    /// The blob holds a network that this program has no code for.
    Topology(WrongTopology),
    /// This machine fails the blob's own test.
    SelfTest(SelfTestError),
    /// The recording cannot be read.
    Recording(RecordingError),
    /// Other weights drove when the recording was made.
    OtherWeights {
        /// Check of the blob given.
        found: u64,
        /// Check of the blob that drove.
        expected: u64,
    },
    /// The machines differ.
    Difference {
        /// Index of the first step that differs.
        step: usize,
        /// Its first value that differs.
        difference: Difference,
    },
}

impl fmt::Display for ReplayError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Blob(error) => write!(f, "weights refused: {error}"),
            Self::Topology(error) => write!(f, "weights refused: {error}"),
            Self::SelfTest(error) => error.fmt(f),
            Self::Recording(error) => write!(f, "recording refused: {error}"),
            Self::OtherWeights { found, expected } => {
                write!(f, "weights {found:016x} given, weights {expected:016x} drove")
            }
            Self::Difference { step, difference } => write!(f, "step {step}: {difference}"),
        }
    }
}

impl core::error::Error for ReplayError {}

/// Replays `recording` with the weights in `blob`; returns how many steps agreed in every bit.
///
/// Both must start at a multiple of 4 bytes.
///
/// # Errors
///
/// The first thing that is wrong with the weights, this machine, or the recording; or the first
/// difference.
pub fn replay(blob: &[u8], recording: &[u8]) -> Result<usize, ReplayError> {
    let blob = Blob::parse(blob).map_err(ReplayError::Blob)?;
    match blob.header().topology.recurrence {
        RecurrenceKind::Feedforward => with_recurrence::<Feedforward>(&blob, recording),
        RecurrenceKind::SelfLoop => with_recurrence::<SelfLoop>(&blob, recording),
        RecurrenceKind::Elman => with_recurrence::<Elman>(&blob, recording),
    }
}

fn with_recurrence<R: Recurrence>(blob: &Blob<'_>, recording: &[u8]) -> Result<usize, ReplayError> {
    match blob.header().activation {
        ActivationKind::Rational => compare::<R>(blob, Rational, recording),
        ActivationKind::Libm => compare::<R>(blob, Libm, recording),
        ActivationKind::Micromath => compare::<R>(blob, Micromath, recording),
    }
}

fn compare<R: Recurrence>(
    blob: &Blob<'_>,
    activation: impl Activation,
    recording: &[u8],
) -> Result<usize, ReplayError> {
    let network = blob.network::<R, HIDDEN, OUTPUTS>().map_err(ReplayError::Topology)?;
    blob.self_test::<R, HIDDEN, OUTPUTS>(activation).map_err(ReplayError::SelfTest)?;
    let recording =
        Recording::<HIDDEN, OUTPUTS>::parse(recording).map_err(ReplayError::Recording)?;
    let (found, expected) = (blob.check(), recording.blob_check());
    if found != expected {
        return Err(ReplayError::OtherWeights { found, expected });
    }
    let mut controller = Controller::new(network, activation, blob.scaling());
    let mut agreed = 0;
    for (step, recorded) in recording.steps().enumerate() {
        let reading = recorded.reading(blob.scaling().range);
        let command = controller.decide(reading.as_ref().map_err(|error| *error));
        let difference =
            recorded.first_difference(command, controller.outputs(), controller.state());
        if let Some(difference) = difference {
            return Err(ReplayError::Difference { step, difference });
        }
        agreed += 1;
    }
    Ok(agreed)
}

//! Drives a recorded drive again and compares every bit with the recording.

use crate::brain::{Brain, HIDDEN, OUTPUTS, Refusal};
use controller_core::blob::Blob;
use controller_core::control_loop::Decide;
use controller_core::recording::{Difference, Recording, RecordingError};

/// Why a replay did not end with equal bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ReplayError {
    /// The weights cannot be used.
    Weights(Refusal),
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

controller_core::sentences! { ReplayError {
    Self::Weights(error) => "{}", error;
    Self::Recording(error) => "recording refused: {}", error;
    Self::OtherWeights { found, expected } =>
        "weights {:016x} given, weights {:016x} drove", found, expected;
    Self::Difference { step, difference } => "step {}: {}", step, difference;
} }

impl core::error::Error for ReplayError {}

impl From<Refusal> for ReplayError {
    fn from(refusal: Refusal) -> Self {
        Self::Weights(refusal)
    }
}

/// Replays `recording` with the weights in `blob`; returns how many steps agreed in every bit.
///
/// Both must start at a multiple of 4 bytes.
///
/// # Errors
///
/// The first thing that is wrong with the weights, this machine, or the recording; or the first
/// difference.
pub fn replay(blob: &[u8], recording: &[u8]) -> Result<usize, ReplayError> {
    let blob = Blob::parse(blob).map_err(Refusal::Blob)?;
    compare(&blob, &mut Brain::new(&blob)?, recording)
}

fn compare(
    blob: &Blob<'_>,
    brain: &mut Brain<'_, HIDDEN, OUTPUTS>,
    recording: &[u8],
) -> Result<usize, ReplayError> {
    let recording =
        Recording::<HIDDEN, OUTPUTS>::parse(recording).map_err(ReplayError::Recording)?;
    let (found, expected) = (blob.check(), recording.blob_check());
    if found != expected {
        return Err(ReplayError::OtherWeights { found, expected });
    }
    let mut agreed = 0;
    for (step, recorded) in recording.steps().enumerate() {
        let reading = recorded.reading(blob.scaling().range);
        let command = brain.decide(reading.as_ref().map_err(|error| *error));
        let difference = recorded.first_difference(command, brain.outputs(), brain.state());
        if let Some(difference) = difference {
            return Err(ReplayError::Difference { step, difference });
        }
        agreed += 1;
    }
    Ok(agreed)
}

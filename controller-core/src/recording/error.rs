//! Why bytes are not a recording.

use core::fmt;

/// Why bytes are not a recording that this program can replay.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum RecordingError {
    /// The bytes are not whole words, or do not start at a multiple of four.
    NotWords {
        /// How many there are.
        bytes: usize,
    },
    /// The first words are not [`MAGIC`](super::MAGIC).
    Magic {
        /// What is there.
        found: [u32; 2],
    },
    /// Another format version.
    Version {
        /// The recording's.
        found: u32,
        /// This program's.
        expected: u32,
    },
    /// Another network: width of the hidden layers, number of outputs.
    Network {
        /// The recording's.
        found: (u32, u32),
        /// This program's.
        expected: (usize, usize),
    },
    /// Another number of words than the header says or needs.
    Length {
        /// What is there.
        found: usize,
        /// What is needed.
        expected: usize,
    },
    /// The check at the end does not match: words were damaged.
    Check {
        /// The stored one, low word first.
        found: [u32; 2],
        /// The one over these words.
        expected: [u32; 2],
    },
    /// A beam's report has a code without a meaning.
    EchoCode {
        /// Index of the step.
        step: usize,
        /// The code.
        found: u32,
    },
}

impl fmt::Display for RecordingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotWords { bytes } => {
                write!(f, "{bytes} bytes at their address are not whole, aligned 32-bit words")
            }
            Self::Magic { .. } => {
                write!(f, "no recording here: it does not start with \"EVODRIVE\"")
            }
            Self::Version { found, expected } => {
                write!(f, "recording format version {found}, this program reads version {expected}")
            }
            Self::Network { found, expected } => write!(
                f,
                "recorded with hidden layers of {} and {} outputs, this program has {} and {}",
                found.0, found.1, expected.0, expected.1
            ),
            Self::Length { found, expected } => {
                write!(f, "{found} words, a recording of {expected} words expected")
            }
            Self::Check { found: [low, high], expected: [ours, our_high] } => write!(
                f,
                "damaged: check {high:08x}{low:08x} stored, {our_high:08x}{ours:08x} computed"
            ),
            Self::EchoCode { step, found } => {
                write!(f, "step {step}: a beam's report has code {found}, 0 to 3 expected")
            }
        }
    }
}

impl core::error::Error for RecordingError {}

//! Why bytes are not a recording.

/// Why bytes are not a recording that this program can replay.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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

crate::sentences! { RecordingError {
    Self::NotWords { bytes } =>
        "{} bytes at their address are not whole, aligned 32-bit words", bytes;
    Self::Magic { .. } => "no recording here: it does not start with \"EVODRIVE\"";
    Self::Version { found, expected } =>
        "recording format version {}, this program reads version {}", found, expected;
    Self::Network { found: (hidden, outputs), expected: (own_hidden, own_outputs) } =>
        "recorded with hidden layers of {} and {} outputs, this program has {} and {}",
        hidden, outputs, own_hidden, own_outputs;
    Self::Length { found, expected } =>
        "{} words, a recording of {} words expected", found, expected;
    Self::Check { found: [low, high], expected: [ours, our_high] } =>
        "damaged: check {:08x}{:08x} stored, {:08x}{:08x} computed", high, low, our_high, ours;
    Self::EchoCode { step, found } =>
        "step {}: a beam's report has code {}, 0 to 3 expected", step, found;
} }

impl core::error::Error for RecordingError {}

//! A recorded drive: what was sensed, and every bit the controller answered with.
//!
//! One machine writes it; any other replays it with the same weights and compares bits. It is a
//! sequence of little-endian 32-bit words, read in place:
//!
//! | words | content |
//! | --- | --- |
//! | 2 | the bytes `EVODRIVE` |
//! | 1 | format version, [`VERSION`] |
//! | 1 | width of a hidden layer, `H` |
//! | 1 | number of outputs, `O` |
//! | 1 | number of steps |
//! | 2 | check of the weight blob that drove, low word first |
//! | 13 + `O` + 2 `H` each | the steps |
//! | 2 | CRC-64/XZ over all bytes before it, low word first |
//!
//! A step:
//!
//! | words | content |
//! | --- | --- |
//! | 1 | age of the reading, control periods |
//! | 5 | what each beam reported, rightmost first: 0 nothing, 1 wall, 2 target, 3 no answer |
//! | 5 | at what distance, bits of an `f32` in metres; 0 where there is none |
//! | 1, 1 | the command: bits of the steer angle in radians, of the step length in metres |
//! | `O` | bits of the network's outputs |
//! | `H`, `H` | bits of both hidden layers' outputs |

mod difference;
mod error;

pub use difference::{Difference, Place};
pub use error::RecordingError;

use crate::controller::Command;
use crate::network::State;
use crate::observation::{BEAMS, Echo, Reading, ReadingError};
use crc::{CRC_64_XZ, Crc, NoTable};

/// First two words of every recording.
pub const MAGIC: [u32; 2] = [u32::from_le_bytes(*b"EVOD"), u32::from_le_bytes(*b"RIVE")];

/// The format this release writes and reads.
pub const VERSION: u32 = 1;

/// Words before the first step.
pub const HEADER_WORDS: usize = 8;

/// Words of the check at the end.
pub const CHECK_WORDS: usize = 2;

/// Words of a step that hold what was sensed; the values to compare follow.
pub const SENSED_WORDS: usize = 1 + 2 * BEAMS;

const CHECK: Crc<u64, NoTable> = Crc::<u64, NoTable>::new(&CRC_64_XZ);

/// Words of one step, for hidden layers of this width and this many outputs.
pub const fn step_words(hidden: usize, outputs: usize) -> usize {
    SENSED_WORDS + 2 + outputs + 2 * hidden
}

/// A checked recording of a controller with hidden layers of width `H` and `O` outputs, borrowed.
#[derive(Clone, Copy, Debug)]
pub struct Recording<'a, const H: usize, const O: usize> {
    blob_check: u64,
    steps: &'a [u32],
}

impl<'a, const H: usize, const O: usize> Recording<'a, H, O> {
    /// Reads a recording that is exactly these bytes. They must start at a multiple of 4 bytes.
    ///
    /// # Errors
    ///
    /// The first thing that is wrong, looked for in this order: alignment, magic, version, network,
    /// length, check, codes of the beams' reports.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, RecordingError> {
        let words: &[u32] = bytemuck::try_cast_slice(bytes)
            .map_err(|_| RecordingError::NotWords { bytes: bytes.len() })?;
        let short =
            RecordingError::Length { found: words.len(), expected: HEADER_WORDS + CHECK_WORDS };
        let (head, _) = words.split_first_chunk::<HEADER_WORDS>().ok_or(short)?;
        let [magic, also_magic, version, hidden, outputs, steps, low, high] = *head;
        if [magic, also_magic] != MAGIC {
            return Err(RecordingError::Magic { found: [magic, also_magic] });
        }
        if version != VERSION {
            return Err(RecordingError::Version { found: version, expected: VERSION });
        }
        if (hidden as usize, outputs as usize) != (H, O) {
            return Err(RecordingError::Network { found: (hidden, outputs), expected: (H, O) });
        }
        let expected = (steps as usize)
            .saturating_mul(step_words(H, O))
            .saturating_add(HEADER_WORDS + CHECK_WORDS);
        let length = RecordingError::Length { found: words.len(), expected };
        if words.len() != expected {
            return Err(length);
        }
        let (checked, found) = words.split_last_chunk::<CHECK_WORDS>().ok_or(length)?;
        if *found != check(checked) {
            return Err(RecordingError::Check { found: *found, expected: check(checked) });
        }
        let steps = checked.get(HEADER_WORDS..).ok_or(length)?;
        let recording = Self { blob_check: join([low, high]), steps };
        for (index, step) in recording.steps().enumerate() {
            if let Some(code) = step.codes().iter().find(|code| **code > NO_ANSWER) {
                return Err(RecordingError::EchoCode { step: index, found: *code });
            }
        }
        Ok(recording)
    }

    /// Check of the weight blob that drove, [`Blob::check`](crate::blob::Blob::check).
    pub fn blob_check(&self) -> u64 {
        self.blob_check
    }

    /// The steps in the order they were driven.
    pub fn steps(&self) -> impl ExactSizeIterator<Item = RecordedStep<'a>> + use<'a, H, O> {
        let words = const { step_words(H, O) };
        self.steps.chunks_exact(words).map(|words| RecordedStep { words })
    }
}

/// One step of a recording, borrowed.
#[derive(Clone, Copy, Debug)]
pub struct RecordedStep<'a> {
    words: &'a [u32],
}

const NOTHING: u32 = 0;
const WALL: u32 = 1;
const TARGET: u32 = 2;
const NO_ANSWER: u32 = 3;

impl RecordedStep<'_> {
    /// What was sensed, checked for beams of this range in metres.
    ///
    /// # Errors
    ///
    /// As [`Reading::new`]: recordings hold faults too.
    pub fn reading(&self, range: f32) -> Result<Reading, ReadingError> {
        let mut echoes = [None; BEAMS];
        let distances = self.words.iter().skip(1 + BEAMS);
        for ((echo, code), distance) in echoes.iter_mut().zip(self.codes()).zip(distances) {
            let distance = f32::from_bits(*distance);
            *echo = match *code {
                NOTHING => Some(Echo::Nothing),
                WALL => Some(Echo::Wall(distance)),
                TARGET => Some(Echo::Target(distance)),
                _ => None,
            };
        }
        Reading::new(echoes, self.words.first().copied().unwrap_or(u32::MAX), range)
    }

    /// The first recorded value that has other bits than these; `None` where all agree.
    pub fn first_difference<const H: usize, const O: usize>(
        &self,
        command: Command,
        outputs: &[f32; O],
        state: &State<f32, H>,
    ) -> Option<Difference> {
        let recorded = self.words.iter().skip(SENSED_WORDS);
        values(command, outputs, state).zip(recorded).enumerate().find_map(
            |(index, (found, expected))| {
                (found != *expected).then(|| Difference {
                    place: Place::of_value::<H, O>(index),
                    found,
                    expected: *expected,
                })
            },
        )
    }

    fn codes(&self) -> &[u32] {
        self.words.get(1..=BEAMS).unwrap_or_default()
    }
}

/// The words before the first step, for a writer.
pub fn header<const H: usize, const O: usize>(steps: u32, blob_check: u64) -> [u32; HEADER_WORDS] {
    let [magic, also_magic] = MAGIC;
    let [low, high] = split(blob_check);
    [magic, also_magic, VERSION, H as u32, O as u32, steps, low, high]
}

/// The words of a step that hold what was sensed, for a writer; `None` is a beam without an answer.
pub fn sensed(echoes: &[Option<Echo>; BEAMS], age: u32) -> impl Iterator<Item = u32> {
    let codes = echoes.map(|echo| match echo {
        Some(Echo::Nothing) => NOTHING,
        Some(Echo::Wall(_)) => WALL,
        Some(Echo::Target(_)) => TARGET,
        None => NO_ANSWER,
    });
    let distances = echoes.map(|echo| match echo {
        Some(Echo::Wall(distance) | Echo::Target(distance)) => distance.to_bits(),
        Some(Echo::Nothing) | None => 0,
    });
    core::iter::once(age).chain(codes).chain(distances)
}

/// The words of a step that a replay compares, for a writer.
pub fn values<const H: usize, const O: usize>(
    command: Command,
    outputs: &[f32; O],
    state: &State<f32, H>,
) -> impl Iterator<Item = u32> {
    [command.steer.radians(), command.step.metres()]
        .into_iter()
        .chain(*outputs)
        .chain(state.first)
        .chain(state.second)
        .map(f32::to_bits)
}

/// The words after the last step: the check over all words before them.
pub fn check(words: &[u32]) -> [u32; CHECK_WORDS] {
    split(CHECK.checksum(bytemuck::cast_slice(words)))
}

fn split(value: u64) -> [u32; 2] {
    [value as u32, (value >> 32) as u32]
}

fn join([low, high]: [u32; 2]) -> u64 {
    u64::from(high) << 32 | u64::from(low)
}

//! Checkpoints: a checked container for a run's state, and two files written in turn.
//!
//! All numbers are little-endian:
//!
//! | offset | bytes | content |
//! | --- | --- | --- |
//! | 0 | 8 | [`MAGIC`] |
//! | 8 | 2 | [`VERSION`] |
//! | 10 | 8 | generation: how many are done |
//! | 18 | 8 | `n`, the payload's length |
//! | 26 | `n` | the state, as postcard |
//! | 26 + `n` | 8 | CRC-64/XZ of everything before |

pub mod slots;

use std::fmt;

use crc::{CRC_64_XZ, Crc};
use serde::Serialize;
use serde::de::DeserializeOwned;

pub use slots::{Checkpoints, Loaded};

/// How a checkpoint begins.
pub const MAGIC: [u8; 8] = *b"EVOCKPT\0";

/// Version of the container and of the state in it; a change of either raises it.
pub const VERSION: u16 = 2;

const HEADER: usize = 26;
const CHECK: usize = 8;
const CRC: Crc<u64> = Crc::<u64>::new(&CRC_64_XZ);

/// Packs the state of a run that has done `generation` generations.
///
/// The state must have one encoding only: no hash maps.
///
/// ```
/// use host_trainer::checkpoint::{decode, encode};
///
/// let bytes = encode(12, &vec![1.5_f32, -2.0])?;
/// assert_eq!(decode::<Vec<f32>>(&bytes), Ok((12, vec![1.5, -2.0])));
/// assert!(decode::<Vec<f32>>(&bytes[..bytes.len() - 1]).is_err());
/// # Ok::<(), postcard::Error>(())
/// ```
///
/// # Errors
///
/// postcard's, for a type it cannot hold (a sequence of unknown length).
pub fn encode<T: Serialize>(generation: u64, state: &T) -> Result<Vec<u8>, postcard::Error> {
    let payload = postcard::to_stdvec(state)?;
    let mut bytes = Vec::with_capacity(HEADER + payload.len() + CHECK);
    bytes.extend_from_slice(&MAGIC);
    bytes.extend_from_slice(&VERSION.to_le_bytes());
    bytes.extend_from_slice(&generation.to_le_bytes());
    bytes.extend_from_slice(&(payload.len() as u64).to_le_bytes());
    bytes.extend_from_slice(&payload);
    bytes.extend_from_slice(&CRC.checksum(&bytes).to_le_bytes());
    Ok(bytes)
}

/// Unpacks a checkpoint into the number of generations done and the state.
///
/// # Errors
///
/// Anything but the exact bytes that [`encode`] makes is refused with its cause.
pub fn decode<T: Serialize + DeserializeOwned>(bytes: &[u8]) -> Result<(u64, T), CheckpointError> {
    let too_short = CheckpointError::TooShort { found: bytes.len() };
    let (magic, rest) = bytes.split_first_chunk::<8>().ok_or(too_short.clone())?;
    if *magic != MAGIC {
        return Err(CheckpointError::NotACheckpoint { found: *magic });
    }
    let (version, rest) = rest.split_first_chunk().ok_or(too_short.clone())?;
    let version = u16::from_le_bytes(*version);
    if version != VERSION {
        return Err(CheckpointError::Version { found: version });
    }
    let (generation, rest) = rest.split_first_chunk().ok_or(too_short.clone())?;
    let (length, rest) = rest.split_first_chunk().ok_or(too_short.clone())?;
    let (payload, check) = rest.split_last_chunk().ok_or(too_short)?;
    let declared = u64::from_le_bytes(*length);
    if declared != payload.len() as u64 {
        return Err(CheckpointError::Length { declared, found: payload.len() as u64 });
    }
    let expected = CRC.checksum(&bytes[..bytes.len() - CHECK]);
    let found = u64::from_le_bytes(*check);
    if found != expected {
        return Err(CheckpointError::Check { found, expected });
    }
    let (state, rest) = postcard::take_from_bytes::<T>(payload).map_err(CheckpointError::State)?;
    if !rest.is_empty() {
        return Err(CheckpointError::Trailing { bytes: rest.len() });
    }
    // postcard accepts several encodings of one number; encode writes one of them.
    if postcard::to_stdvec(&state).as_deref() != Ok(payload) {
        return Err(CheckpointError::NotCanonical);
    }
    Ok((u64::from_le_bytes(*generation), state))
}

/// Why bytes are not a checkpoint of this program.
#[derive(Clone, Debug, PartialEq)]
pub enum CheckpointError {
    /// Shorter than an empty checkpoint.
    TooShort {
        /// Bytes there were.
        found: usize,
    },
    /// Does not begin with [`MAGIC`].
    NotACheckpoint {
        /// The first eight bytes.
        found: [u8; 8],
    },
    /// Written by another version of evosteer.
    Version {
        /// Its version.
        found: u16,
    },
    /// Cut off, or something was appended.
    Length {
        /// Bytes of state the header announces.
        declared: u64,
        /// Bytes of state there are.
        found: u64,
    },
    /// Some bit is not what was written.
    Check {
        /// The check in the file.
        found: u64,
        /// The check of the file's bytes.
        expected: u64,
    },
    /// The state is not of the expected type.
    State(postcard::Error),
    /// Bytes follow the state.
    Trailing {
        /// How many.
        bytes: usize,
    },
    /// The state is encoded in a way that [`encode`] does not.
    NotCanonical,
}

impl fmt::Display for CheckpointError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooShort { found } => {
                write!(f, "{found} bytes, expected at least {}", HEADER + CHECK)
            }
            Self::NotACheckpoint { found } => {
                write!(f, "not a checkpoint: it begins with \"{}\"", found.escape_ascii())?;
                write!(f, ", expected \"{}\"", MAGIC.escape_ascii())
            }
            Self::Version { found } => {
                write!(f, "checkpoint version {found}, this evosteer reads version {VERSION}")
            }
            Self::Length { declared, found } => {
                write!(f, "{found} bytes of state, the header announces {declared}")
            }
            Self::Check { found, expected } => {
                write!(f, "damaged: its check is {found:016x}, its bytes give {expected:016x}")
            }
            Self::State(error) => write!(f, "the state does not decode: {error}"),
            Self::Trailing { bytes } => write!(f, "{bytes} bytes follow the state"),
            Self::NotCanonical => f.write_str("the state is not in its only allowed encoding"),
        }
    }
}

impl std::error::Error for CheckpointError {}

#[cfg(test)]
mod tests;

//! Trained weights as bytes: a fixed header, the weights, self-test triples, a 64-bit check.
//!
//! `docs/weight-blob.md` specifies every byte. A [`Blob`] reads in place: parsing checks the
//! bytes where they lie (flash, a file's buffer) and then only borrows them, so the car needs
//! no memory for weights. Whatever the bytes are, they are either accepted whole or refused
//! with a typed cause.

mod header;
mod read;
mod self_test;

pub use header::{Header, HeaderError, NAME_BYTES, Provenance};
pub use self_test::{SelfTestError, arithmetic_self_test};

use crate::controller::Scaling;
use crate::network::{Network, Recurrence, Topology};
use crate::observation::INPUTS;
use core::fmt;
use crc::{CRC_64_XZ, Crc, NoTable};
use serde::ser::{Serialize, SerializeTuple, Serializer};

/// First bytes of every blob.
pub const MAGIC: [u8; 8] = *b"EVOSTEER";

/// The format this release writes and reads.
pub const VERSION: u16 = 1;

/// Bytes before the weights.
pub const HEADER_BYTES: usize = 176;

/// Bytes of the check at the end: CRC-64/XZ over everything before it.
pub const CHECK_BYTES: usize = 8;

/// Weights beyond this magnitude are refused: sums of them could overflow into infinities,
/// and differences of infinities are NaN.
pub const WEIGHT_LIMIT: f32 = 1.0e6;

/// Identity of the arithmetic: bias first, inputs ascending, then recurrent weights
/// ascending, nothing fused.
pub const SUMMATION_ORDER: u8 = 1;

/// Detects every error of up to four bits in blobs of up to 8 KiB, and bursts of up to 64 bits.
/// Without a table: a boot-time check may take milliseconds, two kilobytes of flash may not be there.
const CHECK: Crc<u64, NoTable> = Crc::<u64, NoTable>::new(&CRC_64_XZ);

/// Puts bytes at a multiple of four, where [`Blob::parse`] can read them in place.
///
/// ```
/// use controller_core::blob::{Aligned, Blob, BlobError};
///
/// // On a device: Aligned(*include_bytes!("champion.blob"))
/// static CHAMPION: Aligned<[u8; 256]> = Aligned([0xff; 256]);
/// assert_eq!(Blob::parse(&CHAMPION.0).unwrap_err(), BlobError::Magic { found: [0xff; 8] });
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C, align(4))]
pub struct Aligned<T: ?Sized>(pub T);

/// Why bytes are not a blob that this program can use.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BlobError {
    /// There are fewer bytes than the blob says or a header needs.
    TooShort {
        /// What is there.
        found: usize,
        /// What is needed.
        expected: usize,
    },
    /// There are more bytes than the blob says.
    TooLong {
        /// What is there.
        found: usize,
        /// What the blob says.
        expected: usize,
    },
    /// The first bytes are not [`MAGIC`]. Erased flash reads as `0xFF`.
    Magic {
        /// What is there.
        found: [u8; 8],
    },
    /// Another format version.
    Version {
        /// The blob's.
        found: u16,
        /// This program's, [`VERSION`].
        expected: u16,
    },
    /// The bytes do not start at a multiple of four, so their words cannot be read in place.
    Unaligned,
    /// The length in the header does not follow from the header's topology.
    Length {
        /// What the header says.
        found: usize,
        /// What the topology gives.
        expected: usize,
    },
    /// The check at the end does not match: bytes were damaged.
    Check {
        /// The stored one.
        found: u64,
        /// The one over these bytes.
        expected: u64,
    },
    /// A header field holds a value that no writer of this version stores.
    Header(HeaderError),
    /// A weight is NaN, infinite or beyond [`WEIGHT_LIMIT`].
    Weight {
        /// Position in the genome.
        index: usize,
        /// Its value.
        value: f32,
    },
    /// A number in a self-test triple is NaN, infinite or beyond 1.
    SelfTestValue {
        /// Position among the triples' words.
        index: usize,
        /// Its value.
        value: f32,
    },
}

impl From<HeaderError> for BlobError {
    fn from(error: HeaderError) -> Self {
        Self::Header(error)
    }
}

crate::sentences! { BlobError {
    Self::TooShort { found, expected } => "{} bytes, a blob of {} bytes expected", found, expected;
    Self::TooLong { found, expected } => "{} bytes, the blob ends after {}", found, expected;
    Self::Magic { found: [0xff, 0xff, 0xff, 0xff, ..] } => "no blob here: the flash is erased";
    Self::Magic { .. } => "no blob here: it does not start with \"EVOSTEER\"";
    Self::Version { found, expected } =>
        "blob format version {}, this program reads version {}", found, expected;
    Self::Unaligned => "the blob does not start at a multiple of 4 bytes";
    Self::Length { found, expected } =>
        "the header says {} bytes, its topology gives {}", found, expected;
    Self::Check { found, expected } =>
        "damaged: check {:016x} stored, {:016x} computed", found, expected;
    Self::Header(error) => "{}", error;
    Self::Weight { index, value } => "weight {} is {}, finite and within ±1e6 expected", index, value;
    Self::SelfTestValue { index, value } =>
        "self-test word {} is {}, a number within ±1 expected", index, value;
} }

impl core::error::Error for BlobError {}

/// The blob holds another network than the program was built for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WrongTopology {
    /// The blob's.
    pub found: Topology,
    /// The program's.
    pub expected: Topology,
}

crate::sentences! { WrongTopology {
    Self { found, expected } => "the blob is {}, this program needs {}", found, expected;
} }

impl core::error::Error for WrongTopology {}

/// A checked blob, borrowed.
#[derive(Clone, Copy, Debug)]
pub struct Blob<'a> {
    header: Header,
    weights: &'a [f32],
    self_tests: &'a [f32],
    bytes: &'a [u8],
}

impl<'a> Blob<'a> {
    /// Reads a blob that is exactly these bytes. They must start at a multiple of 4 bytes.
    ///
    /// # Errors
    ///
    /// The first thing that is wrong, looked for in this order: magic, version, stated length,
    /// check, header, length against topology, alignment, weights, self-test.
    pub fn parse(bytes: &'a [u8]) -> Result<Self, BlobError> {
        let expected = stated_len(bytes)?;
        if bytes.len() > expected {
            return Err(BlobError::TooLong { found: bytes.len(), expected });
        }
        Self::parse_exact(bytes)
    }

    /// Reads a blob at the start of a larger region, such as a flash sector with an erased tail.
    ///
    /// # Errors
    ///
    /// As [`Self::parse`].
    pub fn parse_prefix(region: &'a [u8]) -> Result<Self, BlobError> {
        let expected = stated_len(region)?;
        let too_short = BlobError::TooShort { found: region.len(), expected };
        Self::parse_exact(region.get(..expected).ok_or(too_short)?)
    }

    fn parse_exact(bytes: &'a [u8]) -> Result<Self, BlobError> {
        let too_short =
            BlobError::TooShort { found: bytes.len(), expected: HEADER_BYTES + CHECK_BYTES };
        let (body, check) = bytes.split_last_chunk::<CHECK_BYTES>().ok_or(too_short)?;
        let (found, expected) = (u64::from_le_bytes(*check), CHECK.checksum(body));
        if found != expected {
            return Err(BlobError::Check { found, expected });
        }
        let (head, words) = body.split_first_chunk::<HEADER_BYTES>().ok_or(too_short)?;
        let header = Header::decode(head)?;
        if bytes.len() != header.blob_len() {
            return Err(BlobError::Length { found: bytes.len(), expected: header.blob_len() });
        }
        let words: &[f32] = bytemuck::try_cast_slice(words).map_err(|_| BlobError::Unaligned)?;
        let (weights, self_tests) =
            words.split_at_checked(header.topology.weights()).ok_or(too_short)?;
        refuse_weights(weights)?;
        refuse_self_tests(self_tests)?;
        Ok(Self { header, weights, self_tests, bytes })
    }

    /// What the blob says about itself.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// How inputs and outputs relate to the car.
    pub fn scaling(&self) -> Scaling {
        self.header.scaling
    }

    /// The weights in the genome's order.
    pub fn weights(&self) -> &'a [f32] {
        self.weights
    }

    /// The stored check: a name for these exact bytes.
    pub fn check(&self) -> u64 {
        self.bytes.last_chunk().copied().map_or(0, u64::from_le_bytes)
    }

    /// The network over the weights, without a copy.
    ///
    /// # Errors
    ///
    /// [`WrongTopology`] if the blob holds another network.
    pub fn network<R: Recurrence, const H: usize, const O: usize>(
        &self,
    ) -> Result<Network<'a, R, f32, INPUTS, H, O>, WrongTopology> {
        let found = self.header.topology;
        let expected = Network::<R, f32, INPUTS, H, O>::topology(found.biases);
        let wrong = WrongTopology { found, expected };
        if found != expected {
            return Err(wrong);
        }
        Network::new(self.weights, found.biases).map_err(|_| wrong)
    }
}

/// The blob length that the header states, after checking magic and version.
fn stated_len(bytes: &[u8]) -> Result<usize, BlobError> {
    let short = BlobError::TooShort { found: bytes.len(), expected: HEADER_BYTES + CHECK_BYTES };
    let mut reader = read::Reader::new(bytes);
    let magic = reader.array().ok_or(short)?;
    if magic != MAGIC {
        return Err(BlobError::Magic { found: magic });
    }
    let version = reader.u16().ok_or(short)?;
    if version != VERSION {
        return Err(BlobError::Version { found: version, expected: VERSION });
    }
    reader.u16().ok_or(short)?;
    let stated = reader.u32().ok_or(short)? as usize;
    if bytes.len() < stated {
        return Err(BlobError::TooShort { found: bytes.len(), expected: stated });
    }
    Ok(stated)
}

fn refuse_weights(weights: &[f32]) -> Result<(), BlobError> {
    for (index, weight) in weights.iter().enumerate() {
        // Also true for NaN, which is within no range.
        if !(-WEIGHT_LIMIT..=WEIGHT_LIMIT).contains(weight) {
            return Err(BlobError::Weight { index, value: *weight });
        }
    }
    Ok(())
}

fn refuse_self_tests(words: &[f32]) -> Result<(), BlobError> {
    for (index, word) in words.iter().enumerate() {
        if !(-1.0..=1.0).contains(word) {
            return Err(BlobError::SelfTestValue { index, value: *word });
        }
    }
    Ok(())
}

/// Words in genome order, serialised as a tuple: postcard writes them as little-endian `f32`
/// without a length.
struct Words<'a>(&'a [f32]);

impl Serialize for Words<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut tuple = serializer.serialize_tuple(self.0.len())?;
        for word in self.0 {
            tuple.serialize_element(word)?;
        }
        tuple.end()
    }
}

/// Why a blob cannot be written.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EncodeError {
    /// The output has fewer bytes than the blob, [`Header::blob_len`].
    Buffer {
        /// What was given.
        found: usize,
        /// What is needed.
        expected: usize,
    },
    /// Weights or self-test words do not match the header's counts.
    Count {
        /// What was given.
        found: usize,
        /// What the header says.
        expected: usize,
    },
    /// Reading the blob back would refuse it.
    Refused(BlobError),
}

impl fmt::Display for EncodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Buffer { found, expected } => {
                write!(f, "{found} bytes of room, the blob takes {expected}")
            }
            Self::Count { found, expected } => {
                write!(f, "{found} numbers given, the header says {expected}")
            }
            Self::Refused(error) => write!(f, "this blob would be refused: {error}"),
        }
    }
}

impl core::error::Error for EncodeError {}

/// Writes a blob and returns its length. The output must start at a multiple of 4 bytes.
///
/// `self_tests` holds the triples' words: inputs, state before (first hidden layer, second),
/// outputs; [`Header::self_test_words`] numbers each.
///
/// # Errors
///
/// Counts that do not match the header, too little room, or anything that [`Blob::parse`]
/// would refuse: what is written can always be read.
pub fn encode(
    header: &Header,
    weights: &[f32],
    self_tests: &[f32],
    out: &mut [u8],
) -> Result<usize, EncodeError> {
    for (words, expected) in [
        (weights, header.topology.weights()),
        (self_tests, usize::from(header.self_tests) * header.self_test_words()),
    ] {
        if words.len() != expected {
            return Err(EncodeError::Count { found: words.len(), expected });
        }
    }
    let expected = header.blob_len();
    let buffer = EncodeError::Buffer { found: out.len(), expected };
    let out = out.get_mut(..expected).ok_or(buffer)?;
    let (body, check) = out.split_last_chunk_mut::<CHECK_BYTES>().ok_or(buffer)?;
    let (head, payload) = body.split_first_chunk_mut::<HEADER_BYTES>().ok_or(buffer)?;
    header.encode(head);
    let rest = payload.get_mut(4 * weights.len()..).ok_or(buffer)?;
    postcard::to_slice(&Words(self_tests), rest).map_err(|_| buffer)?;
    postcard::to_slice(&Words(weights), payload).map_err(|_| buffer)?;
    *check = CHECK.checksum(body).to_le_bytes();
    Blob::parse(out).map_err(EncodeError::Refused)?;
    Ok(expected)
}

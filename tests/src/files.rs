//! The two files of a proof: cases from the host to a machine, results back.
//!
//! Both are sequences of little-endian 32-bit words, written and read as they come, so that a machine with a
//! few kilobytes of memory can prove any number of steps.
//!
//! Cases:
//!
//! | words | content |
//! | --- | --- |
//! | 2 | the bytes `EVOCASES` |
//! | 1, 1 | format version, [`VERSION`]; number of cases |
//! | 1, 1, 1 | of each case: seed of its course, steps, words of its weight blob |
//! | … | the weight blob |
//! | 2 | the check so far, low word first |
//!
//! Results:
//!
//! | words | content |
//! | --- | --- |
//! | 2 | the bytes `EVOTRACE` |
//! | 1, 1 | format version, [`VERSION`]; number of cases |
//! | 1, 1, 2 | of each case: its number, steps, check of its weight blob, low word first |
//! | [`VALUES`] each | the steps, as [`closed_loop`](crate::closed_loop) orders them |
//! | 2 | the check so far, low word first |
//!
//! The check is FNV-1a over all words before it, a word at a time. A file that ends early, goes on, or has one
//! word damaged is refused; no two words can be swapped between cases, since the check runs on.

mod cases;
mod error;
mod results;
mod words;

pub use cases::{Case, CaseAndBlob, CasesReader, CasesWriter};
pub use error::FileError;
pub use results::{ResultsReader, ResultsWriter};
#[cfg(feature = "std")]
pub use words::Stream;
pub use words::{Sink, Source};

#[cfg(doc)]
use crate::closed_loop::VALUES;

/// The format this release writes and reads.
pub const VERSION: u32 = 1;

/// Longest weight blob of a case, words: 4 KiB, which the smallest board has memory for.
pub const BLOB_WORDS: usize = 1024;

const fn magic(text: &[u8; 8]) -> [u32; 2] {
    let [a, b, c, d, e, f, g, h] = *text;
    [u32::from_le_bytes([a, b, c, d]), u32::from_le_bytes([e, f, g, h])]
}

const CASES: [u32; 2] = magic(b"EVOCASES");
const RESULTS: [u32; 2] = magic(b"EVOTRACE");

#[cfg(test)]
mod tests;

//! Why a file of a proof is not read further.

use core::fmt;

/// What is wrong with a file of cases or results. `E` is what its medium reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileError<E> {
    /// It cannot be read, or it ends early.
    Medium(E),
    /// It is another kind of file.
    Magic {
        /// Its first words.
        found: [u32; 2],
        /// This kind's.
        expected: [u32; 2],
    },
    /// Another format version.
    Version {
        /// The file's.
        found: u32,
        /// This program's.
        expected: u32,
    },
    /// A weight blob longer than a case may have.
    BlobTooLong {
        /// Its words.
        found: u32,
        /// The most that are read.
        expected: usize,
    },
    /// The results of another case, or of other weights, than asked for.
    OtherCase {
        /// Number, steps and blob check of the results.
        found: [u32; 4],
        /// Those of the case.
        expected: [u32; 4],
    },
    /// More or fewer cases than asked for.
    Count {
        /// In the file.
        found: u32,
        /// Asked for.
        expected: u32,
    },
    /// Words were damaged.
    Check {
        /// The stored check, low word first.
        found: [u32; 2],
        /// The one over the words before it.
        expected: [u32; 2],
    },
    /// It goes on after its last case.
    GoesOn,
}

impl<E: fmt::Display> fmt::Display for FileError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Medium(error) => error.fmt(f),
            Self::Magic { found: [a, b], expected: [c, d] } => {
                write!(f, "it starts with {a:08x} {b:08x}, {c:08x} {d:08x} expected")
            }
            Self::Version { found, expected } => {
                write!(f, "format version {found}, this program reads version {expected}")
            }
            Self::BlobTooLong { found, expected } => {
                write!(f, "a weight blob of {found} words, at most {expected} expected")
            }
            Self::OtherCase { found, expected } => {
                write!(f, "results of case {found:08x?}, {expected:08x?} expected")
            }
            Self::Count { found, expected } => write!(f, "{found} cases, {expected} expected"),
            Self::Check { found: [a, b], expected: [c, d] } => {
                write!(f, "damaged: check {b:08x}{a:08x} stored, {d:08x}{c:08x} computed")
            }
            Self::GoesOn => f.write_str("it goes on after its last case"),
        }
    }
}

impl<E: fmt::Debug + fmt::Display> core::error::Error for FileError<E> {}

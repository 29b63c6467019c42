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

controller_core::sentences! { impl<E> FileError<E> {
    Self::Medium(error) => "{}", error;
    Self::Magic { found: [a, b], expected: [c, d] } =>
        "it starts with {:08x} {:08x}, {:08x} {:08x} expected", a, b, c, d;
    Self::Version { found, expected } =>
        "format version {}, this program reads version {}", found, expected;
    Self::BlobTooLong { found, expected } =>
        "a weight blob of {} words, at most {} expected", found, expected;
    Self::OtherCase { found: [case, steps, low, high], expected: [c, s, l, h] } =>
        "results of case {}, {} steps, weights {:08x}{:08x}; expected case {}, {} steps, weights {:08x}{:08x}",
        case, steps, high, low, c, s, h, l;
    Self::Count { found, expected } => "{} cases, {} expected", found, expected;
    Self::Check { found: [a, b], expected: [c, d] } =>
        "damaged: check {:08x}{:08x} stored, {:08x}{:08x} computed", b, a, d, c;
    Self::GoesOn => "it goes on after its last case";
} }

impl<E: fmt::Debug + fmt::Display> core::error::Error for FileError<E> {}

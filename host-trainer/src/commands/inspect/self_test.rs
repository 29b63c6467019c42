//! The recorded self-test, run here: sizes become types.

use std::fmt;

use controller_core::blob::{Blob, SelfTestError};
use controller_core::network::{Elman, Feedforward, Recurrence, RecurrenceKind, SelfLoop};

use crate::scenario::NetworkSpec;

/// What the self-test said.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum SelfTest {
    /// Every recorded output came out with the same bits.
    Passed,
    /// The blob records no triples.
    NoneRecorded,
    /// No network of this size is built into this program.
    NotBuiltIn,
    /// Another result than recorded.
    Failed(SelfTestError),
}

impl SelfTest {
    /// Runs the blob's self-test on this machine.
    pub(super) fn run(blob: &Blob<'_>) -> Self {
        if blob.header().self_tests == 0 {
            return Self::NoneRecorded;
        }
        match blob.header().topology.recurrence {
            RecurrenceKind::Feedforward => sized::<Feedforward>(blob),
            RecurrenceKind::SelfLoop => sized::<SelfLoop>(blob),
            RecurrenceKind::Elman => sized::<Elman>(blob),
        }
    }

    /// One word for machines.
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Passed => "passed",
            Self::NoneRecorded => "none",
            Self::NotBuiltIn => "not-built-in",
            Self::Failed(_) => "failed",
        }
    }
}

impl fmt::Display for SelfTest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Passed => write!(f, "passed: this machine computes the recorded bits"),
            Self::NoneRecorded => write!(f, "none recorded"),
            Self::NotBuiltIn => write!(
                f,
                "not run: hidden layers of {:?} neurons are built into this program",
                NetworkSpec::HIDDEN
            ),
            Self::Failed(error) => write!(f, "FAILED: {error}"),
        }
    }
}

fn sized<R: Recurrence>(blob: &Blob<'_>) -> SelfTest {
    let (topology, activation) = (blob.header().topology, blob.header().activation);
    macro_rules! pick {
        ($(($hidden:literal, $outputs:literal)),*) => {
            match (topology.hidden, topology.outputs) {
                $(($hidden, $outputs) => blob.self_test::<R, $hidden, $outputs>(activation),)*
                _ => return SelfTest::NotBuiltIn,
            }
        };
    }
    let result = pick!((12, 1), (12, 2), (16, 1), (16, 2), (24, 1), (24, 2), (32, 1), (32, 2));
    result.map_or_else(SelfTest::Failed, |()| SelfTest::Passed)
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use super::*;
    use crate::blob_file::{BlobFile, FileBytes};
    use crate::sample_blob::SampleBlob;

    fn run(sample: &SampleBlob) -> SelfTest {
        let file = FileBytes::new(PathBuf::from("x"), &sample.bytes());
        SelfTest::run(&BlobFile::check(file).unwrap().blob())
    }

    #[test]
    fn every_size_that_a_scenario_may_ask_for_is_built_in() {
        macro_rules! all_pass {
            ($($hidden:literal)*) => {
                let built_in = [$($hidden),*];
                $(
                    assert_eq!(run(&SampleBlob::new::<Feedforward, $hidden, 1>(false)), SelfTest::Passed);
                    assert_eq!(run(&SampleBlob::new::<SelfLoop, $hidden, 2>(true)), SelfTest::Passed);
                    assert_eq!(run(&SampleBlob::new::<Elman, $hidden, 1>(true)), SelfTest::Passed);
                )*
                assert_eq!(built_in, NetworkSpec::HIDDEN);
            };
        }
        all_pass!(12 16 24 32);
    }

    #[test]
    fn another_size_or_nothing_to_compare_is_no_failure() {
        assert_eq!(run(&SampleBlob::new::<Elman, 13, 1>(true)), SelfTest::NotBuiltIn);
        let mut sample = SampleBlob::new::<Elman, 12, 1>(true);
        sample.header.self_tests = 0;
        sample.self_tests.clear();
        assert_eq!(run(&sample), SelfTest::NoneRecorded);
    }

    #[test]
    fn one_other_bit_in_the_last_recorded_output_fails() {
        let mut sample = SampleBlob::new::<Elman, 12, 2>(true);
        let last = sample.self_tests.last_mut().unwrap();
        let found = last.to_bits();
        *last = f32::from_bits(found ^ 1);
        let expected = SelfTestError::Output { triple: 1, output: 1, found, expected: found ^ 1 };
        assert_eq!(run(&sample), SelfTest::Failed(expected));
    }
}

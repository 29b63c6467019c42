//! The cases that a machine is asked to drive.

use super::words::Checked;
use super::{BLOB_WORDS, CASES, FileError, Sink, Source, VERSION};

/// One drive, but for its weights.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Case {
    /// Seed of its course, [`Course::Seeded`](crate::course::Course::Seeded).
    pub seed: u32,
    /// Steps.
    pub steps: u32,
}

/// A case with the words of its weight blob.
pub type CaseAndBlob<'r> = (Case, &'r [u32]);

/// Writes cases.
#[derive(Debug)]
pub struct CasesWriter<K> {
    words: Checked<K>,
}

impl<K: Sink> CasesWriter<K> {
    /// Begins a file of so many cases.
    ///
    /// # Errors
    ///
    /// What the medium reports, as in every function here.
    pub fn new(medium: K, cases: u32) -> Result<Self, K::Error> {
        let mut words = Checked::new(medium);
        let [first, second] = CASES;
        words.put(&[first, second, VERSION, cases])?;
        Ok(Self { words })
    }

    /// Adds a case and its weight blob.
    ///
    /// # Errors
    ///
    /// As [`Self::new`].
    pub fn add(&mut self, case: Case, blob: &[u32]) -> Result<(), K::Error> {
        self.words.put(&[case.seed, case.steps, blob.len() as u32])?;
        self.words.put(blob)?;
        self.words.put_check()
    }

    /// Ends the file; returns its medium.
    ///
    /// # Errors
    ///
    /// As [`Self::new`].
    pub fn finish(mut self) -> Result<K, K::Error> {
        self.words.medium.flush()?;
        Ok(self.words.medium)
    }
}

/// Reads cases.
#[derive(Debug)]
pub struct CasesReader<S> {
    words: Checked<S>,
    left: u32,
}

impl<S: Source> CasesReader<S> {
    /// Reads the head of the file.
    ///
    /// # Errors
    ///
    /// Another kind of file, another version, or what the medium reports.
    pub fn new(medium: S) -> Result<Self, FileError<S::Error>> {
        let mut words = Checked::new(medium);
        let left = words.head(CASES)?;
        Ok(Self { words, left })
    }

    /// Cases that are still to come.
    pub fn left(&self) -> u32 {
        self.left
    }

    /// The next case with its weight blob, which is put into `room` and not looked into; `None` after the last.
    ///
    /// # Errors
    ///
    /// A blob longer than `room`, damage, a file that goes on after its last case, or what the medium reports.
    pub fn next<'r>(
        &mut self,
        room: &'r mut [u32; BLOB_WORDS],
    ) -> Result<Option<CaseAndBlob<'r>>, FileError<S::Error>> {
        if self.left == 0 {
            return self.words.expect_end().map(|()| None);
        }
        self.left -= 1;
        let [seed, steps, length] = self.words.array()?;
        let blob = room
            .get_mut(..length as usize)
            .ok_or(FileError::BlobTooLong { found: length, expected: BLOB_WORDS })?;
        self.words.fill(blob)?;
        self.words.expect_check()?;
        Ok(Some((Case { seed, steps }, blob)))
    }
}

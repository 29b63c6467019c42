//! What a machine answers: every value of every step.

use super::words::{Checked, split};
use super::{Case, FileError, RESULTS, Sink, Source, VERSION};
use crate::closed_loop::{Bits, VALUES};

/// Writes results.
#[derive(Debug)]
pub struct ResultsWriter<K> {
    words: Checked<K>,
    case: u32,
}

impl<K: Sink> ResultsWriter<K> {
    /// Begins the results of so many cases.
    ///
    /// # Errors
    ///
    /// What the medium reports, as in every function here.
    pub fn new(medium: K, cases: u32) -> Result<Self, K::Error> {
        let mut words = Checked::new(medium);
        let [first, second] = RESULTS;
        words.put(&[first, second, VERSION, cases])?;
        Ok(Self { words, case: 0 })
    }

    /// Begins a case, driven by the weight blob with this check.
    ///
    /// # Errors
    ///
    /// As [`Self::new`].
    pub fn begin(&mut self, case: Case, blob_check: u64) -> Result<(), K::Error> {
        let [low, high] = split(blob_check);
        self.words.put(&[self.case, case.steps, low, high])?;
        self.case = self.case.wrapping_add(1);
        Ok(())
    }

    /// Adds a step.
    ///
    /// # Errors
    ///
    /// As [`Self::new`].
    pub fn step(&mut self, bits: &Bits) -> Result<(), K::Error> {
        self.words.put(bits)
    }

    /// Ends a case.
    ///
    /// # Errors
    ///
    /// As [`Self::new`].
    pub fn end(&mut self) -> Result<(), K::Error> {
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

/// Reads results.
#[derive(Debug)]
pub struct ResultsReader<S> {
    words: Checked<S>,
    case: u32,
}

impl<S: Source> ResultsReader<S> {
    /// Reads the head of the results of so many cases.
    ///
    /// # Errors
    ///
    /// Another kind of file, version or number, or what the medium reports.
    pub fn new(medium: S, cases: u32) -> Result<Self, FileError<S::Error>> {
        let mut words = Checked::new(medium);
        let found = words.head(RESULTS)?;
        if found != cases {
            return Err(FileError::Count { found, expected: cases });
        }
        Ok(Self { words, case: 0 })
    }

    /// Begins the next case, which has to be this one.
    ///
    /// # Errors
    ///
    /// Results of another case or of other weights, or what the medium reports.
    pub fn begin(&mut self, case: Case, blob_check: u64) -> Result<(), FileError<S::Error>> {
        let [low, high] = split(blob_check);
        let expected = [self.case, case.steps, low, high];
        let found = self.words.array()?;
        if found != expected {
            return Err(FileError::OtherCase { found, expected });
        }
        self.case = self.case.wrapping_add(1);
        Ok(())
    }

    /// The next step.
    ///
    /// # Errors
    ///
    /// What the medium reports.
    pub fn step(&mut self) -> Result<Bits, FileError<S::Error>> {
        self.words.array::<VALUES>()
    }

    /// Ends a case.
    ///
    /// # Errors
    ///
    /// Damage, or what the medium reports.
    pub fn end(&mut self) -> Result<(), FileError<S::Error>> {
        self.words.expect_check()
    }

    /// Ends the file.
    ///
    /// # Errors
    ///
    /// A file that goes on, or what the medium reports.
    pub fn finish(mut self) -> Result<(), FileError<S::Error>> {
        self.words.expect_end()
    }
}

//! Words in and out, and the check that runs along.

use super::FileError;

/// Where words come from.
pub trait Source {
    /// Why they do not come.
    type Error;

    /// Fills all of `words`.
    ///
    /// # Errors
    ///
    /// Whatever the medium reports, the end of the file included.
    fn fill(&mut self, words: &mut [u32]) -> Result<(), Self::Error>;

    /// Whether the file ends here.
    ///
    /// # Errors
    ///
    /// Whatever the medium reports.
    fn at_end(&mut self) -> Result<bool, Self::Error>;
}

/// Where words go.
pub trait Sink {
    /// Why they do not go.
    type Error;

    /// Writes all of `words`.
    ///
    /// # Errors
    ///
    /// Whatever the medium reports.
    fn put(&mut self, words: &[u32]) -> Result<(), Self::Error>;

    /// Writes what is still held back.
    ///
    /// # Errors
    ///
    /// Whatever the medium reports.
    fn flush(&mut self) -> Result<(), Self::Error>;
}

/// FNV-1a with 64 bits, a word at a time. A change in one word changes every check after it, because each
/// step is reversible: an exclusive or, and a product with an odd number.
#[derive(Clone, Copy, Debug)]
pub(super) struct Check(u64);

impl Check {
    pub(super) fn new() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }

    pub(super) fn add(&mut self, words: &[u32]) {
        for word in words {
            self.0 = (self.0 ^ u64::from(*word)).wrapping_mul(0x100_0000_01b3);
        }
    }

    pub(super) fn words(self) -> [u32; 2] {
        split(self.0)
    }
}

/// Low word first.
pub(super) fn split(value: u64) -> [u32; 2] {
    [value as u32, (value >> 32) as u32]
}

/// Reads words and runs the check over them.
#[derive(Clone, Debug)]
pub(super) struct Checked<M> {
    pub(super) medium: M,
    check: Check,
}

impl<M> Checked<M> {
    pub(super) fn new(medium: M) -> Self {
        Self { medium, check: Check::new() }
    }
}

impl<S: Source> Checked<S> {
    pub(super) fn fill(&mut self, words: &mut [u32]) -> Result<(), FileError<S::Error>> {
        self.medium.fill(words).map_err(FileError::Medium)?;
        self.check.add(words);
        Ok(())
    }

    pub(super) fn array<const N: usize>(&mut self) -> Result<[u32; N], FileError<S::Error>> {
        let mut words = [0; N];
        self.fill(&mut words)?;
        Ok(words)
    }

    /// Reads the check and compares it.
    pub(super) fn expect_check(&mut self) -> Result<(), FileError<S::Error>> {
        let expected = self.check.words();
        let found: [u32; 2] = self.array()?;
        if found == expected { Ok(()) } else { Err(FileError::Check { found, expected }) }
    }

    /// Magic, version, and the number of cases.
    pub(super) fn head(&mut self, magic: [u32; 2]) -> Result<u32, FileError<S::Error>> {
        let [first, second, version, cases] = self.array()?;
        if [first, second] != magic {
            return Err(FileError::Magic { found: [first, second], expected: magic });
        }
        if version != super::VERSION {
            return Err(FileError::Version { found: version, expected: super::VERSION });
        }
        Ok(cases)
    }

    pub(super) fn expect_end(&mut self) -> Result<(), FileError<S::Error>> {
        let ends = self.medium.at_end().map_err(FileError::Medium)?;
        if ends { Ok(()) } else { Err(FileError::GoesOn) }
    }
}

impl<K: Sink> Checked<K> {
    pub(super) fn put(&mut self, words: &[u32]) -> Result<(), K::Error> {
        self.check.add(words);
        self.medium.put(words)
    }

    pub(super) fn put_check(&mut self) -> Result<(), K::Error> {
        let words = self.check.words();
        self.put(&words)
    }
}

/// A file, or anything else with the standard library's traits, as words.
#[cfg(feature = "std")]
#[derive(Debug)]
pub struct Stream<T>(pub T);

#[cfg(feature = "std")]
impl<R: std::io::BufRead> Source for Stream<R> {
    type Error = std::io::Error;

    fn fill(&mut self, words: &mut [u32]) -> std::io::Result<()> {
        self.0.read_exact(bytemuck::cast_slice_mut(words))
    }

    fn at_end(&mut self) -> std::io::Result<bool> {
        Ok(self.0.fill_buf()?.is_empty())
    }
}

#[cfg(feature = "std")]
impl<W: std::io::Write> Sink for Stream<W> {
    type Error = std::io::Error;

    fn put(&mut self, words: &[u32]) -> std::io::Result<()> {
        self.0.write_all(bytemuck::cast_slice(words))
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.0.flush()
    }
}

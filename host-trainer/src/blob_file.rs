//! A champion as the command line names it, read and checked.
//!
//! `CHAMPION` is a weight blob or a run folder, which stands for its `champion.blob`.

use std::fs::{self, File};
use std::io::{self, ErrorKind, Read};
use std::path::{Path, PathBuf};

use controller_core::blob::{Blob, BlobError};

use crate::failure::Failure;
use crate::run_folder::RunFolder;

/// Longest file that is read, bytes. The networks that are built in take less than 100 kB.
pub const LONGEST_FILE: u64 = 1 << 20;

/// A file's bytes where words can be read in place: they start at a multiple of four.
#[derive(Clone, Debug)]
pub struct FileBytes {
    path: PathBuf,
    words: Vec<u32>,
    length: usize,
}

impl FileBytes {
    /// Reads what the command line names as `argument`, a file or a run folder.
    ///
    /// # Errors
    ///
    /// Bad input, naming `argument`, when nothing is there or it is longer than
    /// [`LONGEST_FILE`]; input/output for everything else.
    pub fn read(argument: &str, path: &Path) -> Result<Self, Failure> {
        let path = locate(argument, path)?;
        let failed = |cause: io::Error| Failure::io("read", &path, &cause);
        let file = File::open(&path).map_err(failed)?;
        let stated = file.metadata().map_err(failed)?.len();
        let mut bytes = Vec::new();
        // A pipe or a device states no length, so the reading is limited as well.
        if stated <= LONGEST_FILE {
            file.take(LONGEST_FILE + 1).read_to_end(&mut bytes).map_err(failed)?;
        }
        if stated.max(bytes.len() as u64) > LONGEST_FILE {
            return Err(Failure::bad_input(format!(
                "{argument} {}: more than 1 MiB, a weight blob of a few kB expected",
                path.display()
            )));
        }
        Ok(Self::new(path, &bytes))
    }

    /// Copies bytes from elsewhere; `path` is what messages call them.
    pub fn new(path: PathBuf, bytes: &[u8]) -> Self {
        let mut words = vec![0; bytes.len().div_ceil(4)];
        let room: &mut [u8] = bytemuck::cast_slice_mut(&mut words);
        for (slot, byte) in room.iter_mut().zip(bytes) {
            *slot = *byte;
        }
        Self { path, words, length: bytes.len() }
    }

    /// The file: within the run folder, if that was named.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// All of the file.
    pub fn bytes(&self) -> &[u8] {
        let bytes: &[u8] = bytemuck::cast_slice(&self.words);
        bytes.get(..self.length).unwrap_or(bytes)
    }
}

/// A file that holds a weight blob and nothing else.
#[derive(Clone, Debug)]
pub struct BlobFile(FileBytes);

impl BlobFile {
    /// Reads the argument `CHAMPION`: a weight blob, or a run folder for its `champion.blob`.
    ///
    /// # Errors
    ///
    /// Bad input when nothing is there, or naming the reason why it is no blob; input/output
    /// when it cannot be read.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        Self::read_as("CHAMPION", path)
    }

    /// The same for another `argument` of the command line.
    ///
    /// # Errors
    ///
    /// As [`Self::read`], naming that argument.
    pub fn read_as(argument: &str, path: &Path) -> Result<Self, Failure> {
        let file = FileBytes::read(argument, path)?;
        let refused = |cause: BlobError| refusal(file.path(), &cause);
        Blob::parse(file.bytes()).map_err(refused)?;
        Ok(Self(file))
    }

    /// Checks bytes that were read already.
    ///
    /// # Errors
    ///
    /// The bytes come back, with the reason why they are no blob.
    pub fn check(file: FileBytes) -> Result<Self, (FileBytes, BlobError)> {
        match Blob::parse(file.bytes()).err() {
            None => Ok(Self(file)),
            Some(cause) => Err((file, cause)),
        }
    }

    /// The blob in the file.
    pub fn blob(&self) -> Blob<'_> {
        Blob::parse(self.bytes()).expect("both constructors parsed the same bytes")
    }

    /// The file: within the run folder, if that was named.
    pub fn path(&self) -> &Path {
        self.0.path()
    }

    /// All of the file, which is all of the blob.
    pub fn bytes(&self) -> &[u8] {
        self.0.bytes()
    }
}

/// The failure that says why the file at `path` is not used.
pub fn refusal(path: &Path, cause: &BlobError) -> Failure {
    Failure::bad_input(format!("{} is refused: {cause}", path.display()))
}

/// The file that an argument stands for. Everything a champion can be called is decided here.
fn locate(argument: &str, path: &Path) -> Result<PathBuf, Failure> {
    let metadata = match fs::metadata(path) {
        Ok(metadata) => metadata,
        // `runs/a.blob/x`, where `runs/a.blob` is a file, is no file either.
        Err(cause) if matches!(cause.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
            return Err(Failure::bad_input(format!(
                "{argument} {}: no such file; a weight blob or a run folder expected",
                path.display()
            )));
        }
        Err(cause) => return Err(Failure::io("read", path, &cause)),
    };
    if !metadata.is_dir() {
        return Ok(path.to_owned());
    }
    let champion = path.join(RunFolder::CHAMPION);
    if champion.exists() {
        return Ok(champion);
    }
    let folder = path.display();
    Err(Failure::bad_input(if path.join(RunFolder::MANIFEST).exists() {
        format!(
            "{argument} {folder}: this run has not finished and holds no {} yet; finish it with: \
             evosteer train --resume {folder}",
            RunFolder::CHAMPION
        )
    } else {
        format!(
            "{argument} {folder}: a folder without {}; a weight blob or a run folder expected",
            RunFolder::CHAMPION
        )
    }))
}

#[cfg(test)]
mod tests;

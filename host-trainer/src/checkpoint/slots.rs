//! The two checkpoint files of a run: the newer counts, the older is the way back.

use std::fs;
use std::io::ErrorKind;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::{decode, encode};
use crate::failure::Failure;
use crate::run_folder::RunFolder;

/// Writes checkpoints so that a good one exists at every instant.
#[derive(Debug)]
pub struct Checkpoints {
    /// Index into [`RunFolder::CHECKPOINTS`] of the file to write next.
    next: usize,
}

/// A checkpoint read back.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded<T> {
    /// How many generations were done.
    pub generation: u64,
    /// The state after them.
    pub state: T,
    /// A damaged newer file that was passed over, in words for the operator.
    pub warnings: Vec<String>,
}

impl Checkpoints {
    /// Finds the newest good checkpoint, if the run has any, and gets ready to write the
    /// next one over the other file.
    ///
    /// # Errors
    ///
    /// Bad input when there are checkpoints and none is good, with each one's fault;
    /// input/output when a file cannot be read.
    pub fn open<T: Serialize + DeserializeOwned>(
        folder: &RunFolder,
    ) -> Result<(Self, Option<Loaded<T>>), Failure> {
        let mut newest: Option<(usize, u64, T)> = None;
        let mut damaged = Vec::new();
        for (slot, name) in RunFolder::CHECKPOINTS.into_iter().enumerate() {
            let path = folder.join(name);
            let bytes = match fs::read(&path) {
                Ok(bytes) => bytes,
                Err(cause) if cause.kind() == ErrorKind::NotFound => continue,
                Err(cause) => return Err(Failure::io("read", &path, &cause)),
            };
            match decode::<T>(&bytes) {
                Ok((generation, state)) => {
                    if newest.as_ref().is_none_or(|(_, newest, _)| generation > *newest) {
                        newest = Some((slot, generation, state));
                    }
                }
                Err(error) => damaged.push(format!("{}: {error}", path.display())),
            }
        }
        match newest {
            Some((slot, generation, state)) => {
                let warnings = damaged
                    .into_iter()
                    .map(|fault| format!("{fault}; going on from generation {generation}"))
                    .collect();
                Ok((Self { next: 1 - slot }, Some(Loaded { generation, state, warnings })))
            }
            None if damaged.is_empty() => Ok((Self { next: 0 }, None)),
            None => Err(Failure::bad_input(format!(
                "no checkpoint in {} can be resumed\n  {}\n  without them the run begins anew \
                 and ends the same",
                folder.path().display(),
                damaged.join("\n  ")
            ))),
        }
    }

    /// Writes the state after `generation` generations, over the older of the two files.
    ///
    /// When this fails, the newer file is untouched and is still the newest.
    ///
    /// # Errors
    ///
    /// Input/output, naming the file.
    pub fn save<T: Serialize>(
        &mut self,
        folder: &RunFolder,
        generation: u64,
        state: &T,
    ) -> Result<(), Failure> {
        let name = RunFolder::CHECKPOINTS[self.next];
        let bytes = encode(generation, state).map_err(|error| {
            let cause = std::io::Error::new(ErrorKind::InvalidData, error.to_string());
            Failure::io("write", &folder.join(name), &cause)
        })?;
        folder.write(name, &bytes)?;
        self.next = 1 - self.next;
        Ok(())
    }
}

#[cfg(test)]
mod tests;

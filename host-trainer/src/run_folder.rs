//! The folder of one training run, held by one process at a time.
//!
//! | file | holds | written |
//! | --- | --- | --- |
//! | `manifest.toml` | what the run is: [`Manifest`] | once, first |
//! | `from.blob` | the champion that it began with, where it did not begin with random networks | once, second |
//! | `metrics.csv` | one row per generation: [`Metrics`] | row by row |
//! | `timing.csv` | how fast each generation was; the only file that differs between equal runs | row by row |
//! | `checkpoint-a.bin`, `checkpoint-b.bin` | state to resume from: [`crate::checkpoint`] | in turn |
//! | `champion.blob` | the best controller | at the end |
//! | `plots/*.svg`, `report.html` | pictures and the report | at the end |
//! | `worlds/*.toml`, `worlds/*.svg` | random worlds it trained in, where it made any | second, and at the end |
//! | `lock` | nothing; whoever holds its lock owns the folder | |

pub mod manifest;
pub mod metrics;

use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

pub use manifest::Manifest;
pub use metrics::{Metrics, MetricsRow};

use crate::failure::{Failure, FailureKind};
use crate::files;

/// A run's folder, locked for this process until dropped.
///
/// The operating system frees the lock when the process ends in any way, `kill -9` included.
#[derive(Debug)]
pub struct RunFolder {
    path: PathBuf,
    lock: File,
}

impl RunFolder {
    /// What the run is.
    pub const MANIFEST: &'static str = "manifest.toml";
    /// What a reproduction is, in its place.
    pub const REPRODUCTION: &'static str = "reproduction.toml";
    /// The champion that the run began with.
    pub const FROM: &'static str = "from.blob";
    /// One row per generation.
    pub const METRICS: &'static str = "metrics.csv";
    /// Wall-clock speed per generation.
    pub const TIMING: &'static str = "timing.csv";
    /// The two checkpoints, written in turn.
    pub const CHECKPOINTS: [&'static str; 2] = ["checkpoint-a.bin", "checkpoint-b.bin"];
    /// The best controller.
    pub const CHAMPION: &'static str = "champion.blob";
    /// The folder of the plots.
    pub const PLOTS: &'static str = "plots";
    /// The folder of the worlds that a run made for itself to train in.
    pub const WORLDS: &'static str = "worlds";
    /// The self-contained report.
    pub const REPORT: &'static str = "report.html";
    /// Holds the lock.
    pub const LOCK: &'static str = "lock";

    /// Makes `path` a new run's folder, with its parents; an empty folder is taken over.
    ///
    /// # Errors
    ///
    /// Busy when another process is creating or using it; bad input when it holds
    /// anything already; input/output when it cannot be written to.
    pub fn create(path: &Path) -> Result<Self, Failure> {
        match fs::create_dir_all(path) {
            Ok(()) => {}
            Err(_) if path.exists() && !path.is_dir() => {
                return Err(Failure::bad_input(format!(
                    "--out: {} is a file; expected a folder that is new or empty",
                    path.display()
                )));
            }
            Err(cause) => return Err(Failure::io("create the folder", path, &cause)),
        }
        // A folder of someone else's is refused before a lock file is put into it. What is there may also be
        // the beginning of a run, made between two looks: then its lock decides.
        let has_lock = || path.join(Self::LOCK).exists();
        if !has_lock()
            && let Err(used) = refuse_used(path)
            && !has_lock()
        {
            return Err(used);
        }
        let folder = Self::lock(path)?;
        // Another process may have had a whole run here since the first look.
        refuse_used(path)?;
        Ok(folder)
    }

    /// Makes a new run's folder `<base>/<name>-<seed>`, or the first free one of
    /// `<name>-<seed>-2`, `-3`, …
    ///
    /// # Errors
    ///
    /// Input/output when nothing can be created in `base`.
    pub fn choose(base: &Path, name: &str, seed: u64) -> Result<Self, Failure> {
        fs::create_dir_all(base).map_err(|cause| Failure::io("create the folder", base, &cause))?;
        let mut candidate = base.join(format!("{name}-{seed}"));
        let mut number = 1_u64;
        loop {
            match fs::create_dir(&candidate) {
                Ok(()) => match Self::create(&candidate) {
                    // Someone gave this very folder as --out between the two lines.
                    Err(taken)
                        if matches!(taken.kind(), FailureKind::Busy | FailureKind::BadInput) => {}
                    result => return result,
                },
                Err(cause) if cause.kind() == ErrorKind::AlreadyExists => {}
                Err(cause) => return Err(Failure::io("create the folder", &candidate, &cause)),
            }
            number += 1;
            candidate = base.join(format!("{name}-{seed}-{number}"));
        }
    }

    /// Takes up the run in `path`.
    ///
    /// # Errors
    ///
    /// Busy when another process is using it; bad input when it is not a run's folder;
    /// input/output when it cannot be written to.
    pub fn resume(path: &Path) -> Result<Self, Failure> {
        Self::take_up(path, Self::MANIFEST, "train")
    }

    /// Takes up the reproduction in `path`.
    ///
    /// # Errors
    ///
    /// As [`RunFolder::resume`].
    pub fn resume_reproduction(path: &Path) -> Result<Self, Failure> {
        Self::take_up(path, Self::REPRODUCTION, "reproduce")
    }

    /// Takes up what `verb` has begun, which says what it is in the file `begun_by`.
    fn take_up(path: &Path, begun_by: &str, verb: &str) -> Result<Self, Failure> {
        let not_a_run = |why: &str| {
            Failure::bad_input(format!(
                "--resume: {} {why}; expected a folder that `evosteer {verb}` has made",
                path.display()
            ))
        };
        match fs::metadata(path) {
            Ok(found) if found.is_dir() => {}
            Ok(_) => return Err(not_a_run("is a file")),
            Err(cause) if cause.kind() == ErrorKind::NotFound => {
                return Err(not_a_run("does not exist"));
            }
            Err(cause) => return Err(Failure::io("open the folder", path, &cause)),
        }
        let has_manifest = || path.join(begun_by).is_file();
        // A run that is just starting has a lock and no manifest yet: it is busy.
        if !has_manifest() && !path.join(Self::LOCK).exists() {
            return Err(not_a_run(&format!("has no {begun_by}")));
        }
        let folder = Self::lock(path)?;
        if !has_manifest() {
            return Err(not_a_run(&format!("has no {begun_by}")));
        }
        Ok(folder)
    }

    /// Where the run lives, as the user wrote it.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Where a file of the run lies.
    pub fn join(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    /// Writes or replaces a file of the run, whole and durable; `name` may be in a
    /// subfolder, which is created.
    ///
    /// # Errors
    ///
    /// Input/output, naming the file.
    pub fn write(&self, name: &str, bytes: &[u8]) -> Result<(), Failure> {
        let path = self.join(name);
        if let Some(parent) = path.parent()
            && !parent.exists()
        {
            fs::create_dir_all(parent)
                .and_then(|()| files::sync_folder(&self.path))
                .map_err(|cause| Failure::io("create the folder", parent, &cause))?;
        }
        files::write(&path, bytes)
    }

    /// Locks the folder, clears what a killed predecessor left, and tries a write.
    fn lock(path: &Path) -> Result<Self, Failure> {
        let lock_path = path.join(Self::LOCK);
        let lock = File::options()
            .write(true)
            .create(true)
            .truncate(false)
            .open(&lock_path)
            .map_err(|cause| Failure::io("create", &lock_path, &cause))?;
        match lock.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                return Err(Failure::new(
                    FailureKind::Busy,
                    format!("another evosteer is using the run folder {}", path.display()),
                ));
            }
            Err(TryLockError::Error(cause)) => {
                return Err(Failure::io("lock", &lock_path, &cause));
            }
        }
        files::remove_strays(path)?;
        for part in [Self::PLOTS, Self::WORLDS].map(|part| path.join(part)) {
            if part.is_dir() {
                files::remove_strays(&part)?;
            }
        }
        files::check_writable(path)?;
        Ok(Self { path: path.to_owned(), lock })
    }
}

impl Drop for RunFolder {
    /// Closing the file would free the lock too, but not while a child process that another
    /// thread is just starting still has its copy of it.
    fn drop(&mut self) {
        let _ = self.lock.unlock();
    }
}

/// Refuses a folder that holds anything but a lock and unfinished files.
fn refuse_used(path: &Path) -> Result<(), Failure> {
    let unreadable = |cause: io::Error| Failure::io("list the folder", path, &cause);
    for entry in fs::read_dir(path).map_err(unreadable)? {
        let name = entry.map_err(unreadable)?.file_name();
        if name == RunFolder::LOCK || files::is_temporary(&name) {
            continue;
        }
        let begun_by = [RunFolder::MANIFEST, RunFolder::REPRODUCTION];
        let advice = if begun_by.iter().any(|name| path.join(name).exists()) {
            format!(
                "is a run already and is not overwritten; go on with it by --resume {}, or give another --out",
                path.display()
            )
        } else {
            format!(
                "is not empty ({} is in it); give another --out, a folder that is new or empty",
                name.display()
            )
        };
        return Err(Failure::bad_input(format!("--out: {} {advice}", path.display())));
    }
    Ok(())
}

#[cfg(test)]
mod tests;

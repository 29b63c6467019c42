//! Files that are either whole or absent, also after a power cut.
//!
//! Every file evosteer leaves behind is written here: into a temporary file in the same
//! folder, then fsync, rename, and fsync of the folder. A process killed in between leaves
//! only a file whose name starts with [`TEMPORARY_PREFIX`], which [`remove_strays`] finds.

use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::failure::Failure;

/// How the name of a file begins while it is being written.
pub const TEMPORARY_PREFIX: &str = ".evosteer-unfinished-";

/// Makes `bytes` the content of `path`, or leaves `path` as it was.
///
/// When this returns, the content survives a power cut. A symbolic link is followed; a
/// device or pipe (`/dev/stdout`) is written to, since renaming would replace it.
///
/// # Errors
///
/// Input/output, naming `path` and the system's reason.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let failed = |cause: io::Error| Failure::io("write", path, &cause);
    let (target, permissions) = match fs::metadata(path) {
        Ok(found) if found.is_file() => {
            (fs::canonicalize(path).map_err(failed)?, Some(found.permissions()))
        }
        Ok(found) if found.is_dir() => return Err(failed(ErrorKind::IsADirectory.into())),
        Ok(_) => return write_through(path, bytes).map_err(failed),
        Err(_) => (path.to_owned(), None),
    };
    let folder = folder_of(&target);
    let temporary = temporary_in(folder, bytes, permissions).map_err(failed)?;
    temporary.persist(&target).map_err(|refused| failed(refused.error))?;
    sync_folder(folder).map_err(failed)
}

/// Creates `path` with `bytes`, or refuses when anything is already there.
///
/// Of several processes that try at once, one succeeds.
///
/// # Errors
///
/// Bad input when `path` exists; input/output, naming `path`, for everything else.
pub fn write_new(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let failed = |cause: io::Error| match cause.kind() {
        ErrorKind::AlreadyExists => Failure::bad_input(format!(
            "{} exists already and is not overwritten; remove it or choose another name",
            path.display()
        )),
        _ => Failure::io("write", path, &cause),
    };
    // Saves writing the bytes for nothing; what decides is the rename below.
    if fs::symlink_metadata(path).is_ok() {
        return Err(failed(ErrorKind::AlreadyExists.into()));
    }
    let folder = folder_of(path);
    let temporary = temporary_in(folder, bytes, None).map_err(failed)?;
    temporary.persist_noclobber(path).map_err(|refused| failed(refused.error))?;
    sync_folder(folder).map_err(failed)
}

/// Shows that files can be created in `folder`, and leaves none.
///
/// # Errors
///
/// Input/output, naming `folder` and the system's reason.
pub fn check_writable(folder: &Path) -> Result<(), Failure> {
    temporary_in(folder, &[], None)
        .and_then(NamedTempFile::close)
        .map_err(|cause| Failure::io("write in the folder", folder, &cause))
}

/// Removes what killed processes left in `folder`, and says what that was.
///
/// A file that a living process is still writing stays: its writer holds a lock on it.
///
/// # Errors
///
/// Input/output, when `folder` cannot be listed or a file in it not removed.
pub fn remove_strays(folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let unreadable = |cause: io::Error| Failure::io("list the folder", folder, &cause);
    let mut removed = Vec::new();
    for entry in fs::read_dir(folder).map_err(unreadable)? {
        let entry = entry.map_err(unreadable)?;
        let is_file = entry.file_type().map_err(unreadable)?.is_file();
        if !is_file || !is_temporary(&entry.file_name()) {
            continue;
        }
        let path = entry.path();
        if is_being_written(&path) {
            continue;
        }
        match fs::remove_file(&path) {
            Ok(()) => removed.push(path),
            Err(cause) if cause.kind() == ErrorKind::NotFound => {}
            Err(cause) => return Err(Failure::io("remove", &path, &cause)),
        }
    }
    removed.sort();
    Ok(removed)
}

/// Whether a file of this name is one of ours that was never finished.
pub fn is_temporary(name: &OsStr) -> bool {
    name.as_encoded_bytes().starts_with(TEMPORARY_PREFIX.as_bytes())
}

/// A durable file under a temporary name; dropping it removes it.
fn temporary_in(
    folder: &Path,
    bytes: &[u8],
    permissions: Option<fs::Permissions>,
) -> io::Result<NamedTempFile> {
    let temporary = tempfile::Builder::new()
        .prefix(TEMPORARY_PREFIX)
        // Opened here and not by tempfile, whose mode is 0600: results are for sharing.
        .make_in(folder, |path| File::options().write(true).create_new(true).open(path))
        .map_err(|cause| name_missing_folder(folder, cause))?;
    // Tells remove_strays that the writer lives. Where locks do not work, is_being_written
    // cannot get one either and takes every temporary file for a living one.
    let _ = temporary.as_file().try_lock();
    let mut file = temporary.as_file();
    file.write_all(bytes)?;
    if let Some(permissions) = permissions {
        file.set_permissions(permissions)?;
    }
    file.sync_all()?;
    Ok(temporary)
}

/// The system says "no such file" of a file we are about to create; say what is missing.
fn name_missing_folder(folder: &Path, cause: io::Error) -> io::Error {
    if cause.kind() != ErrorKind::NotFound || folder.exists() {
        return cause;
    }
    io::Error::new(cause.kind(), format!("the folder {} does not exist", folder.display()))
}

fn is_being_written(path: &Path) -> bool {
    match File::open(path) {
        Ok(file) => file.try_lock().is_err(),
        // Not ours to open, or finished this instant.
        Err(_) => true,
    }
}

fn write_through(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = File::options().write(true).open(path)?;
    file.write_all(bytes)?;
    file.flush()
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Makes a rename in `folder` survive a power cut.
#[cfg(unix)]
pub(crate) fn sync_folder(folder: &Path) -> io::Result<()> {
    match File::open(folder)?.sync_all() {
        // Some network file systems cannot; they have nothing better to offer.
        Err(cause) if matches!(cause.kind(), ErrorKind::InvalidInput | ErrorKind::Unsupported) => {
            Ok(())
        }
        result => result,
    }
}

/// Windows has no fsync of a folder; its file systems journal renames.
#[cfg(not(unix))]
pub(crate) fn sync_folder(_: &Path) -> io::Result<()> {
    Ok(())
}

#[cfg(test)]
mod tests;

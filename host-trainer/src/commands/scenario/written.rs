//! Results on disk: all of them, or a refusal before the first.

use std::path::{Path, PathBuf};

use crate::failure::Failure;
use crate::files;

/// The picture that goes beside a scenario file.
///
/// # Errors
///
/// Bad input for a scenario file with the picture's own name.
pub(super) fn picture_beside(file: &Path) -> Result<PathBuf, Failure> {
    let picture = file.with_extension("svg");
    if picture == file {
        let file = file.display();
        let message = format!("--out: found {file}, expected a name that ends in .toml");
        return Err(Failure::bad_input(message));
    }
    Ok(picture)
}

/// Refuses files that exist, unless they may be replaced.
///
/// # Errors
///
/// Bad input that names the first one.
pub(super) fn refuse_existing(paths: &[&Path], force: bool) -> Result<(), Failure> {
    match paths.iter().find(|path| std::fs::symlink_metadata(path).is_ok()) {
        Some(path) if !force => Err(Failure::bad_input(format!(
            "{} exists already and is not overwritten; choose another name with --out, or \
             replace it with --force",
            path.display()
        ))),
        _ => Ok(()),
    }
}

/// Writes files, none of which may exist unless `force` is given.
///
/// # Errors
///
/// Those of [`refuse_existing`], before anything is written; input/output otherwise.
pub(super) fn write_all(results: &[(&Path, &str)], force: bool) -> Result<(), Failure> {
    let paths: Vec<&Path> = results.iter().map(|(path, _)| *path).collect();
    refuse_existing(&paths, force)?;
    let write = if force { files::write } else { files::write_new };
    results.iter().try_for_each(|(path, text)| write(path, text.as_bytes()))
}

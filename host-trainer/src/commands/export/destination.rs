//! Where the exported file goes.

use std::fs;
use std::path::{Path, PathBuf};

use super::ExportArgs;
use crate::blob_file::BlobFile;
use crate::failure::{Failure, FailureKind};
use crate::files;
use crate::output::Output;

/// A file or standard output.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Destination {
    /// Raw bytes to standard output.
    StandardOutput,
    /// A file, and whether it may be there already.
    File { path: PathBuf, replace: bool },
}

impl Destination {
    /// What `--out` and `--force` mean for this champion.
    pub(super) fn resolve(args: &ExportArgs, champion: &BlobFile) -> Result<Self, Failure> {
        let path = match &args.out {
            Some(path) if path == Path::new("-") => {
                return if args.json {
                    Err(Failure::bad_input(
                        "--json: standard output carries the file already; give --out a file name",
                    ))
                } else {
                    Ok(Self::StandardOutput)
                };
            }
            Some(path) => path.clone(),
            None => champion.path().with_extension(args.format.name()),
        };
        if is_same_file(&path, champion.path()) {
            return Err(Failure::bad_input(format!(
                "--out {}: the name of a file other than the champion expected",
                path.display()
            )));
        }
        Ok(Self::File { path, replace: args.force })
    }

    /// The file, if it is one.
    pub(super) fn path(&self) -> Option<&Path> {
        match self {
            Self::StandardOutput => None,
            Self::File { path, .. } => Some(path),
        }
    }

    /// Writes everything or nothing.
    pub(super) fn write(&self, bytes: &[u8], output: &mut Output) -> Result<(), Failure> {
        match self {
            Self::StandardOutput => output.bytes(bytes),
            Self::File { path, replace: true } => files::write(path, bytes)?,
            Self::File { path, replace: false } => {
                files::write_new(path, bytes).map_err(|failure| match failure.kind() {
                    FailureKind::BadInput => Failure::bad_input(format!(
                        "--out {}: exists already and is not replaced without --force",
                        path.display()
                    )),
                    _ => failure,
                })?;
            }
        }
        Ok(())
    }
}

fn is_same_file(a: &Path, b: &Path) -> bool {
    matches!((fs::canonicalize(a), fs::canonicalize(b)), (Ok(a), Ok(b)) if a == b)
}

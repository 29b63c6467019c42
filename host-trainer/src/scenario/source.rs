//! Where the text of a scenario comes from, and how its relative paths are meant.

use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

use super::shipped;
use crate::failure::Failure;

/// The text of a scenario file, with the names needed to talk about it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    /// What messages call it: a path as it was given, or the name of a shipped scenario.
    pub(super) label: String,
    /// The scenario's name, unless the text gives another.
    pub(super) name: String,
    pub(super) text: String,
    folder: PathBuf,
}

/// Longest scenario file, bytes. The largest BARN world has 10,000.
const LONGEST: u64 = 4 << 20;

impl Source {
    /// A text that is already in memory; relative paths in it start at `folder`.
    pub fn new(label: impl Into<String>, text: impl Into<String>, folder: &Path) -> Self {
        let label = label.into();
        let name = name_from(Path::new(&label));
        Self { label, name, text: text.into(), folder: folder.to_owned() }
    }

    /// Reads a scenario file; relative paths in it start at its folder.
    ///
    /// # Errors
    ///
    /// Input/output if it cannot be read; bad input if it is no file, longer than 4 MiB or not
    /// UTF-8.
    pub fn read(path: &Path) -> Result<Self, Failure> {
        let unreadable = |cause: std::io::Error| Failure::io("read scenario", path, &cause);
        let refused = |what: &str| {
            Failure::bad_input(format!(
                "SCENARIO {}: {what}; the name of a scenario, its file or a run folder expected",
                path.display()
            ))
        };
        // Asked before opening: opening a pipe would wait for its writer.
        match std::fs::metadata(path) {
            Ok(found) if found.is_file() => {}
            Ok(found) if found.is_dir() => return Err(refused("a folder")),
            Ok(_) => return Err(refused("not a file")),
            Err(cause)
                if matches!(cause.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) =>
            {
                return Err(refused("no such file"));
            }
            Err(cause) => return Err(unreadable(cause)),
        }
        let mut bytes = Vec::new();
        let file = std::fs::File::open(path).map_err(unreadable)?;
        file.take(LONGEST + 1).read_to_end(&mut bytes).map_err(unreadable)?;
        if bytes.len() as u64 > LONGEST {
            let path = path.display();
            let message =
                format!("{path} is longer than {} MiB, too long for a scenario", LONGEST >> 20);
            return Err(Failure::bad_input(message));
        }
        let text = String::from_utf8(bytes).map_err(|error| {
            let good = error.utf8_error().valid_up_to();
            not_text(path, &String::from_utf8_lossy(&error.as_bytes()[..good]))
        })?;
        let folder = path.parent().unwrap_or(Path::new(""));
        Ok(Self::new(path.to_string_lossy(), text, folder))
    }

    /// A scenario inside this program.
    pub(super) fn shipped(entry: &shipped::Entry) -> Self {
        let folder = Path::new(entry.path).parent().unwrap_or(Path::new(""));
        let folder = format!("{}{}", shipped::PREFIX, folder.display());
        Self {
            label: entry.name.to_owned(),
            name: entry.name.to_owned(),
            text: entry.text.to_owned(),
            folder: PathBuf::from(folder),
        }
    }

    /// What a path in this text means: the same file from any working directory.
    pub(super) fn resolve(&self, path: &Path) -> PathBuf {
        if shipped::is_shipped(path) {
            return path.to_owned();
        }
        let joined = self.folder.join(path);
        if shipped::is_shipped(&joined) {
            return joined;
        }
        std::path::absolute(&joined).unwrap_or(joined)
    }
}

fn not_text(path: &Path, before: &str) -> Failure {
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().unwrap_or("").chars().count() + 1;
    let path = path.display();
    Failure::bad_input(format!("{path}:{line}:{column}: not UTF-8, expected a text file in TOML"))
}

/// The file's stem, reduced to what a scenario's name may hold.
fn name_from(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let allowed = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    let name: String =
        stem.chars().map(|c| if allowed(c) { c } else { '_' }).take(super::NAME_LENGTH).collect();
    if name.is_empty() { "unnamed".to_owned() } else { name }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_is_the_files_stem_in_the_letters_a_name_may_have() {
        for (path, name) in [
            ("rooms/my room.v2.toml", "my_room_v2"),
            ("größe.toml", "gr__e"),
            ("", "unnamed"),
            ("..", "unnamed"),
        ] {
            assert_eq!(name_from(Path::new(path)), name, "{path}");
        }
    }

    #[test]
    fn a_relative_path_starts_at_the_scenarios_folder_and_ends_up_absolute() {
        let source = Source::new("a.toml", "", Path::new("/maps"));
        assert_eq!(source.resolve(Path::new("b/c.yaml")), Path::new("/maps/b/c.yaml"));
        assert_eq!(source.resolve(Path::new("/d.yaml")), Path::new("/d.yaml"));
        assert!(Source::new("a.toml", "", Path::new("maps")).resolve(Path::new("b")).is_absolute());
    }

    #[test]
    fn a_file_that_is_no_text_is_refused_with_the_place() {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), b"name = \"a\"\nx = \xff").unwrap();
        let failure = Source::read(file.path()).unwrap_err();
        assert_eq!(failure.exit_code(), 2);
        assert!(failure.to_string().contains(":2:5: not UTF-8"), "{failure}");
    }

    #[test]
    fn what_is_no_file_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        assert_eq!(Source::read(folder.path()).unwrap_err().exit_code(), 2);
        assert_eq!(Source::read(&folder.path().join("none")).unwrap_err().exit_code(), 2);
    }
}

//! The way from a scenario file to its map, as the file is to name it.

use std::path::{Component, Path, PathBuf};

use crate::failure::Failure;

/// The path of `target` as seen from the folder of `file`, with `/` between its parts; `file`
/// itself need not exist. Absolute where there is no relative one, as between drives.
///
/// # Errors
///
/// Input/output if either folder cannot be found; bad input if the path is not UTF-8.
pub(super) fn from_to(file: &Path, target: &Path) -> Result<String, Failure> {
    let from = folder_of(file)?;
    let to = folder_of(target)?.join(target.file_name().unwrap_or_default());
    let path = relative(&from, &to);
    let not_text = || {
        let path = path.display();
        Failure::bad_input(format!(
            "{path} is not UTF-8, expected a path that a TOML file can hold"
        ))
    };
    let text = path.to_str().ok_or_else(not_text)?;
    Ok(if cfg!(windows) { text.replace('\\', "/") } else { text.to_owned() })
}

/// A file's name for people.
pub(super) fn name_of(file: &Path) -> String {
    file.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

fn folder_of(file: &Path) -> Result<PathBuf, Failure> {
    let folder = match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    folder.canonicalize().map_err(|cause| Failure::io("find the folder", folder, &cause))
}

/// The way from one absolute folder to an absolute path.
fn relative(from: &Path, to: &Path) -> PathBuf {
    let mut here = from.components().peekable();
    let mut there = to.components().peekable();
    if here.peek() != there.peek() {
        return to.to_owned();
    }
    while here.peek().is_some() && here.peek() == there.peek() {
        here.next();
        there.next();
    }
    here.map(|_| Component::ParentDir).chain(there).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_relative_path_goes_up_as_far_as_needed_and_down_again() {
        for (from, to, expected) in [
            ("/a/b", "/a/b/m.yaml", "m.yaml"),
            ("/a/b", "/a/b/c/m.yaml", "c/m.yaml"),
            ("/a/b", "/a/bc/m.yaml", "../bc/m.yaml"),
            ("/a/b/c", "/m.yaml", "../../../m.yaml"),
        ] {
            assert_eq!(relative(Path::new(from), Path::new(to)), Path::new(expected));
        }
    }

    #[test]
    fn a_link_to_a_folder_is_followed_so_that_the_path_holds() {
        let folder = tempfile::tempdir().unwrap();
        let [maps, deep] = ["maps", "x/y"].map(|name| folder.path().join(name));
        std::fs::create_dir_all(&maps).unwrap();
        std::fs::create_dir_all(&deep).unwrap();
        let link = folder.path().join("link");
        #[cfg(unix)]
        std::os::unix::fs::symlink(&deep, &link).unwrap();
        #[cfg(not(unix))]
        std::fs::create_dir(&link).unwrap();
        let path = from_to(&link.join("new.toml"), &maps.join("m.yaml")).unwrap();
        assert_eq!(
            link.join(path).parent().unwrap().canonicalize().unwrap(),
            maps.canonicalize().unwrap()
        );
    }
}

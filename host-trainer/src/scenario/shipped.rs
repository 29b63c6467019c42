//! The scenarios inside this program, so that they work from any directory.

use std::path::Path;

/// A scenario that comes with the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// What a person calls it.
    pub name: &'static str,
    /// Its file in `scenarios/`.
    pub path: &'static str,
    /// What the file says.
    pub text: &'static str,
}

/// How a path to a file inside this program begins.
pub(super) const PREFIX: &str = "shipped:";

macro_rules! entry {
    ($name:literal, $path:literal) => {
        Entry {
            name: $name,
            path: $path,
            text: include_str!(concat!("../../../scenarios/", $path)),
        }
    };
}

/// Every scenario that comes with the program, the paper's first.
pub(super) const ENTRIES: &[Entry] = &[
    entry!("open", "open.toml"),
    entry!("obstacles", "obstacles.toml"),
    entry!("complex", "complex.toml"),
    entry!("small-car", "small-car.toml"),
    entry!("depot", "worlds/depot.toml"),
    entry!("tb3_sandbox", "worlds/tb3_sandbox.toml"),
    entry!("barn_000", "worlds/barn_000.toml"),
    entry!("barn_264", "worlds/barn_264.toml"),
    entry!("medium_maze", "worlds/medium_maze.toml"),
    entry!("switchback_maze", "worlds/switchback_maze.toml"),
];

macro_rules! file {
    ($path:literal) => {
        (concat!("shipped:", $path), include_bytes!(concat!("../../../scenarios/", $path)))
    };
}

/// Files that shipped scenarios name.
const FILES: &[(&str, &[u8])] = &[
    file!("worlds/nav2/depot.yaml"),
    file!("worlds/nav2/depot.pgm"),
    file!("worlds/nav2/tb3_sandbox.yaml"),
    file!("worlds/nav2/tb3_sandbox.pgm"),
];

/// The contents of a file inside this program; none if the path is an ordinary one or there is
/// no such file.
pub(crate) fn bytes(path: &Path) -> Option<&'static [u8]> {
    FILES.iter().find(|(name, _)| Path::new(name) == path).map(|(_, bytes)| *bytes)
}

/// Whether a path means a file inside this program.
pub(super) fn is_shipped(path: &Path) -> bool {
    path.to_str().is_some_and(|path| path.starts_with(PREFIX))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::path::PathBuf;

    use super::*;

    fn scenarios() -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios")
    }

    #[test]
    fn every_scenario_file_of_the_repository_is_shipped_under_its_own_name() {
        let mut on_disk = BTreeSet::new();
        for folder in ["", "worlds"] {
            for file in std::fs::read_dir(scenarios().join(folder)).unwrap() {
                let path = file.unwrap().path();
                if path.extension().is_some_and(|extension| extension == "toml") {
                    let path = path.strip_prefix(scenarios()).unwrap();
                    on_disk.insert(path.to_str().unwrap().replace('\\', "/"));
                }
            }
        }
        let shipped: BTreeSet<String> = ENTRIES.iter().map(|entry| entry.path.to_owned()).collect();
        assert_eq!(shipped, on_disk);
        for entry in ENTRIES {
            assert_eq!(Path::new(entry.path).file_stem().unwrap(), entry.name);
        }
    }

    #[test]
    fn no_file_is_shipped_that_no_scenario_needs() {
        for (name, _) in FILES {
            let yaml = name.trim_start_matches("shipped:worlds/").replace(".pgm", ".yaml");
            assert!(ENTRIES.iter().any(|entry| entry.text.contains(&yaml)), "{name}");
        }
    }
}

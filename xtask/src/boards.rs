//! The boards: one row each, in the order of their folders under `firmware-example/boards`.

use std::path::Path;

use crate::failure::Failure;
use crate::options::Options;

/// A machine the firmware is built for.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Board {
    /// Name of its folder and its binary; its cargo feature is `board-<name>`.
    pub(crate) name: &'static str,
    /// Rust's name for its instruction set.
    pub(crate) triple: &'static str,
    /// How it runs here.
    pub(crate) emulator: Emulator,
}

/// The emulator that stands in for a board.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Emulator {
    /// QEMU's program.
    pub(crate) program: &'static str,
    /// Debian's package that has it.
    pub(crate) package: &'static str,
    /// QEMU's name of the machine.
    pub(crate) machine: &'static str,
}

impl Board {
    /// The cargo feature that turns its dependencies and its binary on.
    pub(crate) fn feature(&self) -> String {
        format!("board-{}", self.name)
    }
}

/// Every board there is.
pub(crate) const ALL: &[Board] = &[Board {
    name: "mps2-an386",
    triple: "thumbv7em-none-eabihf",
    emulator: Emulator {
        program: "qemu-system-arm",
        package: "qemu-system-arm",
        machine: "mps2-an386",
    },
}];

/// The boards named by the operands, or all of them.
pub(crate) fn chosen(options: &Options) -> Result<Vec<&'static Board>, Failure> {
    match options.operands.as_slice() {
        [] => Ok(ALL.iter().collect()),
        names => names.iter().map(|name| named(name)).collect(),
    }
}

/// The board called `name`.
pub(crate) fn named(name: &str) -> Result<&'static Board, Failure> {
    ALL.iter().find(|board| board.name == name).ok_or_else(|| {
        Failure::usage(format!("no board `{name}`; expected one of: {}", names().join(", ")))
    })
}

/// The board a program was built for, by its file name.
pub(crate) fn of_program(elf: &Path) -> Result<&'static Board, Failure> {
    let stem = elf.file_stem().unwrap_or_default().to_string_lossy();
    ALL.iter().find(|board| board.name == stem).ok_or_else(|| {
        Failure::usage(format!(
            "{}: the file name is no board's; say --board with one of: {}",
            elf.display(),
            names().join(", ")
        ))
    })
}

fn names() -> Vec<&'static str> {
    ALL.iter().map(|board| board.name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::process::root;

    #[test]
    fn every_board_has_a_folder_a_feature_and_a_binary_and_every_folder_is_a_board() {
        let firmware = root().join("firmware-example");
        let mut folders: Vec<String> = std::fs::read_dir(firmware.join("boards"))
            .expect("boards")
            .map(|entry| entry.expect("entry").file_name().to_string_lossy().into_owned())
            .collect();
        folders.sort();
        assert_eq!(folders, names());

        let manifest = std::fs::read_to_string(firmware.join("Cargo.toml")).expect("manifest");
        for board in ALL {
            assert!(
                manifest.contains(&format!("\n{} = [", board.feature())),
                "no feature for {}",
                board.name
            );
            assert!(
                manifest.contains(&format!("name = \"{}\"", board.name)),
                "no binary for {}",
                board.name
            );
        }
    }

    #[test]
    fn every_triple_has_our_runner() {
        let config =
            std::fs::read_to_string(root().join(".cargo/config.toml")).expect("cargo config");
        for board in ALL {
            let table = format!("[target.{}]\nrunner = \"cargo xtask qemu\"", board.triple);
            assert!(config.contains(&table), "no runner for {}", board.triple);
        }
    }

    #[test]
    fn a_program_under_another_name_asks_which_board_it_is_for() {
        let failure = of_program(Path::new("/tmp/renamed.elf")).expect_err("unknown name");
        assert!(failure.to_string().contains("--board"), "{failure}");
    }
}

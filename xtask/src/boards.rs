//! The boards: one row each, in the order of their folders under `firmware-example/boards`.

use std::ops::Range;
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
    /// Rust's name for its processor, whose timing the code is made for; the bits do not depend on it.
    pub(crate) cpu: &'static str,
    /// How it runs here.
    pub(crate) emulator: Emulator,
}

/// A program for a board: all that building needs to know.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Program {
    /// Name of the board's folder and of the binary; the cargo feature is `board-<name>`.
    pub(crate) name: &'static str,
    /// Rust's name for the instruction set.
    pub(crate) triple: &'static str,
    /// Rust's name for the processor.
    pub(crate) cpu: &'static str,
}

impl Program {
    /// The cargo feature that turns its dependencies and its binary on.
    pub(crate) fn feature(&self) -> String {
        format!("board-{}", self.name)
    }
}

/// A board that no emulator stands in for.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Real {
    /// What to build for it.
    pub(crate) program: Program,
    /// How its boot loader takes files.
    pub(crate) drive: Drive,
}

/// The drive that a boot loader shows, onto which UF2 files are dropped.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Drive {
    /// UF2 family of the programs it starts.
    pub(crate) family: u32,
    /// The flash that is really there; the chip shows more addresses.
    pub(crate) flash: Range<u32>,
}

/// Boards that no emulator stands in for: built and linted with the others, never run here.
pub(crate) const REAL: &[Real] = &[Real {
    program: Program { name: "pico2", triple: "thumbv8m.main-none-eabihf", cpu: "cortex-m33" },
    // `rp2350-arm-s`: its boot ROM starts Arm programs of the secure world.
    drive: Drive { family: 0xe48b_ff59, flash: 0x1000_0000..0x1040_0000 },
}];

/// The emulator that stands in for a board.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Emulator {
    /// QEMU's program.
    pub(crate) program: &'static str,
    /// Debian's package that has it.
    pub(crate) package: &'static str,
    /// QEMU's name of the machine.
    pub(crate) machine: &'static str,
    /// What else QEMU has to be told about it.
    pub(crate) options: &'static [&'static str],
}

impl Board {
    /// What to build for it.
    pub(crate) fn program(&self) -> Program {
        let Self { name, triple, cpu, .. } = *self;
        Program { name, triple, cpu }
    }
}

/// Every board that an emulator stands in for.
pub(crate) const ALL: &[Board] = &[
    Board {
        name: "microbit",
        triple: "thumbv6m-none-eabi",
        cpu: "cortex-m0",
        emulator: arm("microbit"),
    },
    Board {
        name: "mps2-an385",
        triple: "thumbv7m-none-eabi",
        cpu: "cortex-m3",
        emulator: arm("mps2-an385"),
    },
    Board {
        name: "mps2-an386",
        triple: "thumbv7em-none-eabihf",
        cpu: "cortex-m4",
        emulator: arm("mps2-an386"),
    },
    Board {
        name: "mps2-an500",
        triple: "thumbv7em-none-eabihf",
        cpu: "cortex-m7",
        emulator: arm("mps2-an500"),
    },
    Board {
        name: "riscv32-virt",
        triple: "riscv32imafc-unknown-none-elf",
        cpu: "generic-rv32",
        emulator: Emulator {
            program: "qemu-system-riscv32",
            package: "qemu-system-misc",
            machine: "virt",
            // Otherwise QEMU puts OpenSBI where our program lies.
            options: &["-bios", "none"],
        },
    },
];

const fn arm(machine: &'static str) -> Emulator {
    Emulator { program: "qemu-system-arm", package: "qemu-system-arm", machine, options: &[] }
}

/// Every program there is, those of real boards last.
pub(crate) fn programs() -> impl Iterator<Item = Program> {
    ALL.iter().map(Board::program).chain(REAL.iter().map(|board| board.program))
}

fn real(name: &str) -> Option<&'static Real> {
    REAL.iter().find(|board| board.program.name == name)
}

/// The real boards named by the operands, or all of them.
pub(crate) fn chosen_real(options: &Options) -> Result<Vec<&'static Real>, Failure> {
    let known = || {
        let names: Vec<&str> = REAL.iter().map(|board| board.program.name).collect();
        names.join(", ")
    };
    match options.operands.as_slice() {
        [] => Ok(REAL.iter().collect()),
        names => names
            .iter()
            .map(|name| {
                real(name).ok_or_else(|| {
                    let expected = known();
                    Failure::usage(format!("no real board `{name}`; expected one of: {expected}"))
                })
            })
            .collect(),
    }
}

/// The programs named by the operands, or every one there is.
pub(crate) fn chosen_programs(options: &Options) -> Result<Vec<Program>, Failure> {
    let known = |name: &String| {
        programs().find(|program| program.name == name).ok_or_else(|| {
            let names: Vec<&str> = programs().map(|program| program.name).collect();
            Failure::usage(format!("no board `{name}`; expected one of: {}", names.join(", ")))
        })
    };
    match options.operands.as_slice() {
        [] => Ok(programs().collect()),
        names => names.iter().map(known).collect(),
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

    /// Names in a folder without their extensions, sorted.
    fn listed(folder: &str) -> Vec<String> {
        let mut names: Vec<String> = std::fs::read_dir(root().join(folder))
            .expect(folder)
            .map(|entry| entry.expect("entry").path())
            .map(|path| path.file_stem().expect("a name").to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }

    /// Names of emulated and real boards, sorted.
    fn with_real() -> Vec<&'static str> {
        let mut names = names();
        names.extend(REAL.iter().map(|board| board.program.name));
        names.sort_unstable();
        names
    }

    #[test]
    fn folders_programs_features_and_binaries_are_those_of_this_list() {
        let names = with_real();
        assert_eq!(listed("firmware-example/boards"), names);
        assert_eq!(listed("firmware-example/src/bin"), names);

        let manifest =
            std::fs::read_to_string(root().join("firmware-example/Cargo.toml")).expect("manifest");
        let features: Vec<&str> = manifest
            .lines()
            .filter_map(|line| Some(line.strip_prefix("board-")?.split_once(" = [")?.0))
            .collect();
        assert_eq!(features, names);
        let binaries: Vec<String> = manifest
            .split("[[bin]]\n")
            .skip(1)
            .map(|table| table.lines().take(3).collect::<Vec<_>>().join("\n"))
            .collect();
        let expected: Vec<String> = names
            .iter()
            .map(|name| {
                format!(
                    "name = \"{name}\"\npath = \"src/bin/{name}.rs\"\nrequired-features = [\"board-{name}\"]"
                )
            })
            .collect();
        assert_eq!(binaries, expected);
    }

    #[test]
    fn every_triple_has_our_runner() {
        let config =
            std::fs::read_to_string(root().join(".cargo/config.toml")).expect("cargo config");
        for board in ALL {
            let table = format!("[target.{}]\nrunner = \"cargo xtask qemu\"", board.triple);
            assert!(config.contains(&table), "no runner for {}", board.triple);
        }
        for Real { program, .. } in REAL {
            let table = format!("[target.{}]\nrunner = \"probe-rs run ", program.triple);
            assert!(config.contains(&table), "no runner for {}", program.triple);
        }
    }

    #[test]
    fn an_unknown_board_is_refused_with_all_that_can_be_built() {
        let options = Options::parse(vec!["build".into(), "pico3".into()]).expect("readable");
        let failure = chosen_programs(&options).expect_err("no such board");
        let expected = "no board `pico3`; expected one of: microbit, mps2-an385, mps2-an386, mps2-an500, \
                        riscv32-virt, pico2";
        assert_eq!(failure.to_string(), expected);
    }

    #[test]
    fn a_program_under_another_name_asks_which_board_it_is_for() {
        let failure = of_program(Path::new("/tmp/renamed.elf")).expect_err("unknown name");
        assert!(failure.to_string().contains("--board"), "{failure}");
    }
}

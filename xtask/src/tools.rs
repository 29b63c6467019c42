//! What the tasks need beyond cargo, and how each is fetched.

use std::process::Command;

use crate::apt;
use crate::boards::{self, Board};
use crate::failure::Failure;
use crate::options::Options;
use crate::process;
use crate::targets::Toolchain;

/// Installs what any task here could miss; does nothing where all is in place.
pub(crate) fn fetch_all(options: &Options) -> Result<(), Failure> {
    for (component, program) in [("rustfmt", "cargo-fmt"), ("clippy", "cargo-clippy")] {
        fetch_component(component, program)?;
    }
    for program in boards::programs() {
        Toolchain::fetch(options.targets, program.triple)?;
    }
    for board in boards::ALL {
        fetch_emulator(board)?;
    }
    for (program, package, why) in TEST_TOOLS {
        if process::which(program).is_none() {
            apt::install(&[package], why)?;
        }
    }
    Ok(())
}

/// Programs that tests call: the program, its Debian package, and what it is for.
const TEST_TOOLS: [(&str, &str, &str); 5] = [
    ("chromium", "chromium", "a test opens the report in a browser"),
    ("chromedriver", "chromium-driver", "a test presses the report's buttons"),
    ("python3", "python3", "independent decoders of our formats are written in Python"),
    ("objcopy", "binutils", "a test reads exported Intel HEX back"),
    ("valgrind", "valgrind", "it counts the instructions of a simulated step"),
];

/// Whether a part of the toolchain answers; rustup leaves its proxy in place for parts it does not have.
pub(crate) fn component_version(program: &str) -> Option<String> {
    process::output(Command::new(program).arg("--version").current_dir(process::root()))
}

fn fetch_component(component: &str, program: &str) -> Result<(), Failure> {
    if component_version(program).is_some() {
        return Ok(());
    }
    eprintln!("xtask: fetching {component} with rustup: `cargo xtask lint` needs it");
    process::run(Command::new("rustup").args(["component", "add", component]))
}

fn fetch_emulator(board: &Board) -> Result<(), Failure> {
    if process::which(board.emulator.program).is_some() {
        return Ok(());
    }
    apt::install(&[board.emulator.package], &format!("QEMU stands in for the board {}", board.name))
}

/// Fails, naming the way out, unless the board's emulator is here.
pub(crate) fn need_emulator(board: &Board) -> Result<(), Failure> {
    match process::which(board.emulator.program) {
        Some(_) => Ok(()),
        None => Err(Failure::missing(
            board.emulator.program,
            &apt::command_line(&[board.emulator.package]),
        )),
    }
}

/// Fails, naming the way out, unless valgrind is here.
pub(crate) fn need_valgrind() -> Result<(), Failure> {
    match process::which("valgrind") {
        Some(_) => Ok(()),
        None => Err(Failure::missing("valgrind", &apt::command_line(&["valgrind"]))),
    }
}

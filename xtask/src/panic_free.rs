//! `cargo xtask panic-free`: the driving program linked so that it fails if anything in it can panic.

use std::path::{Path, PathBuf};

use crate::boards::{self, Board};
use crate::failure::Failure;
use crate::firmware;
use crate::options::Options;
use crate::panics;
use crate::process;
use crate::stack;
use crate::targets::Toolchain;

/// The example that is the program.
pub(crate) const IMAGE: &str = "panic_free";

/// One board per instruction set: software floats, a floating-point unit, another architecture.
const BOARDS: [&str; 3] = ["microbit", "mps2-an386", "riscv32-virt"];

/// What has to be in the program, or that it links would say nothing: parts of names of functions that run.
const CONTENTS: [&str; 6] = [
    "controller_core::network::Network",
    "controller_core::blob::Blob",
    "panic_free::drive",
    "panic_free::replay",
    "panic_free::room",
    "vl53l0x::VL53L0x",
];

/// Links the program for each instruction set and says what it holds.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    for name in BOARDS {
        let board = boards::named(name)?;
        let image = link(board, options)?;
        let graph = stack::graph(&image)?;
        let missing = CONTENTS
            .into_iter()
            .find(|part| !stack::running(&graph).any(|function| function.name.contains(part)));
        if let Some(part) = missing {
            return Err(Failure::failed(format!(
                "{}: nothing of `{part}` runs in it, so that it links proves nothing of it",
                image.display()
            )));
        }
        println!(
            "{}: no panic can be reached from any of {} functions",
            board.triple,
            stack::running(&graph).count()
        );
    }
    Ok(())
}

/// The same for a test run: first that it notices an index that nobody has checked, then for real.
pub(crate) fn test(options: &Options) -> Result<(), Failure> {
    let spoiled = Options { sabotage: Some("index".into()), ..options.clone() };
    match link(boards::named(BOARDS[1])?, &spoiled) {
        Ok(image) => Err(Failure::failed(format!(
            "{}: a panic can be reached on purpose, and yet it links",
            image.display()
        ))),
        Err(failure) if failure.to_string().contains("panic_bounds_check") => run(options),
        Err(failure) => Err(failure),
    }
}

fn link(board: &Board, options: &Options) -> Result<PathBuf, Failure> {
    let toolchain = Toolchain::find(options.targets, board.triple)?;
    let Err(failure) = process::run(&mut command(board, toolchain, options)) else {
        return Ok(path(board, toolchain));
    };
    // Once more, with the missing function let pass: the program would not run, but it tells who calls.
    let mut lenient = command(board, toolchain, options);
    lenient.arg("-Clink-arg=--warn-unresolved-symbols");
    process::run(&mut lenient)?;
    let graph = stack::graph(&path(board, toolchain))?;
    let paths = panics::of(&graph);
    if paths.is_empty() {
        return Err(failure);
    }
    let list: Vec<String> =
        paths.iter().map(|(from, into)| format!("  {from} -> {into}")).collect();
    Err(Failure::failed(format!("{}: a panic can be reached:\n{}", board.triple, list.join("\n"))))
}

fn command(board: &Board, toolchain: Toolchain, options: &Options) -> std::process::Command {
    let program = board.program();
    let mut command = firmware::processor_command("rustc", &program, toolchain);
    let runtime = if board.triple.starts_with("riscv") { "riscv" } else { "cortex-m" };
    let mut features = format!("{IMAGE},{runtime}").replace('_', "-");
    if let Some(sabotage) = &options.sabotage {
        features += &format!(",sabotage-{sabotage}");
    }
    command.args(["--features", &features, "--example", IMAGE]);
    firmware::record_stack(&mut command);
    // The compiler may look through more calls than in a board's program: what a caller rules out has to reach
    // the division in the `vl53l0x` crate that it would make fail.
    command.arg("-Cllvm-args=-inline-threshold=1000");
    command
}

fn path(board: &Board, toolchain: Toolchain) -> PathBuf {
    let folder: &Path = &toolchain.target_dir().join(board.triple).join("firmware");
    folder.join("examples").join(IMAGE)
}

//! Runs a board's program in QEMU: log decoded, exit code passed on, never longer than its time.

#[cfg(feature = "decode")]
mod decode;
#[cfg(feature = "decode")]
mod emulate;
mod flash;

use std::path::Path;

use crate::boards::{self, Board};
use crate::failure::Failure;
use crate::options::Options;
use crate::tools;

/// `cargo xtask qemu ELF`, also cargo's runner for the boards.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let [elf] = options.operands.as_slice() else {
        return Err(Failure::usage("qemu: expected one program to run: cargo xtask qemu ELF"));
    };
    let elf = Path::new(elf);
    let board = match &options.board {
        Some(name) => boards::named(name)?,
        None => boards::of_program(elf)?,
    };
    if !elf.is_file() {
        return Err(Failure::usage(format!("no program at {}", elf.display())));
    }
    let weights = options.weights.as_deref();
    let flash = flash::device(flash::Region::of(elf)?, weights)?;
    tools::need_emulator(board)?;
    if let Some(folder) = options.prove.as_deref().filter(|folder| !folder.is_dir()) {
        return Err(Failure::usage(format!("--prove: no folder at {}", folder.display())));
    }
    emulate(board, elf, flash.as_deref(), options)
}

#[cfg(feature = "decode")]
fn emulate(
    board: &Board,
    elf: &Path,
    flash: Option<&str>,
    options: &Options,
) -> Result<(), Failure> {
    emulate::run(board, elf, flash, options)
}

/// Hands over to an xtask built with the log decoder; this one goes without, to be quick to build.
#[cfg(not(feature = "decode"))]
fn emulate(
    board: &Board,
    elf: &Path,
    _flash: Option<&str>,
    options: &Options,
) -> Result<(), Failure> {
    let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let mut command = decoder("run");
    command
        .args(["--", "qemu", "--board", board.name, "--timeout"])
        .arg(options.timeout.as_secs().to_string())
        .arg(absolute(elf));
    if let Some(weights) = &options.weights {
        command.arg("--weights").arg(absolute(weights));
    }
    if let Some(folder) = &options.prove {
        command.arg("--prove").arg(absolute(folder));
    }
    if let Some(shift) = options.icount {
        command.args(["--icount", &shift.to_string()]);
    }
    let status = command
        .status()
        .map_err(|error| Failure::failed(format!("cannot start cargo: {error}")))?;
    match status.code() {
        Some(0) => Ok(()),
        // It has said why.
        Some(code) => std::process::exit(code),
        None => Err(Failure::failed(format!("the runner ended with {status}"))),
    }
}

/// Runs a program to its end and returns its log; `arguments` are options of `cargo xtask qemu`.
pub(crate) fn log(board: &Board, elf: &Path, arguments: &[&str]) -> Result<String, Failure> {
    tools::need_emulator(board)?;
    let mut command = decoder("run");
    command.args(["--", "qemu", "--board", board.name]).args(arguments).arg(elf);
    let output = command
        .stderr(std::process::Stdio::inherit())
        .output()
        .map_err(|error| Failure::failed(format!("cannot start cargo: {error}")))?;
    let log = String::from_utf8_lossy(&output.stdout).into_owned();
    if output.status.success() {
        Ok(log)
    } else {
        Err(Failure::failed(format!("{} ended with {}:\n{log}", elf.display(), output.status)))
    }
}

/// `cargo <verb>` for the xtask that has the log decoder, in a profile made for building it fast.
pub(crate) fn decoder(verb: &str) -> std::process::Command {
    let mut command = crate::process::cargo();
    command.arg(verb).args([
        "--quiet",
        "--profile",
        "tools",
        "--package",
        "xtask",
        "--features",
        "decode",
    ]);
    command
}

//! Builds the boards' programs.

use std::path::PathBuf;
use std::process::Command;

use crate::boards::{self, Board};
use crate::failure::Failure;
use crate::options::Options;
use crate::process;
use crate::targets::Toolchain;

/// `cargo xtask build`: the only lines on standard output are the programs' paths.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    for board in boards::chosen(options)? {
        println!("{}", build(board, options)?.display());
    }
    Ok(())
}

/// Builds one board and returns its program.
pub(crate) fn build(board: &Board, options: &Options) -> Result<PathBuf, Failure> {
    let toolchain = Toolchain::find(options.targets, board.triple)?;
    let mut command = command("build", board, toolchain);
    if let Some(sabotage) = &options.sabotage {
        command.args(["--features", &format!("sabotage-{sabotage}")]);
    }
    process::run(&mut command)?;
    let folder = toolchain.target_dir().join(board.triple).join("firmware");
    Ok(folder.join(board.name))
}

/// `cargo <verb>` for one board's program.
pub(crate) fn command(verb: &str, board: &Board, toolchain: Toolchain) -> Command {
    let mut command = toolchain.cargo(verb, board.triple);
    // Here and not in `.cargo/config.toml`: two boards share an instruction set but not a processor.
    let flags = format!("target.{}.rustflags=[\"-Ctarget-cpu={}\"]", board.triple, board.cpu);
    command.args(["--config", &flags]);
    command.args(["--quiet", "--profile", "firmware", "--package", "firmware-example"]);
    command.args(["--features", &board.feature(), "--bin", board.name]);
    command
}

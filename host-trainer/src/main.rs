//! The `evosteer` command.

use host_trainer::cli;
use std::process::ExitCode;

fn main() -> ExitCode {
    cli::main(std::env::args_os())
}

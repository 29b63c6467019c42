//! Builds the boards' programs.

use std::path::PathBuf;
use std::process::Command;

use crate::boards::{self, Board, Program};
use crate::failure::Failure;
use crate::options::Options;
use crate::panic_free;
use crate::process;
use crate::targets::{self, Toolchain};

/// `cargo xtask build`: the only lines on standard output are the programs' paths.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    for program in boards::chosen_programs(options)? {
        println!("{}", build_program(&program, options)?.display());
    }
    Ok(())
}

/// Builds one board and returns its program.
pub(crate) fn build(board: &Board, options: &Options) -> Result<PathBuf, Failure> {
    build_program(&board.program(), options)
}

/// Builds a program and returns its path.
pub(crate) fn build_program(program: &Program, options: &Options) -> Result<PathBuf, Failure> {
    let toolchain = Toolchain::find(options.targets, program.triple)?;
    let mut command = command("rustc", program, toolchain);
    if let Some(sabotage) = &options.sabotage {
        command.args(["--features", &format!("sabotage-{sabotage}")]);
    }
    record_stack(&mut command);
    process::run(&mut command)?;
    let folder = toolchain.target_dir().join(program.triple).join("firmware");
    let built = folder.join(program.name);
    let Some(sabotage) = &options.sabotage else { return Ok(built) };
    // Under the board's own name somebody would run it for the real one.
    let renamed = built.with_extension(sabotage);
    std::fs::rename(&built, &renamed)
        .map_err(|error| Failure::failed(format!("cannot rename {}: {error}", built.display())))?;
    Ok(renamed)
}

/// Builds an example for a board and returns its path.
pub(crate) fn build_example(
    board: &Board,
    example: &str,
    options: &Options,
) -> Result<PathBuf, Failure> {
    let toolchain = Toolchain::find(options.targets, board.triple)?;
    let mut command = package_command("build", &board.program(), toolchain);
    process::run(command.args(["--example", example]))?;
    let folder = toolchain.target_dir().join(board.triple).join("firmware");
    Ok(folder.join("examples").join(example))
}

/// Lets `cargo rustc` record what each function of the program takes of the stack; arguments after this are
/// the compiler's.
///
/// The record is a section that stays out of the device.
pub(crate) fn record_stack(command: &mut Command) {
    command.args(["--", "-Zemit-stack-sizes"]);
}

/// `cargo <verb>` for one board's program.
pub(crate) fn command(verb: &str, program: &Program, toolchain: Toolchain) -> Command {
    let mut command = package_command(verb, program, toolchain);
    command.args(["--bin", program.name]);
    command
}

/// `cargo <verb>` for the package, as it is for one board; which of its programs is still open.
fn package_command(verb: &str, program: &Program, toolchain: Toolchain) -> Command {
    let mut command = processor_command(verb, program, toolchain);
    command.args(["--features", &program.feature()]);
    command
}

/// `cargo <verb>` for the package, made for the processor of this board; features and program are still open.
pub(crate) fn processor_command(verb: &str, program: &Program, toolchain: Toolchain) -> Command {
    let mut command = toolchain.cargo(verb, program.triple);
    if toolchain == Toolchain::Rustup {
        // Rust calls the record of stack sizes unstable. It is allowed to our programs by name, and no other crate
        // takes this for a nightly compiler. The same value every time: build scripts run again when it changes.
        let programs = boards::programs().map(|program| program.name.replace('-', "_"));
        let names: Vec<String> = programs.chain([panic_free::IMAGE.to_owned()]).collect();
        command.env("RUSTC_BOOTSTRAP", names.join(","));
    }
    // Here and not in `.cargo/config.toml`: two boards share an instruction set but not a processor.
    let mut flags = vec![format!("-Ctarget-cpu={}", program.cpu)];
    if program.triple.starts_with("riscv") {
        // There a jump through a table looks like a call through a pointer, and the stack would have no bound.
        flags.push("-Cjump-tables=no".into());
    }
    let flags = targets::setting(program.triple, "rustflags", &format!("{flags:?}"));
    command.args(["--config", &flags]);
    command.args(["--quiet", "--profile", "firmware", "--package", "firmware-example"]);
    command
}

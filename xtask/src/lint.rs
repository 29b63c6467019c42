//! Formatting, clippy and documentation, for the host and for every board.

use crate::boards;
use crate::failure::Failure;
use crate::firmware;
use crate::options::Options;
use crate::process;
use crate::targets::Toolchain;

/// `cargo xtask lint`.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    process::run(process::cargo().args(["fmt", "--all", "--check"]))?;
    process::run(process::cargo().args([
        "clippy",
        "--quiet",
        "--workspace",
        "--all-targets",
        "--",
        "-D",
        "warnings",
    ]))?;
    process::run(process::cargo().args([
        "clippy",
        "--quiet",
        "--package",
        "xtask",
        "--features",
        "decode",
        "--",
        "-D",
        "warnings",
    ]))?;
    for program in boards::programs() {
        let toolchain = Toolchain::find(options.targets, program.triple)?;
        process::run(firmware::command("clippy", &program, toolchain).args([
            "--examples",
            "--",
            "-D",
            "warnings",
        ]))?;
    }
    process::run(
        process::cargo()
            .args(["doc", "--quiet", "--workspace", "--no-deps"])
            .env("RUSTDOCFLAGS", "-D warnings"),
    )
}

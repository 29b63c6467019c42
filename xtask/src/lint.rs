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

#[cfg(test)]
mod tests {
    use std::path::Path;

    use crate::process::root;

    #[test]
    fn the_core_forbids_unsafe_code() {
        let core =
            std::fs::read_to_string(root().join("controller-core/src/lib.rs")).expect("core");
        assert!(core.lines().any(|line| line == "#![forbid(unsafe_code)]"));
    }

    /// Clippy refuses a block without its `SAFETY` comment; a new one should not come in unseen.
    #[test]
    fn unsafe_blocks_of_the_driving_program_are_these() {
        let mut found = Vec::new();
        count(&root().join("firmware-example/src"), &mut found);
        found.sort();
        let expected = [
            ("emulated/high_water.rs", 1),
            ("emulated/riscv_support.rs", 1),
            ("pico2/fail_safe.rs", 3),
            ("weights_region.rs", 1),
        ];
        assert_eq!(found, expected.map(|(file, blocks)| (file.to_owned(), blocks)));
    }

    fn count(folder: &Path, found: &mut Vec<(String, usize)>) {
        for entry in std::fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                count(&path, found);
                continue;
            }
            let blocks =
                std::fs::read_to_string(&path).expect("a file").matches("unsafe {").count();
            let file = path.strip_prefix(root().join("firmware-example/src")).expect("inside");
            if blocks > 0 {
                found.push((file.display().to_string(), blocks));
            }
        }
    }
}

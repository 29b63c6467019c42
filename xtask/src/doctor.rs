//! `cargo xtask doctor`: what is here, what is missing, and the command that gets it.

use std::process::Command;

use crate::apt;
use crate::boards;
use crate::failure::Failure;
use crate::options::Options;
use crate::process;
use crate::targets::Toolchain;
use crate::tools;

/// One thing looked for.
struct Finding {
    what: String,
    found: Option<String>,
    fix: String,
}

/// Prints one line per tool; fails if any is missing.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let findings = findings(options);
    for Finding { what, found, fix } in &findings {
        match found {
            Some(version) => println!("ok       {what}: {version}"),
            None => println!("MISSING  {what}\n         {fix}"),
        }
    }
    let missing: Vec<&str> =
        findings.iter().filter(|f| f.found.is_none()).map(|f| f.what.as_str()).collect();
    match missing.as_slice() {
        [] => Ok(()),
        missing => Err(Failure::missing(&missing.join(", "), "cargo xtask fetch")),
    }
}

fn findings(options: &Options) -> Vec<Finding> {
    let mut findings = vec![
        finding("cargo", first_line(process::cargo().arg("--version")), "https://rustup.rs"),
        finding(
            "C linker",
            first_line(Command::new("cc").arg("--version")),
            &apt::command_line(&["gcc"]),
        ),
        finding("rustfmt", tools::component_version("cargo-fmt"), "rustup component add rustfmt"),
        finding("clippy", tools::component_version("cargo-clippy"), "rustup component add clippy"),
    ];
    for program in boards::programs() {
        let toolchain = Toolchain::find(options.targets, program.triple);
        let found = toolchain.as_ref().ok().and_then(|toolchain| toolchain.version());
        let fix = toolchain.err().map_or_else(String::new, |failure| failure.to_string());
        findings.push(finding(
            &format!("compiler for {} ({})", program.name, program.triple),
            found,
            &fix,
        ));
    }
    for board in boards::ALL {
        let emulator = &board.emulator;
        findings.push(finding(
            &format!("emulator of {}", board.name),
            first_line(Command::new(emulator.program).arg("--version")),
            &apt::command_line(&[emulator.package]),
        ));
    }
    findings
}

fn finding(what: &str, found: Option<String>, fix: &str) -> Finding {
    Finding { what: what.into(), found, fix: fix.into() }
}

fn first_line(command: &mut Command) -> Option<String> {
    process::output(command)?.lines().next().map(str::to_owned)
}

//! `cargo xtask test`: everything that must hold, with nothing left out.

mod tally;

use std::io::{BufRead, BufReader};
use std::process::Stdio;
use std::time::Instant;

use crate::bench;
use crate::boards;
use crate::exhaustive;
use crate::failure::Failure;
use crate::firmware;
use crate::lint;
use crate::options::Options;
use crate::panic_free;
use crate::process;
use crate::qemu;
use crate::size;
use crate::speed;
use crate::tools;
use tally::Tally;

/// One part of the whole, with its name for the summary.
type Step = (&'static str, fn(&Options, &mut Tally) -> Result<(), Failure>);

/// In the order they run; a failed step does not keep the later ones from running.
const STEPS: &[Step] = &[
    ("tools are here", |options, _| tools::fetch_all(options)),
    ("lint", |options, _| lint::run(options)),
    ("boards build", |options, _| build_boards(options)),
    ("no panic can be reached", |options, _| panic_free::test(options)),
    ("flash, RAM and stack", |options, _| size::run(options)),
    ("instructions of a step", |options, _| speed::run(options)),
    ("instructions of a simulated step", |_, _| bench::counted()),
    ("one tanh on host and board", |options, _| exhaustive::sample(options)),
    ("tests on the host and on the emulated boards", cargo_test),
];

/// Runs every step and closes with one line for all tests.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let started = Instant::now();
    let mut tally = Tally::default();
    let mut failed = Vec::new();
    let mut report = String::new();
    for (name, step) in STEPS {
        eprintln!("xtask: {name}");
        let step_started = Instant::now();
        let outcome = step(options, &mut tally);
        let seconds = step_started.elapsed().as_secs_f64();
        match outcome {
            Ok(()) => report += &format!("step {name} ... ok ({seconds:.0} s)\n"),
            Err(failure) => {
                eprintln!("xtask: {name}: {failure}");
                report += &format!("step {name} ... FAILED ({seconds:.0} s): {failure}\n");
                failed.push(*name);
            }
        }
    }
    println!("\n{report}\n{}", tally.summary(failed.is_empty(), started.elapsed()));
    if failed.is_empty() {
        Ok(())
    } else {
        Err(Failure::failed(format!("failed: {}", failed.join("; "))))
    }
}

/// Builds programs and log decoder up front, so that a test's time is the test's own.
fn build_boards(options: &Options) -> Result<(), Failure> {
    for program in boards::programs() {
        firmware::build_program(&program, options)?;
    }
    process::run(&mut qemu::decoder("build"))
}

/// All tests of the workspace, those too slow for every day included; `CI` and `EVOSTEER_REQUIRE_ALL` make a test that would be left out
/// a failure.
fn cargo_test(options: &Options, tally: &mut Tally) -> Result<(), Failure> {
    let mut command = process::cargo();
    command.args(["test", "--workspace", "--no-fail-fast", "--", "--include-ignored"]);
    command.env("CI", "true").env("EVOSTEER_REQUIRE_ALL", "1");
    command.env("XTASK_TARGETS", options.targets.name()).stdout(Stdio::piped());
    let cannot = |what: &str, error| Failure::failed(format!("cannot {what} cargo test: {error}"));
    let mut child = command.spawn().map_err(|error| cannot("start", error))?;
    let pipe = child.stdout.take().expect("stdout is piped");
    for line in BufReader::new(pipe).split(b'\n') {
        let line = line.map_err(|error| cannot("read", error))?;
        let line = String::from_utf8_lossy(&line);
        println!("{line}");
        tally.read(&line);
    }
    let status = child.wait().map_err(|error| cannot("wait for", error))?;
    if !status.success() {
        return Err(Failure::failed(format!("cargo test ended with {status}")));
    }
    // A suite that dies silently would otherwise look like success.
    if tally.passed() == 0 { Err(Failure::failed("cargo test ran no test")) } else { Ok(()) }
}

//! `cargo xtask bench`: how fast the simulation is on this machine.
//!
//! Times are for people, who know what else their machine does: nothing fails over them. Counts of
//! instructions are exact, and are held to bounds.

mod callgrind;
mod counts;

use std::process::{Command, Stdio};

use crate::failure::Failure;
use crate::options::Options;
use crate::page::{self, Place};
use crate::process;
use crate::tools;
use counts::Counts;

/// Where the table of counts stands.
const COUNTS: Place = Place { page: "docs/performance.md", command: "bench --counted" };

/// Where the table of times stands; written anew on request, never compared.
const TIMES: Place = Place { page: "docs/performance.md", command: "bench" };

/// Vectors that valgrind knows, narrowest first.
const SETS: [&str; 2] = ["sse2", "avx2"];

/// How far a count may be from the one in the table, of it: what allocators, and the C library's own
/// choice of instructions, make of a count.
const MARGIN: f64 = 0.02;

/// Prints the table of times, or counts instructions.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    if options.counted {
        return match options.json {
            false => counted(),
            true => Err(Failure::usage(
                "bench: --counted prints no JSON; its table is in the documentation",
            )),
        };
    }
    let mut command = process::cargo();
    command.args(["bench", "--quiet", "--package", "host-trainer", "--bench", "table"]);
    if options.json {
        command.args(["--", "--json"]);
    }
    let output = command
        .stdin(Stdio::null())
        .stderr(Stdio::inherit())
        .output()
        .map_err(|error| Failure::failed(format!("cargo bench did not start: {error}")))?;
    if !output.status.success() {
        return Err(Failure::failed(format!("cargo bench ended with {}", output.status)));
    }
    let table = String::from_utf8_lossy(&output.stdout);
    print!("{table}");
    if options.json { Ok(()) } else { page::bless(&TIMES, &cpu(), &table) }
}

/// The CPU's name, as far as this system tells it.
fn cpu() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = text.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    name.map_or("an unknown CPU", |(_, name)| name.trim()).to_owned()
}

/// Counts the instructions of a step, and compares them with the table in the documentation.
pub(crate) fn counted() -> Result<(), Failure> {
    tools::need_valgrind()?;
    process::run(process::cargo().args([
        "build",
        "--quiet",
        "--release",
        "--package",
        "host-trainer",
        "--example",
        "counted",
    ]))?;
    let counts: Option<Vec<Counts>> =
        SETS.iter().map(|set| count(set)).collect::<Result<_, _>>()?;
    let Some(counts) = counts else {
        eprintln!("xtask: this CPU has no AVX2: instructions are not compared");
        return Ok(());
    };
    let table = counts::table(&counts);
    print!("{table}");
    let compiler =
        process::output(Command::new("rustc").arg("--version").current_dir(process::root()))
            .ok_or_else(|| Failure::missing("rustc", "https://rustup.rs"))?;
    page::keep_within(&COUNTS, &compiler, &table, MARGIN)
}

/// Runs the counting program once; none if this CPU lacks the instructions.
fn count(set: &'static str) -> Result<Option<Counts>, Failure> {
    let file = process::root().join(format!("target/counted-{set}.callgrind"));
    let program = process::root().join("target/release/examples/counted");
    let mut command = Command::new("valgrind");
    command.args(["--quiet", "--tool=callgrind", "--dump-line=no"]);
    command.arg(format!("--callgrind-out-file={}", file.display())).arg(program);
    let output = command
        .env("EVOSTEER_INSTRUCTIONS", set)
        .output()
        .map_err(|error| Failure::failed(format!("valgrind did not start: {error}")))?;
    if output.status.code() == Some(2) {
        return Ok(None);
    }
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        return Err(Failure::failed(format!("valgrind ended with {}: {said}", output.status)));
    }
    let said = String::from_utf8_lossy(&output.stdout);
    let steps = said.split_whitespace().next().and_then(|word| word.parse().ok());
    let steps =
        steps.ok_or_else(|| Failure::failed(format!("the program printed no steps: {said}")))?;
    let profile = std::fs::read_to_string(&file)
        .map_err(|error| Failure::failed(format!("{}: {error}", file.display())))?;
    Counts::of(set, &profile, steps)
        .map(Some)
        .map_err(|why| Failure::failed(format!("{}: {why}", file.display())))
}

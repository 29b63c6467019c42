//! The hash of a tanh over inputs of any number, on all cores of this machine.
//!
//! `tanh_hash rational|libm|micromath all|sample scalar|lanes` prints the hash and nothing else:
//! over every `f32` or 2²⁴ of them, one at a time or 16 side by side. The machine is this one, the
//! compiler's settings are those of the profile it is run in; `cargo xtask exhaustive` compares.

use controller_core::activation::digest::{Inputs, of, of_lanes};
use controller_core::activation::{Activation, Libm, Micromath, Rational};
use std::process::ExitCode;
use std::thread;

const USAGE: &str = "expected: tanh_hash rational|libm|micromath all|sample scalar|lanes";

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let hash = match words.as_slice() {
        ["rational", how @ ..] => hash(Rational, how),
        ["libm", how @ ..] => hash(Libm, how),
        ["micromath", how @ ..] => hash(Micromath, how),
        _ => None,
    };
    match hash {
        Some(hash) => println!("{hash:016x}"),
        None => eprintln!("found: {}\n{USAGE}", words.join(" ")),
    }
    if hash.is_some() { ExitCode::SUCCESS } else { ExitCode::from(2) }
}

fn hash(activation: impl Activation + Send + Sync, how: &[&str]) -> Option<u64> {
    let (inputs, width) = match how {
        ["all", width] => (Inputs::ALL, width),
        ["sample", width] => (Inputs::SAMPLE, width),
        _ => return None,
    };
    match *width {
        "scalar" => Some(on_all_cores(inputs, |part| of(activation, part))),
        "lanes" => Some(on_all_cores(inputs, |part| of_lanes::<16>(activation, part))),
        _ => None,
    }
}

/// Adds up the hashes of as many parts as there are cores.
fn on_all_cores(inputs: Inputs, hash: impl Fn(Inputs) -> u64 + Sync) -> u64 {
    let parts = thread::available_parallelism().map_or(1, |cores| cores.get() as u64);
    thread::scope(|scope| {
        let hash = &hash;
        let workers: Vec<_> =
            (0..parts).map(|part| scope.spawn(move || hash(inputs.part(part, parts)))).collect();
        let hashes = workers
            .into_iter()
            .map(|worker| worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        hashes.fold(0, u64::wrapping_add)
    })
}

//! Every `f32` there is through the three tanh: worst errors, falls, and one hash of all bits.
//!
//! `cargo run --release -p controller-core --example exhaustive` takes a few minutes on two
//! cores. Arguments name the tanh to run (`rational`, `libm`, `micromath`), all three by
//! default. The reference is `libm::tanh` in double precision. Exit code 1 if a hash is not the
//! recorded one: then this machine, or this release, computes other bits.

use controller_core::activation::digest::{mixed, recorded};
use controller_core::activation::{Activation, ActivationKind};
use std::ops::RangeInclusive;
use std::process::ExitCode;
use std::time::Instant;

/// What walking a range of bit patterns showed; two adjacent ranges add up.
#[derive(Clone, Copy, Default)]
struct Findings {
    /// Largest error in units of the last place of the exact value.
    ulps: f64,
    /// Where it is.
    ulps_at: f32,
    /// Largest absolute error.
    absolute: f64,
    /// Where it is.
    absolute_at: f32,
    /// Neighbours where the larger input has the smaller result.
    falls: u64,
    /// Deepest of these falls.
    deepest: f32,
    /// Results outside ±1, and inputs where exactly one of input and result is NaN.
    broken: u64,
    /// Sum over all inputs of a mix of input and result bits; the order does not matter.
    hash: u64,
}

impl Findings {
    fn join(self, other: Self) -> Self {
        let (ulps, ulps_at) = if other.ulps > self.ulps {
            (other.ulps, other.ulps_at)
        } else {
            (self.ulps, self.ulps_at)
        };
        let (absolute, absolute_at) = if other.absolute > self.absolute {
            (other.absolute, other.absolute_at)
        } else {
            (self.absolute, self.absolute_at)
        };
        Self {
            ulps,
            ulps_at,
            absolute,
            absolute_at,
            falls: self.falls + other.falls,
            deepest: self.deepest.max(other.deepest),
            broken: self.broken + other.broken,
            hash: self.hash.wrapping_add(other.hash),
        }
    }
}

fn apply(activation: impl Activation, x: f32) -> f32 {
    let mut sums = [x];
    activation.apply(&mut sums);
    let [y] = sums;
    y
}

/// 1 / spacing of `f32` around a value: 2^(23 − exponent), the exponent at least −126.
fn per_ulp(value: f64) -> f64 {
    let exponent = (value.to_bits() >> 52 & 0x7ff).max(1023 - 126);
    f64::from_bits((1023 + 23 + 1023 - exponent) << 52)
}

/// Walks bit patterns of positive inputs, each with its negative twin.
fn walk(activation: impl Activation, patterns: RangeInclusive<u32>) -> Findings {
    let mut found = Findings::default();
    let before = patterns.start().saturating_sub(1);
    let mut previous =
        [before, before | 1 << 31].map(|bits| apply(activation, f32::from_bits(bits)));
    for bits in patterns {
        let exact = libm::tanh(f64::from(f32::from_bits(bits)));
        for (sign, previous) in [0, 1 << 31].into_iter().zip(&mut previous) {
            let x = f32::from_bits(bits | sign);
            let y = apply(activation, x);
            found.hash = found.hash.wrapping_add(mixed(bits | sign, y));
            if x.is_nan() {
                found.broken += u64::from(!y.is_nan());
                continue;
            }
            found.broken += u64::from(!(-1.0..=1.0).contains(&y));
            let exact = if sign == 0 { exact } else { -exact };
            let error = (f64::from(y) - exact).abs();
            if error > found.absolute {
                (found.absolute, found.absolute_at) = (error, x);
            }
            if error * per_ulp(exact) > found.ulps {
                (found.ulps, found.ulps_at) = (error * per_ulp(exact), x);
            }
            let fall = if sign == 0 { *previous - y } else { y - *previous };
            if fall > 0.0 {
                found.falls += 1;
                found.deepest = found.deepest.max(fall);
            }
            *previous = y;
        }
    }
    found
}

/// Walks all positive patterns, striped over two threads.
fn walk_all(activation: impl Activation + Send + Sync) -> Findings {
    const PARTS: u32 = 64;
    const LEN: u32 = (1 << 31) / PARTS;
    let stripe = |start: u32| {
        (start..PARTS)
            .step_by(2)
            .map(|part| walk(activation, part * LEN..=part * LEN + (LEN - 1)))
            .fold(Findings::default(), Findings::join)
    };
    std::thread::scope(|scope| {
        let odd = scope.spawn(|| stripe(1));
        let even = stripe(0);
        odd.join().map_or_else(|panic| std::panic::resume_unwind(panic), |odd| even.join(odd))
    })
}

fn report(activation: impl Activation + Send + Sync) -> bool {
    let start = Instant::now();
    let found = walk_all(activation);
    let seconds = start.elapsed().as_secs();
    println!("{}: all 2^32 inputs in {seconds} s", activation.kind());
    println!("  worst error  {:.4} ULP at {:e}", found.ulps, found.ulps_at);
    println!("  worst error  {:.3e} at {:e}", found.absolute, found.absolute_at);
    println!("  falls        {}, the deepest {:e}", found.falls, found.deepest);
    println!("  broken       {} (outside ±1, or NaN on one side only)", found.broken);
    let recorded = recorded(activation.kind());
    let verdict = if found.hash == recorded { "as recorded" } else { "NOT the recorded one" };
    println!("  hash         {:016x}, {verdict}", found.hash);
    found.broken == 0 && found.hash == recorded
}

fn main() -> ExitCode {
    use controller_core::activation::{Libm, Micromath, Rational};
    let asked: Vec<String> = std::env::args().skip(1).collect();
    let all = [ActivationKind::Rational, ActivationKind::Libm, ActivationKind::Micromath];
    if let Some(unknown) = asked.iter().find(|name| !all.iter().any(|k| k.to_string() == **name)) {
        eprintln!("{unknown}: unknown tanh, expected rational, libm or micromath");
        return ExitCode::from(2);
    }
    let mut sound = true;
    for kind in all {
        if asked.is_empty() || asked.contains(&kind.to_string()) {
            // By type, so that the compiler specialises the loop.
            sound &= match kind {
                ActivationKind::Rational => report(Rational),
                ActivationKind::Libm => report(Libm),
                ActivationKind::Micromath => report(Micromath),
            };
        }
    }
    if sound { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

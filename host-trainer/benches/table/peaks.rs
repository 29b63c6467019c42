//! What one core of this machine can do at most, with each set of instructions.

use crate::row::Row;
use crate::timing::median;
use host_trainer::vector::{Instructions, Kernel, MOST_LANES, Vector};
use std::hint::black_box;
use std::time::Instant;

const ROUNDS: usize = 7;

/// Sums that do not wait for each other: more than latency times units on any x86, and no more
/// than AVX2 has registers for.
const CHAINS: usize = 12;

/// Products, and as many sums that they are added to. With a constant they fill all registers but one: AVX-512 has 32, the
/// others 16.
const fn mixed<V: Vector>() -> usize {
    if V::WIDTH == MOST_LANES { MOST_MIXED } else { 7 }
}

/// The most of them.
const MOST_MIXED: usize = 15;

/// Vectors that are read one after the other without waiting.
const READ_TOGETHER: usize = 8;

/// One core's rates with one set of instructions, per nanosecond.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Peaks {
    /// Sums, in numbers.
    pub(crate) add: f64,
    /// Products, in numbers.
    pub(crate) mul: f64,
    /// Products and sums of them, in numbers of both: what a network is made of.
    pub(crate) mixed: f64,
    /// Quotients, in numbers.
    pub(crate) div: f64,
    /// Square roots, in numbers.
    pub(crate) sqrt: f64,
    /// Bytes from the first cache.
    pub(crate) near: f64,
    /// Bytes from the second cache.
    pub(crate) far: f64,
}

/// The peaks of every set but the scalar one, which a compiler turns into vectors here.
pub(crate) fn measure(sets: &[Instructions]) -> Vec<(Instructions, Peaks)> {
    let vectors = sets.iter().filter(|set| set.width() > 1);
    let peaks = |set: &Instructions| {
        let rate = |work: Work, rounds: u32| {
            let rates = (0..ROUNDS).map(|_| set.run(Measure { work, rounds }));
            median(rates.collect())
        };
        let peaks = Peaks {
            add: rate(Work::Add, 400_000),
            mul: rate(Work::Mul, 400_000),
            mixed: rate(Work::Mixed, 400_000),
            div: rate(Work::Div, 40_000),
            sqrt: rate(Work::Sqrt, 40_000),
            near: rate(Work::Load { bytes: 16 << 10 }, 2_000),
            far: rate(Work::Load { bytes: 512 << 10 }, 60),
        };
        (*set, peaks)
    };
    vectors.map(peaks).collect()
}

/// What is done over and over.
#[derive(Clone, Copy)]
enum Work {
    Add,
    Mul,
    Mixed,
    Div,
    Sqrt,
    /// The largest number in this much memory.
    Load {
        bytes: usize,
    },
}

struct Measure {
    work: Work,
    rounds: u32,
}

impl Kernel for Measure {
    /// Numbers or bytes per nanosecond.
    type Output = f64;

    #[inline(always)]
    fn run<V: Vector>(self) -> f64 {
        let one = V::from(black_box(1.0));
        let zero = V::from(black_box(0.0));
        let mut chains = [one; CHAINS];
        let memory = match self.work {
            Work::Load { bytes } => vec![V::from(1.0); bytes / size_of::<V>()],
            _ => Vec::new(),
        };
        let begun = Instant::now();
        let per_round = match self.work {
            Work::Add => {
                for _ in 0..self.rounds {
                    for chain in &mut chains {
                        *chain = *chain + zero;
                    }
                }
                CHAINS * V::WIDTH
            }
            Work::Mul => {
                for _ in 0..self.rounds {
                    for chain in &mut chains {
                        *chain = *chain * one;
                    }
                }
                CHAINS * V::WIDTH
            }
            Work::Mixed => {
                let (mut products, mut sums) = ([zero; MOST_MIXED], [zero; MOST_MIXED]);
                for _ in 0..self.rounds {
                    let both = products.iter_mut().zip(&mut sums);
                    for (product, sum) in both.take(const { mixed::<V>() }) {
                        *product = *product * one;
                        *sum = *sum + *product;
                    }
                }
                black_box(sums);
                2 * mixed::<V>() * V::WIDTH
            }
            Work::Div => {
                for _ in 0..self.rounds {
                    for chain in &mut chains {
                        *chain = one / *chain;
                    }
                }
                CHAINS * V::WIDTH
            }
            Work::Sqrt => {
                for _ in 0..self.rounds {
                    for chain in &mut chains {
                        *chain = chain.sqrt();
                    }
                }
                CHAINS * V::WIDTH
            }
            Work::Load { bytes } => {
                // Only their largest is looked at: else each would be written to memory wherever it is read.
                let mut largest = [one; READ_TOGETHER];
                for _ in 0..self.rounds {
                    for numbers in black_box(&memory).as_chunks::<READ_TOGETHER>().0 {
                        for place in 0..READ_TOGETHER {
                            largest[place] = largest[place].max(numbers[place]);
                        }
                    }
                }
                black_box(largest.into_iter().fold(zero, V::max));
                bytes
            }
        };
        black_box(&chains);
        per_round as f64 * f64::from(self.rounds) / (begun.elapsed().as_secs_f64() * 1e9)
    }
}

/// Its lines of the table.
pub(crate) fn rows(peaks: &[(Instructions, Peaks)]) -> Vec<Row> {
    let mut rows = Vec::new();
    for (set, Peaks { add, mul, mixed, div, sqrt, near, far }) in peaks {
        for (what, rate, unit) in [
            ("sums", add, "per ns"),
            ("products", mul, "per ns"),
            ("sums and products", mixed, "per ns"),
            ("quotients", div, "per ns"),
            ("square roots", sqrt, "per ns"),
            ("16 KiB read", near, "bytes/ns"),
            ("512 KiB read", far, "bytes/ns"),
        ] {
            rows.push(Row::new("peak of a core", format!("{set}, {what}"), *rate, unit));
        }
    }
    rows
}

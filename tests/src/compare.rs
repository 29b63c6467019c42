//! Two machines' answers, word by word.

use std::fmt;

use crate::closed_loop::{Bits, Value};
use crate::files::{Case, FileError, ResultsReader, Source};
use crate::on_host;
use crate::weight_sets::{self, WeightSet};

/// Where two machines first disagree.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// Name of the weights.
    pub weights: String,
    /// Seed of the course.
    pub seed: u32,
    /// Step, from 0.
    pub step: u32,
    /// Which value of it: of several the one that is computed first.
    pub value: Value,
    /// Bits the machine computed.
    pub found: u32,
    /// Bits the host computed, one drive at a time.
    pub expected: u32,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { weights, seed, step, value, found, expected } = self;
        write!(
            f,
            "{weights}, course {seed}, step {step}: {value}: {found:08x} computed, {expected:08x} expected \
             ({:e} and {:e})",
            f32::from_bits(*found),
            f32::from_bits(*expected)
        )
    }
}

/// How far a machine agreed with the host.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Steps compared, every value of each.
    pub steps: u64,
    /// Bits that differ in all of them.
    pub differing_bits: u64,
    /// The first value that differs.
    pub first: Option<Difference>,
}

impl Tally {
    /// Compares one step.
    pub fn step(&mut self, weights: &str, seed: u32, step: u32, found: &Bits, expected: &Bits) {
        self.steps += 1;
        self.differing_bits += found
            .iter()
            .zip(expected)
            .map(|(found, expected)| u64::from((found ^ expected).count_ones()))
            .sum::<u64>();
        if self.differing_bits == 0 || self.first.is_some() {
            return;
        }
        let differing = (0..found.len()).filter(|place| found[*place] != expected[*place]);
        self.first = differing.min_by_key(|place| Value(*place).order()).map(|place| Difference {
            weights: weights.to_owned(),
            seed,
            step,
            value: Value(place),
            found: found[place],
            expected: expected[place],
        });
    }

    /// Adds what was compared after this.
    pub fn add(&mut self, later: Self) {
        self.steps += later.steps;
        self.differing_bits += later.differing_bits;
        self.first = self.first.take().or(later.first);
    }
}

/// Weights and a course for them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Drive {
    /// What the machine drives with.
    pub weights: WeightSet,
    /// Where and how far.
    pub case: Case,
}

/// Every generated weight set on a course of its own, each for so many steps.
pub fn generated_drives(steps: u32) -> Vec<Drive> {
    let sets = weight_sets::generated().into_iter().zip(0..);
    sets.map(|(weights, seed)| Drive { weights, case: Case { seed, steps } }).collect()
}

/// Reads a machine's results of these drives and compares each with what the host computes now.
///
/// # Errors
///
/// Results that are damaged, or not of these drives.
pub fn with_host<S: Source>(drives: &[Drive], results: S) -> Result<Tally, FileError<S::Error>> {
    let mut results = ResultsReader::new(results, drives.len() as u32)?;
    let mut tally = Tally::default();
    for Drive { weights, case } in drives {
        tally.add(case_with_host(&mut results, weights, weights, *case)?);
    }
    results.finish()?;
    Ok(tally)
}

/// Compares the next case of `results`, driven with `driven`, with what the host computes with `expected`.
///
/// # Errors
///
/// As [`with_host`].
pub fn case_with_host<S: Source>(
    results: &mut ResultsReader<S>,
    driven: &WeightSet,
    expected: &WeightSet,
    case: Case,
) -> Result<Tally, FileError<S::Error>> {
    let blob = expected.blob();
    let reference = on_host::steps(&blob, case).expect("a weight set is of the right size");
    let mut tally = Tally::default();
    results.begin(case, driven.blob().check())?;
    for (step, expected) in (0..case.steps).zip(reference) {
        tally.step(driven.name(), case.seed, step, &results.step()?, &expected);
    }
    results.end()?;
    Ok(tally)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closed_loop::VALUES;

    #[test]
    fn every_bit_is_counted_and_the_first_difference_is_kept() {
        let expected = [0x3f80_0000; VALUES];
        let mut tally = Tally::default();
        tally.step("w", 5, 0, &expected, &expected);
        let mut found = expected;
        found[8] ^= 0b101;
        found[20] ^= 1;
        found[0] ^= 1;
        tally.step("w", 5, 1, &found, &expected);
        tally.step("w", 5, 2, &expected.map(|word| !word), &expected);
        assert_eq!((tally.steps, tally.differing_bits), (3, 4 + 32 * VALUES as u64));
        assert_eq!(
            tally.first.expect("there is one").to_string(),
            "w, course 5, step 1: neuron 5 of the first hidden layer: 3f800005 computed, 3f800000 expected \
             (1.0000006e0 and 1e0)"
        );
    }
}

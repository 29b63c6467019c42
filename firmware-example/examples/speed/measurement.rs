//! One thing measured over all inputs, net of doing nothing.

use crate::counter::Counter;
use crate::stack;
use core::hint::black_box;

/// Inputs of each measurement.
pub(crate) const INPUTS: u32 = 1024;

/// What a call takes beyond a call of an empty function.
pub(crate) struct Measurement {
    /// Fewest instructions.
    pub(crate) min: u32,
    /// Most instructions.
    pub(crate) max: u32,
    /// Instructions of all inputs together.
    pub(crate) sum: u32,
    /// Bytes of stack.
    pub(crate) stack: u32,
}

/// Measures `call` with each of the inputs, and `empty` with the same.
///
/// # Errors
///
/// A stack deeper than was painted.
pub(crate) fn measure<I>(
    counter: &Counter,
    mut input: impl FnMut() -> I,
    mut call: impl FnMut(&I),
    mut empty: impl FnMut(&I),
) -> Result<Measurement, &'static str> {
    let mut found = Measurement { min: u32::MAX, max: 0, sum: 0, stack: 0 };
    for _ in 0..INPUTS {
        let input = black_box(input());
        let nothing = counter.count(black_box(&mut || empty(&input)));
        let count = counter.count(black_box(&mut || call(&input))).wrapping_sub(nothing);
        let nothing = stack::used(black_box(&mut || empty(&input)))?;
        let stack = stack::used(black_box(&mut || call(&input)))?.saturating_sub(nothing);
        found.min = found.min.min(count);
        found.max = found.max.max(count);
        found.sum += count;
        found.stack = found.stack.max(stack);
    }
    Ok(found)
}

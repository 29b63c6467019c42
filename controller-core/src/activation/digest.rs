//! A tanh as one number: a hash of its results over many inputs, or over all there are.
//!
//! Two machines, compilers or widths with the same hash over all 2³² inputs compute the same
//! tanh. The hash is a sum, so the inputs may be walked in any order and in parts.
//!
//! ```
//! use controller_core::activation::Rational;
//! use controller_core::activation::digest::{Inputs, of, of_lanes};
//!
//! let inputs = Inputs { first: 0, stride: 65_537, count: 1 << 16 };
//! assert_eq!(of(Rational, inputs), of_lanes::<16>(Rational, inputs));
//! ```

use super::{Activation, ActivationKind};
use crate::lane::Lanes;
use core::array::from_fn;

/// Bit patterns of inputs: `first`, then every `stride`-th, around past 2³².
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Inputs {
    /// The first.
    pub first: u32,
    /// From one to the next; an odd one meets every pattern once in 2³².
    pub stride: u32,
    /// How many, at most 2³².
    pub count: u64,
}

impl Inputs {
    /// Every `f32` there is.
    pub const ALL: Self = Self { first: 0, stride: 1, count: 1 << 32 };

    /// 2²⁴ of them: all signs and exponents, and low bits that vary.
    pub const SAMPLE: Self = Self { first: 0, stride: 257, count: 1 << 24 };

    /// The pattern at a place.
    #[inline(always)]
    pub const fn at(self, index: u64) -> u32 {
        self.first.wrapping_add(self.stride.wrapping_mul(index as u32))
    }

    /// The `part`-th of `parts` nearly equal parts; none beyond the last.
    pub const fn part(self, part: u64, parts: u64) -> Self {
        let part = if part < parts { part } else { parts };
        let (start, end) = (self.count * part / parts, self.count * (part + 1) / parts);
        let end = if end < self.count { end } else { self.count };
        Self { first: self.at(start), stride: self.stride, count: end - start }
    }
}

/// The hash over [`Inputs::ALL`] that every release and machine has to compute.
pub const fn recorded(kind: ActivationKind) -> u64 {
    match kind {
        ActivationKind::Rational => 0x6d7c_4c7f_fae6_d8a1,
        ActivationKind::Libm => 0xc0ea_d866_5cfc_7426,
        ActivationKind::Micromath => 0xc8de_85c1_17c0_6d0f,
    }
}

/// The hash over some inputs.
pub fn of(activation: impl Activation, inputs: Inputs) -> u64 {
    let mut hash = 0u64;
    for index in 0..inputs.count {
        hash = hash.wrapping_add(one(activation, inputs.at(index)));
    }
    hash
}

/// The same hash, computed `N` inputs side by side.
pub fn of_lanes<const N: usize>(activation: impl Activation, inputs: Inputs) -> u64 {
    let mut hash = 0u64;
    let mut index = 0;
    while index + N as u64 <= inputs.count {
        let patterns: [u32; N] = from_fn(|lane| inputs.at(index + lane as u64));
        let mut sums = [Lanes(patterns.map(f32::from_bits))];
        activation.apply(&mut sums);
        let [Lanes(results)] = sums;
        for (pattern, result) in patterns.into_iter().zip(results) {
            hash = hash.wrapping_add(mixed(pattern, result));
        }
        index += N as u64;
    }
    for index in index..inputs.count {
        hash = hash.wrapping_add(one(activation, inputs.at(index)));
    }
    hash
}

#[inline(always)]
fn one(activation: impl Activation, pattern: u32) -> u64 {
    let mut sums = [f32::from_bits(pattern)];
    activation.apply(&mut sums);
    let [result] = sums;
    mixed(pattern, result)
}

/// What one input adds to the hash: its bits and its result's, mixed (the finaliser of
/// MurmurHash3). Every NaN counts as the canonical one.
#[inline(always)]
pub const fn mixed(pattern: u32, result: f32) -> u64 {
    let result = if result.is_nan() { 0x7fc0_0000 } else { result.to_bits() };
    let mut mixed = (pattern as u64) << 32 | result as u64;
    mixed ^= mixed >> 33;
    mixed = mixed.wrapping_mul(0xff51_afd7_ed55_8ccd);
    mixed ^= mixed >> 33;
    mixed = mixed.wrapping_mul(0xc4ce_b9fe_1a85_ec53);
    mixed ^ mixed >> 33
}

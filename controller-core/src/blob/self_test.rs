//! Does this machine compute what the trainer computed? Asked at boot, answered in bits.

use super::{Blob, WrongTopology};
use crate::activation::{Activation, ActivationKind};
use crate::network::{Recurrence, State};
use crate::observation::INPUTS;
use core::hint::black_box;

/// This machine computes something else than the one that wrote the blob.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SelfTestError {
    /// The blob holds another network.
    Topology(WrongTopology),
    /// The blob's weights were trained with another tanh.
    Activation {
        /// The blob's.
        found: ActivationKind,
        /// The program's.
        expected: ActivationKind,
    },
    /// A recorded output came out with other bits.
    Output {
        /// Which triple.
        triple: usize,
        /// Which output.
        output: usize,
        /// Bits computed here.
        found: u32,
        /// Bits recorded by the trainer.
        expected: u32,
    },
    /// Subnormal numbers are flushed to zero, or products are fused.
    Arithmetic {
        /// Bits computed here.
        found: u32,
        /// Bits that IEEE 754 defines.
        expected: u32,
    },
}

crate::sentences! { SelfTestError {
    Self::Topology(error) => "{}", error;
    Self::Activation { found, expected } =>
        "the blob was trained with tanh {}, this program runs {}", found, expected;
    Self::Output { triple, output, found, expected } =>
        "self-test {}, output {}: {:08x} computed, {:08x} recorded", triple, output, found, expected;
    Self::Arithmetic { found, expected } =>
        "this machine's arithmetic is not IEEE 754: {:08x} computed, {:08x} expected", found, expected;
} }

impl core::error::Error for SelfTestError {}

/// Checks that subnormals are kept and that a product is rounded before it is added.
///
/// # Errors
///
/// [`SelfTestError::Arithmetic`] with the first result that differs.
pub fn arithmetic_self_test() -> Result<(), SelfTestError> {
    let expect = |found: f32, expected: u32| {
        if found.to_bits() == expected {
            Ok(())
        } else {
            Err(SelfTestError::Arithmetic { found: found.to_bits(), expected })
        }
    };
    // 2^-100 · 2^-40 = 2^-140, a subnormal; zero where subnormals are flushed.
    let tiny = f32::from_bits((127 - 100) << 23);
    let smaller = f32::from_bits((127 - 40) << 23);
    expect(black_box(tiny) * black_box(smaller), 1 << 9)?;
    // (1 + 2^-12)² = 1 + 2^-11 + 2^-24: rounded, the last term goes; fused, it stays.
    let x = black_box(1.0 + 1.0 / 4096.0f32);
    let fused_or_not = black_box(-(1.0 + 1.0 / 2048.0f32)) + x * x;
    expect(fused_or_not, 0)
}

impl Blob<'_> {
    /// Runs every recorded triple through the network and compares outputs as bits. A blob
    /// without triples passes if this machine's arithmetic, network and tanh are the right ones.
    ///
    /// # Errors
    ///
    /// The first difference.
    pub fn self_test<R: Recurrence, const H: usize, const O: usize>(
        &self,
        activation: impl Activation,
    ) -> Result<(), SelfTestError> {
        arithmetic_self_test()?;
        let network = self.network::<R, H, O>().map_err(SelfTestError::Topology)?;
        let (found, expected) = (self.header().activation, activation.kind());
        if found != expected {
            return Err(SelfTestError::Activation { found, expected });
        }
        let words = const { INPUTS + 2 * H + O };
        for (triple, record) in self.self_tests.chunks_exact(words).enumerate() {
            let Some((inputs, rest)) = record.split_first_chunk::<INPUTS>() else { continue };
            let Some((first, rest)) = rest.split_first_chunk::<H>() else { continue };
            let Some((second, expected)) = rest.split_first_chunk::<H>() else { continue };
            let mut state = State { first: *first, second: *second };
            let outputs = network.step_alone(activation, &mut state, inputs);
            for (output, (found, expected)) in outputs.iter().zip(expected).enumerate() {
                let (found, expected) = (found.to_bits(), expected.to_bits());
                if found != expected {
                    return Err(SelfTestError::Output { triple, output, found, expected });
                }
            }
        }
        Ok(())
    }
}

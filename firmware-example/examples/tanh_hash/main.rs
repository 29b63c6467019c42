//! The hash of a tanh over many inputs, on the emulated Cortex-M4F.
//!
//! `cargo xtask exhaustive` builds and runs it, and puts the order into the flash for weights: four
//! little-endian words, the tanh (0 rational, 1 libm, 2 micromath), the first bit pattern, the stride, and
//! how many inputs less one. The answer is a line `hash <16 hexadecimal digits>`.
#![no_std]
#![no_main]

use controller_core::activation::digest::{Inputs, of};
use controller_core::activation::{Libm, Micromath, Rational};
use firmware_example::{emulated, weights_region};

#[cortex_m_rt::entry]
fn main() -> ! {
    let order = weights_region::bytes().as_chunks().0;
    let [tanh, first, stride, last, ..] = order else {
        defmt::error!("the flash for weights has no room for four words");
        emulated::fail()
    };
    let [tanh, first, stride, last] =
        [tanh, first, stride, last].map(|word| u32::from_le_bytes(*word));
    let inputs = Inputs { first, stride, count: u64::from(last) + 1 };
    let hash = match tanh {
        0 => of(Rational, inputs),
        1 => of(Libm, inputs),
        2 => of(Micromath, inputs),
        other => {
            defmt::error!("tanh {=u32} ordered, expected 0 to 2", other);
            emulated::fail()
        }
    };
    defmt::info!("hash {=u64:016x}", hash);
    emulated::succeed()
}

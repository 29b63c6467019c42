//! Counts the instructions of network steps, control steps and tanh on the emulated Cortex-M4F.
//!
//! `cargo xtask speed` builds and runs it and makes a table of what it says. Each line names what was
//! measured and then has `key=value` pairs: instructions (`min`, `max`, and their `sum` over all
//! `inputs`) and bytes of `stack`, both net of calling an empty function of the same signature;
//! the address of its `code`; bytes of the network's `state` and `weights`.
#![no_std]
#![no_main]

mod cases;
mod counter;
mod inputs;
mod loops;
mod measurement;
mod stack;

use controller_core::activation::{Libm, Micromath, Rational};
use controller_core::network::{Elman, Feedforward, SelfLoop};
use cortex_m::Peripherals;
use counter::Counter;
use firmware_example::emulated;

#[cortex_m_rt::entry]
fn main() -> ! {
    let Some(peripherals) = Peripherals::take() else { emulated::fail() };
    let counter = Counter::start(peripherals.SYST);
    if let Some((rounds, found, expected)) = loops::first_miscount(&counter) {
        defmt::error!(
            "a loop of {=u32} rounds: {=u32} instructions counted, {=u32} expected; QEMU has to run with -icount shift=7",
            rounds,
            found,
            expected
        );
        emulated::fail()
    }
    let all = [
        cases::steps::<Feedforward>(&counter, "feedforward-rational"),
        cases::steps::<SelfLoop>(&counter, "self-libm"),
        cases::steps::<Elman>(&counter, "elman-rational"),
        cases::tanh(&counter, Rational),
        cases::tanh(&counter, Libm),
        cases::tanh(&counter, Micromath),
    ];
    if let Some(trouble) = all.into_iter().find_map(Result::err) {
        defmt::error!("{=str}", trouble);
        emulated::fail()
    }
    emulated::succeed()
}

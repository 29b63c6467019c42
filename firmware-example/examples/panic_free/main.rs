//! A program that links only if nothing in it can panic: `cargo xtask panic-free`.
//!
//! It holds what the boards hold: the driving program with all drivers, the replay of recorded drives and
//! the drive through the room. Its hardware is memory that anybody may have written, and so are its
//! calibration, weights and recordings: the compiler can rule a panic out only for all of their values.
//! The panic handler calls a function that is nowhere. It runs on no machine.
#![no_std]
#![no_main]
#![expect(unsafe_code, reason = "only the linker knows that there is no panic")]

mod memory;
mod parts;

use firmware_example::app::{self, Car};
use firmware_example::brain::{HIDDEN, OUTPUTS};
use firmware_example::calibration::Calibration;
use firmware_example::{closed_loop, replay};
use memory::Memory;
use parts::{Bench, Timer};

#[cfg_attr(target_arch = "arm", cortex_m_rt::entry)]
#[cfg_attr(target_arch = "riscv32", riscv_rt::entry)]
fn main() -> ! {
    loop {
        match Memory::CHOICE.read() {
            0 => drive(),
            1 => replay(),
            _ => room(),
        }
        #[cfg(feature = "sabotage-index")]
        Memory::REPORT.keep(Memory::WEIGHTS.bytes()[Memory::CHOICE.read() as usize]);
    }
}

// Not inlined, so that each can be found in the program.

/// The driving program, for ever; back at once if the calibration is refused.
#[inline(never)]
fn drive() {
    let calibration: Calibration = Memory::CALIBRATION.numbers();
    let calibration = match calibration.check() {
        Ok(checked) => checked,
        Err(error) => return Memory::REPORT.keep(error),
    };
    let mut parts = parts::parts();
    app::fail_safe(&mut parts.servo, &mut parts.motor, &calibration);
    let mut timer = Timer;
    let weights = Memory::WEIGHTS.bytes();
    let car = Car::<Bench, HIDDEN, OUTPUTS>::boot(parts, &calibration, weights, &mut timer);
    app::run(car, &mut timer)
}

/// What the emulated boards do with a recorded drive.
#[inline(never)]
fn replay() {
    Memory::REPORT.keep(replay::replay(Memory::WEIGHTS.bytes(), Memory::RECORDING.bytes()));
}

/// What they do with weights in flash.
#[inline(never)]
fn room() {
    Memory::REPORT.keep(closed_loop::drive(Memory::WEIGHTS.bytes(), Memory::CHOICE.read()));
}

unsafe extern "C" {
    /// Defined nowhere. Its name is what the linker says if something may call it.
    #[link_name = "PANIC PATH IS REACHABLE"]
    safe fn panic_path_is_reachable() -> !;
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    panic_path_is_reachable()
}

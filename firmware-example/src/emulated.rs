//! How a program on a board that QEMU stands in for logs, panics and ends; and the program itself.

#[cfg(feature = "cortex-m")]
mod high_water;
mod proof;
#[cfg(feature = "cortex-m")]
#[path = "emulated/cortex_m_support.rs"]
mod support;
#[cfg(feature = "riscv")]
#[path = "emulated/riscv_support.rs"]
mod support;

use crate::brain::Refusal;
use crate::last_words::LastWords;
use crate::{closed_loop, recorded, replay, weights_region};
use controller_core::blob::BlobError;
use core::sync::atomic::{AtomicBool, Ordering};
// Linked for its global logger: defmt frames leave through semihosting.
use defmt_semihosting as _;
use semihosting::process;

/// What flash reads as before anything is written to it.
const ERASED: [u8; 8] = [0xff; 8];

/// Steps in the room.
const STEPS: u32 = 200;

/// Replays every recorded drive, drives with the weights in flash if there are any, reports each, and
/// ends the run: badly if a bit differed or weights were refused. Started with the command line `prove` it drives
/// the cases of a file instead.
pub fn run() -> ! {
    sabotage();
    if proof::is_asked_for() {
        if proof::run() { succeed() } else { fail() }
    }
    let mut all_agree = true;
    for &recorded::Drive { name, blob, recording } in recorded::ALL {
        match replay::replay(blob, recording) {
            Ok(steps) => defmt::info!("{=str}: {=usize} steps, every bit as recorded", name, steps),
            Err(error) => {
                defmt::error!("{=str}: {}", name, error);
                all_agree = false;
            }
        }
    }
    let usable = drive_with_weights_in_flash();
    #[cfg(feature = "cortex-m")]
    defmt::info!("stack: at most {=usize} bytes used", high_water::bytes());
    if all_agree && usable { succeed() } else { fail() }
}

/// False if there is something else than usable weights; erased flash is no fault of a board's.
fn drive_with_weights_in_flash() -> bool {
    match closed_loop::drive(weights_region::bytes(), STEPS) {
        Ok(closed_loop::Drive { weights, digest }) => {
            defmt::info!(
                "weights {=u64:016x}: {=u32} steps in the room, digest {=u64:016x}",
                weights,
                STEPS,
                digest
            );
            true
        }
        Err(refusal @ Refusal::Blob(BlobError::Magic { found: ERASED })) => {
            defmt::warn!("not driving: {}", refusal);
            true
        }
        Err(refusal) => {
            defmt::error!("not driving: {}", refusal);
            false
        }
    }
}

/// Ends the run well: QEMU exits with code 0.
pub fn succeed() -> ! {
    process::exit(0)
}

/// Ends the run badly: QEMU exits with code 1.
pub fn fail() -> ! {
    process::exit(1)
}

/// Reports what went wrong and ends the run badly. What fails in here comes here again, and then there is
/// nothing but the end.
pub(crate) fn fail_saying(report: impl FnOnce()) -> ! {
    static FAILED_BEFORE: AtomicBool = AtomicBool::new(false);
    if !FAILED_BEFORE.load(Ordering::Relaxed) {
        FAILED_BEFORE.store(true, Ordering::Relaxed);
        report();
    }
    fail()
}

/// Reports the panic and ends the run: without an exit QEMU would sit in the handler for ever.
#[panic_handler]
fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
    fail_saying(|| defmt::error!("{}", LastWords(info)))
}

/// Fails in the way a `sabotage-*` feature asks for, so that a test sees the runner notice.
fn sabotage() {
    #[cfg(feature = "sabotage-panic")]
    panic!("on purpose");
    #[cfg(feature = "sabotage-fault")]
    support::undefined_instruction();
    #[cfg(feature = "sabotage-hang")]
    loop {
        core::hint::spin_loop();
    }
}

//! How a program on a board that QEMU stands in for logs, panics and ends; and the program itself.

#[cfg(feature = "cortex-m")]
#[path = "emulated/cortex_m_support.rs"]
mod support;
#[cfg(feature = "riscv")]
#[path = "emulated/riscv_support.rs"]
mod support;

use crate::{recorded, replay};
// Linked for its global logger: defmt frames leave through semihosting.
use defmt_semihosting as _;
use semihosting::process;

/// Replays every recorded drive, reports each, and ends the run.
pub fn run() -> ! {
    sabotage();
    let mut all_agree = true;
    for recorded::Drive { name, blob, recording } in recorded::all() {
        match replay::replay(blob, recording) {
            Ok(steps) => defmt::info!("{=str}: {=usize} steps, every bit as recorded", name, steps),
            Err(error) => {
                defmt::error!("{=str}: {}", name, defmt::Display2Format(&error));
                all_agree = false;
            }
        }
    }
    if all_agree { succeed() } else { fail() }
}

/// Ends the run well: QEMU exits with code 0.
pub fn succeed() -> ! {
    process::exit(0)
}

/// Ends the run badly: QEMU exits with code 1.
pub fn fail() -> ! {
    process::exit(1)
}

/// Reports the panic and ends the run: without an exit QEMU would sit in the handler for ever.
#[panic_handler]
fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
    defmt::error!("panic: {}", defmt::Display2Format(info));
    fail()
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

//! How a program on a board that QEMU stands in for logs, panics and ends.

#[cfg(feature = "cortex-m")]
mod cortex_m_faults;

// Linked for its global logger: defmt frames leave through semihosting.
use defmt_semihosting as _;
use semihosting::process;

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

//! What a RISC-V board needs: critical sections, and traps that end the run with failure.
#![expect(
    unsafe_code,
    reason = "riscv-rt finds its handlers by name, which the language calls unsafe"
)]

use riscv::register::{mcause, mepc};
use riscv_rt::TrapFrame;

/// Runs into an instruction that no processor has: an exception.
#[cfg(feature = "sabotage-fault")]
pub(super) fn undefined_instruction() -> ! {
    // SAFETY: execution goes on in the exception handler, which never returns.
    unsafe { core::arch::asm!("unimp", options(noreturn)) }
}

// SAFETY: riscv-rt declares the function with this signature and looks it up under this name.
#[unsafe(export_name = "ExceptionHandler")]
extern "C" fn exception(frame: &TrapFrame) -> ! {
    super::fail_saying(|| {
        defmt::error!(
            "exception {=usize} at pc {=usize:#010x}, called from {=usize:#010x}",
            mcause::read().code(),
            mepc::read(),
            frame.ra
        );
    })
}

// SAFETY: as above.
#[unsafe(export_name = "DefaultHandler")]
extern "C" fn interrupt() -> ! {
    super::fail_saying(|| {
        defmt::error!("interrupt {=usize} has no handler", mcause::read().code());
    })
}

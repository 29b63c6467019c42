//! What every Cortex-M board needs: critical sections, and faults that end the run with failure.
#![expect(
    unsafe_code,
    reason = "cortex-m-rt wants its handlers declared unsafe; they do nothing unsafe"
)]

// Linked for its critical sections, which the log needs.
use cortex_m as _;
use cortex_m_rt::{ExceptionFrame, exception};

/// Runs into an instruction that no processor has: a hard fault.
#[cfg(feature = "sabotage-fault")]
pub(super) fn undefined_instruction() -> ! {
    cortex_m::asm::udf()
}

#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    defmt::error!(
        "hard fault at pc {=u32:#010x}, called from {=u32:#010x}",
        frame.pc(),
        frame.lr()
    );
    super::fail()
}

#[exception]
unsafe fn DefaultHandler(interrupt: i16) -> ! {
    defmt::error!("interrupt {=i16} has no handler", interrupt);
    super::fail()
}

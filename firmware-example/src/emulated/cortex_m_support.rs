//! What every Cortex-M board that QEMU stands in for needs besides its exceptions: critical sections.

// Linked for its critical sections, which the log needs.
use cortex_m as _;

/// Runs into an instruction that no processor has: a hard fault.
#[cfg(feature = "sabotage-fault")]
pub(super) fn undefined_instruction() -> ! {
    cortex_m::asm::udf()
}

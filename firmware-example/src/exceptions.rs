//! What a Cortex-M does about a fault or an interrupt that nobody handles: it says so, and fails as its
//! board fails.
#![expect(
    unsafe_code,
    reason = "cortex-m-rt wants its handlers declared unsafe; they do nothing unsafe"
)]

#[cfg(feature = "emulated")]
use crate::emulated::fail_saying as fail;
#[cfg(feature = "board-pico2")]
use crate::pico2::fail;
use cortex_m_rt::{ExceptionFrame, exception};

#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    fail(|| {
        defmt::error!(
            "hard fault at pc {=u32:#010x}, called from {=u32:#010x}",
            frame.pc(),
            frame.lr()
        );
    })
}

#[exception]
unsafe fn DefaultHandler(interrupt: i16) -> ! {
    fail(|| defmt::error!("interrupt {=i16} has no handler", interrupt))
}

//! Instructions between two readings of the system timer.
//!
//! Under QEMU's `-icount shift=7` an instruction is 128 ns of virtual time, and a tick of this
//! machine's 25 MHz clock is 40 ns: 3.2 ticks each. A count is less than a tick off at either
//! end, so rounding makes it exact. The measuring itself is in it; callers take off what the
//! same measurement of an empty function counts.

use core::sync::atomic::{Ordering, compiler_fence};
use cortex_m::peripheral::{SYST, syst::SystClkSource};

/// The timer counts down through so many values.
const VALUES: u32 = 1 << 24;

/// Instructions per tick are `PER_TICK.0 / PER_TICK.1`.
const PER_TICK: (u32, u32) = (5, 16);

/// The running timer.
pub(crate) struct Counter(());

impl Counter {
    /// Starts it.
    pub(crate) fn start(mut timer: SYST) -> Self {
        timer.set_clock_source(SystClkSource::Core);
        timer.set_reload(VALUES - 1);
        timer.clear_current();
        timer.enable_counter();
        Self(())
    }

    /// Instructions that `call` takes, the measuring included; up to five million.
    #[inline(never)]
    pub(crate) fn count(&self, call: &mut dyn FnMut()) -> u32 {
        let before = SYST::get_current();
        compiler_fence(Ordering::SeqCst);
        call();
        compiler_fence(Ordering::SeqCst);
        let ticks = before.wrapping_sub(SYST::get_current()) % VALUES;
        (ticks * PER_TICK.0 + PER_TICK.1 / 2) / PER_TICK.1
    }
}

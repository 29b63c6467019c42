//! What the car does when its program fails: it stops, says why, and starts anew.

use super::{CALIBRATION, FAILED, MARK, motor, servo};
use crate::app;
use crate::last_words::LastWords;
use core::sync::atomic::{AtomicBool, Ordering};
use embassy_rp::clocks::clk_sys_freq;
use embassy_rp::peripherals::{PIN_16, PIN_18, PWM_SLICE0, PWM_SLICE1, WATCHDOG};
use embassy_rp::watchdog::Watchdog;

/// Stops the motor and straightens the wheels, then reports, then resets the chip.
///
/// The car comes first, because the log may be what failed. What fails in here comes here again, and
/// then there is nothing but the reset. The watchdog does it: it takes the pulse generators along,
/// where a reset of the processor alone may leave them running.
pub(crate) fn fail(report: impl FnOnce()) -> ! {
    static FAILED_BEFORE: AtomicBool = AtomicBool::new(false);
    if !FAILED_BEFORE.swap(true, Ordering::Relaxed) {
        stop();
        report();
        // A tenth of a second for a debug probe to fetch the report before memory is cleared.
        cortex_m::asm::delay(clk_sys_freq() / 10);
    }
    reset()
}

#[expect(unsafe_code, reason = "the program that owned the pins will not go on")]
fn stop() {
    let Ok(calibration) = CALIBRATION.check() else { return };
    // SAFETY: whoever owned these never runs again; the chip is reset at the end of `fail`.
    let (motor_slice, motor_pin) = unsafe { (PWM_SLICE1::steal(), PIN_18::steal()) };
    // SAFETY: the same.
    let (servo_slice, servo_pin) = unsafe { (PWM_SLICE0::steal(), PIN_16::steal()) };
    let mut motor = motor(motor_slice, motor_pin);
    let mut servo = servo(servo_slice, servo_pin);
    app::fail_safe(&mut servo, &mut motor, &calibration);
    // Dropped, they would leave both lines without pulses before the reset.
    core::mem::forget((servo, motor));
}

#[expect(unsafe_code, reason = "the program that owned the watchdog will not go on")]
fn reset() -> ! {
    // SAFETY: whoever owned it never runs again.
    let mut watchdog = Watchdog::new(unsafe { WATCHDOG::steal() });
    watchdog.set_scratch(MARK, FAILED);
    loop {
        watchdog.trigger_reset();
    }
}

#[panic_handler]
fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
    fail(|| defmt::error!("{}", LastWords(info)))
}

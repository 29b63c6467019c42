//! What the Raspberry Pi Pico 2 brings besides pins: time, watchdog, log, and what happens on a panic.
#![expect(
    unsafe_code,
    reason = "cortex-m-rt wants its handlers declared unsafe; they do nothing unsafe"
)]

use crate::calibration::CalibrationError;
use crate::clock::{Clock, Micros, Watchdog};
use cortex_m::peripheral::SCB;
use cortex_m_rt::{ExceptionFrame, exception};
// Linked for its global logger: defmt frames wait in memory for a debug probe.
use defmt_rtt as _;
use embassy_rp::Peri;
use embassy_rp::peripherals::WATCHDOG;
use embassy_time::{Duration, Instant};

defmt::timestamp!("{=u64:us}", Instant::now().as_micros());

/// Booting may take this long: five sensors calibrate themselves.
const BOOT: Duration = Duration::from_secs(8);

/// The chip's microsecond timer.
#[derive(Clone, Copy, Debug)]
pub struct Timer;

impl Clock for Timer {
    fn now(&mut self) -> Micros {
        Micros(Instant::now().as_micros())
    }

    fn wait_until(&mut self, due: Micros) -> Micros {
        loop {
            let now = self.now();
            if now >= due {
                return now;
            }
            core::hint::spin_loop();
        }
    }
}

/// The chip's watchdog.
pub struct Dog {
    watchdog: embassy_rp::watchdog::Watchdog,
    timeout: Duration,
}

impl Dog {
    /// Starts the watchdog with time enough to boot, and says so if it was what reset the chip.
    pub fn guarding_boot(peripheral: Peri<'static, WATCHDOG>) -> Self {
        let mut watchdog = embassy_rp::watchdog::Watchdog::new(peripheral);
        if watchdog.reset_reason().is_some() {
            defmt::warn!("the watchdog reset the board");
        }
        watchdog.start(BOOT);
        Self { watchdog, timeout: BOOT }
    }
}

impl Watchdog for Dog {
    fn start(&mut self, timeout: u64) {
        // The counter has 24 bits.
        self.timeout = Duration::from_micros(timeout.min(0x00ff_ffff));
        self.watchdog.start(self.timeout);
    }

    fn feed(&mut self) {
        self.watchdog.feed(self.timeout);
    }
}

/// Says what is wrong with the calibration that the program was built with, for ever; nothing moves.
pub fn halt(error: CalibrationError) -> ! {
    defmt::error!("not driving: {}", defmt::Display2Format(&error));
    loop {
        cortex_m::asm::wfi();
    }
}

/// Reports the panic and resets the chip: booting stops the motor before anything else.
#[panic_handler]
fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
    defmt::error!("panic: {}", defmt::Display2Format(info));
    SCB::sys_reset()
}

#[exception]
unsafe fn HardFault(frame: &ExceptionFrame) -> ! {
    defmt::error!(
        "hard fault at pc {=u32:#010x}, called from {=u32:#010x}",
        frame.pc(),
        frame.lr()
    );
    SCB::sys_reset()
}

#[exception]
unsafe fn DefaultHandler(interrupt: i16) -> ! {
    defmt::error!("interrupt {=i16} has no handler", interrupt);
    SCB::sys_reset()
}

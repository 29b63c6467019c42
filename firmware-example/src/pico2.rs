//! What the Raspberry Pi Pico 2 brings besides pins: its calibration, time, watchdog and log.

mod fail_safe;

pub(crate) use fail_safe::fail;

use crate::calibration::{Calibration, CalibrationError};
use crate::clock::{Clock, Micros, Watchdog};
use crate::drivers::target_beacon::Receivers;
use crate::drivers::tof_array::TofArray;
use crate::hardware::Hardware;
use crate::journal::DefmtLog;
// Linked for its global logger: defmt frames wait in memory for a debug probe.
use defmt_rtt as _;
use embassy_rp::Peri;
use embassy_rp::clocks::clk_sys_freq;
use embassy_rp::gpio::{Input, Output, OutputOpenDrain};
use embassy_rp::i2c::{Blocking, I2c};
use embassy_rp::peripherals::{I2C0, PIN_16, PIN_18, PWM_SLICE0, PWM_SLICE1, WATCHDOG};
use embassy_rp::pwm::{self, Pwm};
use embassy_time::{Delay, Duration, Instant};

defmt::timestamp!("{=u64:us}", Instant::now().as_micros());

/// What this car is like. Measure yours and write it here; then train with the same numbers.
pub const CALIBRATION: Calibration = Calibration::UNFITTED;

/// Booting may take this long: five sensors calibrate themselves.
const BOOT: Duration = Duration::from_secs(8);

/// The scratch register that outlives a reset and tells the next boot what it was for; 4 to 7 are the boot
/// loader's.
const MARK: usize = 0;
/// In [`MARK`] from boot on.
const RUNNING: u32 = 0x6461_7274;
/// In [`MARK`] when the program itself asks for the reset.
const FAILED: u32 = 0x6661_696c;

/// The types of this car's parts.
#[derive(Clone, Copy, Debug)]
pub enum Pico2 {}

impl Hardware for Pico2 {
    type Sensors = TofArray<I2c<'static, I2C0, Blocking>, OutputOpenDrain<'static>, Delay>;
    type Beacon = Receivers<Input<'static>>;
    type Servo = Pwm<'static>;
    type Motor = Pwm<'static>;
    type Button = Input<'static>;
    type Lamp = Output<'static>;
    type Watchdog = Dog;
    type Journal = DefmtLog;
}

/// The steering servo's channel, without pulses yet. The types say which pin it is, here and when the
/// program fails.
pub fn servo(slice: Peri<'static, PWM_SLICE0>, pin: Peri<'static, PIN_16>) -> Pwm<'static> {
    Pwm::new_output_a(slice, pin, frames(CALIBRATION.servo.frame))
}

/// The speed controller's channel, in the same way.
pub fn motor(slice: Peri<'static, PWM_SLICE1>, pin: Peri<'static, PIN_18>) -> Pwm<'static> {
    Pwm::new_output_a(slice, pin, frames(CALIBRATION.motor.frame))
}

/// One count a microsecond, one round a frame.
fn frames(microseconds: u16) -> pwm::Config {
    let mut config = pwm::Config::default();
    // 150 MHz: fits the divider.
    config.divider = u8::try_from(clk_sys_freq() / 1_000_000).unwrap_or(u8::MAX).into();
    config.top = microseconds.saturating_sub(1);
    config
}

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
        // The boot loader ends a download with the same reset, and leaves no mark of ours.
        match (watchdog.reset_reason(), watchdog.get_scratch(MARK)) {
            (Some(_), FAILED) => defmt::warn!("the program failed and reset the board"),
            (Some(_), RUNNING) => defmt::warn!("the watchdog reset the board"),
            _ => {}
        }
        watchdog.set_scratch(MARK, RUNNING);
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
    defmt::error!("not driving: {}", error);
    loop {
        cortex_m::asm::wfi();
    }
}

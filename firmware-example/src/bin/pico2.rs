//! Raspberry Pi Pico 2: the car. Wiring table and parts list in `boards/pico2/README.md`.
#![no_std]
#![no_main]

use controller_core::observation::BEAMS;
use embassy_rp::gpio::{Input, Level, Output, OutputOpenDrain, Pull};
use embassy_rp::i2c::{self, I2c};
use embassy_time::Delay;
use firmware_example::app::{self, Car, Parts};
use firmware_example::brain::{HIDDEN, OUTPUTS};
use firmware_example::drivers::target_beacon::Receivers;
use firmware_example::drivers::tof_array::TofArray;
use firmware_example::journal::DefmtLog;
use firmware_example::pico2::{self, Dog, Pico2, Timer};
use firmware_example::weights_region;

#[cortex_m_rt::entry]
fn main() -> ! {
    let p = embassy_rp::init(embassy_rp::config::Config::default());
    let calibration = match pico2::CALIBRATION.check() {
        Ok(checked) => checked,
        Err(error) => pico2::halt(error),
    };

    let servo = pico2::servo(p.PWM_SLICE0, p.PIN_16);
    let motor = pico2::motor(p.PWM_SLICE1, p.PIN_18);

    // Reset here too if the sensors' bus hangs at boot.
    let watchdog = Dog::guarding_boot(p.WATCHDOG);
    let mut fast = i2c::Config::default();
    fast.frequency = 400_000;
    let bus = I2c::new_blocking(p.I2C0, p.PIN_5, p.PIN_4, fast);
    let shutdown: [OutputOpenDrain<'_>; BEAMS] = [
        OutputOpenDrain::new(p.PIN_6, Level::Low),
        OutputOpenDrain::new(p.PIN_7, Level::Low),
        OutputOpenDrain::new(p.PIN_8, Level::Low),
        OutputOpenDrain::new(p.PIN_9, Level::Low),
        OutputOpenDrain::new(p.PIN_10, Level::Low),
    ];
    let receivers: [Input<'_>; BEAMS] = [
        Input::new(p.PIN_11, Pull::Up),
        Input::new(p.PIN_12, Pull::Up),
        Input::new(p.PIN_13, Pull::Up),
        Input::new(p.PIN_14, Pull::Up),
        Input::new(p.PIN_15, Pull::Up),
    ];
    let parts = Parts {
        sensors: TofArray::new(bus, shutdown, Delay),
        beacon: Receivers(receivers),
        servo,
        motor,
        button: Input::new(p.PIN_22, Pull::Up),
        lamp: Output::new(p.PIN_25, Level::Low),
        watchdog,
        journal: DefmtLog,
    };
    let mut timer = Timer;
    let region = weights_region::bytes();
    let car = Car::<Pico2, HIDDEN, OUTPUTS>::boot(parts, &calibration, region, &mut timer);
    app::run(car, &mut timer)
}

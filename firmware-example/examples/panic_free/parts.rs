//! A car whose parts answer anything at all, errors included.

use controller_core::observation::BEAMS;
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{self, InputPin, OutputPin};
use embedded_hal::i2c::{self, I2c, Operation};
use embedded_hal::pwm::{self, SetDutyCycle};
use firmware_example::app::Parts;
use firmware_example::clock::{Clock, Micros, Watchdog};
use firmware_example::drivers::target_beacon::Receivers;
use firmware_example::drivers::tof_array::TofArray;
use firmware_example::hardware::Hardware;
use firmware_example::journal::{Event, Journal};

use crate::memory::Memory;

/// The types of the car's parts.
pub(crate) struct Bench;

impl Hardware for Bench {
    type Sensors = TofArray<Bus, Pin, Timer>;
    type Beacon = Receivers<Pin>;
    type Servo = Pwm;
    type Motor = Pwm;
    type Button = Pin;
    type Lamp = Pin;
    type Watchdog = Dog;
    type Journal = Log;
}

/// The parts, each in memory of its own.
pub(crate) fn parts() -> Parts<Bench> {
    let pins = |first: usize| -> [Pin; BEAMS] { core::array::from_fn(|i| pin(first + i)) };
    Parts {
        sensors: TofArray::new(Bus(Memory::part(0)), pins(1), Timer),
        beacon: Receivers(pins(6)),
        servo: Pwm(Memory::part(11)),
        motor: Pwm(Memory::part(12)),
        button: pin(13),
        lamp: pin(14),
        watchdog: Dog(Memory::part(15)),
        journal: Log(Memory::part(16)),
    }
}

fn pin(index: usize) -> Pin {
    Pin(Memory::part(index))
}

pub(crate) struct Bus(Memory);

impl i2c::ErrorType for Bus {
    type Error = i2c::ErrorKind;
}

impl I2c for Bus {
    fn transaction(
        &mut self,
        address: u8,
        operations: &mut [Operation<'_>],
    ) -> Result<(), i2c::ErrorKind> {
        self.0.write(address.into());
        for operation in operations {
            match operation {
                Operation::Read(bytes) => bytes.fill_with(|| self.0.read() as u8),
                Operation::Write(bytes) => {
                    bytes.iter().for_each(|byte| self.0.write((*byte).into()))
                }
            }
        }
        match self.0.read() {
            0 => Ok(()),
            1 => Err(i2c::ErrorKind::Bus),
            2 => Err(i2c::ErrorKind::ArbitrationLoss),
            3 => Err(i2c::ErrorKind::NoAcknowledge(i2c::NoAcknowledgeSource::Unknown)),
            4 => Err(i2c::ErrorKind::Overrun),
            _ => Err(i2c::ErrorKind::Other),
        }
    }
}

pub(crate) struct Pin(Memory);

impl Pin {
    fn answer(&self) -> Result<u32, digital::ErrorKind> {
        match self.0.read() {
            0 => Err(digital::ErrorKind::Other),
            level => Ok(level),
        }
    }
}

impl digital::ErrorType for Pin {
    type Error = digital::ErrorKind;
}

impl InputPin for Pin {
    fn is_high(&mut self) -> Result<bool, digital::ErrorKind> {
        self.is_low().map(|low| !low)
    }

    fn is_low(&mut self) -> Result<bool, digital::ErrorKind> {
        self.answer().map(|level| level == 1)
    }
}

impl OutputPin for Pin {
    fn set_low(&mut self) -> Result<(), digital::ErrorKind> {
        self.0.write(0);
        self.answer().map(|_| ())
    }

    fn set_high(&mut self) -> Result<(), digital::ErrorKind> {
        self.0.write(1);
        self.answer().map(|_| ())
    }
}

pub(crate) struct Pwm(Memory);

impl pwm::ErrorType for Pwm {
    type Error = pwm::ErrorKind;
}

impl SetDutyCycle for Pwm {
    fn max_duty_cycle(&self) -> u16 {
        self.0.read() as u16
    }

    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), pwm::ErrorKind> {
        self.0.write(duty.into());
        if self.0.read() == 0 { Ok(()) } else { Err(pwm::ErrorKind::Other) }
    }
}

/// A clock that may jump in both directions.
pub(crate) struct Timer;

impl Clock for Timer {
    fn now(&mut self) -> Micros {
        let clock = Memory::part(17);
        Micros(u64::from(clock.read()) << 32 | u64::from(clock.read_next()))
    }

    fn wait_until(&mut self, due: Micros) -> Micros {
        Memory::part(17).keep(due);
        self.now()
    }
}

impl DelayNs for Timer {
    fn delay_ns(&mut self, nanoseconds: u32) {
        Memory::part(17).write(nanoseconds);
    }
}

pub(crate) struct Dog(Memory);

impl Watchdog for Dog {
    fn start(&mut self, timeout: u64) {
        self.0.keep(timeout);
    }

    fn feed(&mut self) {
        self.0.write(1);
    }
}

pub(crate) struct Log(Memory);

impl Journal for Log {
    fn note(&mut self, event: Event) {
        self.0.keep(event);
    }
}

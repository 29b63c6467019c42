//! A bus that passes on no number the set-up of a VL53L0X would divide by zero with.
//!
//! The `vl53l0x` crate computes time-outs from two laser pulse periods that it reads from the sensor. A
//! bus whose data line hangs high reads 255, which the crate takes for a period of 0, and panics.

use super::rangefinder::{BusFault, SensorFault};
use core::fmt;
use core::ops::RangeInclusive;
use embedded_hal::i2c::{self, I2c, Operation};

/// PRE_RANGE_CONFIG_VCSEL_PERIOD and FINAL_RANGE_CONFIG_VCSEL_PERIOD.
const PULSE_PERIODS: [u8; 2] = [0x50, 0x70];

/// What they hold for the periods of 8 to 18 clocks that ST's driver allows.
const PLAUSIBLE: RangeInclusive<u8> = 3..=8;

/// A bus with a VL53L0X on it.
pub(super) struct PlausibleBus<'a, B>(pub(super) &'a mut B);

/// Why the bus did not deliver.
pub(super) enum Fault<E> {
    /// It failed.
    Bus(E),
    /// It delivered what no sensor would say.
    Implausible {
        /// The register that was read.
        register: u8,
        /// What was read.
        found: u8,
    },
}

impl<B: I2c> PlausibleBus<'_, B> {
    fn check(register: &[u8], value: &[u8]) -> Result<(), Fault<B::Error>> {
        match (register, value) {
            (&[register], &[found])
                if PULSE_PERIODS.contains(&register) && !PLAUSIBLE.contains(&found) =>
            {
                Err(Fault::Implausible { register, found })
            }
            _ => Ok(()),
        }
    }
}

impl<B: I2c> i2c::ErrorType for PlausibleBus<'_, B> {
    type Error = Fault<B::Error>;
}

impl<B: I2c> I2c for PlausibleBus<'_, B> {
    // The driver writes and reads in one call; inlined, the check tells the compiler what the value can be.
    #[inline(always)]
    fn write_read(
        &mut self,
        address: u8,
        write: &[u8],
        read: &mut [u8],
    ) -> Result<(), Self::Error> {
        self.0.write_read(address, write, read).map_err(Fault::Bus)?;
        Self::check(write, read)
    }

    fn transaction(
        &mut self,
        address: u8,
        operations: &mut [Operation<'_>],
    ) -> Result<(), Self::Error> {
        self.0.transaction(address, operations).map_err(Fault::Bus)?;
        match operations {
            [Operation::Write(write), Operation::Read(read)] => Self::check(write, read),
            _ => Ok(()),
        }
    }
}

impl<E: i2c::Error> i2c::Error for Fault<E> {
    fn kind(&self) -> i2c::ErrorKind {
        match self {
            Self::Bus(error) => error.kind(),
            Self::Implausible { .. } => i2c::ErrorKind::Other,
        }
    }
}

impl<E: fmt::Debug> fmt::Debug for Fault<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bus(error) => error.fmt(f),
            Self::Implausible { register, found } => write!(f, "{register:#04x}: {found}"),
        }
    }
}

impl<E: i2c::Error> From<Fault<E>> for SensorFault {
    fn from(fault: Fault<E>) -> Self {
        match fault {
            Fault::Bus(error) => Self::Bus(BusFault::from(error.kind())),
            Fault::Implausible { register, found } => Self::Implausible { register, found },
        }
    }
}

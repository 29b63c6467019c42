//! What range sensors report, and how they fail.

use controller_core::observation::BEAMS;
use embedded_hal::i2c;

/// One measurement. Nearer is smaller; nothing is further than everything.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Range {
    /// A surface at this many millimetres.
    At(u16),
    /// No surface that sends enough light back.
    Nothing,
}

/// Five range sensors, one per beam, each measuring on its own.
pub trait RangeFinders {
    /// Finds and starts all sensors. Called once, before the watchdog runs: it may take a second.
    ///
    /// # Errors
    ///
    /// The first sensor that could not be started, and why.
    fn start(&mut self) -> Result<(), StartError>;

    /// The measurement that this beam's sensor has finished since the last call, if any. Does
    /// not wait.
    ///
    /// # Errors
    ///
    /// Why the sensor cannot be read, or what it says is wrong with it.
    fn take(&mut self, beam: usize) -> Result<Option<Range>, SensorFault>;
}

/// What is wrong with one sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SensorFault {
    /// The bus between the sensor and us.
    Bus(BusFault),
    /// Something answers that is no VL53L0X.
    OtherDevice {
        /// Its identity.
        found: u8,
        /// A VL53L0X's identity.
        expected: u8,
    },
    /// It did not finish its own calibration.
    Timeout,
    /// It reports a fault of its laser or its supply.
    Hardware {
        /// The sensor's status code.
        status: u8,
    },
    /// It said something that no VL53L0X says.
    Implausible {
        /// The register that was read.
        register: u8,
        /// What was read.
        found: u8,
    },
    /// There is no sensor for this beam.
    NoSuchBeam,
}

controller_core::sentences! { SensorFault {
    Self::Bus(fault) => "{}", fault;
    Self::OtherDevice { found, expected } =>
        "another device answers: identity {:#04x}, {:#04x} expected", found, expected;
    Self::Timeout => "it did not finish its calibration";
    Self::Hardware { status } => "it reports a hardware fault, status {}", status;
    Self::Implausible { register, found } =>
        "its register {:#04x} reads {}, which no VL53L0X says", register, found;
    Self::NoSuchBeam => "there is no such beam";
} }

impl core::error::Error for SensorFault {}

/// What went wrong on an I²C bus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BusFault {
    /// Nobody acknowledged: the device is off, missing, or at another address.
    NoAnswer,
    /// Another master won the bus.
    Arbitration,
    /// A start or stop in the wrong place: usually a loose wire or a missing pull-up.
    Wiring,
    /// Data came faster than it was fetched.
    Overrun,
    /// A cause that `embedded-hal` has no name for, such as the driver's own time-out.
    Other,
}

impl From<i2c::ErrorKind> for BusFault {
    fn from(kind: i2c::ErrorKind) -> Self {
        match kind {
            i2c::ErrorKind::NoAcknowledge(_) => Self::NoAnswer,
            i2c::ErrorKind::ArbitrationLoss => Self::Arbitration,
            i2c::ErrorKind::Bus => Self::Wiring,
            i2c::ErrorKind::Overrun => Self::Overrun,
            _ => Self::Other,
        }
    }
}

controller_core::sentences! { BusFault {
    Self::NoAnswer => "it does not answer";
    Self::Arbitration => "another master took the bus";
    Self::Wiring => "the bus is disturbed: check its wires and pull-ups";
    Self::Overrun => "the bus overran";
    Self::Other => "the bus driver gave up";
} }

/// Why the five sensors could not be started.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StartError {
    /// A sensor's shutdown line could not be driven.
    ShutdownLine {
        /// Index of the beam, rightmost is 0.
        beam: usize,
    },
    /// Something answers although every sensor is held in reset: a shutdown line is not
    /// connected, or another device has this address.
    NotInReset {
        /// The address that answers.
        address: u8,
    },
    /// A sensor does not start, or is gone when all others have started.
    Sensor {
        /// Index of the beam, rightmost is 0.
        beam: usize,
        /// Why.
        fault: SensorFault,
    },
}

controller_core::sentences! { StartError {
    Self::ShutdownLine { beam } =>
        "beam {} of 0 to {}: cannot drive its shutdown line", beam, BEAMS - 1;
    Self::NotInReset { address } =>
        "address {:#04x} answers while all sensors are in reset: check the shutdown lines", address;
    Self::Sensor { beam, fault } => "beam {} of 0 to {}: {}", beam, BEAMS - 1, fault;
} }

impl core::error::Error for StartError {}

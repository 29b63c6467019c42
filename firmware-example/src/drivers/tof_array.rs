//! Five VL53L0X time-of-flight sensors on one I²C bus.
//!
//! Every VL53L0X wakes up at the same address. So all are held in reset by their shutdown lines
//! (XSHUT), then released one by one; each is set up, given its own address and asked for its
//! identity there, before the next may wake. In the end all are asked once more.
//!
//! Setting up is left to the `vl53l0x` crate. Reading is done here, because that crate's reading
//! leaves out the status of a measurement: without it a reflection from beyond the sensor's
//! unambiguous range looks like a near wall.

use super::plausible_bus::{Fault, PlausibleBus};
use super::rangefinder::{BusFault, Range, RangeFinders, SensorFault, StartError};
use controller_core::observation::BEAMS;
use embedded_hal::delay::DelayNs;
use embedded_hal::digital::OutputPin;
use embedded_hal::i2c::I2c;
use vl53l0x::VL53L0x;

/// Where a VL53L0X wakes up.
pub const DEFAULT_ADDRESS: u8 = 0x29;

/// Where the beams' sensors are after [`RangeFinders::start`], rightmost first.
pub const ADDRESSES: [u8; BEAMS] = [0x30, 0x31, 0x32, 0x33, 0x34];

/// What a VL53L0X says at [`IDENTITY`].
const MODEL: u8 = 0xee;

/// Distances from here on are codes for "nothing" (8190 and 8191 millimetres).
const FIRST_CODE: u16 = 8190;

// Registers, by the names in ST's driver.
/// IDENTIFICATION_MODEL_ID.
const IDENTITY: u8 = 0xc0;
/// RESULT_INTERRUPT_STATUS: its low three bits are set while a measurement waits.
const WAITING: u8 = 0x13;
/// RESULT_RANGE_STATUS, first of the twelve bytes of a result.
const RESULT: u8 = 0x14;
/// SYSTEM_INTERRUPT_CLEAR.
const TAKEN: u8 = 0x0b;

/// Reset lasts this long, and so does waking up (at most 1.2 ms by the data sheet), milliseconds.
const RESET: u32 = 2;

/// Five sensors on one bus with their shutdown lines, rightmost first.
#[derive(Debug)]
pub struct TofArray<B, X, D> {
    bus: B,
    shutdown: [X; BEAMS],
    delay: D,
}

impl<B: I2c, X: OutputPin, D: DelayNs> TofArray<B, X, D> {
    /// The sensors on this bus, none of them started. A shutdown line is low to hold its sensor
    /// in reset; on boards without a level shifter it must be open-drain.
    pub fn new(bus: B, shutdown: [X; BEAMS], delay: D) -> Self {
        Self { bus, shutdown, delay }
    }

    fn hold_all(&mut self) -> Result<(), StartError> {
        for (beam, line) in self.shutdown.iter_mut().enumerate() {
            line.set_low().map_err(|_| StartError::ShutdownLine { beam })?;
        }
        self.delay.delay_ms(RESET);
        for address in core::iter::once(DEFAULT_ADDRESS).chain(ADDRESSES) {
            if self.identity(address).is_ok() {
                return Err(StartError::NotInReset { address });
            }
        }
        Ok(())
    }

    fn set_up(&mut self, address: u8) -> Result<(), SensorFault> {
        let mut sensor = VL53L0x::new(PlausibleBus(&mut self.bus)).map_err(set_up_fault)?;
        sensor.set_address(address).map_err(set_up_fault)?;
        // Back to back: the next measurement begins when one ends, about every 33 ms.
        sensor.start_continuous(0)?;
        self.identify(address)
    }

    fn identify(&mut self, address: u8) -> Result<(), SensorFault> {
        match self.identity(address)? {
            MODEL => Ok(()),
            found => Err(SensorFault::OtherDevice { found, expected: MODEL }),
        }
    }

    fn identity(&mut self, address: u8) -> Result<u8, SensorFault> {
        let mut identity = [0];
        self.bus.write_read(address, &[IDENTITY], &mut identity).map_err(bus_fault)?;
        let [identity] = identity;
        Ok(identity)
    }
}

impl<B: I2c, X: OutputPin, D: DelayNs> RangeFinders for TofArray<B, X, D> {
    fn start(&mut self) -> Result<(), StartError> {
        self.hold_all()?;
        for (beam, address) in ADDRESSES.into_iter().enumerate() {
            let line = self.shutdown.get_mut(beam);
            let line = line.ok_or(StartError::ShutdownLine { beam })?;
            line.set_high().map_err(|_| StartError::ShutdownLine { beam })?;
            self.delay.delay_ms(RESET);
            self.set_up(address).map_err(|fault| StartError::Sensor { beam, fault })?;
        }
        // Once more: a weak supply may have cost an earlier sensor its address meanwhile.
        for (beam, address) in ADDRESSES.into_iter().enumerate() {
            self.identify(address).map_err(|fault| StartError::Sensor { beam, fault })?;
        }
        Ok(())
    }

    fn take(&mut self, beam: usize) -> Result<Option<Range>, SensorFault> {
        let address = *ADDRESSES.get(beam).ok_or(SensorFault::NoSuchBeam)?;
        let mut waiting = [0];
        self.bus.write_read(address, &[WAITING], &mut waiting).map_err(bus_fault)?;
        if waiting[0] & 0x07 == 0 {
            return Ok(None);
        }
        let mut result = [0; 12];
        self.bus.write_read(address, &[RESULT], &mut result).map_err(bus_fault)?;
        self.bus.write(address, &[TAKEN, 1]).map_err(bus_fault)?;
        let [status, .., high, low] = result;
        measurement((status >> 3) & 0x0f, u16::from_be_bytes([high, low]))
    }
}

/// A measurement by its device status (ST's driver, `VL53L0X_get_pal_range_status`).
fn measurement(status: u8, millimetres: u16) -> Result<Option<Range>, SensorFault> {
    match status {
        // The laser does not shine or shines too much.
        1..=3 => Err(SensorFault::Hardware { status }),
        // Too little light, or a reflection from beyond the unambiguous range.
        4 | 6 | 9 => Ok(Some(Range::Nothing)),
        // Nearer than the sensor can measure: the worst case is touching.
        8 | 10 => Ok(Some(Range::At(0))),
        11 if millimetres >= FIRST_CODE => Ok(Some(Range::Nothing)),
        11 => Ok(Some(Range::At(millimetres))),
        // No measurement was made; if that lasts, the beam counts as silent.
        _ => Ok(None),
    }
}

fn bus_fault<E: embedded_hal::i2c::Error>(error: E) -> SensorFault {
    SensorFault::Bus(BusFault::from(error.kind()))
}

fn set_up_fault<E: embedded_hal::i2c::Error>(error: vl53l0x::Error<Fault<E>>) -> SensorFault {
    match error {
        vl53l0x::Error::InvalidDevice(found) => SensorFault::OtherDevice { found, expected: MODEL },
        vl53l0x::Error::BusError(fault) => fault.into(),
        vl53l0x::Error::Timeout | vl53l0x::Error::InvalidAddress(_) => SensorFault::Timeout,
    }
}

//! What the car says about itself, as events; a board sends them to its log.

use crate::chassis::ActuatorFault;
use crate::drivers::rangefinder::{SensorFault, StartError};
use crate::odometry::Odometry;
use crate::weights::Refusal;
use controller_core::controller::Command;
use controller_core::observation::ReadingError;
use core::fmt;

/// Something worth a line in the log.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Event {
    /// The weights in flash are good.
    Weights {
        /// Their check, a name for these exact weights.
        check: u64,
        /// Their control period, microseconds.
        period: u64,
    },
    /// The car will not drive with what lies in its weights region.
    Refused(Refusal),
    /// All range sensors run.
    Sensors,
    /// The range sensors could not be started.
    NoSensors(StartError),
    /// The button was held long enough and let go.
    Armed,
    /// The button was pressed.
    Disarmed {
        /// Where the drive ended, as far as the car knows.
        believed: Odometry,
    },
    /// The button cannot be read; the car is disarmed.
    NoButton,
    /// A good reading after bad ones.
    Recovered,
    /// A bad reading: the car stands until readings are good again.
    Stopped(ReadingError),
    /// What is wrong with one sensor.
    Sensor {
        /// Index of the beam, rightmost is 0.
        beam: usize,
        /// What.
        fault: SensorFault,
    },
    /// There was no good reading for too long; the car is disarmed until it is restarted.
    SensorsLost,
    /// An actuator refused: the car is disarmed, and the watchdog will reset it.
    Actuator(ActuatorFault),
    /// A control period began too late.
    Late {
        /// By how many microseconds.
        by: u64,
    },
    /// The button was held to restart the car: the watchdog will do it.
    Restarting,
    /// What the car does, about once a second.
    Driving {
        /// Control periods since it was armed.
        step: u32,
        /// The command in force.
        command: Command,
        /// Where it is, as far as it knows.
        believed: Odometry,
    },
}

impl Event {
    /// Whether somebody has to do something about it.
    pub fn is_fault(&self) -> bool {
        !matches!(
            self,
            Self::Weights { .. }
                | Self::Sensors
                | Self::Armed
                | Self::Disarmed { .. }
                | Self::Recovered
                | Self::Restarting
                | Self::Driving { .. }
        )
    }
}

impl fmt::Display for Event {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Weights { check, period } => {
                write!(f, "weights {check:016x}, a decision every {period} µs")
            }
            Self::Refused(refusal) => write!(f, "not driving: {refusal}"),
            Self::Sensors => f.write_str("all range sensors run"),
            Self::NoSensors(error) => write!(f, "not driving: {error}"),
            Self::Armed => f.write_str("armed"),
            Self::Disarmed { believed } => write!(f, "disarmed: {believed}"),
            Self::NoButton => f.write_str("disarmed: the button cannot be read"),
            Self::Recovered => f.write_str("readings are good again"),
            Self::Stopped(error) => write!(f, "stopped: {error}"),
            Self::Sensor { beam, fault } => write!(f, "beam {beam}: {fault}"),
            Self::SensorsLost => {
                f.write_str("disarmed: no good reading for too long; hold the button to restart")
            }
            Self::Actuator(fault) => write!(f, "disarmed, waiting for the watchdog: {fault}"),
            Self::Late { by } => write!(f, "a control period began {by} µs late"),
            Self::Restarting => f.write_str("restarting"),
            Self::Driving { step, command, believed } => write!(
                f,
                "step {step}: steer {:.0}°, {:.3} m a step; {believed}",
                command.steer.radians().to_degrees(),
                command.step.metres()
            ),
        }
    }
}

/// Something that keeps events.
pub trait Journal {
    /// Keeps one.
    fn note(&mut self, event: Event);
}

/// Sends events to the defmt log of the board: faults as warnings, the rest as information.
#[cfg(feature = "defmt")]
#[derive(Clone, Copy, Debug, Default)]
pub struct DefmtLog;

#[cfg(feature = "defmt")]
impl Journal for DefmtLog {
    fn note(&mut self, event: Event) {
        let text = defmt::Display2Format(&event);
        if event.is_fault() { defmt::warn!("{}", text) } else { defmt::info!("{}", text) }
    }
}

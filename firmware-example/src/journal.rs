//! What the car says about itself, as events; a board sends them to its log.

use crate::chassis::ActuatorFault;
use crate::drivers::rangefinder::{SensorFault, StartError};
use crate::figures::{degrees, rounded};
use crate::odometry::Odometry;
use crate::weights::Refusal;
use controller_core::controller::Command;
use controller_core::observation::ReadingError;

/// Something worth a line in the log.
#[derive(Clone, Copy, Debug, PartialEq)]
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

controller_core::sentences! { Event {
    Self::Weights { check, period } =>
        "weights {:016x}, a decision every {} µs", check, period;
    Self::Refused(refusal) => "not driving: {}", refusal;
    Self::Sensors => "all range sensors run";
    Self::NoSensors(error) => "not driving: {}", error;
    Self::Armed => "armed";
    Self::Disarmed { believed } => "disarmed: {}", believed;
    Self::NoButton => "disarmed: the button cannot be read";
    Self::Recovered => "readings are good again";
    Self::Stopped(error) => "stopped: {}", error;
    Self::Sensor { beam, fault } => "beam {}: {}", beam, fault;
    Self::SensorsLost =>
        "disarmed: no good reading for too long; hold the button to restart";
    Self::Actuator(fault) => "disarmed, waiting for the watchdog: {}", fault;
    Self::Late { by } => "a control period began {} µs late", by;
    Self::Restarting => "restarting";
    Self::Driving { step, command, believed } =>
        "step {}: steer {}°, {} m a step; {}",
        step, degrees(command.steer.radians()), rounded(command.step.metres(), 1000.0), believed;
} }

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
        if event.is_fault() { defmt::warn!("{}", event) } else { defmt::info!("{}", event) }
    }
}

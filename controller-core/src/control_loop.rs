//! One control period, written once for simulator, recording and board.

use crate::controller::Command;
use crate::observation::{Reading, ReadingError};
use core::fmt;

/// Something that reports what the beams see.
pub trait Sense {
    /// Reads all beams once.
    ///
    /// # Errors
    ///
    /// What is wrong with the reading; the car stops for it.
    fn sense(&mut self) -> Result<Reading, ReadingError>;
}

/// Something that steers and drives.
pub trait Actuate {
    /// Why the hardware refused.
    type Error;

    /// Makes the car do this until the next call.
    ///
    /// # Errors
    ///
    /// Whatever the hardware reports.
    fn actuate(&mut self, command: Command) -> Result<(), Self::Error>;
}

/// Something that decides: a [`Controller`](crate::controller::Controller) of any size.
pub trait Decide {
    /// Decides on one reading, or stops on the lack of one.
    fn decide(&mut self, reading: Result<&Reading, ReadingError>) -> Command;
}

/// What went wrong in one control period.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum TickError<E> {
    /// The reading was bad; the car has been told to stop.
    Sense(ReadingError),
    /// The command did not reach the hardware.
    Actuate(E),
}

impl<E: fmt::Display> fmt::Display for TickError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sense(error) => write!(f, "stopped: {error}"),
            Self::Actuate(error) => write!(f, "the actuator refused: {error}"),
        }
    }
}

impl<E: fmt::Debug + fmt::Display> core::error::Error for TickError<E> {}

/// Senses, decides and acts once.
///
/// # Errors
///
/// A bad reading is reported after the car has been told to stop, so no error leaves the
/// previous command in force.
#[inline]
pub fn tick<C, D>(car: &mut C, controller: &mut D) -> Result<Command, TickError<C::Error>>
where
    C: Sense + Actuate,
    D: Decide + ?Sized,
{
    let reading = car.sense();
    let command = controller.decide(reading.as_ref().map_err(|error| *error));
    car.actuate(command).map_err(TickError::Actuate)?;
    reading.map(|_| command).map_err(TickError::Sense)
}

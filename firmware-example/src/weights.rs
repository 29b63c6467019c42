//! From a region of flash to a controller that may drive this car, or the reason why not.
//!
//! The weights lie outside the program, in flash of their own. They are checked and tested
//! where they lie and never copied.

use crate::brain::{self, Brain};
use crate::calibration::Checked;
use crate::fit::{self, Misfit};
use controller_core::blob::Blob;

/// Why the car does not drive with what lies in its weights region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Refusal {
    /// No car could drive with them.
    Unusable(brain::Refusal),
    /// The weights were trained for another car.
    Misfit(Misfit),
}

controller_core::sentences! { Refusal {
    Self::Unusable(error) => "{}", error;
    Self::Misfit(error) => "{}", error;
} }

impl core::error::Error for Refusal {}

impl From<brain::Refusal> for Refusal {
    fn from(refusal: brain::Refusal) -> Self {
        Self::Unusable(refusal)
    }
}

/// Reads the blob at the start of a region, runs its self-test on this machine, and compares
/// the car it was trained for with this one. The region must start at a multiple of 4 bytes
/// and may go on after the blob.
///
/// # Errors
///
/// The first reason not to drive with it.
pub fn load<'w, const H: usize, const O: usize>(
    region: &'w [u8],
    car: &Checked,
) -> Result<Brain<'w, H, O>, Refusal> {
    let blob = Blob::parse_prefix(region).map_err(brain::Refusal::Blob)?;
    let brain = Brain::new(&blob)?;
    fit::check(blob.header(), car).map_err(Refusal::Misfit)?;
    Ok(brain)
}

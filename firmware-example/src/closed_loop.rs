//! Drives with the weights in flash: a drive through the room, boiled down to one number.

use crate::brain::{Brain, HIDDEN, OUTPUTS, Refusal};
use controller_core::blob::Blob;
use crc::{CRC_64_XZ, Crc, NoTable};
use equivalence_tests::closed_loop::ClosedLoop;
use equivalence_tests::course::Course;

const DIGEST: Crc<u64, NoTable> = Crc::<u64, NoTable>::new(&CRC_64_XZ);

/// A drive in the room, boiled down to what two machines compare.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Drive {
    /// Check of the blob that drove.
    pub weights: u64,
    /// CRC-64/XZ over the bits of every step: command, outputs, both hidden layers, pose after it;
    /// each value as a little-endian word.
    pub digest: u64,
}

/// Drives so many steps with the blob at the start of `region`, which must start at a multiple of 4 bytes.
///
/// The car is the one the blob describes; every few steps it is put elsewhere in the room.
///
/// # Errors
///
/// Why the weights cannot be used; then nothing is driven.
pub fn drive(region: &[u8], steps: u32) -> Result<Drive, Refusal> {
    let blob = Blob::parse_prefix(region).map_err(Refusal::Blob)?;
    let mut brain = Brain::<HIDDEN, OUTPUTS>::new(&blob)?;
    let mut car = ClosedLoop::new(blob.header(), Course::Tour);
    let mut digest = DIGEST.digest();
    for _ in 0..steps {
        for word in car.step(&mut brain) {
            digest.update(&word.to_le_bytes());
        }
    }
    Ok(Drive { weights: blob.check(), digest: digest.finalize() })
}

//! Drives a car through the room: what it does decides what it sees next, so one differing bit grows.

use crate::brain::{Brain, HIDDEN, OUTPUTS, Refusal};
use crate::room;
use controller_core::blob::{Blob, Header};
use controller_core::control_loop::{Actuate, Sense, tick};
use controller_core::controller::Command;
use controller_core::motion::Pose;
use controller_core::observation::{Reading, ReadingError};
use core::convert::Infallible;
use crc::{CRC_64_XZ, Crc, NoTable};

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
    let mut brain = Brain::new(&blob)?;
    Ok(Drive { weights: blob.check(), digest: digest(blob.header(), &mut brain, steps) })
}

fn digest(header: &Header, brain: &mut Brain<'_, HIDDEN, OUTPUTS>, steps: u32) -> u64 {
    let mut car = Car { header, pose: Pose::new(0.0, 0.0, 0.0) };
    let mut digest = DIGEST.digest();
    for step in 0..steps {
        car.pose = room::start(step).unwrap_or(car.pose);
        // A bad reading has already become a stop, and this actuator refuses nothing.
        let command = tick(&mut car, brain).unwrap_or(Command::STOP);
        let hidden = brain.state();
        let commanded = [command.steer.radians(), command.step.metres()];
        let reached = [car.pose.x, car.pose.y, car.pose.heading];
        let values: [&[f32]; 5] =
            [&commanded, brain.outputs(), &hidden.first, &hidden.second, &reached];
        for value in values.into_iter().flatten() {
            digest.update(&value.to_bits().to_le_bytes());
        }
    }
    digest.finalize()
}

/// A car in the room, built as the blob's header says.
struct Car<'a> {
    header: &'a Header,
    pose: Pose<f32>,
}

impl Sense for Car<'_> {
    fn sense(&mut self) -> Result<Reading, ReadingError> {
        let range = self.header.scaling.range;
        Reading::new(room::look(&self.pose, &self.header.beams, range), 0, range)
    }
}

impl Actuate for Car<'_> {
    type Error = Infallible;

    fn actuate(&mut self, command: Command) -> Result<(), Infallible> {
        self.pose = room::drive(&self.pose, command, self.header.wheelbase);
        Ok(())
    }
}

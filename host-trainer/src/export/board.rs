//! Boards whose flash is known: where weights go when nobody says otherwise.

use std::ops::Range;

use super::family::Family;
use super::placement::PlacementError;

/// A board, as far as writing weights to its flash goes.
#[derive(Debug, PartialEq, Eq)]
pub struct Board {
    /// What the maker calls it.
    pub name: &'static str,
    /// What probe-rs calls its chip.
    pub chip: &'static str,
    /// Label of the drive it shows in its boot loader.
    pub drive: &'static str,
    /// Addresses its boot loader accepts for flash. Smaller flash is seen several times over.
    pub flash: Range<u32>,
    /// Bytes that are erased together.
    pub sector: u32,
    /// Flash kept for weights: programs and other data stay out of it.
    pub weights: Range<u32>,
}

impl Board {
    /// Raspberry Pi Pico 2, RP2350 with 4 MiB of flash.
    ///
    /// The weights have the last 64 KiB but the very last sector: firmware files for the drive
    /// begin with a block that erases that one, as a cure for the chip's erratum RP2350-E10.
    pub const PICO_2: Self = Self {
        name: "Raspberry Pi Pico 2",
        chip: "RP235x",
        drive: "RP2350",
        flash: 0x1000_0000..0x1200_0000,
        sector: 4096,
        weights: 0x103f_0000..0x103f_f000,
    };

    /// Raspberry Pi Pico, RP2040 with 2 MiB of flash. The weights have its last 64 KiB.
    pub const PICO: Self = Self {
        name: "Raspberry Pi Pico",
        chip: "RP2040",
        drive: "RPI-RP2",
        flash: 0x1000_0000..0x1100_0000,
        sector: 4096,
        weights: 0x101f_0000..0x1020_0000,
    };

    /// Every board there is; the first is the one meant when none is named.
    pub const ALL: [&Self; 2] = [&Self::PICO_2, &Self::PICO];

    /// The board with this chip, if it is known. Case does not matter.
    pub fn of_chip(chip: &str) -> Option<&'static Self> {
        Self::ALL.into_iter().find(|board| board.chip.eq_ignore_ascii_case(chip))
    }

    /// The board that takes UF2 files of this family, if it is known.
    pub fn of_family(family: Family) -> Option<&'static Self> {
        match family.name()? {
            "rp2040" => Some(&Self::PICO),
            "absolute" | "data" => Some(&Self::PICO_2),
            name if name.starts_with("rp2350-") => Some(&Self::PICO_2),
            _ => None,
        }
    }

    /// The car that the shipped driving program for this board makes of it, if there is one.
    pub fn car(&self) -> Option<&'static ShippedCar> {
        (*self == Self::PICO_2).then_some(&ShippedCar::PICO_2)
    }

    /// Refuses an address where the shipped driving program does not look for weights.
    ///
    /// # Errors
    ///
    /// [`PlacementError::OutsideWeights`], which names [`Self::weights`].
    pub fn check_weights(&self, address: u32) -> Result<(), PlacementError> {
        if self.weights.contains(&address) {
            return Ok(());
        }
        let Range { start, end } = self.weights;
        Err(PlacementError::OutsideWeights { board: self.name, start, end })
    }

    /// Refuses a place that this board's boot loader would not write.
    ///
    /// # Errors
    ///
    /// Bytes outside of [`Self::flash`], or past the end of [`Self::weights`] when they
    /// begin inside.
    pub fn check(&self, address: u32, length: usize) -> Result<(), PlacementError> {
        let end = u64::from(address) + length as u64;
        let Range { start, end: flash_end } = self.flash;
        if address < start || end > u64::from(flash_end) {
            return Err(PlacementError::OutsideFlash { board: self.name, start, end: flash_end });
        }
        if self.weights.contains(&address) && end > u64::from(self.weights.end) {
            let room = (self.weights.end - address) as usize;
            return Err(PlacementError::NoRoom { board: self.name, length, room });
        }
        Ok(())
    }

    /// The whole sectors that writing these bytes erases first.
    pub fn erased(&self, address: u32, length: usize) -> Range<u64> {
        let sector = u64::from(self.sector);
        let start = u64::from(address) / sector * sector;
        start..(u64::from(address) + length as u64).next_multiple_of(sector)
    }
}

/// What the shipped driving program can do, before anybody fitted it to another car.
///
/// A copy of the numbers in the driving program's calibration (`firmware-example/src/calibration.rs`,
/// `brain.rs` and `fit.rs`), which decide: this crate only says in advance what the car
/// would refuse. A test holds the two together (`tests/tests/shipped_car.rs`).
#[derive(Debug, PartialEq)]
pub struct ShippedCar {
    /// Neurons in each hidden layer of the networks it has code for.
    pub hidden: usize,
    /// Outputs of the networks it has code for.
    pub outputs: usize,
    /// Shortest and longest control period it keeps, seconds.
    pub periods: (f32, f32),
    /// Furthest it steers to either side, radians.
    pub steer_limit: f32,
    /// Fastest it drives, metres per second.
    pub speed_limit: f32,
    /// Furthest its sensors see, metres.
    pub range: f32,
    /// Front axle to rear axle, metres.
    pub wheelbase: f32,
    /// Share by which a champion's wheelbase may differ.
    pub wheelbase_tolerance: f32,
    /// Where its beams point, degrees to the left, rightmost first. All start at the middle of
    /// the front axle.
    pub beam_degrees: [f32; 5],
    /// Metres that a champion's beam may start elsewhere, forwards and sideways.
    pub mount_tolerance: f32,
    /// Radians that a champion's beam may point elsewhere.
    pub angle_tolerance: f32,
}

impl ShippedCar {
    /// The car on a Raspberry Pi Pico 2.
    pub const PICO_2: Self = Self {
        hidden: 12,
        outputs: 1,
        periods: (0.02, 0.2),
        steer_limit: 0.5,
        speed_limit: 1.0,
        range: 1.2,
        wheelbase: 0.3,
        wheelbase_tolerance: 0.1,
        beam_degrees: [-30.0, -15.0, 0.0, 15.0, 30.0],
        mount_tolerance: 0.05,
        angle_tolerance: 0.053,
    };

    /// The champion's control period if this car keeps it, else one it keeps, seconds.
    pub fn period(&self, wanted: f32) -> f32 {
        let (shortest, longest) = self.periods;
        if (shortest..=longest).contains(&wanted) { wanted } else { 0.1 }
    }

    /// The longest step of this car in [`Self::period`], metres.
    pub fn step(&self, wanted_period: f32) -> f32 {
        self.speed_limit * self.period(wanted_period)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_board_keeps_whole_sectors_for_weights_inside_its_flash() {
        for board in Board::ALL {
            for edge in [board.weights.start, board.weights.end] {
                assert_eq!(edge % board.sector, 0, "{}", board.name);
            }
            let room = board.weights.len();
            assert_eq!(board.check(board.weights.start, room), Ok(()));
            assert!(room >= 48 * 1024, "{}: the widest Elman network takes 14 kB", board.name);
        }
    }

    #[test]
    fn weights_keep_clear_of_the_sector_that_firmware_files_erase() {
        // picotool's cure for RP2350-E10 writes 0x10ffff00, which is 0x103fff00 in 4 MiB.
        let block = 0x1000_0000 + (0x10ff_ff00 - 0x1000_0000) % (4 << 20);
        let erased = Board::PICO_2.erased(block, 256);
        assert!(erased.start >= u64::from(Board::PICO_2.weights.end));
    }

    #[test]
    fn a_place_outside_of_the_flash_or_past_the_weights_region_is_refused() {
        let pico = Board::PICO_2;
        let outside =
            PlacementError::OutsideFlash { board: pico.name, start: 0x1000_0000, end: 0x1200_0000 };
        assert_eq!(pico.check(0x0fff_ffff, 4), Err(outside.clone()));
        assert_eq!(pico.check(0x11ff_fffc, 4), Ok(()));
        assert_eq!(pico.check(0x11ff_fffc, 5), Err(outside));
        let room = PlacementError::NoRoom { board: pico.name, length: 257, room: 256 };
        assert_eq!(pico.check(0x103f_ef00, 256), Ok(()));
        assert_eq!(pico.check(0x103f_ef00, 257), Err(room));
        assert_eq!(pico.check(0x1020_0000, 1 << 20), Ok(()), "elsewhere the user knows better");
    }

    #[test]
    fn erasing_takes_whole_sectors_around_the_bytes() {
        let erased = |address, length| Board::PICO.erased(address, length);
        assert_eq!(erased(0x101f_0000, 1), 0x101f_0000..0x101f_1000);
        assert_eq!(erased(0x101f_0000, 4096), 0x101f_0000..0x101f_1000);
        assert_eq!(erased(0x101f_0f00, 257), 0x101f_0000..0x101f_2000);
    }
}

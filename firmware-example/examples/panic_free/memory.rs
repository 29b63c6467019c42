//! Memory whose content the compiler knows nothing about.

use firmware_example::calibration::Calibration;

/// A place in memory that anybody may write at any time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Memory(usize);

impl Memory {
    /// What to do next.
    pub(crate) const CHOICE: Self = Self(0x4000_0000);
    /// Numbers of the car.
    pub(crate) const CALIBRATION: Self = Self(0x4000_0100);
    /// Address and length of a weight blob, or of something else.
    pub(crate) const WEIGHTS: Self = Self(0x4000_0200);
    /// Address and length of a recording, or of something else.
    pub(crate) const RECORDING: Self = Self(0x4000_0208);
    /// Results.
    pub(crate) const REPORT: Self = Self(0x4000_0300);

    /// The place of a part's registers, eight words each.
    pub(crate) const fn part(index: usize) -> Self {
        Self(0x4001_0000 + 32 * index)
    }

    /// The word here.
    pub(crate) fn read(self) -> u32 {
        // SAFETY: the program runs on no machine; on none the address would be readable memory.
        unsafe { core::ptr::with_exposed_provenance::<u32>(self.0).read_volatile() }
    }

    /// The word after it.
    pub(crate) fn read_next(self) -> u32 {
        Self(self.0 + 4).read()
    }

    /// Writes the word here.
    pub(crate) fn write(self, word: u32) {
        self.keep(word);
    }

    /// Writes any value here, so that it was not computed in vain.
    pub(crate) fn keep<T>(self, value: T) {
        let place = core::ptr::with_exposed_provenance_mut::<T>(self.0);
        // SAFETY: as for `read`.
        unsafe { place.write_volatile(value) }
    }

    /// The bytes whose address and length stand here.
    pub(crate) fn bytes(self) -> &'static [u8] {
        let start = core::ptr::with_exposed_provenance(self.read() as usize);
        // SAFETY: as for `read`.
        unsafe { core::slice::from_raw_parts(start, self.read_next() as usize) }
    }

    /// A calibration of whatever numbers stand here.
    pub(crate) fn numbers(self) -> Calibration {
        // SAFETY: as for `read`; a calibration is made of numbers, of which all bits are valid.
        unsafe { core::ptr::with_exposed_provenance::<Calibration>(self.0).read_volatile() }
    }
}

//! Eight numbers side by side, in whatever registers the caller has.

use controller_core::lane::{Lane, Lanes};

/// A [`Lane`] of eight numbers that can be read and written one by one.
pub trait Eight: Lane {
    /// Eight numbers from memory.
    fn load(numbers: &[f32; 8]) -> Self;

    /// The eight numbers.
    fn numbers(self) -> [f32; 8];

    /// Whether the mask holds anywhere.
    fn any(mask: Self::Mask) -> bool;
}

impl Eight for Lanes<8> {
    #[inline(always)]
    fn load(numbers: &[f32; 8]) -> Self {
        Self(*numbers)
    }

    #[inline(always)]
    fn numbers(self) -> [f32; 8] {
        self.0
    }

    #[inline(always)]
    fn any(mask: Self::Mask) -> bool {
        mask.any()
    }
}

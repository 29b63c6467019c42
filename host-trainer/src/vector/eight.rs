//! Eight numbers, whatever the width: obstacles are tested against one robot in packs of eight.

use super::{Slots, Vector};
use controller_core::lane::{Lane, Lanes};

/// A [`Lane`] of eight numbers.
pub trait Eight: Lane {
    /// Eight numbers from memory.
    fn load(numbers: &[f32; 8]) -> Self;

    /// The eight numbers.
    fn numbers(self) -> [f32; 8];

    /// Whether the mask holds anywhere.
    fn any(mask: Self::Mask) -> bool;

    /// The smallest of eight numbers, none of them NaN.
    #[inline(always)]
    fn least(self) -> f32 {
        let mut least = f32::INFINITY;
        for number in self.numbers() {
            least = Lane::min(number, least);
        }
        least
    }
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

/// Two vectors of four.
impl<V: Vector> Eight for Slots<V, 2> {
    #[inline(always)]
    fn load(numbers: &[f32; 8]) -> Self {
        const { assert!(V::WIDTH == 4) };
        let mut both = Self::from(0.0);
        both.numbers_mut().copy_from_slice(numbers);
        both
    }

    #[inline(always)]
    fn numbers(self) -> [f32; 8] {
        const { assert!(V::WIDTH == 4) };
        let mut numbers = [0.0; 8];
        numbers.copy_from_slice(Slots::numbers(&self));
        numbers
    }

    #[inline(always)]
    fn any(mask: Self::Mask) -> bool {
        Self::bits(mask) != [0; 2]
    }
}

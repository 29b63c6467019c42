//! The simulator's own vectors, as the comparison drives them.

use std::ops::{Add, Div, Mul, Neg, Sub};

use controller_core::lane::Lane;
use equivalence_tests::compare::{Drive, Tally};
use equivalence_tests::side_by_side::{self, Wide};

use crate::vector::{Instructions, Kernel, Vector};

/// Drives all in the vectors of these instructions and compares every lane with the drive alone.
pub(super) fn compare(instructions: Instructions, drives: &[Drive]) -> Tally {
    instructions.run(Comparison(drives))
}

struct Comparison<'a>(&'a [Drive]);

impl Kernel for Comparison<'_> {
    type Output = Tally;

    #[inline(always)]
    fn run<V: Vector>(self) -> Tally {
        side_by_side::compare::<Register<V>>(self.0)
    }
}

/// A vector whose lanes the comparison fills and reads; its arithmetic is the vector's.
#[derive(Clone, Copy, Debug)]
struct Register<V>(V);

impl<V: Vector> Wide for Register<V> {
    const COUNT: usize = V::WIDTH;

    fn gather(mut number: impl FnMut(usize) -> f32) -> Self {
        let mut vector = V::zeroed();
        for (index, lane) in vector.lanes_mut().iter_mut().enumerate() {
            *lane = number(index);
        }
        Self(vector)
    }

    fn lane(&self, index: usize) -> f32 {
        self.0.lanes().get(index).copied().unwrap_or(f32::NAN)
    }
}

impl<V: Vector> From<f32> for Register<V> {
    #[inline(always)]
    fn from(value: f32) -> Self {
        Self(V::from(value))
    }
}

macro_rules! operators {
    ($($trait:ident :: $method:ident),*) => {$(
        impl<V: Vector> $trait for Register<V> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }
    )*};
}
operators!(Add::add, Sub::sub, Mul::mul, Div::div);

impl<V: Vector> Neg for Register<V> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl<V: Vector> Lane for Register<V> {
    type Mask = V::Mask;

    #[inline(always)]
    fn lt(self, other: Self) -> V::Mask {
        self.0.lt(other.0)
    }

    #[inline(always)]
    fn le(self, other: Self) -> V::Mask {
        self.0.le(other.0)
    }

    #[inline(always)]
    fn select(mask: V::Mask, yes: Self, no: Self) -> Self {
        Self(V::select(mask, yes.0, no.0))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.abs())
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.sqrt())
    }

    #[inline(always)]
    fn map(self, f: impl Fn(f32) -> f32) -> Self {
        Self(self.0.map(f))
    }

    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self(self.0.min(other.0))
    }

    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self(self.0.max(other.0))
    }

    #[inline(always)]
    fn held_within(self, limit: f32) -> Self {
        Self(self.0.held_within(limit))
    }
}

#[cfg(test)]
mod tests {
    use equivalence_tests::compare;

    use super::*;

    #[test]
    fn every_lane_of_every_vector_of_this_cpu_is_the_same_drive_alone() {
        let drives = compare::generated_drives(300);
        for instructions in Instructions::available() {
            let Tally { steps, differing_bits, first } = compare(instructions, &drives);
            assert_eq!((steps, differing_bits, first), (144 * 300, 0, None), "{instructions}");
        }
    }
}

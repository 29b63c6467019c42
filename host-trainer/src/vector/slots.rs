//! Several vectors as one [`Lane`]: more robots than a register holds, so that each weight is
//! loaded once for all of them and the CPU always has other sums to work on.

use super::{Vector, each};
use controller_core::lane::Lane;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// `K` vectors.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub struct Slots<V, const K: usize>(pub [V; K]);

/// One answer per lane of [`Slots`].
#[derive(Clone, Copy, Debug)]
pub struct SlotsMask<M, const K: usize>(pub [M; K]);

/// A network's weight of `SETS` individuals in each lane. A type of its own, because a weight is
/// spread over the vectors where a number is spread over the lanes.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub struct Weight<V, const SETS: usize>(pub [V; SETS]);

impl<V: Vector, const K: usize> Slots<V, K> {
    /// Every number: all lanes of the first vector, then of the second.
    #[inline(always)]
    pub fn numbers(&self) -> &[f32] {
        bytemuck::must_cast_slice(&self.0)
    }

    /// The same, to write.
    #[inline(always)]
    pub fn numbers_mut(&mut self) -> &mut [f32] {
        bytemuck::must_cast_slice_mut(&mut self.0)
    }

    /// The mask of each vector as bits, lane 0 lowest.
    #[inline(always)]
    pub fn bits(mask: SlotsMask<V::Mask, K>) -> [u32; K] {
        let mut bits = [0; K];
        for (bits, mask) in bits.iter_mut().zip(mask.0) {
            *bits = V::bits(mask);
        }
        bits
    }
}

impl<V: Lane, const K: usize> From<f32> for Slots<V, K> {
    #[inline(always)]
    fn from(value: f32) -> Self {
        Self([V::from(value); K])
    }
}

impl<V: Lane, const K: usize, const SETS: usize> From<Weight<V, SETS>> for Slots<V, K> {
    #[inline(always)]
    fn from(weight: Weight<V, SETS>) -> Self {
        const {
            assert!(
                SETS == 1 || SETS >= K,
                "one for all, or one for each, of which the first count"
            )
        };
        let mut all = [weight.0[0]; K];
        if SETS > 1 {
            all.copy_from_slice(&weight.0[..K]);
        }
        Self(all)
    }
}

macro_rules! each_vector {
    ($($trait:ident :: $method:ident),*) => {$(
        impl<V: Lane, const K: usize> $trait for Slots<V, K> {
            type Output = Self;
            #[inline(always)]
            fn $method(mut self, other: Self) -> Self {
                for (one, other) in self.0.iter_mut().zip(other.0) {
                    *one = one.$method(other);
                }
                self
            }
        }
    )*};
}
each_vector!(Add::add, Sub::sub, Mul::mul, Div::div);

macro_rules! each_mask {
    ($($trait:ident :: $method:ident),*) => {$(
        impl<M: Copy + $trait<Output = M>, const K: usize> $trait for SlotsMask<M, K> {
            type Output = Self;
            #[inline(always)]
            fn $method(mut self, other: Self) -> Self {
                for (one, other) in self.0.iter_mut().zip(other.0) {
                    *one = one.$method(other);
                }
                self
            }
        }
    )*};
}
each_mask!(BitAnd::bitand, BitOr::bitor);

impl<M: Copy + Not<Output = M>, const K: usize> Not for SlotsMask<M, K> {
    type Output = Self;
    #[inline(always)]
    fn not(mut self) -> Self {
        for one in &mut self.0 {
            *one = !*one;
        }
        self
    }
}

impl<V: Lane, const K: usize> Neg for Slots<V, K> {
    type Output = Self;
    #[inline(always)]
    fn neg(mut self) -> Self {
        for one in &mut self.0 {
            *one = -*one;
        }
        self
    }
}

impl<V: Vector, const K: usize> Lane for Slots<V, K> {
    type Mask = SlotsMask<V::Mask, K>;

    #[inline(always)]
    fn lt(self, other: Self) -> Self::Mask {
        let mut mask = [self.0[0].lt(other.0[0]); K];
        for ((mask, one), other) in mask.iter_mut().zip(self.0).zip(other.0).skip(1) {
            *mask = one.lt(other);
        }
        SlotsMask(mask)
    }

    #[inline(always)]
    fn le(self, other: Self) -> Self::Mask {
        let mut mask = [self.0[0].le(other.0[0]); K];
        for ((mask, one), other) in mask.iter_mut().zip(self.0).zip(other.0).skip(1) {
            *mask = one.le(other);
        }
        SlotsMask(mask)
    }

    #[inline(always)]
    fn select(mask: Self::Mask, mut yes: Self, no: Self) -> Self {
        for ((yes, no), mask) in yes.0.iter_mut().zip(no.0).zip(mask.0) {
            *yes = V::select(mask, *yes, no);
        }
        yes
    }

    #[inline(always)]
    fn abs(mut self) -> Self {
        for one in &mut self.0 {
            *one = one.abs();
        }
        self
    }

    #[inline(always)]
    fn sqrt(mut self) -> Self {
        for one in &mut self.0 {
            *one = one.sqrt();
        }
        self
    }

    #[inline(always)]
    fn map(mut self, f: impl Fn(f32) -> f32) -> Self {
        each(self.numbers_mut(), f);
        self
    }

    #[inline(always)]
    fn min(mut self, other: Self) -> Self {
        for (one, other) in self.0.iter_mut().zip(other.0) {
            *one = one.min(other);
        }
        self
    }

    #[inline(always)]
    fn max(mut self, other: Self) -> Self {
        for (one, other) in self.0.iter_mut().zip(other.0) {
            *one = one.max(other);
        }
        self
    }

    #[inline(always)]
    fn held_within(mut self, limit: f32) -> Self {
        for one in &mut self.0 {
            *one = one.held_within(limit);
        }
        self
    }
}

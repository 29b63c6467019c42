//! The number type of all arithmetic: one `f32`, or several side by side.
//!
//! Everything that must give the same bits on host and device is written once, generic over
//! [`Lane`]. The microcontroller instantiates it with `f32`; a wide host engine with
//! [`Lanes`] or a SIMD register. Each operation here acts on every lane for itself, so lane
//! `i` of a wide run is the scalar run of lane `i`.

use core::array::from_fn;
use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// A number, or several computed side by side.
pub trait Lane:
    Copy
    + From<f32>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The answer to a comparison, per lane.
    type Mask: Copy
        + BitAnd<Output = Self::Mask>
        + BitOr<Output = Self::Mask>
        + Not<Output = Self::Mask>;

    /// `self < other`; false where either is NaN.
    fn lt(self, other: Self) -> Self::Mask;

    /// `self <= other`; false where either is NaN.
    fn le(self, other: Self) -> Self::Mask;

    /// `yes` where the mask holds, else `no`.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;

    /// The magnitude; clears the sign bit.
    fn abs(self) -> Self;

    /// The correctly rounded square root.
    fn sqrt(self) -> Self;

    /// Applies a scalar function to each lane.
    fn map(self, f: impl Fn(f32) -> f32) -> Self;

    /// `self` where it is smaller, else `other`; `other` where `self` is NaN.
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        Self::select(self.lt(other), self, other)
    }

    /// `self` where it is larger, else `other`; `other` where `self` is NaN.
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        Self::select(other.lt(self), self, other)
    }

    /// Held within `-limit..=limit`; NaN stays NaN.
    #[inline(always)]
    fn held_within(self, limit: f32) -> Self {
        let high = Self::from(limit);
        let low = -high;
        let below = Self::select(high.lt(self), high, self);
        Self::select(below.lt(low), low, below)
    }
}

impl Lane for f32 {
    type Mask = bool;

    #[inline(always)]
    fn lt(self, other: Self) -> bool {
        self < other
    }

    #[inline(always)]
    fn le(self, other: Self) -> bool {
        self <= other
    }

    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self::from_bits(self.to_bits() & 0x7fff_ffff)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        libm::sqrtf(self)
    }

    #[inline(always)]
    fn map(self, f: impl Fn(f32) -> f32) -> Self {
        f(self)
    }
}

/// `N` numbers side by side in a plain array: portable, safe, and the oracle for any faster
/// lane type.
///
/// ```
/// use controller_core::lane::{Lane, Lanes};
///
/// let sum = Lanes([1.0, 2.0]) + Lanes::from(10.0);
/// assert_eq!(sum.0, [11.0, 12.0]);
/// assert_eq!(sum.min(Lanes::from(11.5)).0, [11.0, 11.5]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lanes<const N: usize>(pub [f32; N]);

/// One answer per lane of [`Lanes`].
///
/// Kept as bit masks, all ones or all zeros, because compilers turn those into vector
/// instructions and arrays of `bool` into shuffles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LaneMask<const N: usize>([u32; N]);

impl<const N: usize> LaneMask<N> {
    /// What one lane says; no for a lane that there is not.
    #[inline(always)]
    pub fn lane(self, index: usize) -> bool {
        self.0.get(index).is_some_and(|lane| *lane != 0)
    }

    /// Whether any lane says yes.
    #[inline(always)]
    pub fn any(self) -> bool {
        self.0.iter().fold(0, |any, lane| any | lane) != 0
    }
}

impl<const N: usize> From<f32> for Lanes<N> {
    #[inline(always)]
    fn from(value: f32) -> Self {
        Self([value; N])
    }
}

impl<const N: usize> Lanes<N> {
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        Self(from_fn(|i| f(self.0[i], other.0[i])))
    }

    #[inline(always)]
    fn compare(self, other: Self, f: impl Fn(f32, f32) -> bool) -> LaneMask<N> {
        LaneMask(from_fn(|i| if f(self.0[i], other.0[i]) { u32::MAX } else { 0 }))
    }
}

macro_rules! lanewise {
    ($($trait:ident :: $method:ident),*) => {$(
        impl<const N: usize> $trait for Lanes<N> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, |a, b| a.$method(b))
            }
        }
    )*};
}
lanewise!(Add::add, Sub::sub, Mul::mul, Div::div);

impl<const N: usize> Neg for Lanes<N> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self(self.0.map(|value| -value))
    }
}

impl<const N: usize> BitAnd for LaneMask<N> {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(from_fn(|i| self.0[i] & other.0[i]))
    }
}

impl<const N: usize> BitOr for LaneMask<N> {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(from_fn(|i| self.0[i] | other.0[i]))
    }
}

impl<const N: usize> Not for LaneMask<N> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(self.0.map(|lane| !lane))
    }
}

impl<const N: usize> Lane for Lanes<N> {
    type Mask = LaneMask<N>;

    #[inline(always)]
    fn lt(self, other: Self) -> LaneMask<N> {
        self.compare(other, |a, b| a < b)
    }

    #[inline(always)]
    fn le(self, other: Self) -> LaneMask<N> {
        self.compare(other, |a, b| a <= b)
    }

    #[inline(always)]
    fn select(mask: LaneMask<N>, yes: Self, no: Self) -> Self {
        Self(from_fn(|i| {
            f32::from_bits((yes.0[i].to_bits() & mask.0[i]) | (no.0[i].to_bits() & !mask.0[i]))
        }))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(self.0.map(Lane::abs))
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(self.0.map(Lane::sqrt))
    }

    #[inline(always)]
    fn map(self, f: impl Fn(f32) -> f32) -> Self {
        Self(self.0.map(f))
    }
}

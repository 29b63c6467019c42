//! Numbers that remember where they come from, and add differently for it.

use controller_core::lane::Lane;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// A number as core would have computed it, and what it was made of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Number {
    value: f32,
    origin: Origin,
}

#[derive(Clone, Copy, Debug)]
enum Origin {
    /// Nothing that matters.
    Other,
    /// The two factors of a product.
    #[cfg_attr(
        not(feature = "sabotage-fused-sum"),
        expect(dead_code, reason = "only a fused sum looks at the factors")
    )]
    Product(f32, f32),
    /// A sum before its last product, and that product.
    #[cfg(not(feature = "sabotage-fused-sum"))]
    Sum(f32, f32),
}

impl Number {
    pub(super) fn value(self) -> f32 {
        self.value
    }
}

impl From<f32> for Number {
    fn from(value: f32) -> Self {
        Self { value, origin: Origin::Other }
    }
}

impl Mul for Number {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self { value: self.value * other.value, origin: Origin::Product(self.value, other.value) }
    }
}

#[cfg(feature = "sabotage-fused-sum")]
impl Add for Number {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        match other.origin {
            Origin::Product(a, b) => libm::fmaf(a, b, self.value).into(),
            Origin::Other => (self.value + other.value).into(),
        }
    }
}

#[cfg(not(feature = "sabotage-fused-sum"))]
impl Add for Number {
    type Output = Self;

    /// Every second product of a sum is added before the one that came first.
    fn add(self, other: Self) -> Self {
        match (self.origin, other.origin) {
            (Origin::Sum(before, last), Origin::Product(..)) => {
                ((before + other.value) + last).into()
            }
            (_, Origin::Product(..)) => Self {
                value: self.value + other.value,
                origin: Origin::Sum(self.value, other.value),
            },
            _ => (self.value + other.value).into(),
        }
    }
}

impl Sub for Number {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        (self.value - other.value).into()
    }
}

impl Div for Number {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        (self.value / other.value).into()
    }
}

impl Neg for Number {
    type Output = Self;

    fn neg(self) -> Self {
        (-self.value).into()
    }
}

impl Lane for Number {
    type Mask = bool;

    fn lt(self, other: Self) -> bool {
        self.value < other.value
    }

    fn le(self, other: Self) -> bool {
        self.value <= other.value
    }

    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }

    fn abs(self) -> Self {
        Lane::abs(self.value).into()
    }

    fn sqrt(self) -> Self {
        Lane::sqrt(self.value).into()
    }

    fn map(self, f: impl Fn(f32) -> f32) -> Self {
        f(self.value).into()
    }
}

//! The hyperbolic tangent, in three named forms that host and device share.
//!
//! | kind | worst error over every `f32` | falls | why |
//! | --- | --- | --- | --- |
//! | [`Rational`] (default) | 5.81 ULP, 3.5e-7 | 16 559 310, up to 4.8e-7 | branch-free: the fastest in lanes and on a Cortex-M4F |
//! | [`Libm`] | 2.19 ULP, 8.5e-8 | 21 478, up to 3.0e-8 | the accurate one |
//! | [`Micromath`] | 1.1e-3 | 5 543, up to 1.2e-5 | built from a bit-trick exponential, for parts without an FPU |
//!
//! A fall is a pair of neighbouring inputs where the larger one has the smaller result: none of
//! the three is monotonic to the last bit. `cargo xtask exhaustive` re-measures the table over
//! all 2³² inputs; the tests walk a stride of it. NaN gives NaN in all three, and no result
//! leaves `-1.0..=1.0`.

pub mod digest;

use crate::lane::Lane;
use serde::{Deserialize, Serialize};

/// Which tanh a set of weights was trained with; recorded in the weight blob.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ActivationKind {
    /// [`Rational`].
    #[default]
    Rational,
    /// [`Libm`].
    Libm,
    /// [`Micromath`].
    Micromath,
}

/// Something that can pass sums through a tanh.
pub trait Activation: Copy {
    /// Whether it is a few instructions in a row, without branches or calls.
    const BRANCH_FREE: bool;

    /// The kind recorded in the weight blob.
    fn kind(self) -> ActivationKind;

    /// Replaces each sum by its tanh.
    fn apply<L: Lane, const N: usize>(self, sums: &mut [L; N]);
}

/// The default tanh; see [`Rational`].
#[inline(always)]
pub fn tanh<L: Lane>(x: L) -> L {
    Rational::tanh(x)
}

/// x·P₄(x²)/Q₄(x²) with the argument held within ±8.089648, where tanh rounds to ±1.
///
/// Made of sums, products and one division only. The coefficients come from a search that
/// minimised the worst error in ULP after rounding each operation to `f32`. Results never
/// leave `-1.0..=1.0`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rational;

impl Rational {
    /// tanh of every lane.
    #[inline(always)]
    pub fn tanh<L: Lane>(x: L) -> L {
        let x = x.held_within(8.089_648);
        let u = x * x;
        let numerator =
            Self::polynomial(u, [1.384_288_5e-8, 2.095_166_4e-5, 0.003_516_053, 0.133_981_57]);
        let denominator =
            Self::polynomial(u, [7.973_38e-7, 0.000_331_933_8, 0.025_954_522, 0.467_314_75]);
        x * numerator / denominator
    }

    /// Horner's rule down to the constant 1. A function and not a closure, because a closure is
    /// compiled for the least machine, and its vector instructions then become calls.
    #[inline(always)]
    fn polynomial<L: Lane>(u: L, coefficients: [f32; 4]) -> L {
        let mut value = L::from(coefficients[0]);
        for coefficient in &coefficients[1..] {
            value = value * u + L::from(*coefficient);
        }
        value * u + L::from(1.0)
    }
}

/// `libm::tanhf`: musl's tanh in Rust, the same bits wherever Rust runs.
#[derive(Clone, Copy, Debug, Default)]
pub struct Libm;

impl Libm {
    /// tanh of every lane.
    #[inline(always)]
    pub fn tanh<L: Lane>(x: L) -> L {
        x.map(libm::tanhf)
    }
}

/// `1 − 2/(exp(2x) + 1)` with micromath's approximate exponential.
///
/// The argument is held within ±9: micromath's own `exp` turns into NaN past 44. Results
/// never leave `-1.0..=1.0`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Micromath;

impl Micromath {
    /// tanh of every lane.
    #[inline(always)]
    pub fn tanh<L: Lane>(x: L) -> L {
        x.map(|x| {
            // micromath's exp looks inside NaN and answers a number; keep NaN a NaN.
            if x.is_nan() {
                return x;
            }
            let x = x.held_within(9.0);
            let exp = micromath::F32Ext::exp(x + x);
            1.0 - 2.0 / (exp + 1.0)
        })
    }
}

macro_rules! activation {
    ($($name:ident: $branch_free:literal),*) => {$(
        impl Activation for $name {
            const BRANCH_FREE: bool = $branch_free;

            fn kind(self) -> ActivationKind {
                ActivationKind::$name
            }

            #[inline(always)]
            fn apply<L: Lane, const N: usize>(self, sums: &mut [L; N]) {
                for sum in sums {
                    *sum = $name::tanh(*sum);
                }
            }
        }
    )*};
}
activation!(Rational: true, Libm: false, Micromath: false);

/// Chosen at run time; a device that knows its kind uses the type instead and links one tanh.
impl Activation for ActivationKind {
    const BRANCH_FREE: bool = false;

    fn kind(self) -> ActivationKind {
        self
    }

    #[inline(always)]
    fn apply<L: Lane, const N: usize>(self, sums: &mut [L; N]) {
        match self {
            Self::Rational => Rational.apply(sums),
            Self::Libm => Libm.apply(sums),
            Self::Micromath => Micromath.apply(sums),
        }
    }
}

crate::sentences! { ActivationKind {
    Self::Rational => "rational";
    Self::Libm => "libm";
    Self::Micromath => "micromath";
} }

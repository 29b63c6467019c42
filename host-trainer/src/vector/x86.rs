//! Vectors in the registers of an x86: 4 numbers (SSE2), 8 (AVX2), 16 (AVX-512).
//!
//! The one place with `unsafe` in this crate. Rust's vector instructions are `unsafe` to call
//! where the compiler does not know that the CPU has them. Here [`run`] asks the CPU before it
//! names [`Wide8`] or [`Wide16`]; no other module can name them, so their operations run only on
//! CPUs that have them. (A token in each value would prove that to the compiler, but a lane must
//! be made from a bare `f32`.)
#![allow(unsafe_code)]

use super::table::Columns;
use super::{ByName, Instructions, Kernel, MOST_LANES, Part, RowOfLane, Vector, Whole, each};
use bytemuck::{Pod, Zeroable};
use controller_core::lane::Lane;
use core::arch::x86_64::*;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

/// Four numbers.
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(super) struct Wide4(__m128);

/// Eight numbers; only named after [`has_avx2`].
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(super) struct Wide8(__m256);

/// Sixteen numbers; only named after [`has_avx512`].
#[derive(Clone, Copy, Debug)]
#[repr(transparent)]
pub(super) struct Wide16(__m512);

/// Whether this CPU has these features, and a function that is compiled for them: one list, so that they agree.
macro_rules! compiled_for {
    ($has:ident, $with:ident, $wide:ident, [$($feature:tt),*]) => {
        #[doc = concat!("Whether this CPU has what [`", stringify!($wide), "`] needs.")]
        pub(super) fn $has() -> bool {
            $(is_x86_feature_detected!($feature))&&*
        }

        #[inline(never)]
        #[target_feature($(enable = $feature),*)]
        fn $with<P: Part<$wide>>(part: P) -> P::Output {
            part.run()
        }
    };
}

// Beside the vectors: bits of a mask counted and found by one instruction, which AVX2 does not promise.
compiled_for!(has_avx2, with_avx2, Wide8, ["avx2", "bmi1", "bmi2", "lzcnt", "popcnt"]);
compiled_for!(
    has_avx512,
    with_avx512,
    Wide16,
    ["avx2", "bmi1", "bmi2", "lzcnt", "popcnt", "avx512f", "avx512dq", "avx512vl", "avx512bw"]
);

/// Fetches what lies here into the first cache.
#[inline(always)]
pub(super) fn fetch<T>(at: *const T) {
    // SAFETY: every x86-64 has SSE; a fetch never faults, wherever it points.
    unsafe { _mm_prefetch::<_MM_HINT_T0>(at.cast()) }
}

/// Runs the kernel with these instructions, which this CPU has.
pub(super) fn run<K: Kernel>(instructions: Instructions, kernel: K) -> K::Output {
    match instructions {
        Instructions::Avx512 if has_avx512() => Wide16::apart(Whole(kernel)),
        Instructions::Avx512 | Instructions::Avx2 if has_avx2() => Wide8::apart(Whole(kernel)),
        Instructions::Scalar => f32::apart(Whole(kernel)),
        _ => Wide4::apart(Whole(kernel)),
    }
}

macro_rules! operator {
    ($name:ident, $trait:ident :: $method:ident, $instruction:ident) => {
        impl $trait for $name {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: this type is only named where the CPU has its instructions.
                Self(unsafe { $instruction(self.0, other.0) })
            }
        }
    };
}

/// Implements [`Lane`] and what it asks for. `min` and `max` of an x86 answer their second
/// operand where either is NaN or both are zero, which is exactly what [`Lane::min`] says.
macro_rules! lane {
    (
        $name:ident, $mask:ident,
        $add:ident, $sub:ident, $mul:ident, $div:ident, $min:ident, $max:ident, $sqrt:ident,
        $splat:ident, and_not: $and_not:ident, xor: $xor:ident,
        |$a:ident, $b:ident| lt: $lt:expr, le: $le:expr, |$m:ident| select: $select:expr
    ) => {
        operator!($name, Add::add, $add);
        operator!($name, Sub::sub, $sub);
        operator!($name, Mul::mul, $mul);
        operator!($name, Div::div, $div);

        // SAFETY: a register of `f32`s, without padding; all bits are allowed.
        unsafe impl Zeroable for $name {}
        // SAFETY: as above.
        unsafe impl Pod for $name {}

        impl From<f32> for $name {
            #[inline(always)]
            fn from(value: f32) -> Self {
                // SAFETY: this type is only named where the CPU has its instructions.
                Self(unsafe { $splat(value) })
            }
        }

        impl Neg for $name {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                // SAFETY: this type is only named where the CPU has its instructions.
                Self(unsafe { $xor(self.0, $splat(-0.0)) })
            }
        }

        impl Lane for $name {
            type Mask = $mask;

            #[inline(always)]
            fn lt(self, other: Self) -> $mask {
                let ($a, $b) = (self.0, other.0);
                // SAFETY: this type is only named where the CPU has its instructions.
                $mask(unsafe { $lt })
            }

            #[inline(always)]
            fn le(self, other: Self) -> $mask {
                let ($a, $b) = (self.0, other.0);
                // SAFETY: this type is only named where the CPU has its instructions.
                $mask(unsafe { $le })
            }

            #[inline(always)]
            fn select(mask: $mask, yes: Self, no: Self) -> Self {
                let ($m, $a, $b) = (mask.0, yes.0, no.0);
                // SAFETY: this type is only named where the CPU has its instructions.
                Self(unsafe { $select })
            }

            #[inline(always)]
            fn abs(self) -> Self {
                // SAFETY: this type is only named where the CPU has its instructions.
                Self(unsafe { $and_not($splat(-0.0), self.0) })
            }

            #[inline(always)]
            fn sqrt(self) -> Self {
                // SAFETY: this type is only named where the CPU has its instructions.
                Self(unsafe { $sqrt(self.0) })
            }

            #[inline(always)]
            fn map(mut self, f: impl Fn(f32) -> f32) -> Self {
                each(self.lanes_mut(), f);
                self
            }

            #[inline(always)]
            fn min(self, other: Self) -> Self {
                // SAFETY: this type is only named where the CPU has its instructions.
                Self(unsafe { $min(self.0, other.0) })
            }

            #[inline(always)]
            fn max(self, other: Self) -> Self {
                // SAFETY: this type is only named where the CPU has its instructions.
                Self(unsafe { $max(self.0, other.0) })
            }

            /// The limit comes first, so that NaN stays NaN.
            #[inline(always)]
            fn held_within(self, limit: f32) -> Self {
                Self::from(-limit).max(Self::from(limit).min(self))
            }
        }
    };
}

/// Implements a mask of whole words, up to AVX2.
macro_rules! mask {
    ($name:ident, $raw:ty, $and:ident, $or:ident, |$a:ident| not: $not:expr) => {
        /// One answer per lane, all bits of a word alike.
        #[derive(Clone, Copy, Debug)]
        pub(super) struct $name($raw);

        operator!($name, BitAnd::bitand, $and);
        operator!($name, BitOr::bitor, $or);

        impl Not for $name {
            type Output = Self;
            #[inline(always)]
            fn not(self) -> Self {
                let $a = self.0;
                // SAFETY: this type is only named where the CPU has its instructions.
                Self(unsafe { $not })
            }
        }
    };
}

/// One answer per lane, a bit each, lane 0 lowest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mask16(__mmask16);

impl BitAnd for Mask16 {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
}

impl BitOr for Mask16 {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl Not for Mask16 {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0)
    }
}

lane!(
    Wide4, Mask4,
    _mm_add_ps, _mm_sub_ps, _mm_mul_ps, _mm_div_ps, _mm_min_ps, _mm_max_ps, _mm_sqrt_ps,
    _mm_set1_ps, and_not: _mm_andnot_ps, xor: _mm_xor_ps,
    |a, b| lt: _mm_cmplt_ps(a, b), le: _mm_cmple_ps(a, b),
    |m| select: _mm_or_ps(_mm_and_ps(m, a), _mm_andnot_ps(m, b))
);
mask!(
    Mask4, __m128, _mm_and_ps, _mm_or_ps,
    |a| not: _mm_xor_ps(a, _mm_castsi128_ps(_mm_set1_epi32(-1)))
);

lane!(
    Wide8, Mask8,
    _mm256_add_ps, _mm256_sub_ps, _mm256_mul_ps, _mm256_div_ps, _mm256_min_ps, _mm256_max_ps,
    _mm256_sqrt_ps, _mm256_set1_ps, and_not: _mm256_andnot_ps, xor: _mm256_xor_ps,
    |a, b| lt: _mm256_cmp_ps::<_CMP_LT_OQ>(a, b), le: _mm256_cmp_ps::<_CMP_LE_OQ>(a, b),
    |m| select: _mm256_blendv_ps(b, a, m)
);
mask!(
    Mask8, __m256, _mm256_and_ps, _mm256_or_ps,
    |a| not: _mm256_xor_ps(a, _mm256_castsi256_ps(_mm256_set1_epi32(-1)))
);

lane!(
    Wide16, Mask16,
    _mm512_add_ps, _mm512_sub_ps, _mm512_mul_ps, _mm512_div_ps, _mm512_min_ps, _mm512_max_ps,
    _mm512_sqrt_ps, _mm512_set1_ps, and_not: _mm512_andnot_ps, xor: _mm512_xor_ps,
    |a, b| lt: _mm512_cmp_ps_mask::<_CMP_LT_OQ>(a, b), le: _mm512_cmp_ps_mask::<_CMP_LE_OQ>(a, b),
    |m| select: _mm512_mask_blend_ps(m, b, a)
);

/// A lane's row in a register of four.
#[inline(always)]
fn row(rows: &impl RowOfLane, lane: usize) -> __m128 {
    // SAFETY: every x86-64 has SSE2, and four numbers lie there.
    unsafe { _mm_loadu_ps(rows.row(lane).as_ptr()) }
}

/// Turns registers with a row in each four lanes into one with the first numbers of all rows, one
/// with the second ones, and so on.
macro_rules! turned {
    (
        $name:ident, $unpack_low:ident, $unpack_high:ident, $shuffle:ident,
        [$a:ident, $b:ident, $c:ident, $d:ident]
    ) => {{
        // SAFETY: this type is only named where the CPU has its instructions.
        unsafe {
            let (ab, cd) = ($unpack_low($a, $b), $unpack_low($c, $d));
            let (ab_high, cd_high) = ($unpack_high($a, $b), $unpack_high($c, $d));
            [
                $name($shuffle::<0x44>(ab, cd)),
                $name($shuffle::<0xee>(ab, cd)),
                $name($shuffle::<0x44>(ab_high, cd_high)),
                $name($shuffle::<0xee>(ab_high, cd_high)),
            ]
        }
    }};
}

/// Implements [`Vector::places_around`].
macro_rules! places_around {
    (
        $nearest:ident, $splat:ident, $load:ident, $store:ident,
        $add:ident, $and:ident, $shift_left:ident
    ) => {
        #[inline(always)]
        fn places_around(self, parts: u32, bases: &[u32; MOST_LANES]) -> [u32; MOST_LANES] {
            let mut places = [0; MOST_LANES];
            // SAFETY: this type is only named where the CPU has its instructions; there are bases for all
            // lanes, and there is room. A CPU rounds so unless it is told otherwise, which nobody does.
            unsafe {
                let shift = _mm_cvtsi64_si128(i64::from(parts.trailing_zeros()));
                let bases = $shift_left($load(bases.as_ptr().cast()), shift);
                let part = $and($nearest(self.0), $splat((parts - 1).cast_signed()));
                $store(places.as_mut_ptr().cast(), $add(bases, part));
            }
            places
        }
    };
}

impl Vector for Wide4 {
    const WIDTH: usize = 4;

    #[inline(always)]
    fn bits(mask: Mask4) -> u32 {
        // SAFETY: every x86-64 has SSE2.
        unsafe { _mm_movemask_ps(mask.0) as u32 }
    }

    #[inline(always)]
    fn flipped_by(self, other: Self) -> Self {
        // SAFETY: this type is only named where the CPU has its instructions.
        Self(unsafe { _mm_xor_ps(self.0, _mm_and_ps(other.0, _mm_set1_ps(-0.0))) })
    }

    #[inline(always)]
    fn places(self) -> [u32; MOST_LANES] {
        let mut places = [0; MOST_LANES];
        // SAFETY: this type is only named where the CPU has its instructions; there is room.
        unsafe { _mm_storeu_si128(places.as_mut_ptr().cast(), _mm_cvttps_epi32(self.0)) };
        places
    }

    places_around!(
        _mm_cvtps_epi32,
        _mm_set1_epi32,
        _mm_loadu_si128,
        _mm_storeu_si128,
        _mm_add_epi32,
        _mm_and_si128,
        _mm_sll_epi32
    );

    #[inline(always)]
    fn rows<R: RowOfLane>(rows: R) -> [Self; 4] {
        let mut four = [row(&rows, 0); 4];
        for (lane, four) in four.iter_mut().enumerate().skip(1) {
            *four = row(&rows, lane);
        }
        let [a, b, c, d] = four;
        turned!(Self, _mm_unpacklo_ps, _mm_unpackhi_ps, _mm_shuffle_ps, [a, b, c, d])
    }

    #[inline(never)]
    fn apart<P: Part<Self>>(part: P) -> P::Output {
        part.run()
    }
}

impl Vector for Wide8 {
    const WIDTH: usize = 8;

    #[inline(always)]
    fn bits(mask: Mask8) -> u32 {
        // SAFETY: this type is only named where the CPU has its instructions.
        unsafe { _mm256_movemask_ps(mask.0) as u32 }
    }

    #[inline(always)]
    fn flipped_by(self, other: Self) -> Self {
        // SAFETY: this type is only named where the CPU has its instructions.
        Self(unsafe { _mm256_xor_ps(self.0, _mm256_and_ps(other.0, _mm256_set1_ps(-0.0))) })
    }

    #[inline(always)]
    fn places(self) -> [u32; MOST_LANES] {
        let mut places = [0; MOST_LANES];
        // SAFETY: this type is only named where the CPU has its instructions; there is room.
        unsafe { _mm256_storeu_si256(places.as_mut_ptr().cast(), _mm256_cvttps_epi32(self.0)) };
        places
    }

    places_around!(
        _mm256_cvtps_epi32,
        _mm256_set1_epi32,
        _mm256_loadu_si256,
        _mm256_storeu_si256,
        _mm256_add_epi32,
        _mm256_and_si256,
        _mm256_sll_epi32
    );

    #[inline(always)]
    fn rows<R: RowOfLane>(rows: R) -> [Self; 4] {
        let mut four = [Self::from(0.0).0; 4];
        for (lane, four) in four.iter_mut().enumerate() {
            let (low, high) = (row(&rows, lane), row(&rows, lane + 4));
            // SAFETY: this type is only named where the CPU has its instructions.
            *four = unsafe { _mm256_insertf128_ps::<1>(_mm256_castps128_ps256(low), high) };
        }
        let [a, b, c, d] = four;
        turned!(Self, _mm256_unpacklo_ps, _mm256_unpackhi_ps, _mm256_shuffle_ps, [a, b, c, d])
    }

    #[inline(always)]
    fn apart<P: Part<Self>>(part: P) -> P::Output {
        // SAFETY: this type is only named where the CPU has its instructions.
        unsafe { with_avx2(part) }
    }
}

impl Vector for Wide16 {
    const WIDTH: usize = 16;
    const SQUEEZES: bool = true;

    #[inline(always)]
    fn bits(mask: Mask16) -> u32 {
        u32::from(mask.0)
    }

    #[inline(always)]
    fn flipped_by(self, other: Self) -> Self {
        // SAFETY: this type is only named where the CPU has its instructions.
        Self(unsafe { _mm512_xor_ps(self.0, _mm512_and_ps(other.0, _mm512_set1_ps(-0.0))) })
    }

    #[inline(always)]
    fn places(self) -> [u32; MOST_LANES] {
        let mut places = [0; MOST_LANES];
        // SAFETY: this type is only named where the CPU has its instructions; there is room.
        unsafe { _mm512_storeu_si512(places.as_mut_ptr().cast(), _mm512_cvttps_epi32(self.0)) };
        places
    }

    places_around!(
        _mm512_cvtps_epi32,
        _mm512_set1_epi32,
        _mm512_loadu_si512,
        _mm512_storeu_si512,
        _mm512_add_epi32,
        _mm512_and_si512,
        _mm512_sll_epi32
    );

    #[inline(always)]
    fn rows<R: RowOfLane>(rows: R) -> [Self; 4] {
        let mut four = [Self::from(0.0).0; 4];
        for (lane, four) in four.iter_mut().enumerate() {
            let [a, b] = [row(&rows, lane), row(&rows, lane + 4)];
            let [c, d] = [row(&rows, lane + 8), row(&rows, lane + 12)];
            // SAFETY: this type is only named where the CPU has its instructions.
            *four = unsafe {
                let ab = _mm512_insertf32x4::<1>(_mm512_castps128_ps512(a), b);
                _mm512_insertf32x4::<3>(_mm512_insertf32x4::<2>(ab, c), d)
            };
        }
        let [a, b, c, d] = four;
        turned!(Self, _mm512_unpacklo_ps, _mm512_unpackhi_ps, _mm512_shuffle_ps, [a, b, c, d])
    }

    /// Takes few rows from registers: two of them are a table of 32 numbers.
    #[inline(always)]
    fn named(rows: ByName<'_>) -> [Self; 4] {
        let Some(Columns { columns, are_few }) = rows.table.columns() else {
            return Self::rows(rows);
        };
        // SAFETY: this type is only named where the CPU has its instructions; the numbers are sixteen.
        let (names, from_32, from_48) = unsafe {
            let shift = _mm_cvtsi64_si128(rows.byte as i64 * 8);
            let names = _mm512_srl_epi32(_mm512_loadu_si512(rows.names.as_ptr().cast()), shift);
            let from_32 = _mm512_test_epi32_mask(names, _mm512_set1_epi32(32));
            (names, from_32, _mm512_mask_test_epi32_mask(from_32, names, _mm512_set1_epi32(16)))
        };
        let mut four = [Self::from(0.0); 4];
        for (four, column) in four.iter_mut().zip(columns) {
            // SAFETY: this type is only named where the CPU has its instructions; a column has four
            // times sixteen numbers, and of each name only as many bits count as tell them apart.
            four.0 = unsafe {
                let at = column.as_ptr();
                let (a, b) = (_mm512_loadu_ps(at), _mm512_loadu_ps(at.add(16)));
                let (c, d) = (_mm512_loadu_ps(at.add(32)), _mm512_loadu_ps(at.add(48)));
                let near = _mm512_permutex2var_ps(a, names, b);
                let past = _mm512_mask_permutexvar_ps(near, from_32, names, c);
                if *are_few { past } else { _mm512_mask_permutexvar_ps(past, from_48, names, d) }
            };
        }
        four
    }

    #[inline(always)]
    fn lanes_with(numbers: &[u32; MOST_LANES], bits: u32) -> u32 {
        // SAFETY: this type is only named where the CPU has its instructions; the numbers are sixteen.
        u32::from(unsafe {
            let numbers = _mm512_loadu_si512(numbers.as_ptr().cast());
            _mm512_test_epi32_mask(numbers, _mm512_set1_epi32(bits.cast_signed()))
        })
    }

    #[inline(always)]
    fn squeezed(self, lanes: u32) -> Self {
        // SAFETY: this type is only named where the CPU has its instructions.
        Self(unsafe { _mm512_maskz_compress_ps(lanes as u16, self.0) })
    }

    #[inline(always)]
    fn spread(self, lanes: u32, rest: Self) -> Self {
        // SAFETY: this type is only named where the CPU has its instructions.
        Self(unsafe { _mm512_mask_expand_ps(rest.0, lanes as u16, self.0) })
    }

    #[inline(always)]
    fn apart<P: Part<Self>>(part: P) -> P::Output {
        // SAFETY: this type is only named where the CPU has its instructions.
        unsafe { with_avx512(part) }
    }
}

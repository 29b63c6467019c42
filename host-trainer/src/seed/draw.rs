//! What can be drawn from a stream. Written out here, on top of 32-bit words only, so that no
//! other crate's release or feature flag can change what a seed means.

use std::f64::consts::TAU;

use rand::Rng;
use rand::rngs::ChaCha8Rng;

/// The random numbers of one place in a run.
#[derive(Debug)]
pub struct Stream {
    generator: ChaCha8Rng,
}

impl Stream {
    pub(super) fn new(generator: ChaCha8Rng) -> Self {
        Self { generator }
    }

    /// The next 32 random bits.
    pub(crate) fn word(&mut self) -> u32 {
        self.generator.next_u32()
    }

    /// The next two words, the first one lowest.
    fn two_words(&mut self) -> u64 {
        let low = self.word();
        u64::from(self.word()) << 32 | u64::from(low)
    }

    /// Uniform in `0.0..1.0`: one of the 2²⁴ multiples of 2⁻²⁴.
    pub fn unit(&mut self) -> f32 {
        const STEP: f32 = 1.0 / (1 << 24) as f32;
        (self.word() >> 8) as f32 * STEP
    }

    /// Uniform in `0.0..1.0`: one of the 2⁵³ multiples of 2⁻⁵³.
    pub fn unit_f64(&mut self) -> f64 {
        const STEP: f64 = 1.0 / (1_u64 << 53) as f64;
        (self.two_words() >> 11) as f64 * STEP
    }

    /// Uniform between two finite numbers, `low` included: `low + (high − low) · unit`.
    ///
    /// Computed in `f64` and rounded once, so the result never leaves `low..=high`. It is
    /// below `high` unless the range is so far from 0, or so one-sided, that its last 2⁻²⁴
    /// part rounds to `high`; `-bound..bound` never does.
    pub fn within(&mut self, low: f32, high: f32) -> f32 {
        let (low, high) = (f64::from(low), f64::from(high));
        (low + (high - low) * f64::from(self.unit())) as f32
    }

    /// `true` with probability `p`; never at 0 or below, always at 1 or above.
    pub fn chance(&mut self, p: f32) -> bool {
        self.unit() < p
    }

    /// Uniform in `0..len`, every index exactly equally likely.
    ///
    /// # Panics
    /// When `len` is 0.
    pub fn index(&mut self, len: usize) -> usize {
        assert!(len > 0, "nothing to choose from");
        let len = len as u64;
        loop {
            // Lemire's method: the high half is the index; the few low halves that would
            // favour some indices are drawn again.
            let product = u128::from(self.two_words()) * u128::from(len);
            let low = product as u64;
            if low >= len || low >= len.wrapping_neg() % len {
                return (product >> 64) as usize;
            }
        }
    }

    /// Puts the items into random order, every order equally likely.
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for end in (2..=items.len()).rev() {
            let chosen = self.index(end);
            items.swap(chosen, end - 1);
        }
    }

    /// Normal with mean 0 and standard deviation 1, by Box and Muller's method; never farther
    /// out than 6.8.
    pub fn normal(&mut self) -> f32 {
        const STEP: f64 = 1.0 / (1_u64 << 32) as f64;
        let radius = (f64::from(self.word()) + 0.5) * STEP;
        let turn = f64::from(self.word()) * STEP;
        (libm::sqrt(-2.0 * libm::log(radius)) * libm::cos(TAU * turn)) as f32
    }
}

#[cfg(test)]
mod tests {
    use super::super::statistics::{chi_square, follows};
    use super::super::{Purpose, RunSeed};
    use super::*;

    fn stream(seed: u64) -> Stream {
        RunSeed(seed).stream(Purpose::Episode, 3, 11)
    }

    /// Expected values: the definitions above in Python, over the Python ChaCha8 of the
    /// stream's own test, with the C library's `log` and `cos`.
    #[test]
    fn draws_have_the_same_values_in_every_release() {
        let mut s = stream(7);
        assert_eq!(
            [s.unit(), s.unit(), s.unit()].map(f32::to_bits),
            [0x3f1d_564f, 0x3f54_bc2e, 0x3e37_2548]
        );
        assert_eq!(
            [s.unit_f64(), s.unit_f64()].map(f64::to_bits),
            [0x3fe4_183e_5a57_184d, 0x3f74_475c_4cac_0800]
        );
        let ranged = [s.within(-3.0, 3.0), s.within(0.1, 0.7), s.within(5.0, 5.0)];
        assert_eq!(ranged.map(f32::to_bits), [0xbf9f_0981, 0x3eb6_370b, 0x40a0_0000]);
        assert_eq!(
            [s.index(10), s.index(553), s.index(1 << 40), s.index(1)],
            [8, 487, 686_144_074_657, 0]
        );
        let normal = [
            0x3f18_44ed_u32,
            0xc002_511a,
            0x3f44_4aa9,
            0xbfa0_be5d,
            0x3f0c_1146,
            0x3ed0_8e6b,
            0xbf94_1849,
            0x3dce_e3e4,
        ];
        assert_eq!(std::array::from_fn(|_| s.normal().to_bits()), normal);
        let mut order = [0, 1, 2, 3, 4, 5, 6];
        s.shuffle(&mut order);
        assert_eq!(order, [0, 5, 4, 6, 2, 3, 1]);
    }

    #[test]
    fn uniform_draws_never_leave_their_range() {
        let mut s = stream(1);
        let ranges = [
            (-1.0, 1.0),
            (f32::MIN, f32::MAX),
            (1.0, f32::from_bits(1.0_f32.to_bits() + 1)),
            (-f32::MIN_POSITIVE, 0.0),
            (-3e38, 1e-30),
        ];
        for (low, high) in ranges {
            for _ in 0..20_000 {
                let value = s.within(low, high);
                assert!((low..=high).contains(&value), "{value} outside {low}..={high}");
            }
        }
    }

    #[test]
    fn a_range_around_zero_excludes_its_upper_end() {
        // The largest unit is 1 − 2⁻²⁴; the formula at that value decides.
        let largest_unit = f64::from(1.0_f32 - 1.0 / 16_777_216.0);
        for bound in [0.1_f32, 1.0, 3.0, 5.0, 1e6] {
            let top = (-f64::from(bound) + 2.0 * f64::from(bound) * largest_unit) as f32;
            assert!(top < bound);
        }
    }

    #[test]
    fn a_chance_of_none_or_all_is_certain() {
        let mut s = stream(2);
        for _ in 0..10_000 {
            assert!(!s.chance(0.0));
            assert!(s.chance(1.0));
        }
    }

    /// Chi-square of seven equally likely cells: 99.99 % of samples stay below 27.86.
    #[test]
    fn every_index_is_equally_likely() {
        let mut s = stream(3);
        let mut counts = [0; 7];
        for _ in 0..70_000 {
            counts[s.index(7)] += 1;
        }
        assert!(chi_square(counts) < 27.86, "{counts:?}");
    }

    /// Four 64-bit numbers share three indices here, so that one index of each three would
    /// come twice as often if nothing were drawn again. 99.99 % of samples stay below 18.4.
    #[test]
    fn indices_stay_equally_likely_where_the_range_does_not_divide_evenly() {
        let mut s = stream(8);
        let mut counts = [0; 3];
        for _ in 0..30_000 {
            counts[s.index(3 << 62) % 3] += 1;
        }
        assert!(chi_square(counts) < 18.4, "{counts:?}");
    }

    /// Chi-square of 24 equally likely orders: 99.99 % of samples stay below 58.
    #[test]
    fn every_order_is_equally_likely() {
        let mut s = stream(4);
        let mut counts = std::collections::HashMap::new();
        for _ in 0..24_000 {
            let mut items = [0, 1, 2, 3];
            s.shuffle(&mut items);
            *counts.entry(items).or_insert(0) += 1;
        }
        assert_eq!(counts.len(), 24);
        assert!(chi_square(counts.values().copied()) < 58.0, "{counts:?}");
    }

    #[test]
    fn normal_draws_follow_the_error_function() {
        let mut s = stream(5);
        let drawn = (0..100_000).map(|_| f64::from(s.normal())).collect();
        assert!(follows(drawn, |x| 0.5 * libm::erfc(-x / std::f64::consts::SQRT_2)));
    }

    #[test]
    fn uniform_draws_fill_their_range_evenly() {
        let mut s = stream(6);
        let drawn = (0..100_000).map(|_| f64::from(s.within(-2.0, 6.0))).collect();
        assert!(follows(drawn, |x| (x + 2.0) / 8.0));
        let fine = (0..100_000).map(|_| s.unit_f64()).collect();
        assert!(follows(fine, |x| x));
    }
}

//! Numbers that look random and are the same on every machine.

/// SplitMix64 (Steele, Lea, Flood 2014), seeded with its state.
#[derive(Clone, Debug)]
pub struct Random(pub u64);

impl Random {
    /// The numbers that belong to one place of a drive: a seed, what they are for, and a step.
    pub fn at(seed: u32, purpose: u8, step: u32) -> Self {
        let mut random = Self(u64::from(seed) << 32 | u64::from(step));
        // Neighbouring places start far apart.
        Self(random.next_bits() ^ u64::from(purpose))
    }

    /// 64 bits.
    pub fn next_bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// Uniform in `-1.0..1.0`, a multiple of 2⁻²³.
    pub fn within_one(&mut self) -> f32 {
        let bits = self.next_bits() >> 40;
        bits as f32 * (1.0 / 8_388_608.0) - 1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_numbers_of_seed_0_are_those_of_the_published_generator() {
        // https://prng.di.unimi.it/splitmix64.c, seeded with 0.
        let mut random = Random(0);
        let found = [(); 3].map(|()| random.next_bits());
        assert_eq!(found, [0xe220_a839_7b1d_cdaf, 0x6e78_9e6a_a1b9_65f4, 0x06c4_5d18_8009_454f]);
    }
}

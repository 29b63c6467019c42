//! One seed repeats a run: every random number belongs to a place in it, never to a thread
//! or a moment.
//!
//! A place is (seed, [`Purpose`], generation, index). Its numbers are the key stream of
//! ChaCha8 under
//!
//! - key: the seed (8 bytes, little-endian), the purpose's number (8 bytes, little-endian),
//!   the 16 characters `evosteer streams`;
//! - nonce: `generation · 2³² + index`;
//! - block counter from 0.
//!
//! Two different places differ in key or nonce, so no cipher block of one is ever a block of
//! the other, however much either draws (a stream is 2⁷⁰ bytes long). That they look
//! independent of each other is what the cipher is for.

mod draw;
#[cfg(test)]
pub(crate) mod statistics;

use std::fmt;
use std::str::FromStr;

use rand::SeedableRng;
use rand::rngs::ChaCha8Rng;
use serde::{Deserialize, Serialize};

pub use draw::Stream;

/// The number that decides every random choice of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(transparent)]
pub struct RunSeed(pub u64);

/// What random numbers are for; different purposes never share any.
///
/// The numbers are part of what a seed means: never change or reuse one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Purpose {
    /// Genes of the first generation; index: individual.
    InitialPopulation = 1,
    /// Selection, crossover and mutation of one generation.
    Breeding = 2,
    /// Start/goal pairs that training drives.
    TrainingPairs = 3,
    /// Noise, offsets and randomised vehicles of drives.
    Episode = 4,
    /// Start/goal pairs that training never sees; also with the same seed.
    EvaluationPairs = 5,
    /// Worlds made by `scenario generate`.
    GeneratedWorld = 6,
    /// Inputs and states of the self-test in a champion's blob; generation: the champion's.
    SelfTest = 7,
    /// Noise, offsets and randomised vehicles of an evaluation's drives; index: pair.
    EvaluationDrive = 8,
    /// Start/goal pairs that choose the champion; index: pair.
    ValidationPairs = 9,
    /// Noise, offsets and randomised vehicles of the drives that choose the champion; index: pair.
    ValidationDrive = 10,
    /// Which individuals of one generation join the archive of a novelty search.
    NoveltyArchive = 11,
    /// The worlds that a run makes for itself; in place of the generation: 0 first, 1 later, 2 held out;
    /// index: world.
    TrainingWorld = 12,
}

impl Purpose {
    /// Every purpose, by number.
    pub const ALL: [Self; 12] = [
        Self::InitialPopulation,
        Self::Breeding,
        Self::TrainingPairs,
        Self::Episode,
        Self::EvaluationPairs,
        Self::GeneratedWorld,
        Self::SelfTest,
        Self::EvaluationDrive,
        Self::ValidationPairs,
        Self::ValidationDrive,
        Self::NoveltyArchive,
        Self::TrainingWorld,
    ];
}

impl RunSeed {
    /// The random numbers of one place in the run, from their beginning.
    ///
    /// What `index` counts (an individual, a pair, an attempt) is up to the purpose; use 0
    /// where there is nothing to count.
    pub fn stream(self, purpose: Purpose, generation: u32, index: u32) -> Stream {
        let mut key = *b"................evosteer streams";
        key[..8].copy_from_slice(&self.0.to_le_bytes());
        key[8..16].copy_from_slice(&(purpose as u64).to_le_bytes());
        let mut generator = ChaCha8Rng::from_seed(key);
        generator.set_stream(u64::from(generation) << 32 | u64::from(index));
        Stream::new(generator)
    }
}

impl fmt::Display for RunSeed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl FromStr for RunSeed {
    type Err = NotASeed;

    /// Reads a decimal number from 0 to 2⁶⁴ − 1.
    fn from_str(text: &str) -> Result<Self, Self::Err> {
        text.parse().map(Self).map_err(|_| NotASeed)
    }
}

/// A text that is no seed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotASeed;

impl fmt::Display for NotASeed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "expected a whole number from 0 to {}", u64::MAX)
    }
}

impl std::error::Error for NotASeed {}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::*;

    fn first_words<const N: usize>(mut stream: Stream) -> [u32; N] {
        std::array::from_fn(|_| stream.word())
    }

    /// Expected words: a ChaCha8 written in Python from RFC 8439 with 8 rounds and the
    /// original 64-bit counter and nonce.
    #[test]
    fn a_place_has_the_same_numbers_in_every_release() {
        let words = |seed, purpose, generation, index| {
            first_words::<4>(RunSeed(seed).stream(purpose, generation, index))
        };
        assert_eq!(
            words(0, Purpose::InitialPopulation, 0, 0),
            [0x6ded_1f92, 0xfb0f_9d01, 0x1afa_c21e, 0x332d_64e5]
        );
        assert_eq!(
            words(7, Purpose::Breeding, 3, 0),
            [0x332d_68ad, 0xe8b8_23c5, 0x3952_b5e6, 0xc8f2_7b80]
        );
        assert_eq!(
            words(7, Purpose::TrainingPairs, 0, 0),
            [0x83de_70bb, 0x30fc_db4b, 0xd752_0a05, 0x12d1_719e]
        );
        assert_eq!(
            words(7, Purpose::Episode, 3, 11),
            [0x9d56_4fb3, 0xd4bc_2e42, 0x2dc9_5253, 0xb8c2_6ee0]
        );
        assert_eq!(
            words(u64::MAX, Purpose::EvaluationPairs, u32::MAX, 2),
            [0xf2bb_5a4f, 0x1297_1171, 0x5505_21fc, 0x5e62_93b6]
        );
        assert_eq!(
            words(0x0123_4567_89ab_cdef, Purpose::GeneratedWorld, 0, u32::MAX),
            [0xea1e_8f42, 0x909c_6f29, 0xb7c1_84c3, 0x9b04_1d94]
        );
    }

    #[test]
    fn a_stream_goes_on_past_its_first_cipher_blocks_as_the_cipher_does() {
        let words = first_words::<1001>(RunSeed(7).stream(Purpose::Episode, 3, 11));
        assert_eq!(words[1000], 0x084f_643b);
    }

    #[test]
    fn no_two_neighbouring_places_share_a_word_pair() {
        let mut seen = HashSet::new();
        for seed in [0, 1, 1 << 32] {
            for purpose in Purpose::ALL {
                for (generation, index) in (0..8).flat_map(|g| (0..8).map(move |i| (g, i))) {
                    let words = first_words::<8>(RunSeed(seed).stream(purpose, generation, index));
                    for pair in words.as_chunks::<2>().0 {
                        assert!(seen.insert(*pair), "{seed} {purpose:?} {generation} {index}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_seed_reads_back_as_it_prints_and_refuses_anything_else() {
        let largest = RunSeed(u64::MAX);
        assert_eq!(largest.to_string().parse(), Ok(largest));
        for wrong in ["", "-1", "1.5", "18446744073709551616", "seven"] {
            assert!(wrong.parse::<RunSeed>().is_err(), "{wrong:?}");
        }
    }
}

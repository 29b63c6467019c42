//! Short lists of obstacles: up to seven names in a word, and every word once.

use std::collections::HashMap;
use std::sync::atomic::{AtomicU16, AtomicU32, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

/// Names, lowest bits first, and two flags.
pub(super) type Word = u64;

/// Bits of a name.
pub(super) const NAME: u32 = u8::BITS;

/// Names in a word.
pub(super) const NAMES: usize = 7;

/// All bits of names.
pub(super) const NAMED: Word = (1 << (NAMES as u32 * NAME)) - 1;

/// The bit of a word that says: its names are not all there are.
pub(super) const UNKNOWN: Word = 1 << (Word::BITS - 1);

/// The bit of a word that says: what is left out stands behind walls that meet, or discs that touch,
/// and a beam that passes the ends or edges of these too closely cannot be sure to meet one of them.
pub(super) const JOINT: Word = UNKNOWN >> 1;

/// The names in a word.
pub(super) fn named(word: Word) -> impl Iterator<Item = u8> {
    word.to_le_bytes().into_iter().take(NAMES).take_while(|name| *name != 0)
}

/// Every word once. Few are different, so the shelves hold short numbers.
#[derive(Debug)]
pub(super) struct Words {
    /// The first is that of what nobody has looked at.
    words: Box<[AtomicU64]>,
    numbers: Mutex<Numbers>,
}

/// The number of every word.
#[derive(Debug, Default)]
struct Numbers {
    all: HashMap<Word, u16>,
    /// The last one asked for: from one direction to the next it is mostly the same.
    last: (Word, u16),
}

/// Every word, by number.
#[derive(Clone, Copy)]
pub(super) struct AllWords<'a>(&'a [AtomicU64; Words::MOST]);

/// A word's number and a distance: the word names all that a beam can meet before that, also where it
/// passes walls' ends too closely.
#[derive(Clone, Copy)]
pub(super) struct Whole(u32);

impl Whole {
    /// Parts of a beam's range.
    const PARTS: f32 = 65_534.0;

    /// The word of this number names all within `beyond` metres, of which it remembers a little less.
    pub(super) fn new(number: u16, beyond: f32, range: f32) -> Self {
        let parts =
            if beyond < range { (beyond / range * Self::PARTS - 1.0) as u16 } else { u16::MAX };
        Self(u32::from(parts) << u16::BITS | u32::from(number))
    }

    /// What has been put here, if anything has.
    pub(super) fn in_place(place: &AtomicU32) -> Option<Self> {
        match place.load(Ordering::Acquire) {
            0 => None,
            bits => Some(Self(bits)),
        }
    }

    /// Puts it here.
    pub(super) fn put(self, place: &AtomicU32) {
        place.store(self.0, Ordering::Release);
    }

    /// The word's number.
    pub(super) fn number(self) -> u16 {
        self.0 as u16
    }

    /// No distance to what is not named is computed as less than this, metres.
    pub(super) fn beyond(self, range: f32) -> f32 {
        match (self.0 >> u16::BITS) as u16 {
            u16::MAX => f32::INFINITY,
            parts => f32::from(parts) / Self::PARTS * range,
        }
    }
}

impl Words {
    /// Numbers of words.
    const MOST: usize = 1 << u16::BITS;

    pub(super) fn new() -> Self {
        let words: Box<[AtomicU64]> = bytemuck::zeroed_slice_box(Self::MOST);
        words[0].store(UNKNOWN, Ordering::Relaxed);
        Self { words, numbers: Mutex::default() }
    }

    /// Every word.
    #[inline(always)]
    pub(super) fn all(&self) -> AllWords<'_> {
        AllWords(self.words.first_chunk().expect("a word for every number"))
    }

    /// The number of this word; none if there are too many.
    pub(super) fn number(&self, word: Word) -> Option<u16> {
        let Numbers { all, last } =
            &mut *self.numbers.lock().unwrap_or_else(PoisonError::into_inner);
        if last.0 == word && last.1 != 0 {
            return Some(last.1);
        }
        let number = match all.get(&word) {
            Some(known) => *known,
            None => {
                let number = u16::try_from(all.len() + 1).ok()?;
                self.words[usize::from(number)].store(word, Ordering::Relaxed);
                all.insert(word, number);
                number
            }
        };
        *last = (word, number);
        Some(number)
    }
}

impl AllWords<'_> {
    /// The word whose number is kept here.
    #[inline(always)]
    pub(super) fn of(self, number: &AtomicU16) -> Word {
        // Whoever sees a number also sees what it stands for.
        self.of_number(number.load(Ordering::Acquire))
    }

    /// The word of this number, which was loaded with `Acquire`.
    #[inline(always)]
    pub(super) fn of_number(self, number: u16) -> Word {
        self.0[usize::from(number)].load(Ordering::Relaxed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_distance_is_remembered_as_a_little_less(
            number: u16,
            range in 0.1_f32..200.0,
            part in 0.0_f32..1.0,
        ) {
            let whole = Whole::new(number, part * range, range);
            let remembered = whole.beyond(range);
            prop_assert_eq!(whole.number(), number);
            prop_assert!(remembered <= part * range);
            prop_assert!(remembered >= part * range - 1e-4 * range);
        }
    }

    #[test]
    fn nothing_is_nearer_than_what_lies_out_of_range() {
        assert_eq!(Whole::new(7, 10.0, 10.0).beyond(10.0), f32::INFINITY);
        assert_eq!(Whole::new(7, f32::INFINITY, 10.0).beyond(10.0), f32::INFINITY);
    }
}

//! Short lists of obstacles: up to seven names in a word, and every word once.

use std::collections::HashMap;
use std::sync::atomic::{AtomicU16, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

/// Names, lowest bits first, and two flags.
pub(super) type Word = u64;

/// Bits of a name.
pub(super) const NAME: u32 = u8::BITS;

/// Names in a word.
pub(super) const NAMES: usize = 7;

/// The bit of a word that says: its names are not all there are.
pub(super) const UNKNOWN: Word = 1 << (Word::BITS - 1);

/// The bit of a word that says: what is left out stands behind walls that meet, or discs that touch,
/// and a beam that passes the ends or edges of these too closely cannot be sure to meet one of them.
pub(super) const JOINT: Word = UNKNOWN >> 1;

/// Every word once. Few are different, so the shelves hold short numbers.
#[derive(Debug)]
pub(super) struct Words {
    /// The first is that of what nobody has looked at.
    words: Box<[AtomicU64]>,
    numbers: Mutex<HashMap<Word, u16>>,
}

/// Every word, by number.
#[derive(Clone, Copy)]
pub(super) struct AllWords<'a>(&'a [AtomicU64; Words::MOST]);

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
        let mut numbers = self.numbers.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = numbers.get(&word) {
            return Some(*known);
        }
        let number = u16::try_from(numbers.len() + 1).ok()?;
        self.words[usize::from(number)].store(word, Ordering::Relaxed);
        numbers.insert(word, number);
        Some(number)
    }
}

impl AllWords<'_> {
    /// The word whose number is kept here.
    #[inline(always)]
    pub(super) fn of(self, number: &AtomicU16) -> Word {
        // Whoever sees a number also sees what it stands for.
        let number = number.load(Ordering::Acquire);
        self.0[usize::from(number)].load(Ordering::Relaxed)
    }
}

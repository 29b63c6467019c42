//! Many questions at once, and the words that answer them.

use super::beams::Row;
use super::words::{AllWords, JOINT, NAME, NAMES, UNKNOWN, Word};
use crate::vector::{MOST_LANES, RowOfLane, Vector, fetch, ones};
use std::sync::atomic::{AtomicU16, AtomicU32, Ordering};

/// Questions of `N` times several robots, and the words that answer them.
///
/// Everything is written in place: a copy would have to wait for what has just been written.
pub(super) struct Asked<const N: usize> {
    /// Where the words' numbers are.
    places: [[u32; MOST_LANES]; N],
    words: [[Word; MOST_LANES]; N],
    /// The shelves that were asked, in a large world.
    shelves: [[u32; MOST_LANES]; N],
    /// What is set in any lane's word.
    any: [Word; N],
}

impl<const N: usize> Asked<N> {
    /// Most rounds.
    pub(super) const ROUNDS: usize = NAMES;

    /// No questions yet.
    #[inline(always)]
    pub(super) fn new() -> Self {
        const { assert!(N <= u32::BITS as usize) };
        Self {
            places: [[0; MOST_LANES]; N],
            words: [[0; MOST_LANES]; N],
            shelves: [[0; MOST_LANES]; N],
            any: [0; N],
        }
    }

    /// Writes down where the numbers of a question's words are, and the shelves in a large world.
    #[inline(always)]
    pub(super) fn ask<V: Vector>(
        &mut self,
        question: usize,
        places: V,
        shelves: Option<[u32; MOST_LANES]>,
    ) {
        if let Some(shelves) = shelves {
            self.shelves[question] = shelves;
        }
        self.places[question] = places.places();
    }

    /// Has a question's numbers fetched. Those of all robots together take as long to come as those
    /// of one.
    #[inline(always)]
    pub(super) fn fetch<V: Vector>(&self, question: usize, numbers: &[AtomicU16]) {
        for place in &self.places[question][..V::WIDTH] {
            fetch(numbers, *place as usize);
        }
    }

    /// Writes down the words of all questions.
    #[inline(always)]
    pub(super) fn answer<V: Vector>(&mut self, numbers: &[AtomicU16], words: AllWords<'_>) {
        for question in 0..N {
            let (places, slots) = (&self.places[question], &mut self.words[question]);
            let mut any = 0;
            for lane in 0..V::WIDTH {
                let word = words.of(&numbers[places[lane] as usize]);
                slots[lane] = word;
                any |= word;
            }
            self.any[question] = any;
        }
    }

    /// The words of one question.
    #[inline(always)]
    pub(super) fn words(&self, question: usize) -> &[Word; MOST_LANES] {
        &self.words[question]
    }

    /// The shelves that were asked one question, in a large world.
    #[inline(always)]
    pub(super) fn shelves(&self, question: usize) -> &[u32; MOST_LANES] {
        &self.shelves[question]
    }

    /// The questions with a name for this round in any lane.
    #[inline(always)]
    pub(super) fn with_name(&self, round: usize) -> impl Iterator<Item = usize> + use<N> {
        let mut questions = 0;
        for (number, any) in self.any.iter().enumerate() {
            let name = (*any >> (round as u32 * NAME)) as u8;
            questions |= u32::from(name != 0) << number;
        }
        ones(questions)
    }

    /// Lanes whose word does not say everything, as bits.
    #[inline(always)]
    pub(super) fn unknown<V: Vector>(&self, question: usize) -> u32 {
        if self.any[question] & UNKNOWN == 0 { 0 } else { self.with::<V>(question, UNKNOWN) }
    }

    /// Those and the lanes whose word relies on walls that meet.
    #[inline(always)]
    pub(super) fn unsure<V: Vector>(&self, question: usize) -> u32 {
        self.with::<V>(question, UNKNOWN | JOINT)
    }

    #[cold]
    #[inline(never)]
    fn with<V: Vector>(&self, question: usize, flags: Word) -> u32 {
        let mut lanes = 0;
        for (lane, word) in self.words[question][..V::WIDTH].iter().enumerate() {
            lanes |= u32::from(*word & flags != 0) << lane;
        }
        lanes
    }
}

/// Rows of a large world.
pub(super) struct ByPlace<'a> {
    pub(super) table: &'a [Row],
    pub(super) places: &'a [AtomicU32],
    pub(super) words: &'a [Word; MOST_LANES],
    pub(super) shelves: &'a [u32; MOST_LANES],
    pub(super) round: usize,
}

impl RowOfLane for ByPlace<'_> {
    #[inline(always)]
    fn row(&self, lane: usize) -> &Row {
        let name = (self.words[lane] >> (self.round as u32 * NAME)) as u8;
        let place = place(self.shelves[lane], name);
        &self.table[self.places[place].load(Ordering::Relaxed) as usize]
    }
}

/// Where a shelf keeps what a name means.
pub(super) fn place(shelf: u32, name: u8) -> usize {
    (shelf as usize) << NAME | usize::from(name)
}

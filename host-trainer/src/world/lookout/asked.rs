//! Many questions at once, and the words that answer them.

use super::beams::Row;
use super::legends::Meanings;
use super::words::{AllWords, JOINT, NAME, NAMES, UNKNOWN, Word};
use crate::vector::{MOST_LANES, RowOfLane, Vector, fetch, ones};
use std::sync::atomic::AtomicU16;

/// Questions of `N` times several robots, and the words that answer them.
///
/// Everything is written in place: a copy would have to wait for what has just been written.
pub(super) struct Asked<const N: usize> {
    /// Where the words' numbers are.
    places: [[u32; MOST_LANES]; N],
    words: [[Word; MOST_LANES]; N],
    /// By which legends the words are to be read, in a large world.
    legends: [[u32; MOST_LANES]; N],
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
            legends: [[0; MOST_LANES]; N],
            any: [0; N],
        }
    }

    /// Writes down where the numbers of a question's words are, and the legends in a large world.
    #[inline(always)]
    pub(super) fn ask<V: Vector>(
        &mut self,
        question: usize,
        places: V,
        legends: Option<&[u32; MOST_LANES]>,
    ) {
        if let Some(legends) = legends {
            self.legends[question] = *legends;
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

    /// Writes down the words of all questions. They go by car, as many for each; those of a car without
    /// a lane in `live` have no names.
    #[inline(always)]
    pub(super) fn answer<V: Vector>(
        &mut self,
        numbers: &[AtomicU16],
        words: AllWords<'_>,
        live: &[u32],
    ) {
        for question in 0..N {
            if live[question * live.len() / N] == 0 {
                self.any[question] = 0;
                continue;
            }
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

    /// The legends to one question's words, in a large world.
    #[inline(always)]
    pub(super) fn legends(&self, question: usize) -> &[u32; MOST_LANES] {
        &self.legends[question]
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
    table: &'a [Row],
    meanings: &'a Meanings,
    /// Where each lane's name is among the meanings.
    at: [u32; MOST_LANES],
}

impl<'a> ByPlace<'a> {
    /// Those of each word's name in this round, as its legend says.
    #[inline(always)]
    pub(super) fn new(
        table: &'a [Row],
        meanings: &'a Meanings,
        words: &[Word; MOST_LANES],
        legends: &[u32; MOST_LANES],
        round: usize,
    ) -> Self {
        // By themselves, so that the compiler makes vectors of it.
        let mut at = [0; MOST_LANES];
        for lane in 0..MOST_LANES {
            let name = (words[lane] >> (round as u32 * NAME)) as u32 & 0xff;
            at[lane] = legends[lane] << NAME | name;
        }
        Self { table, meanings, at }
    }
}

impl RowOfLane for ByPlace<'_> {
    #[inline(always)]
    fn row(&self, lane: usize) -> &Row {
        &self.table[self.meanings.at(self.at[lane])]
    }
}

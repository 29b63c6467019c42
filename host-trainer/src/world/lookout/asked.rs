//! Many questions at once, and the words that answer them.

use super::beams::Row;
use super::legends::Meanings;
use super::words::{AllWords, JOINT, NAME, NAMED, NAMES, UNKNOWN, Word};
use crate::vector::{MOST_LANES, RowOfLane, Vector, fetch};
use std::sync::atomic::AtomicU16;

/// Questions as bits, by how many names their longest word has.
pub(super) type ByNames = [u32; NAMES + 1];

/// Questions of `N` times several robots, and the words that answer them.
///
/// Everything is written in place: a copy would have to wait for what has just been written.
pub(super) struct Asked<const N: usize> {
    /// Where the words' numbers are.
    places: [[u32; MOST_LANES]; N],
    words: [[Word; MOST_LANES]; N],
    /// Where the legends start by which the words are to be read, in a large world.
    legend_starts: [[u32; MOST_LANES]; N],
    /// What is set in any lane's word.
    any: [Word; N],
    /// Lanes in which a question may have been left open, as bits.
    open: [u32; N],
}

impl<const N: usize> Asked<N> {
    /// No questions yet.
    #[inline(always)]
    pub(super) fn new() -> Self {
        const { assert!(N <= u32::BITS as usize) };
        Self {
            places: [[0; MOST_LANES]; N],
            words: [[0; MOST_LANES]; N],
            legend_starts: [[0; MOST_LANES]; N],
            any: [0; N],
            open: [0; N],
        }
    }

    /// Writes down where the numbers of a question's words are, and the legends in a large world.
    #[inline(always)]
    pub(super) fn ask<V: Vector>(
        &mut self,
        question: usize,
        places: V,
        legend_starts: Option<&[u32; MOST_LANES]>,
    ) {
        if let Some(starts) = legend_starts {
            self.legend_starts[question] = *starts;
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

    /// Writes down the words of all questions; returns the questions by how many names their longest word
    /// has. They go by car, as many for each; those of a car without a lane in `live` are not asked.
    #[inline(always)]
    pub(super) fn answer<V: Vector>(
        &mut self,
        numbers: &[AtomicU16],
        words: AllWords<'_>,
        live: &[u32],
    ) -> ByNames {
        let mut by_names = [0; NAMES + 1];
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
            by_names[longest(any)] |= 1 << question;
        }
        by_names
    }

    /// The words of one question.
    #[inline(always)]
    pub(super) fn words(&self, question: usize) -> &[Word; MOST_LANES] {
        &self.words[question]
    }

    /// Where the legends to one question's words start, in a large world.
    #[inline(always)]
    pub(super) fn legend_starts(&self, question: usize) -> &[u32; MOST_LANES] {
        &self.legend_starts[question]
    }

    /// Lanes whose word does not say everything, as bits.
    #[inline(always)]
    pub(super) fn unknown<V: Vector>(&self, question: usize) -> u32 {
        if self.any[question] & UNKNOWN == 0 { 0 } else { self.with::<V>(question, UNKNOWN) }
    }

    /// Writes down in which lanes a question may be left open, of which these are doubtful; returns whether
    /// there are any. Lanes where nobody asks are among them until [`Self::close`].
    #[inline(always)]
    pub(super) fn leave_open<V: Vector>(&mut self, question: usize, doubtful: u32) -> bool {
        self.open[question] = doubtful | self.unknown::<V>(question);
        self.open[question] != 0
    }

    /// Closes a question where nobody in `live` asks, and where its word says everything and does not rely on
    /// walls that meet.
    #[inline(never)]
    pub(super) fn close<V: Vector>(&mut self, question: usize, live: u32) {
        self.open[question] &= live & self.with::<V>(question, UNKNOWN | JOINT);
    }

    /// In which lanes a question is open, as bits, if it was left open since it was asked.
    #[inline(always)]
    pub(super) fn open(&self, question: usize) -> u32 {
        self.open[question]
    }

    /// Where the number of one question's word is in each lane.
    #[inline(always)]
    pub(super) fn places(&self, question: usize) -> &[u32; MOST_LANES] {
        &self.places[question]
    }

    #[inline(never)]
    fn with<V: Vector>(&self, question: usize, flags: Word) -> u32 {
        let mut lanes = 0;
        for (lane, word) in self.words[question][..V::WIDTH].iter().enumerate() {
            lanes |= u32::from(*word & flags != 0) << lane;
        }
        lanes
    }
}

/// How many names the longest of some words has, of which this is set in any.
#[inline(always)]
fn longest(any: Word) -> usize {
    (any & NAMED).checked_ilog2().map_or(0, |last| (last / NAME) as usize + 1)
}

/// Rows of a large world, of what each lane's word names in a round, as its legend says.
#[derive(Clone, Copy)]
pub(super) struct ByPlace<'a> {
    /// By place, after one that nothing meets.
    pub(super) table: &'a [Row],
    pub(super) meanings: &'a Meanings,
    pub(super) words: &'a [Word; MOST_LANES],
    pub(super) legend_starts: &'a [u32; MOST_LANES],
    pub(super) round: usize,
}

impl RowOfLane for ByPlace<'_> {
    #[inline(always)]
    fn row(&self, lane: usize) -> &Row {
        // Little-endian, as controller-core demands.
        let names: &[u8] = bytemuck::must_cast_slice(self.words);
        let name = names[lane * size_of::<Word>() + self.round];
        &self.table[self.meanings.at(self.legend_starts[lane], name)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_word_counts_whatever_its_flags() {
        for names in 0..=NAMES {
            let word = (0..names).fold(0, |word, _| word << NAME | 3);
            for flags in [0, JOINT, UNKNOWN, JOINT | UNKNOWN] {
                assert_eq!(longest(word | flags), names, "{word:x}");
                assert_eq!(longest(word | flags | 1), names.max(1), "{word:x} and one name");
            }
        }
    }
}

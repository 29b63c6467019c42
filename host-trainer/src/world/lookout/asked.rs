//! Many questions at once, and the words that answer them.

use super::beams::Row;
use super::legends::Meanings;
use super::words::{AllWords, JOINT, NAME, NAMED, NAMES, UNKNOWN, Word};
use crate::vector::{MOST_LANES, RowOfLane, Vector, fetch, ones};
use std::sync::atomic::AtomicU16;

/// Names in the low half of a word.
pub(super) const IN_HALF: usize = (u32::BITS / NAME) as usize;

/// What the high half of a word says: further names, and that they are not all there are.
const IN_HIGH: Word = (NAMED | UNKNOWN) & !(u32::MAX as Word);

/// Questions as bits, by how many names their longest word has; those that nobody asks are left out.
pub(super) type ByNames = [u32; NAMES + 1];

/// Questions of `N` times several robots, and the words that answer them.
///
/// Everything is written in place: a copy would have to wait for what has just been written.
pub(super) struct Asked<const N: usize> {
    /// Where the words' numbers are.
    places: [[u32; MOST_LANES]; N],
    /// The low halves of the words: their first names.
    low: [[u32; MOST_LANES]; N],
    /// The high halves, where any lane's says something of [`IN_HIGH`].
    high: [[u32; MOST_LANES]; N],
    /// Where the legends start by which the words are to be read, in a large world.
    legend_starts: [[u32; MOST_LANES]; N],
    /// What is set in any lane's word.
    any: [Word; N],
    /// Lanes in which a question may have been left open, as bits.
    open: [u32; N],
}

/// A name of every lane.
#[derive(Clone, Copy)]
pub(super) struct Names<'a> {
    /// Halves of words.
    pub(super) halves: &'a [u32; MOST_LANES],
    /// Which name of each.
    pub(super) byte: usize,
    /// Where the legends to them start, in a large world.
    pub(super) legend_starts: &'a [u32; MOST_LANES],
}

impl<const N: usize> Asked<N> {
    /// No questions yet.
    #[inline(always)]
    pub(super) fn new() -> Self {
        const { assert!(N <= u32::BITS as usize) };
        Self {
            places: [[0; MOST_LANES]; N],
            low: [[0; MOST_LANES]; N],
            high: [[0; MOST_LANES]; N],
            legend_starts: [[0; MOST_LANES]; N],
            any: [0; N],
            open: [0; N],
        }
    }

    /// Writes down where the numbers of a question's words are, and the legends in a large world.
    #[inline(always)]
    pub(super) fn ask(
        &mut self,
        question: usize,
        places: [u32; MOST_LANES],
        legend_starts: Option<&[u32; MOST_LANES]>,
    ) {
        if let Some(starts) = legend_starts {
            self.legend_starts[question] = *starts;
        }
        self.places[question] = places;
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
    /// has. They go by car, as many for each; those of a car without a lane in `live` are not asked. Where words
    /// mostly are short, it saves time to leave out their high halves.
    #[inline(always)]
    pub(super) fn answer<V: Vector>(
        &mut self,
        numbers: &[AtomicU16],
        words: AllWords<'_>,
        live: &[u32],
        words_are_long: bool,
    ) -> ByNames {
        let mut by_names = [0; NAMES + 1];
        for question in 0..N {
            if live[question * live.len() / N] == 0 {
                self.any[question] = 0;
                continue;
            }
            if words_are_long {
                self.answer_whole::<V>(question, numbers, words);
            } else {
                self.answer_half::<V>(question, numbers, words);
            }
            by_names[self.longest(question)] |= 1 << question;
        }
        by_names
    }

    /// Writes down the low halves of one question's words, and all of them if that is not enough.
    #[inline(always)]
    fn answer_half<V: Vector>(
        &mut self,
        question: usize,
        numbers: &[AtomicU16],
        words: AllWords<'_>,
    ) {
        let (places, halves) = (&self.places[question], &mut self.low[question]);
        let mut any = 0;
        for lane in 0..V::WIDTH {
            let word = words.of(&numbers[places[lane] as usize]);
            halves[lane] = word as u32;
            any |= word;
        }
        self.any[question] = any;
        if any & IN_HIGH != 0 {
            // All of them again: others may have become known meanwhile.
            self.answer_whole::<V>(question, numbers, words);
        }
    }

    /// Writes down one question's words.
    #[inline(always)]
    fn answer_whole<V: Vector>(
        &mut self,
        question: usize,
        numbers: &[AtomicU16],
        words: AllWords<'_>,
    ) {
        let mut any = 0;
        for lane in 0..V::WIDTH {
            let word = words.of(&numbers[self.places[question][lane] as usize]);
            self.low[question][lane] = word as u32;
            self.high[question][lane] = (word >> u32::BITS) as u32;
            any |= word;
        }
        self.any[question] = any;
    }

    /// How many names the longest word of one question has.
    #[inline(always)]
    pub(super) fn longest(&self, question: usize) -> usize {
        longest(self.any[question])
    }

    /// The names of one question in a round, the first of each word in round 0.
    #[inline(always)]
    pub(super) fn names(&self, question: usize, round: usize) -> Names<'_> {
        let halves = if round < IN_HALF { &self.low } else { &self.high };
        let legend_starts = &self.legend_starts[question];
        Names { halves: &halves[question], byte: round % IN_HALF, legend_starts }
    }

    /// Lanes whose word does not say everything, as bits.
    #[inline(always)]
    pub(super) fn unknown<V: Vector>(&self, question: usize) -> u32 {
        if self.any[question] & UNKNOWN == 0 {
            return 0;
        }
        V::lanes_with(&self.high[question], (UNKNOWN >> u32::BITS) as u32)
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
    pub(super) fn close(
        &mut self,
        question: usize,
        numbers: &[AtomicU16],
        words: AllWords<'_>,
        live: u32,
    ) {
        let has_high = self.any[question] & IN_HIGH != 0;
        let mut open = 0;
        for lane in ones(self.open[question] & live) {
            let flags = match has_high {
                true => Word::from(self.high[question][lane]) << u32::BITS,
                false => words.of(&numbers[self.places[question][lane] as usize]),
            };
            open |= u32::from(flags & (UNKNOWN | JOINT) != 0) << lane;
        }
        self.open[question] = open;
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

    /// Where the legends to one question's words start, in a large world.
    #[inline(always)]
    pub(super) fn legend_starts(&self, question: usize) -> &[u32; MOST_LANES] {
        &self.legend_starts[question]
    }
}

impl Asked<1> {
    /// Writes down the word of a lane of the only question, and where its legend starts.
    #[inline(always)]
    pub(super) fn put(&mut self, lane: usize, word: Word, legend_start: u32) {
        self.low[0][lane] = word as u32;
        self.high[0][lane] = (word >> u32::BITS) as u32;
        self.legend_starts[0][lane] = legend_start;
        self.any[0] |= word;
    }
}

/// How many names the longest of some words has, of which this is set in any.
#[inline(always)]
fn longest(any: Word) -> usize {
    (any & NAMED).checked_ilog2().map_or(0, |last| (last / NAME) as usize + 1)
}

/// Rows of a large world, of each lane's name, as its legend says.
#[derive(Clone, Copy)]
pub(super) struct ByPlace<'a> {
    /// By place, after one that nothing meets.
    pub(super) table: &'a [Row],
    pub(super) meanings: &'a Meanings,
    pub(super) names: Names<'a>,
}

impl RowOfLane for ByPlace<'_> {
    #[inline(always)]
    fn row(&self, lane: usize) -> &Row {
        let Names { halves, byte, legend_starts } = self.names;
        // Little-endian, as controller-core demands.
        let names: &[u8] = bytemuck::must_cast_slice(halves);
        let name = names[lane * size_of::<u32>() + byte];
        &self.table[self.meanings.at(legend_starts[lane], name)]
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

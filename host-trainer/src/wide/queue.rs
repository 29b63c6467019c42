//! Who drives what next: the pairs of all individuals, handed out in order.

use super::SLOTS;
use crate::signals::StopFlag;
use crate::vector::Instructions;
use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Most pairs that are handed out together, as a multiple of [`SLOTS`].
const MOST_ROUNDS: usize = 4;

/// Some pairs of one individual.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Job {
    /// The individual.
    pub(super) individual: usize,
    /// The pairs.
    pub(super) pairs: Range<usize>,
}

/// All that is left to drive; shared by all threads.
#[derive(Debug)]
pub(super) struct Queue<'a> {
    next: AtomicUsize,
    individuals: usize,
    pairs: usize,
    together: usize,
    stop: &'a StopFlag,
}

impl<'a> Queue<'a> {
    /// Every pair for every individual. So many are handed out together that a lane has some to
    /// refill from, but not so many that lanes run empty at the end.
    pub(super) fn new(
        individuals: usize,
        pairs: usize,
        threads: usize,
        instructions: Instructions,
        stop: &'a StopFlag,
    ) -> Self {
        let lanes = threads * instructions.width();
        let together = individuals * pairs / (4 * lanes);
        let together = together.clamp(SLOTS, MOST_ROUNDS * SLOTS);
        Self { next: AtomicUsize::new(0), individuals, pairs, together, stop }
    }

    /// Whether everything has been handed out, or the user wants no more.
    pub(super) fn is_stopped(&self) -> bool {
        self.stop.requested().is_some()
    }

    /// The next job.
    pub(super) fn take(&self) -> Option<Job> {
        if self.is_stopped() {
            return None;
        }
        self.job(self.next.fetch_add(1, Ordering::Relaxed))
    }

    /// The next job, if it is of this individual.
    pub(super) fn take_more(&self, individual: usize) -> Option<Job> {
        let next = self.next.load(Ordering::Relaxed);
        let job = self.job(next).filter(|job| job.individual == individual)?;
        let (done, free) = (Ordering::Relaxed, Ordering::Relaxed);
        self.next.compare_exchange(next, next + 1, done, free).ok().map(|_| job)
    }

    fn job(&self, number: usize) -> Option<Job> {
        let per_individual = self.pairs.div_ceil(self.together).max(1);
        let (individual, part) = (number / per_individual, number % per_individual);
        let start = part * self.together;
        let pairs = start..(start + self.together).min(self.pairs);
        (individual < self.individuals && !pairs.is_empty()).then_some(Job { individual, pairs })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_individual_gets_every_pair_once_whoever_takes_them() {
        let stop = StopFlag::default();
        for (individuals, pairs, threads) in [(1, 1, 1), (3, 5, 2), (7, 64, 1), (1, 1000, 2)] {
            for instructions in Instructions::ALL {
                let queue = Queue::new(individuals, pairs, threads, instructions, &stop);
                let mut driven = vec![0; individuals * pairs];
                let mut last = None;
                while let Some(job) =
                    last.and_then(|individual| queue.take_more(individual)).or_else(|| queue.take())
                {
                    last = (last != Some(job.individual)).then_some(job.individual);
                    for pair in job.pairs {
                        driven[job.individual * pairs + pair] += 1;
                    }
                }
                assert!(driven.iter().all(|times| *times == 1), "{individuals} {pairs}");
            }
        }
    }

    #[test]
    fn nothing_is_handed_out_any_more_once_the_user_wants_to_stop() {
        let stop = StopFlag::default();
        let queue = Queue::new(10, 5, 1, Instructions::Scalar, &stop);
        assert!(queue.take().is_some());
        stop.request(2);
        assert!(queue.take().is_none());
    }
}

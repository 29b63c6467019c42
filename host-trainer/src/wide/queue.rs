//! Who drives what next: the pairs of all individuals, handed out one by one.

use crate::signals::StopFlag;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A pair of an individual.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Job {
    /// The individual.
    pub(super) individual: usize,
    /// The pair.
    pub(super) pair: usize,
}

/// All that is left to drive; shared by all threads. The last individuals come first: in a population the unchanged
/// copies of the last generation stand there, who drive longest, and whoever begins late is waited for.
#[derive(Debug)]
pub(super) struct Queue<'a> {
    /// Individuals, the last ones, of whom something has been handed out.
    begun: AtomicUsize,
    /// Individuals, the last ones, of whom nothing is left.
    over: AtomicUsize,
    /// Of each individual: the next pair.
    next: Vec<AtomicUsize>,
    pairs: usize,
    stop: &'a StopFlag,
}

impl<'a> Queue<'a> {
    /// Every pair for every individual.
    pub(super) fn new(individuals: usize, pairs: usize, stop: &'a StopFlag) -> Self {
        let next = (0..individuals).map(|_| AtomicUsize::new(0)).collect();
        Self { begun: AtomicUsize::new(0), over: AtomicUsize::new(0), next, pairs, stop }
    }

    /// Whether the user wants no more.
    pub(super) fn is_stopped(&self) -> bool {
        self.stop.requested().is_some()
    }

    /// Whether there is anything left.
    pub(super) fn has_drives(&self) -> bool {
        self.next_left().is_some()
    }

    /// A pair of an individual who has not begun, or, once all have, of the last of whom any is
    /// left: whoever takes it has weights to load, while those who have them go on with
    /// [`Self::take_more`].
    pub(super) fn take(&self) -> Option<Job> {
        if self.is_stopped() {
            return None;
        }
        if self.begun.load(Ordering::Relaxed) < self.next.len() {
            let begun = self.begun.fetch_add(1, Ordering::Relaxed);
            if let Some(individual) = self.next.len().checked_sub(begun + 1)
                && let Some(pair) = self.take_more(individual)
            {
                return Some(Job { individual, pair });
            }
        }
        loop {
            let individual = self.next_left()?;
            if let Some(pair) = self.take_more(individual) {
                return Some(Job { individual, pair });
            }
        }
    }

    /// Another pair of this individual.
    pub(super) fn take_more(&self, individual: usize) -> Option<usize> {
        if !self.has_more(individual) {
            return None;
        }
        let pair = self.next[individual].fetch_add(1, Ordering::Relaxed);
        (pair < self.pairs).then_some(pair)
    }

    fn has_more(&self, individual: usize) -> bool {
        self.next[individual].load(Ordering::Relaxed) < self.pairs
    }

    /// The last individual of whom a pair is left.
    fn next_left(&self) -> Option<usize> {
        let all = self.next.len();
        let over = self.over.load(Ordering::Relaxed);
        let last = (0..all - over).rfind(|individual| self.has_more(*individual));
        self.over.fetch_max(last.map_or(all, |last| all - 1 - last), Ordering::Relaxed);
        last
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_individual_gets_every_pair_once_whoever_takes_them() {
        let stop = StopFlag::default();
        for (individuals, pairs) in [(1, 1), (3, 5), (7, 64), (1, 1000), (4, 0)] {
            let queue = Queue::new(individuals, pairs, &stop);
            let mut driven = vec![0; individuals * pairs];
            while let Some(Job { individual, pair }) = queue.take() {
                driven[individual * pairs + pair] += 1;
                // Some take what is left of their individual, some a few, some none.
                for _ in 0..[1000, 2, 0][individual % 3] {
                    let Some(pair) = queue.take_more(individual) else { break };
                    driven[individual * pairs + pair] += 1;
                }
                assert_eq!(queue.has_drives(), driven.contains(&0));
            }
            assert!(driven.iter().all(|times| *times == 1), "{individuals} {pairs}");
        }
    }

    #[test]
    fn all_individuals_begin_before_anybody_is_helped() {
        let stop = StopFlag::default();
        let queue = Queue::new(3, 2, &stop);
        let taken: Vec<_> = std::iter::from_fn(|| queue.take()).collect();
        let job = |individual, pair| Job { individual, pair };
        assert_eq!(taken, [job(2, 0), job(1, 0), job(0, 0), job(2, 1), job(1, 1), job(0, 1)]);
    }

    #[test]
    fn nothing_is_handed_out_any_more_once_the_user_wants_to_stop() {
        let stop = StopFlag::default();
        let queue = Queue::new(10, 5, &stop);
        assert!(queue.take().is_some());
        stop.request(2);
        assert!(queue.take().is_none());
    }
}

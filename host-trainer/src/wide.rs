//! Many drives at once, for training and evaluation.
//!
//! A *block* drives [`SLOTS`] cars in each lane of this CPU's vectors. A lane belongs to one
//! individual, whose weights are a column of the block's weights; its cars drive that
//! individual's pairs. A car whose drive has ended takes the next pair, a lane whose individual
//! is done the next individual, until there is nothing left to drive. Where individuals have few
//! pairs and drives end early, cars come to wait for the longest drive of their lane; once they have
//! waited too much, each car is given weights of its own and goes from individual to individual by
//! itself. Once nothing is left to begin, cars close ranks: they leave whole slots empty. Drives end
//! when they like, so lanes and order are a matter of chance; outcomes are kept by individual and pair.
//!
//! [`episode::drive`](crate::episode::drive) is the reference: every operation here is the same
//! generic function over a wider lane, or the same function called for one car after the other
//! (its start), or a number drawn for all who drive the pair (its noise), so each outcome has the
//! bits of that drive.
//!
//! | look in | for |
//! | --- | --- |
//! | `queue` | who drives what next |
//! | `block` | lanes and slots, what happens when a drive ends, how long cars wait for each other |
//! | `cars` | one car in each lane: what they see, how they move |
//! | `starts` | where drives begin, worked out once for all who drive a pair |
//! | `tape` | noise and dropped beams, drawn once for all who drive a pair |
//! | `forward` | the networks of all cars, sizes known at run time |

mod block;
mod cars;
mod forward;
mod queue;
mod starts;
mod tape;

use crate::episode::Outcome;
use crate::problem::Problem;
use crate::scenario::Pair;
use crate::seed::Stream;
use crate::signals::StopFlag;
use crate::vector::{Instructions, Kernel, Vector};
use block::Block;
pub(crate) use forward::step_of_slots;
use queue::Queue;
use starts::Starts;
use tape::Tapes;

/// Cars in each lane. Five share each load of a weight, keep the CPU's arithmetic busy, and
/// are as many as the pairs of the paper's training.
pub const SLOTS: usize = 5;

/// Individuals from which on it pays to keep what is the same for all who drive a pair.
const ENOUGH_INDIVIDUALS: usize = 4;

/// What is to be driven: every individual drives every pair.
pub struct Fleet<'a> {
    /// World, car and network.
    pub problem: &'a Problem,
    /// The individuals' genomes one after the other, each of the problem's topology.
    pub genomes: &'a [f32],
    /// The pairs.
    pub pairs: &'a [Pair],
    /// The random numbers of the drive of each pair, the same for every individual.
    pub random: &'a (dyn Fn(u32) -> Stream + Sync),
    /// Whether a car whose drive has ended starts it again until the step limit, so that every
    /// individual makes the same number of steps. The outcome is that of the first drive.
    pub again: bool,
}

/// How a fleet's drives went.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drives {
    /// Of each individual and pair: all pairs of the first individual, then of the second.
    pub outcomes: Vec<Outcome>,
    /// What happened on the way.
    pub tally: Tally,
}

/// What happened in a fleet's drives, those that were driven again included.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tally {
    /// Control periods of all cars.
    pub steps: u64,
    /// Drives that a collision ended.
    pub stopped: u64,
    /// Drives that reached their target.
    pub reached: u64,
}

impl Fleet<'_> {
    fn individuals(&self) -> usize {
        self.genomes.len() / self.problem.topology().weights()
    }

    /// Drives on the current rayon pool; none once `stop` is raised.
    pub fn drive(&self, instructions: Instructions, stop: &StopFlag) -> Option<Drives> {
        self.drive_by(stop, |work| rayon::broadcast(|_| instructions.run(work)))
    }

    /// Drives on this thread alone; none once `stop` is raised.
    pub fn drive_here(&self, instructions: Instructions, stop: &StopFlag) -> Option<Drives> {
        self.drive_by(stop, |work| vec![instructions.run(work)])
    }

    fn drive_by(&self, stop: &StopFlag, run: impl FnOnce(Work<'_>) -> Vec<Done>) -> Option<Drives> {
        let queue = Queue::new(self.individuals(), self.pairs.len(), stop);
        let (starts, tapes) = (Starts::of(self), Tapes::of(self));
        let done = run(Work { fleet: self, queue: &queue, starts: &starts, tapes: &tapes });
        if stop.requested().is_some() {
            return None;
        }
        let drives = self.individuals() * self.pairs.len();
        let mut all = Drives { outcomes: vec![Outcome::default(); drives], ..Drives::default() };
        for (outcomes, tally) in done {
            for (index, outcome) in outcomes {
                all.outcomes[index] = outcome;
            }
            all.tally.steps += tally.steps;
            all.tally.stopped += tally.stopped;
            all.tally.reached += tally.reached;
        }
        Some(all)
    }
}

/// What one thread does.
#[derive(Clone, Copy)]
struct Work<'a> {
    fleet: &'a Fleet<'a>,
    queue: &'a Queue<'a>,
    starts: &'a Starts,
    tapes: &'a Tapes,
}

/// Outcomes with their places, and what else happened.
type Done = (Vec<(usize, Outcome)>, Tally);

impl Kernel for Work<'_> {
    type Output = Done;

    #[inline(always)]
    fn run<V: Vector>(self) -> Done {
        let mut block = Block::<V>::new(self);
        while block.fill() {
            block.step();
        }
        block.done()
    }
}

#[cfg(test)]
mod tests;

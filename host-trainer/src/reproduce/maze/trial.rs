//! One search from one seed.

use super::plan::MazeSetup;
use crate::checkpoint;
use crate::failure::Failure;
use crate::picture;
use crate::problem::training_drive;
use crate::report::data::Drive;
use crate::reproduce::workers::Job;
use crate::run_folder::RunFolder;
use crate::seed::RunSeed;
use crate::signals::StopFlag;
use crate::training::{Best, Training};
use serde::{Deserialize, Serialize};
use std::io::ErrorKind;

/// A search, done.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MazeTrial {
    /// What it was made of: [`MazeSetup::fingerprint`].
    pub setup: [u8; 32],
    /// Its seed.
    pub seed: u64,
    /// Whether the goal was reached.
    pub solved: bool,
    /// Individuals that were judged, those of the last generation included.
    pub evaluations: u64,
    /// Who reached it, or came nearest.
    pub best: Best,
    /// Where drives ended, from the first generation to the last: all, or evenly some.
    pub ends: Vec<[f32; 2]>,
}

/// Most points that a trial keeps of where drives ended: enough for a picture.
const MOST_ENDS: usize = 4096;

/// Every `stride`-th of the points it is shown, the stride doubled whenever it holds too many.
struct Thinned {
    ends: Vec<[f32; 2]>,
    stride: usize,
    shown: usize,
}

impl Thinned {
    fn show(&mut self, end: [f32; 2]) {
        if self.shown.is_multiple_of(self.stride) {
            if self.ends.len() == MOST_ENDS {
                let mut place = 0..;
                self.ends
                    .retain(|_| place.next().is_none_or(|place: usize| place.is_multiple_of(2)));
                self.stride *= 2;
            }
            if self.shown.is_multiple_of(self.stride) {
                self.ends.push(end);
            }
        }
        self.shown += 1;
    }
}

/// A trial to be done.
#[derive(Clone, Copy, Debug)]
pub struct MazeTask<'a> {
    /// What.
    pub setup: &'a MazeSetup,
    /// From which seed.
    pub seed: RunSeed,
}

impl Job for MazeTask<'_> {
    type Trial = MazeTrial;

    fn run(
        &self,
        stop: &StopFlag,
        judged: impl FnMut() -> bool,
    ) -> Result<Option<MazeTrial>, Failure> {
        MazeTrial::run(self.setup, self.seed, stop, judged)
    }
}

impl MazeTrial {
    /// Searches on the current rayon pool; none if `stop` was raised meanwhile, or `judged` (called
    /// after every generation) says no.
    ///
    /// # Errors
    ///
    /// A world in which no pair is found.
    pub fn run(
        setup: &MazeSetup,
        seed: RunSeed,
        stop: &StopFlag,
        mut judged: impl FnMut() -> bool,
    ) -> Result<Option<Self>, Failure> {
        let mut training = Training::new(&setup.problem, seed)?;
        let mut ends = Thinned { ends: Vec::new(), stride: 1, shown: 0 };
        while !training.is_over() {
            if training.step_unless(stop)?.is_none() || !judged() {
                return Ok(None);
            }
            for end in training.ends().points() {
                if let [x, y, ..] = *end {
                    ends.show([x, y]);
                }
            }
        }
        let best = training.best().cloned().expect("at least one generation was judged");
        Ok(Some(Self {
            setup: setup.fingerprint(),
            seed: seed.0,
            solved: training.is_solved(),
            evaluations: u64::from(training.generation()) * setup.work_of_a_generation(),
            best,
            ends: ends.ends,
        }))
    }

    /// The drive of who reached the goal, or came nearest, driven alone and step by step.
    ///
    /// # Errors
    ///
    /// A world in which no pair is found.
    pub fn drive(&self, setup: &MazeSetup) -> Result<Option<Drive>, Failure> {
        let seed = RunSeed(self.seed);
        let training = Training::new(&setup.problem, seed)?;
        let pairs = training.pairs_of(&self.best)?;
        let place = |pair| training_drive(seed, self.best.generation, pair);
        let drives = picture::drives(&setup.problem, &self.best.genome, &pairs, place);
        Ok(drives.into_iter().next())
    }

    /// Keeps it in the folder.
    ///
    /// # Errors
    ///
    /// Input/output, naming the file.
    pub fn write(&self, setup: &MazeSetup, folder: &RunFolder) -> Result<(), Failure> {
        let generations = self.evaluations / setup.work_of_a_generation();
        let bytes = checkpoint::encode(generations, self)
            .map_err(|error| Failure::bad_input(format!("a trial cannot be written: {error}")))?;
        folder.write(&setup.file(RunSeed(self.seed)), &bytes)
    }

    /// The trial of this seed, if it is done and whole; what is damaged is done again.
    ///
    /// # Errors
    ///
    /// A trial of another setup; a file that cannot be read.
    pub fn read(
        setup: &MazeSetup,
        seed: RunSeed,
        folder: &RunFolder,
    ) -> Result<Option<Self>, Failure> {
        let path = folder.join(&setup.file(seed));
        let bytes = match std::fs::read(&path) {
            Ok(bytes) => bytes,
            Err(cause) if cause.kind() == ErrorKind::NotFound => return Ok(None),
            Err(cause) => return Err(Failure::io("read", &path, &cause)),
        };
        let Ok((_, trial)) = checkpoint::decode::<Self>(&bytes) else { return Ok(None) };
        if (trial.setup, trial.seed) == (setup.fingerprint(), seed.0) {
            return Ok(Some(trial));
        }
        Err(super::super::trial::other_settings(&path))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_run_keeps_evenly_some_of_where_it_ended() {
        let mut thinned = Thinned { ends: Vec::new(), stride: 1, shown: 0 };
        for end in 0..5 * MOST_ENDS {
            thinned.show([end as f32, 0.0]);
        }
        let expected: Vec<[f32; 2]> =
            (0..5 * MOST_ENDS).step_by(8).map(|end| [end as f32, 0.0]).collect();
        assert_eq!(thinned.ends, expected);
    }
}

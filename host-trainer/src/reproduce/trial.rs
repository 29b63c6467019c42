//! One training by one method from one seed, and how its champions do.

use super::failures::Ending;
use super::setup::Setup;
use super::workers::Job;
use crate::checkpoint;
use crate::evaluation::{self, Evaluation, Share};
use crate::failure::Failure;
use crate::pairs::PairSampler;
use crate::problem::{evaluation_drive, training_drive};
use crate::report::data::Drive;
use crate::run_folder::{MetricsRow, RunFolder};
use crate::scenario::Pair;
use crate::seed::RunSeed;
use crate::signals::StopFlag;
use crate::training::{Best, Training};
use crate::{files, picture};
use serde::{Deserialize, Serialize};
use std::io::ErrorKind;
use std::path::Path;

/// A trial, done: enough to draw and count everything without training again.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Trial {
    /// What it was made of: [`Setup::fingerprint`].
    pub setup: [u8; 32],
    /// Its seed.
    pub seed: u64,
    /// One row per generation.
    pub history: Vec<MetricsRow>,
    /// What there was after each of the method's lengths.
    pub stages: Vec<Stage>,
}

/// A trial after so many generations.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stage {
    /// Generations judged.
    pub generations: u32,
    /// The champion.
    pub best: Best,
    /// How its drives of the training pairs ended.
    pub training: Vec<Ending>,
    /// How it did on unseen pairs.
    pub unseen: Unseen,
}

/// Drives of unseen pairs, counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Unseen {
    /// All.
    pub pairs: u32,
    /// Those that reached the target.
    pub reached: u32,
    /// Those that touched nothing else.
    pub clean: u32,
}

impl Unseen {
    /// Reached, as a share.
    pub fn reached_share(self) -> Share {
        Share { count: self.reached, of: self.pairs }
    }

    /// Clean, as a share.
    pub fn clean_share(self) -> Share {
        Share { count: self.clean, of: self.pairs }
    }
}

impl Stage {
    /// Training pairs whose target was reached.
    pub fn training_reached(&self) -> u32 {
        self.training.iter().filter(|ending| ending.reached).count() as u32
    }

    /// Training pairs reached without touching anything.
    pub fn training_clean(&self) -> u32 {
        self.training.iter().filter(|ending| ending.clean()).count() as u32
    }
}

/// A trial to be done.
#[derive(Clone, Copy, Debug)]
pub struct Task<'a> {
    /// What.
    pub setup: &'a Setup,
    /// From which seed.
    pub seed: RunSeed,
}

impl Job for Task<'_> {
    type Trial = Trial;

    fn run(&self, stop: &StopFlag, judged: impl FnMut() -> bool) -> Result<Option<Trial>, Failure> {
        Trial::run(self.setup, self.seed, stop, judged)
    }
}

impl Trial {
    /// Trains and judges on the current rayon pool; none if `stop` was raised meanwhile, or
    /// `judged` (called after every generation) says no.
    ///
    /// # Errors
    ///
    /// A world in which no pair is found.
    pub fn run(
        setup: &Setup,
        seed: RunSeed,
        stop: &StopFlag,
        mut judged: impl FnMut() -> bool,
    ) -> Result<Option<Self>, Failure> {
        let mut training = Training::new(&setup.problem, seed)?;
        let mut stages = Vec::new();
        for length in setup.method.lengths {
            while training.generation() < setup.generations(*length) {
                if training.step_unless(stop)?.is_none() || !judged() {
                    return Ok(None);
                }
            }
            let Some(stage) = Stage::of(setup, seed, &training, stop)? else { return Ok(None) };
            stages.push(stage);
        }
        let history = training.history().to_vec();
        Ok(Some(Self { setup: setup.fingerprint(), seed: seed.0, history, stages }))
    }

    /// Keeps it in the reproduction's folder.
    ///
    /// # Errors
    ///
    /// Input/output, naming the file.
    pub fn write(&self, setup: &Setup, folder: &RunFolder) -> Result<(), Failure> {
        let bytes = checkpoint::encode(self.history.len() as u64, self)
            .map_err(|error| Failure::bad_input(format!("a trial cannot be written: {error}")))?;
        folder.write(&setup.file(RunSeed(self.seed)), &bytes)
    }

    /// The trial of this seed, if it is done and whole; what is damaged is done again.
    ///
    /// # Errors
    ///
    /// A trial of another setup; a file that cannot be read.
    pub fn read(setup: &Setup, seed: RunSeed, folder: &RunFolder) -> Result<Option<Self>, Failure> {
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
        Err(other_settings(&path))
    }

    /// Removes what a killed process left among the trials.
    ///
    /// # Errors
    ///
    /// Input/output, naming the folder.
    pub fn remove_strays(folder: &RunFolder) -> Result<(), Failure> {
        let trials = folder.join(Setup::TRIALS);
        if trials.is_dir() { files::remove_strays(&trials).map(drop) } else { Ok(()) }
    }
}

/// Refuses a kept trial that this version would not make.
pub(super) fn other_settings(path: &Path) -> Failure {
    Failure::bad_input(format!(
        "--resume: {} was made with other settings than this evosteer's; begin again with another \
         --out",
        path.display()
    ))
}

impl Stage {
    fn of(
        setup: &Setup,
        seed: RunSeed,
        training: &Training<'_>,
        stop: &StopFlag,
    ) -> Result<Option<Self>, Failure> {
        let best = training.best().cloned().expect("at least one generation was judged");
        let drives = training_drives(setup, seed, &best, usize::MAX)?;
        let judge = setup.judge();
        let unseen = unseen_pairs(setup, seed, setup.pairs)?;
        let place = |index| evaluation_drive(seed, index);
        let Some(outcomes) = evaluation::outcomes(judge, &best.genome, &unseen, place, stop) else {
            return Ok(None);
        };
        let evaluation = Evaluation::summary(&outcomes, seed);
        Ok(Some(Self {
            generations: training.generation(),
            best,
            training: drives.iter().map(Ending::of).collect(),
            unseen: Unseen {
                pairs: evaluation.pairs,
                reached: evaluation.reached_share().count,
                clean: evaluation.clean_share().count,
            },
        }))
    }
}

/// The champion's drives of its training pairs, the first `most` of them.
///
/// # Errors
///
/// A world in which no pair is found.
pub fn training_drives(
    setup: &Setup,
    seed: RunSeed,
    best: &Best,
    most: usize,
) -> Result<Vec<Drive>, Failure> {
    let training = Training::new(&setup.problem, seed)?;
    let pairs = training.pairs_of(best)?;
    let film = |(index, pair): (u32, &Pair)| {
        let place = |_| training_drive(seed, best.generation, index);
        picture::drives(&setup.problem, &best.genome, std::slice::from_ref(pair), place)
    };
    Ok((0..).zip(&pairs).take(most).flat_map(film).collect())
}

/// The champion's drives of the first unseen pairs, as they are asked for.
///
/// # Errors
///
/// A world in which no pair is found.
pub fn unseen_drives<'a>(
    setup: &'a Setup,
    seed: RunSeed,
    best: &'a Best,
    most: u32,
) -> Result<impl Iterator<Item = Drive> + 'a, Failure> {
    let pairs = unseen_pairs(setup, seed, most.min(setup.pairs))?;
    let film = move |(index, pair): (u32, Pair)| {
        picture::drives(setup.judge(), &best.genome, &[pair], |_| evaluation_drive(seed, index))
    };
    Ok((0..).zip(pairs).flat_map(film))
}

fn unseen_pairs(setup: &Setup, seed: RunSeed, count: u32) -> Result<Vec<Pair>, Failure> {
    let judge = setup.judge();
    PairSampler::new(&judge.world, &judge.scenario)
        .unseen(seed, count)
        .map_err(|none| Failure::bad_input(format!("{}: {none}", setup.scene.name())))
}

#[cfg(test)]
mod tests;

//! Drives that did not arrive: how they ended, and the one that the report shows (Fig. 8).

use super::setup::Setup;
use super::trial::{Stage, Trial, training_drives, unseen_drives};
use crate::failure::Failure;
use crate::report::data::Drive;
use crate::seed::RunSeed;
use serde::{Deserialize, Serialize};

/// How a drive of a training pair ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Ending {
    /// Whether the target was touched.
    pub reached: bool,
    /// Moves that touched an obstacle.
    pub collisions: u32,
    /// Moves of the loop it ended in, if it did: see [`crate::report::loops`]. 1 is standing still.
    pub loop_moves: Option<u32>,
}

impl Ending {
    /// How this drive ended.
    pub fn of(drive: &Drive) -> Self {
        Self {
            reached: drive.outcome.reached,
            collisions: drive.outcome.collisions,
            loop_moves: drive.loop_period.map(|moves| moves as u32),
        }
    }

    /// Reached without touching anything.
    pub fn clean(&self) -> bool {
        self.reached && self.collisions == 0
    }

    /// Whether it went round and round: standing still is no loop.
    pub fn loops(&self) -> bool {
        self.loop_moves.is_some_and(|moves| moves > 1)
    }
}

/// Drives of training pairs that did not reach the target, by how they ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Unreached {
    /// All of them.
    pub drives: u32,
    /// In a periodic loop.
    pub in_loops: u32,
    /// Standing still.
    pub stuck: u32,
}

impl Unreached {
    /// Counts endings.
    pub fn count<'a>(endings: impl Iterator<Item = &'a Ending>) -> Self {
        let mut count = Self::default();
        for ending in endings.filter(|ending| !ending.reached) {
            count.drives += 1;
            count.in_loops += u32::from(ending.loops());
            count.stuck += u32::from(ending.loop_moves == Some(1));
        }
        count
    }
}

/// An unsuccessful run, chosen by rule.
#[derive(Clone, Debug, PartialEq)]
pub struct Unsuccessful {
    /// The run's seed.
    pub seed: u64,
    /// The drive that is shown.
    pub drive: Drive,
    /// Whether it is a drive of a training pair; else of an unseen one.
    pub trained: bool,
    /// Which of them, from 1.
    pub pair: u32,
}

/// Unseen pairs of each run that are searched for a loop.
const SEARCHED: u32 = 100;

/// The unsuccessful run to show: of the champions with the fewest training pairs reached, the
/// first whose drive of one of them ended in a loop; where no training pair did, the first unseen
/// pair that does; none where there is none. Standing still is no loop.
///
/// # Errors
///
/// A world in which no pair is found.
pub fn unsuccessful(setup: &Setup, trials: &[Trial]) -> Result<Option<Unsuccessful>, Failure> {
    let mut order: Vec<(u64, &Stage)> =
        trials.iter().filter_map(|trial| Some((trial.seed, trial.stages.first()?))).collect();
    // Stable: equal ones stay in the order of their seeds.
    order.sort_by_key(|(_, stage)| stage.training_reached());
    for (seed, stage) in &order {
        let Some(place) = stage.training.iter().position(Ending::loops) else { continue };
        let drives = training_drives(setup, RunSeed(*seed), &stage.best, place + 1)?;
        let last = drives.into_iter().next_back();
        return Ok(last.map(|drive| Unsuccessful {
            seed: *seed,
            drive,
            trained: true,
            pair: place as u32 + 1,
        }));
    }
    for (seed, stage) in order {
        let drives = unseen_drives(setup, RunSeed(seed), &stage.best, SEARCHED)?;
        if let Some((pair, drive)) = (1..).zip(drives).find(|(_, drive)| Ending::of(drive).loops())
        {
            return Ok(Some(Unsuccessful { seed, drive, trained: false, pair }));
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::{PaperScene, Plan, sample};

    fn ending(reached: bool, loop_moves: Option<u32>) -> Ending {
        Ending { reached, collisions: 0, loop_moves }
    }

    #[test]
    fn only_drives_that_did_not_arrive_are_counted_and_standing_still_is_no_loop() {
        let endings = [
            ending(true, None),
            ending(false, Some(63)),
            ending(false, Some(1)),
            ending(false, None),
            ending(false, Some(2)),
        ];
        let expected = Unreached { drives: 4, in_loops: 2, stuck: 1 };
        assert_eq!(Unreached::count(endings.iter()), expected);
    }

    /// Champions that have learned hardly anything, where there is much to circle in.
    fn hopeless() -> (Vec<Setup>, Vec<Vec<Trial>>) {
        let scenes = vec![PaperScene::Complex];
        let methods = vec!["paper".to_owned()];
        sample::trials(&Plan { scenes, methods, seeds: 6, pairs: 100, ..sample::plan() })
    }

    #[test]
    fn the_run_that_is_shown_really_loops() {
        let (setups, trials) = hopeless();
        let chosen = unsuccessful(&setups[0], &trials[0]).unwrap().expect("one of 600 drives");
        assert!(Ending::of(&chosen.drive).loops() && !chosen.drive.outcome.reached, "{chosen:?}");
    }

    #[test]
    fn where_every_training_pair_was_reached_an_unseen_one_is_shown() {
        let (setups, mut trials) = hopeless();
        for stage in trials[0].iter_mut().flat_map(|trial| &mut trial.stages) {
            stage.training.fill(ending(true, None));
        }
        let chosen = unsuccessful(&setups[0], &trials[0]).unwrap().expect("one of 600 drives");
        assert!(!chosen.trained && Ending::of(&chosen.drive).loops());
    }

    #[test]
    fn the_worst_run_comes_first_and_of_equals_the_first_seed() {
        let (setups, trials) = sample::trials(&sample::plan());
        let run = |seed, endings: [Ending; 5]| {
            let mut trial = Trial { seed, ..trials[0][0].clone() };
            trial.stages[0].training = endings.to_vec();
            trial
        };
        let (good, looped) = (ending(true, None), ending(false, Some(9)));
        let runs = [
            run(1, [good, good, good, good, looped]),
            run(2, [good, good, looped, looped, looped]),
            run(3, [looped, looped, good, looped, good]),
        ];
        let chosen = unsuccessful(&setups[0], &runs).unwrap().unwrap();
        assert_eq!((chosen.seed, chosen.pair, chosen.trained), (2, 3, true));
    }
}

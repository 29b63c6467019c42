//! Drives of chosen champions on the map (Figs. 3, 4, 7 and 8).

use super::super::failures::{Unsuccessful, unsuccessful};
use super::super::results::percent;
use super::super::setup::Setup;
use super::super::trial::{Stage, Trial, training_drives};
use crate::failure::Failure;
use crate::picture;
use crate::report::plots::trajectory_svg;
use crate::seed::RunSeed;

/// Drives that belong together.
pub(super) struct Group {
    /// Part of their files' names.
    pub(super) id: &'static str,
    pub(super) heading: String,
    pub(super) caption: String,
    pub(super) svgs: Vec<String>,
}

/// Most drives of one champion: the paper's five training pairs.
const MOST_DRIVES: usize = 5;

/// The best champion of the paper's method, the median one, and an unsuccessful run.
pub(super) fn groups(setup: &Setup, trials: &[Trial]) -> Result<Vec<Group>, Failure> {
    let mut order: Vec<(u64, &Stage)> =
        trials.iter().map(|trial| (trial.seed, &trial.stages[0])).collect();
    order.sort_by_key(|(_, stage)| (stage.unseen.reached, stage.unseen.clean));
    let best = order[order.len() - 1];
    let median = order[(order.len() - 1) / 2];
    let mut groups = vec![
        champion(setup, "best", "The best champion", best)?,
        champion(setup, "median", "The median champion", median)?,
    ];
    groups.extend(unsuccessful(setup, trials)?.map(|run| failed(setup, run)));
    Ok(groups)
}

fn champion(
    setup: &Setup,
    id: &'static str,
    heading: &str,
    (seed, stage): (u64, &Stage),
) -> Result<Group, Failure> {
    let drives = training_drives(setup, RunSeed(seed), &stage.best, MOST_DRIVES)?;
    let (scene, body) = (picture::scene(&setup.problem), picture::body(&setup.problem));
    let draw = |(number, drive)| trajectory_svg(&scene, &body, drive, &format!("pair {number}"));
    Ok(Group {
        id,
        heading: format!("{heading}: seed {seed}"),
        caption: format!(
            "Its training pairs. By unseen pairs reached ({}; {} clean).",
            percent(stage.unseen.reached_share().value()),
            percent(stage.unseen.clean_share().value())
        ),
        svgs: (1..).zip(&drives).map(draw).collect(),
    })
}

fn failed(setup: &Setup, run: Unsuccessful) -> Group {
    let Unsuccessful { seed, drive, trained, pair } = run;
    let kind = if trained { "pair" } else { "unseen pair" };
    let (scene, body) = (picture::scene(&setup.problem), picture::body(&setup.problem));
    let title = format!("{kind} {pair}");
    let why = if trained {
        "Of the runs that reached the fewest training pairs, the first with a drive that ends in a \
         periodic loop."
    } else {
        "No training pair was lost in a loop; of the runs that reached the fewest, the first with \
         an unseen pair that was."
    };
    let moves = drive.loop_period.unwrap_or_default();
    Group {
        id: "unsuccessful",
        heading: format!("An unsuccessful run: seed {seed}"),
        caption: format!(
            "As in Fig. 8, the robot starts to move in periodic loops. {why} The loop, found from \
             the poses alone, has {moves} moves."
        ),
        svgs: vec![trajectory_svg(&scene, &body, &drive, &title)],
    }
}

//! `evosteer evaluate`: how good is a champion where it has never been?

mod stress;

use super::advice::counted;
use super::film::check_destination;
use super::number::whole;
use super::setup::{ScenarioOptions, WhichPairs, problem_for};
use crate::blob_file::BlobFile;
use crate::drivable::Planner;
use crate::evaluation::{Evaluation, Share, outcomes};
use crate::failure::Failure;
use crate::files;
use crate::output::Output;
use crate::problem::{Replaced, evaluation_drive};
use crate::scenario::Pair;
use crate::seed::RunSeed;
use crate::signals::StopFlag;
use crate::stress::Stress;
use serde::Serialize;
use std::path::PathBuf;

/// Judges a champion on start/goal pairs that training never used
#[derive(Clone, Debug, clap::Args)]
pub struct EvaluateArgs {
    /// A weight blob, or a run folder for its champion.blob
    champion: PathBuf,

    /// A scenario: the name of a shipped one, a file, or a run folder for its scenario
    scenario: String,

    /// How many pairs to draw
    #[arg(
        long,
        value_name = "N",
        default_value_t = 1000,
        value_parser = whole(1..=10_000_000_u32),
        allow_negative_numbers = true
    )]
    pairs: u32,

    /// Seed of the pairs; training never uses the same ones, whatever its seed was
    #[arg(long, default_value_t = RunSeed(1), allow_negative_numbers = true)]
    seed: RunSeed,

    #[command(flatten)]
    which: WhichPairs,

    /// Leave out pairs for which a search finds no path that a car without reverse gear can drive
    #[arg(long)]
    drivable: bool,

    #[command(flatten)]
    options: ScenarioOptions,

    /// Also drive the same pairs with each disturbance of a real car, alone and all together, and
    /// name the weakest factor
    #[arg(long)]
    stress: bool,

    /// With --stress: also draw its curves as an SVG picture
    #[arg(long, value_name = "FILE", requires = "stress")]
    out: Option<PathBuf>,

    /// Replace the picture if it exists
    #[arg(long, requires = "out")]
    force: bool,

    /// Print the result as one JSON object
    #[arg(long)]
    pub json: bool,
}

/// What `--json` prints.
#[derive(Debug, Serialize)]
struct Report<'a> {
    champion: String,
    scenario: &'a str,
    /// What the champion's own car replaced in the scenario's.
    champions_car: Vec<Replaced>,
    #[serde(flatten)]
    evaluation: &'a Evaluation,
    #[serde(flatten)]
    drivable: Option<Drivable>,
    #[serde(flatten)]
    stress: Option<Stress>,
}

/// How many of the pairs can be driven at all.
#[derive(Debug, Serialize)]
struct Drivable {
    /// Pairs that were looked at.
    drawn: u32,
    /// Share of them for which there is a path.
    drivable: f64,
    /// Its 95 % interval.
    drivable_interval: [f64; 2],
}

/// Evaluates a champion.
///
/// # Errors
///
/// A blob or scenario that is refused, or a world in which no pair is found.
pub fn run(args: &EvaluateArgs, output: &mut Output) -> Result<(), Failure> {
    if let Some(file) = &args.out {
        check_destination(file, args.force)?;
    }
    let champion = BlobFile::read(&args.champion)?;
    let (mut problem, replaced) = problem_for(&champion, &args.scenario, &args.options, output)?;
    let all = args.which.pairs(&problem, &args.scenario, &args.options, args.pairs, args.seed)?;
    let what = if args.which.listed { "listed pair" } else { "unseen pair" };
    let looked_at = counted(all.len() as u64, what);
    let kept: Vec<usize> = if args.drivable {
        Planner::new(&problem).drivable(&all)
    } else {
        (0..all.len()).collect()
    };
    if kept.is_empty() {
        return Err(Failure::bad_input(format!(
            "--drivable: no path is found for any of {looked_at} of {}; without the option they \
             are driven all the same",
            problem.scenario.name
        )));
    }
    let share = Share { count: kept.len() as u32, of: all.len() as u32 };
    let pairs: Vec<Pair> = kept.iter().map(|index| all[*index]).collect();
    // A pair keeps its random numbers, whichever others are left out.
    let place = |index: u32| evaluation_drive(args.seed, kept[index as usize] as u32);
    // Nothing to save: a signal ends the process.
    let never = StopFlag::default();
    let weights = champion.blob();
    let outcomes = outcomes(&problem, weights.weights(), &pairs, place, &never)
        .expect("nobody raises this flag");
    let evaluation = Evaluation::summary(&outcomes, args.seed);
    output.line(format_args!(
        "{} on {}, {looked_at}, seed {}",
        champion.path().display(),
        problem.scenario.name,
        args.seed
    ));
    if args.drivable {
        output.line(format_args!("  drivable         {share}; only these are driven"));
    }
    output.line(format_args!("  reached          {}", evaluation.reached_share()));
    output.line(format_args!("  clean            {}", evaluation.clean_share()));
    if let Some(steps) = evaluation.mean_steps_when_reached {
        output.line(format_args!("  steps to target  {steps:.1} on average"));
    }
    output.line(format_args!("  collisions       {:.2} per drive", evaluation.mean_collisions));
    output.line("  (shares with their 95 % confidence intervals)");
    let stress = args.stress.then(|| {
        Stress::test(&mut problem, weights.weights(), &pairs, place, &never)
            .expect("nobody raises this flag")
    });
    if let Some(stress) = &stress {
        stress::print(stress, output);
        if let Some(file) = &args.out {
            let title = format!("{} on {}", champion.path().display(), problem.scenario.name);
            let picture = stress::picture(title, stress);
            if args.force {
                files::write(file, picture.as_bytes())?;
            } else {
                files::write_new(file, picture.as_bytes())?;
            }
            output.line(format_args!("wrote {}", file.display()));
        }
    }
    output.json(&Report {
        champion: champion.path().display().to_string(),
        scenario: &problem.scenario.name,
        champions_car: replaced,
        evaluation: &evaluation,
        drivable: args.drivable.then(|| Drivable {
            drawn: share.of,
            drivable: share.value(),
            drivable_interval: share.interval(),
        }),
        stress,
    });
    Ok(())
}

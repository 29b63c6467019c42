//! `evosteer evaluate`: how good is a champion where it has never been?

mod stress;
mod table;

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
use crate::problem::{Problem, Replaced, evaluation_drive};
use crate::scenario::Pair;
use crate::seed::{RunSeed, Stream};
use crate::signals::StopFlag;
use crate::stress::Stress;
use serde::Serialize;
use std::path::PathBuf;

/// Judges a champion on start/goal pairs that training never used
#[derive(Clone, Debug, clap::Args)]
pub struct EvaluateArgs {
    /// A weight blob, or a run folder for its champion.blob
    champion: PathBuf,

    /// A scenario: the name of a shipped one, a file, or a run folder for its scenario; of several, a
    /// table
    #[arg(required = true, value_name = "SCENARIO")]
    scenarios: Vec<String>,

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

/// What `--json` prints of one scenario.
#[derive(Debug, Serialize)]
struct Report {
    champion: String,
    scenario: String,
    /// What the champion's own car replaced in the scenario's.
    champions_car: Vec<Replaced>,
    #[serde(flatten)]
    evaluation: Evaluation,
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
    match &args.scenarios[..] {
        [scenario] => one(args, &champion, scenario, output),
        several => table::print(args, &champion, several, output),
    }
}

/// Evaluates in one scenario, in full.
fn one(
    args: &EvaluateArgs,
    champion: &BlobFile,
    scenario: &str,
    output: &mut Output,
) -> Result<(), Failure> {
    let mut task = Task::new(args, champion, scenario, output)?;
    let evaluation = task.evaluation(champion);
    let title = format!("{} on {}", champion.path().display(), task.problem.scenario.name);
    output.line(format_args!("{title}, {}, seed {}", task.looked_at(), args.seed));
    if args.drivable {
        output.line(format_args!("  drivable         {}; only these are driven", task.share()));
    }
    output.line(format_args!("  reached          {}", evaluation.reached_share()));
    output.line(format_args!("  clean            {}", evaluation.clean_share()));
    if let Some(steps) = evaluation.mean_steps_when_reached {
        output.line(format_args!("  steps to target  {steps:.1} on average"));
    }
    output.line(format_args!("  collisions       {:.2} per drive", evaluation.mean_collisions));
    output.line("  (shares with their 95 % confidence intervals)");
    let stress = args.stress.then(|| task.stress(champion));
    if let Some(stress) = &stress {
        stress::print(stress, output);
        if let Some(file) = &args.out {
            let picture = stress::picture(title, stress);
            if args.force {
                files::write(file, picture.as_bytes())?;
            } else {
                files::write_new(file, picture.as_bytes())?;
            }
            output.line(format_args!("wrote {}", file.display()));
        }
    }
    output.json(&task.report(champion, evaluation, stress));
    Ok(())
}

/// A champion's pairs in one scenario.
struct Task<'a> {
    args: &'a EvaluateArgs,
    problem: Problem,
    replaced: Vec<Replaced>,
    /// How many pairs were looked at.
    of: u32,
    /// Places and pairs of those that are driven.
    kept: Vec<u32>,
    pairs: Vec<Pair>,
}

impl<'a> Task<'a> {
    fn new(
        args: &'a EvaluateArgs,
        champion: &BlobFile,
        scenario: &str,
        output: &mut Output,
    ) -> Result<Self, Failure> {
        let (problem, replaced) = problem_for(champion, scenario, &args.options, output)?;
        let all = args.which.pairs(&problem, scenario, &args.options, args.pairs, args.seed)?;
        let kept: Vec<usize> = if args.drivable {
            Planner::new(&problem).drivable(&all)
        } else {
            (0..all.len()).collect()
        };
        let pairs = kept.iter().map(|place| all[*place]).collect();
        let kept = kept.into_iter().map(|place| place as u32).collect();
        let task = Self { args, problem, replaced, of: all.len() as u32, kept, pairs };
        if task.kept.is_empty() {
            return Err(Failure::bad_input(format!(
                "--drivable: no path is found for any of {} of {}; without the option they are \
                 driven all the same",
                task.looked_at(),
                task.problem.scenario.name
            )));
        }
        Ok(task)
    }

    fn looked_at(&self) -> String {
        let what = if self.args.which.listed { "listed pair" } else { "unseen pair" };
        counted(u64::from(self.of), what)
    }

    /// The share of pairs that are driven.
    fn share(&self) -> Share {
        Share { count: self.kept.len() as u32, of: self.of }
    }

    /// A pair keeps its random numbers, whichever others are left out.
    fn place(&self) -> impl Fn(u32) -> Stream + Sync + use<> {
        let (seed, kept) = (self.args.seed, self.kept.clone());
        move |index| evaluation_drive(seed, kept[index as usize])
    }

    fn evaluation(&self, champion: &BlobFile) -> Evaluation {
        let weights = champion.blob().weights();
        // Nothing to save: a signal ends the process.
        let never = StopFlag::default();
        let drives = outcomes(&self.problem, weights, &self.pairs, self.place(), &never);
        Evaluation::summary(&drives.expect("nobody raises this flag"), self.args.seed)
    }

    fn stress(&mut self, champion: &BlobFile) -> Stress {
        let (place, never) = (self.place(), StopFlag::default());
        Stress::test(&mut self.problem, champion.blob().weights(), &self.pairs, place, &never)
            .expect("nobody raises this flag")
    }

    fn report(self, champion: &BlobFile, evaluation: Evaluation, stress: Option<Stress>) -> Report {
        let share = self.share();
        Report {
            champion: champion.path().display().to_string(),
            scenario: self.problem.scenario.name,
            champions_car: self.replaced,
            evaluation,
            drivable: self.args.drivable.then(|| Drivable {
                drawn: share.of,
                drivable: share.value(),
                drivable_interval: share.interval(),
            }),
            stress,
        }
    }
}

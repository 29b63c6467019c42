//! `evosteer evaluate`: how good is a champion where it has never been?

use super::advice::counted;
use super::number::whole;
use super::setup::{ScenarioOptions, WhichPairs, problem_for};
use crate::blob_file::BlobFile;
use crate::evaluation::Evaluation;
use crate::failure::Failure;
use crate::output::Output;
use crate::problem::Replaced;
use crate::seed::RunSeed;
use crate::signals::StopFlag;
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

    #[command(flatten)]
    options: ScenarioOptions,

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
}

/// Evaluates a champion.
///
/// # Errors
///
/// A blob or scenario that is refused, or a world in which no pair is found.
pub fn run(args: &EvaluateArgs, output: &mut Output) -> Result<(), Failure> {
    let champion = BlobFile::read(&args.champion)?;
    let (problem, replaced) = problem_for(&champion, &args.scenario, &args.options, output)?;
    let pairs = args.which.pairs(&problem, &args.scenario, &args.options, args.pairs, args.seed)?;
    // Nothing to save: a signal ends the process.
    let never = StopFlag::default();
    let weights = champion.blob();
    let evaluation = Evaluation::of(&problem, weights.weights(), &pairs, args.seed, &never)
        .expect("nobody raises this flag");
    let what = if args.which.listed { "listed pair" } else { "unseen pair" };
    output.line(format_args!(
        "{} on {}, {}, seed {}",
        champion.path().display(),
        problem.scenario.name,
        counted(evaluation.pairs, what),
        args.seed
    ));
    output.line(format_args!("  reached          {}", evaluation.reached_share()));
    output.line(format_args!("  clean            {}", evaluation.clean_share()));
    if let Some(steps) = evaluation.mean_steps_when_reached {
        output.line(format_args!("  steps to target  {steps:.1} on average"));
    }
    output.line(format_args!("  collisions       {:.2} per drive", evaluation.mean_collisions));
    output.line("  (shares with their 95 % confidence intervals)");
    output.json(&Report {
        champion: champion.path().display().to_string(),
        scenario: &problem.scenario.name,
        champions_car: replaced,
        evaluation: &evaluation,
    });
    Ok(())
}

//! `evosteer scenario show`: what it looks like, or what it says in full.

use super::super::setup::{ScenarioOptions, problem};
use super::drawing::draw;
use super::written::write_all;
use crate::failure::Failure;
use crate::output::Output;
use crate::scenario::{PairSource, to_toml};
use crate::seed::RunSeed;
use serde::Serialize;
use std::path::PathBuf;

/// Draws a scenario's world as an SVG picture, or prints its settings in full
#[derive(Clone, Debug, clap::Args)]
pub(super) struct ShowArgs {
    /// A scenario: the name of a shipped one, or a file
    scenario: String,

    /// Where to draw; a file named after the scenario if not given
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,

    /// Replace the picture if it exists
    #[arg(long)]
    force: bool,

    /// How many unseen pairs to draw, besides the scenario's listed ones
    #[arg(long, default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=100))]
    pairs: u32,

    /// Seed of the unseen pairs; the same as of `evaluate`
    #[arg(long, default_value_t = RunSeed(1))]
    seed: RunSeed,

    /// Print every setting as a scenario file instead of drawing
    #[arg(long, conflicts_with_all = ["out", "force", "pairs", "seed", "json"])]
    toml: bool,

    #[command(flatten)]
    options: ScenarioOptions,

    /// Print the result as one JSON object
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Debug, Serialize)]
struct Report<'a> {
    name: &'a str,
    picture: String,
    listed_pairs: usize,
    unseen_pairs: u32,
    seed: RunSeed,
}

/// Draws a scenario.
///
/// # Errors
///
/// A scenario that is refused, a world in which no pair is found, or a picture that cannot be
/// written.
pub(super) fn run(args: &ShowArgs, output: &mut Output) -> Result<(), Failure> {
    let problem = problem(&args.scenario, args.options.preset, &args.options.settings())?;
    let scenario = &problem.scenario;
    if args.toml {
        output.bytes(to_toml(scenario).as_bytes());
        return Ok(());
    }
    let path = args.out.clone().unwrap_or_else(|| PathBuf::from(format!("{}.svg", scenario.name)));
    let svg = draw(&problem, args.pairs, args.seed)?;
    write_all(&[(&path, &svg)], args.force)?;
    let listed_pairs = match &scenario.pairs.source {
        PairSource::Listed(pairs) => pairs.len(),
        PairSource::Drawn { .. } => 0,
    };
    output.line(format_args!("wrote {} (open it in a browser)", path.display()));
    output.json(&Report {
        name: &scenario.name,
        picture: path.display().to_string(),
        listed_pairs,
        unseen_pairs: args.pairs,
        seed: args.seed,
    });
    Ok(())
}

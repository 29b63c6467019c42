//! `evosteer replay`: watch a champion drive.

use super::film::Film;
use super::setup::{ScenarioOptions, WhichPairs, problem_for};
use crate::blob_file::BlobFile;
use crate::failure::Failure;
use crate::output::Output;
use std::path::PathBuf;

/// Drives a champion and writes an animated page that opens offline
#[derive(Clone, Debug, clap::Args)]
pub struct ReplayArgs {
    /// A weight blob, or a run folder for its champion.blob
    champion: PathBuf,

    /// A scenario: the name of a shipped one, a file, or a run folder for its scenario
    scenario: String,

    #[command(flatten)]
    film: Film,

    #[command(flatten)]
    which: WhichPairs,

    #[command(flatten)]
    options: ScenarioOptions,

    /// Print the result as one JSON object
    #[arg(long)]
    pub json: bool,
}

/// Writes the replay.
///
/// # Errors
///
/// A blob or scenario that is refused, or a page that cannot be written.
pub fn run(args: &ReplayArgs, output: &mut Output) -> Result<(), Failure> {
    let Film { pairs, seed, .. } = args.film;
    args.film.check_page()?;
    let champion = BlobFile::read(&args.champion)?;
    let (problem, replaced) = problem_for(&champion, &args.scenario, &args.options, output)?;
    let pairs = args.which.pairs(&problem, &args.scenario, &args.options, pairs, seed)?;
    args.film.shoot(&champion, &problem, &pairs, replaced, output)
}

//! `evosteer replay`: watch a champion drive.

use super::advice::counted;
use super::number::whole;
use super::setup::{ScenarioOptions, WhichPairs, problem_for};
use crate::blob_file::BlobFile;
use crate::failure::Failure;
use crate::output::Output;
use crate::problem::{Replaced, evaluation_drive};
use crate::report::page;
use crate::seed::RunSeed;
use crate::{files, picture};
use serde::Serialize;
use std::path::PathBuf;

/// Drives a champion and writes an animated page that opens offline
#[derive(Clone, Debug, clap::Args)]
pub struct ReplayArgs {
    /// A weight blob, or a run folder for its champion.blob
    champion: PathBuf,

    /// A scenario: the name of a shipped one, a file, or a run folder for its scenario
    scenario: String,

    /// Where to write the page
    #[arg(long, default_value = "replay.html", value_name = "FILE")]
    out: PathBuf,

    /// Replace the page if it exists
    #[arg(long)]
    force: bool,

    /// How many drives to show
    #[arg(
        long,
        value_name = "N",
        default_value_t = 5,
        value_parser = whole(1..=100_u32),
        allow_negative_numbers = true
    )]
    pairs: u32,

    /// Seed of the pairs; the same as of `evaluate`
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

#[derive(Debug, Serialize)]
struct Report {
    page: String,
    /// What the champion's own car replaced in the scenario's.
    champions_car: Vec<Replaced>,
    drives: Vec<Driven>,
}

#[derive(Debug, Serialize)]
struct Driven {
    reached: bool,
    collisions: u32,
    steps: u32,
    loop_period: Option<usize>,
}

/// Writes the replay.
///
/// # Errors
///
/// A blob or scenario that is refused, or a page that cannot be written.
pub fn run(args: &ReplayArgs, output: &mut Output) -> Result<(), Failure> {
    check_page(args)?;
    let champion = BlobFile::read(&args.champion)?;
    let (problem, replaced) = problem_for(&champion, &args.scenario, &args.options, output)?;
    let pairs = args.which.pairs(&problem, &args.scenario, &args.options, args.pairs, args.seed)?;
    let weights = champion.blob().weights();
    let drives = picture::drives(&problem, weights, &pairs, |i| evaluation_drive(args.seed, i));
    let report = Report {
        page: args.out.display().to_string(),
        champions_car: replaced,
        drives: drives
            .iter()
            .map(|drive| Driven {
                reached: drive.outcome.reached,
                collisions: drive.outcome.collisions,
                steps: drive.outcome.steps,
                loop_period: drive.loop_period,
            })
            .collect(),
    };
    for (number, drive) in (1..).zip(&drives) {
        let steps = counted(drive.outcome.steps, "step");
        output.line(format_args!("drive {number}: {} after {steps}", drive.verdict()));
    }
    if drives.len() < pairs.len() {
        output.warning(format_args!(
            "a page has room for {} of these {} drives",
            drives.len(),
            pairs.len()
        ));
    }
    let header = champion.blob();
    let provenance = header.header().provenance;
    let data = picture::report(
        &problem,
        format!("{} on {}", champion.path().display(), problem.scenario.name),
        String::new(),
        drives,
        Vec::new(),
        vec![
            ("trained on".to_owned(), provenance.scenario_name().to_owned()),
            ("run seed".to_owned(), provenance.seed.to_string()),
            ("generation".to_owned(), provenance.generation.to_string()),
            ("check".to_owned(), format!("{:016x}", header.check())),
        ],
    );
    let page = page::render_replay(&data);
    if args.force {
        files::write(&args.out, page.as_bytes())?;
    } else {
        files::write_new(&args.out, page.as_bytes())?;
    }
    output.line(format_args!("wrote {} (open it in a browser)", args.out.display()));
    output.json(&report);
    Ok(())
}

/// Says before the work what writing would say after it.
fn check_page(args: &ReplayArgs) -> Result<(), Failure> {
    let page = args.out.display();
    if args.out.is_dir() {
        return Err(Failure::bad_input(format!("--out {page}: a folder; a file's name expected")));
    }
    if !args.force && args.out.symlink_metadata().is_ok() {
        return Err(Failure::bad_input(format!(
            "--out {page}: exists already and is not replaced without --force"
        )));
    }
    Ok(())
}

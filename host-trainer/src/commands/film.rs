//! From a champion's drives to an animated page.

use super::advice::counted;
use super::number::whole;
use crate::blob_file::BlobFile;
use crate::failure::Failure;
use crate::output::Output;
use crate::problem::{Problem, Replaced, evaluation_drive};
use crate::report::page;
use crate::scenario::Pair;
use crate::seed::RunSeed;
use crate::{files, picture};
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Which drives are shown, and where.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct Film {
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
    pub(super) pairs: u32,

    /// Seed of the pairs; the same as of `evaluate`
    #[arg(long, default_value_t = RunSeed(1), allow_negative_numbers = true)]
    pub(super) seed: RunSeed,
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

impl Film {
    /// Says before the work what writing the page would say after it.
    pub(super) fn check_page(&self) -> Result<(), Failure> {
        check_destination(&self.out, self.force)
    }

    /// Drives the pairs, writes the page and says how they went.
    ///
    /// # Errors
    ///
    /// A page that cannot be written.
    pub(super) fn shoot(
        &self,
        champion: &BlobFile,
        problem: &Problem,
        pairs: &[Pair],
        replaced: Vec<Replaced>,
        output: &mut Output,
    ) -> Result<(), Failure> {
        let weights = champion.blob().weights();
        let drives = picture::drives(problem, weights, pairs, |i| evaluation_drive(self.seed, i));
        let report = Report {
            page: self.out.display().to_string(),
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
            problem,
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
        if self.force {
            files::write(&self.out, page.as_bytes())?;
        } else {
            files::write_new(&self.out, page.as_bytes())?;
        }
        output.line(format_args!("wrote {} (open it in a browser)", self.out.display()));
        output.json(&report);
        Ok(())
    }
}

/// Refuses an `--out` that could not be written, or would replace a file that it must not.
pub(super) fn check_destination(file: &Path, force: bool) -> Result<(), Failure> {
    let name = file.display();
    if file.is_dir() {
        return Err(Failure::bad_input(format!("--out {name}: a folder; a file's name expected")));
    }
    if !force && file.symlink_metadata().is_ok() {
        return Err(Failure::bad_input(format!(
            "--out {name}: exists already and is not replaced without --force"
        )));
    }
    Ok(())
}

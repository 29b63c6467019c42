//! `evosteer verify`: does the chip compute the same bits?

mod register;
mod report;

use std::path::{Path, PathBuf};

use equivalence_tests::checkout::{Checkout, Trouble};
use equivalence_tests::compare::{self, Drive, Tally};
use equivalence_tests::files::Case;
use equivalence_tests::weight_sets::WeightSet;

use super::advice::counted;
use super::number::whole;
use crate::blob_file::BlobFile;
use crate::failure::{Failure, FailureKind};
use crate::output::Output;
use crate::vector::Instructions;
use report::{Machine, Report};

/// Courses on which each of the user's champions drives.
const COURSES: u32 = 16;

/// Steps that a board drives in one go, or one drive if that is longer: they leave 24 MB of results, gone when
/// they are compared.
const STEPS_PER_RUN: u64 = 200_000;

/// Compares every bit that host and emulated boards compute in the same drives
///
/// Generated weight sets of every recurrence and every tanh drive closed loops, faults of the
/// sensors included, on this machine, also side by side in each kind of vector that its CPU has,
/// and on every emulated board; champions that are named drive besides. Commands, outputs, all hidden values and poses are
/// compared as bits. Needs a checkout of the sources and QEMU.
#[derive(Clone, Debug, clap::Args)]
pub struct VerifyArgs {
    /// Weight blobs to drive with besides, or run folders for their champion.blob
    #[arg(value_name = "CHAMPION")]
    champions: Vec<PathBuf>,

    /// Compare with the emulated boards
    #[arg(long, required = true)]
    emulated: bool,

    /// Compare with this board only; may be given several times
    #[arg(long = "board", value_name = "NAME")]
    boards: Vec<String>,

    /// Steps of each drive
    #[arg(
        long,
        value_name = "N",
        default_value_t = 150,
        value_parser = whole(1..=10_000_000_u32),
        allow_negative_numbers = true
    )]
    steps: u32,

    /// Print the result as one JSON object
    #[arg(long)]
    pub json: bool,
}

/// Compares all machines.
///
/// # Errors
///
/// A difference, with the first one; bad input for a champion that the boards' programs have no
/// code for, an unknown board, and where there is no checkout; input/output when a tool is
/// missing or a board does not get to its end.
pub fn run(args: &VerifyArgs, output: &mut Output) -> Result<(), Failure> {
    let (drives, weight_sets) = drives(args)?;
    let checkout = checkout(&places())?;
    let boards = chosen(&args.boards, &checkout.boards().map_err(|trouble| failure(&trouble))?)?;

    let mut report = Report::new(weight_sets, args.steps, &drives);
    output.status(format_args!("host: {}, each alone and side by side", report.task()));
    for instructions in Instructions::available() {
        let tally = register::compare(instructions, &drives);
        let name = match instructions.width() {
            1 => format!("host, {instructions}"),
            lanes => format!("host, {instructions}, {lanes} lanes"),
        };
        report.host.push(Machine::new(name, tally));
    }
    for board in boards {
        output.status(format_args!("{board}: building its program"));
        let program = checkout.build(&board, None).map_err(|trouble| failure(&trouble))?;
        output.status(format_args!("{board}: driving"));
        let tally = prove(&checkout, &board, &program, &drives, output)?;
        report.boards.push(Machine::new(board, tally));
    }
    report.print(output);
    match report.first_difference() {
        None => Ok(()),
        Some(difference) => Err(Failure::new(FailureKind::Different, difference)),
    }
}

/// What all machines drive, and with how many weight sets.
fn drives(args: &VerifyArgs) -> Result<(Vec<Drive>, usize), Failure> {
    let steps = args.steps;
    let mut drives = compare::generated_drives(steps);
    let sets = drives.len() + args.champions.len();
    for champion in &args.champions {
        let file = BlobFile::read(champion)?;
        let weights =
            WeightSet::new(file.path().display().to_string(), file.bytes()).map_err(|unfit| {
                Failure::bad_input(format!("CHAMPION {}: {unfit}", file.path().display()))
            })?;
        drives.extend(
            (0..COURSES).map(|seed| Drive { weights: weights.clone(), case: Case { seed, steps } }),
        );
    }
    Ok((drives, sets))
}

/// Where a checkout may be found: around the working directory, else around this program.
fn places() -> Vec<PathBuf> {
    [std::env::current_dir(), std::env::current_exe()].into_iter().flatten().collect()
}

fn checkout(places: &[PathBuf]) -> Result<Checkout, Failure> {
    places.iter().find_map(|place| Checkout::around(place)).ok_or_else(|| {
        Failure::bad_input(
            "--emulated needs the sources of the boards' programs, and neither this folder nor \
             this program lies in a checkout of evosteer; clone its repository and, there, run: \
             cargo run --release -- verify --emulated",
        )
    })
}

fn chosen(named: &[String], there: &[String]) -> Result<Vec<String>, Failure> {
    if let Some(unknown) = named.iter().find(|name| !there.contains(name)) {
        return Err(Failure::bad_input(format!(
            "--board: found `{unknown}`, expected one of: {}",
            there.join(", ")
        )));
    }
    let chosen = |name: &&String| named.is_empty() || named.contains(name);
    Ok(there.iter().filter(chosen).cloned().collect())
}

/// Has a board drive everything, in runs of limited size.
fn prove(
    checkout: &Checkout,
    board: &str,
    program: &Path,
    drives: &[Drive],
    output: &mut Output,
) -> Result<Tally, Failure> {
    let mut tally = Tally::default();
    let per_run = (STEPS_PER_RUN / u64::from(drives[0].case.steps)).max(1) as usize;
    for (run, drives) in drives.chunks(per_run).enumerate() {
        if run > 0 {
            output.status(format_args!("{board}: {} so far", counted(tally.steps, "step")));
        }
        let folder = tempfile::tempdir()
            .map_err(|cause| Failure::io("write to", &std::env::temp_dir(), &cause))?;
        tally.add(
            checkout
                .prove(board, program, folder.path(), drives)
                .map_err(|trouble| failure(&trouble))?,
        );
    }
    Ok(tally)
}

fn failure(trouble: &Trouble) -> Failure {
    Failure::new(FailureKind::InputOutput, trouble.to_string())
}

#[cfg(test)]
mod tests;

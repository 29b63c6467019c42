//! The end of a training run: champion, plots, report, and what to do next.

use crate::champion;
use crate::commands::advice::{counted, in_shell, this_program};
use crate::commands::setup::shortest_name;
use crate::episode::Outcome;
use crate::evaluation::{self, Evaluation};
use crate::failure::Failure;
use crate::output::Output;
use crate::problem::{Problem, evaluation_drive, training_drive};
use crate::report::{data::Drive, page, plots};
use crate::run_folder::RunFolder;
use crate::seed::RunSeed;
use crate::signals::StopFlag;
use crate::training::{Best, Training};
use crate::{blob_file::BlobFile, picture};
use serde::Serialize;

/// Unseen pairs that every training run is judged on at its end.
const UNSEEN_PAIRS: u32 = 1000;

/// Most training pairs whose drives are drawn.
const DRAWN_PAIRS: usize = 20;

/// How far [`finish`] got.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Finished {
    /// Everything is written.
    Whole,
    /// A signal came before that.
    Stopped,
}

/// What `--json` prints.
#[derive(Debug, Serialize)]
struct Report<'a> {
    folder: String,
    champion: String,
    report: String,
    scenario: &'a str,
    seed: u64,
    generations: u32,
    best: f64,
    training: OnTrainingPairs,
    unseen: &'a Evaluation,
}

/// How the champion did on the pairs it was trained on.
#[derive(Debug, Serialize)]
struct OnTrainingPairs {
    pairs: usize,
    reached: usize,
    clean: usize,
    collisions: u64,
}

/// Writes everything that a finished run leaves behind, the report last.
///
/// # Errors
///
/// A file that cannot be written.
pub(super) fn finish(
    folder: &RunFolder,
    problem: &Problem,
    seed: RunSeed,
    training: &Training<'_>,
    stop: &StopFlag,
    output: &mut Output,
) -> Result<Finished, Failure> {
    let Some(best) = training.best() else {
        return Err(Failure::bad_input(
            "--generations: 0 generations leave no champion; 1 or more expected",
        ));
    };
    let bytes = champion::to_blob(problem, seed, best)
        .map_err(|error| Failure::bad_input(format!("the champion cannot be written: {error}")))?;
    folder.write(RunFolder::CHAMPION, &bytes)?;

    let pairs = training.pairs_of(best)?;
    let place = |drive| training_drive(seed, best.generation, drive);
    let unseen = problem
        .sampler()
        .unseen(seed, UNSEEN_PAIRS)
        .map_err(|error| Failure::bad_input(error.to_string()))?;
    let never_seen = |index| evaluation_drive(seed, index);
    let (Some(trained), Some(unseen)) = (
        evaluation::outcomes(problem, &best.genome, &pairs, place, stop),
        evaluation::outcomes(problem, &best.genome, &unseen, never_seen, stop),
    ) else {
        return Ok(Finished::Stopped);
    };
    let unseen = Evaluation::summary(&unseen, seed);
    let on_pairs = OnTrainingPairs {
        pairs: trained.len(),
        reached: trained.iter().filter(|outcome| outcome.reached).count(),
        clean: trained.iter().filter(|outcome| Outcome::clean(outcome)).count(),
        collisions: trained.iter().map(|outcome| u64::from(outcome.collisions)).sum(),
    };
    let drawn = &pairs[..pairs.len().min(DRAWN_PAIRS)];
    let drives = picture::drives(problem, &best.genome, drawn, place);
    draw(folder, problem, seed, training, best, drives, &on_pairs, &unseen)?;

    let path = |name: &str| folder.join(name).display().to_string();
    let champion = BlobFile::read(&folder.join(RunFolder::CHAMPION))?;
    let generations = training.generation();
    output.line(format_args!(
        "trained {}; the champion is of generation {} (they count from 0), fitness {:.1}",
        counted(generations, "generation"),
        best.generation,
        best.cost.value()
    ));
    output.line(format_args!(
        "  training pairs  reached {} of {}, clean {}",
        on_pairs.reached, on_pairs.pairs, on_pairs.clean
    ));
    output.line(format_args!("  unseen pairs    reached {}", unseen.reached_share()));
    output.line(format_args!("                  clean   {}", unseen.clean_share()));
    output.line(format_args!("report    {}  (open it in a browser)", path(RunFolder::REPORT)));
    output.line(format_args!(
        "champion  {}  ({} bytes, check {:016x})",
        path(RunFolder::CHAMPION),
        champion.bytes().len(),
        champion.blob().check()
    ));
    output.line(format_args!(
        "next      {} evaluate {} {}",
        this_program(),
        in_shell(folder.path()),
        shortest_name(&problem.scenario, folder.path())
    ));
    output.json(&Report {
        folder: folder.path().display().to_string(),
        champion: path(RunFolder::CHAMPION),
        report: path(RunFolder::REPORT),
        scenario: &problem.scenario.name,
        seed: seed.0,
        generations,
        best: best.cost.value(),
        training: on_pairs,
        unseen: &unseen,
    });
    Ok(Finished::Whole)
}

#[expect(clippy::too_many_arguments, reason = "what a report is made of")]
fn draw(
    folder: &RunFolder,
    problem: &Problem,
    seed: RunSeed,
    training: &Training<'_>,
    best: &Best,
    drives: Vec<Drive>,
    on_pairs: &OnTrainingPairs,
    unseen: &Evaluation,
) -> Result<(), Failure> {
    let plot = |name: &str, svg: &str| {
        folder.write(&format!("{}/{name}.svg", RunFolder::PLOTS), svg.as_bytes())
    };
    let history = picture::history(training.history(), on_pairs.pairs);
    plot("fitness", &plots::fitness_svg(&history))?;
    plot("criteria", &plots::criteria_svg(&history))?;
    let (scene, body) = (picture::scene(problem), picture::body(problem));
    for (number, drive) in (1..).zip(&drives) {
        let title = format!("{}, pair {number}", problem.scenario.name);
        let svg = plots::trajectory_svg(&scene, &body, drive, &title);
        plot(&format!("trajectory-{number}"), &svg)?;
    }
    let shown = if drives.len() < on_pairs.pairs {
        format!(" The first {} are shown.", counted(drives.len() as u64, "training pair"))
    } else {
        String::new()
    };
    let summary = format!(
        "After {} the champion reaches {} of {}.{shown} Of {} pairs it has never seen it \
         reaches {}, and {} without touching anything.",
        counted(training.generation(), "generation"),
        on_pairs.reached,
        counted(on_pairs.pairs as u64, "training pair"),
        unseen.pairs,
        unseen.reached_share(),
        unseen.clean_share()
    );
    let provenance = vec![
        ("evosteer".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
        ("scenario".to_owned(), problem.scenario.name.clone()),
        ("seed".to_owned(), seed.to_string()),
        ("network".to_owned(), problem.topology().to_string()),
        ("generation of the champion".to_owned(), best.generation.to_string()),
        ("fitness of the champion".to_owned(), format!("{:.1}", best.cost.value())),
    ];
    let title = format!("{}, seed {seed}", problem.scenario.name);
    let data = picture::report(problem, title, summary, drives, history, provenance);
    folder.write(RunFolder::REPORT, page::render(&data).as_bytes())
}

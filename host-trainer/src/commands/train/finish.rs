//! The end of a training run: champion, plots, report, and what to do next.

use crate::champion;
use crate::evaluation::Evaluation;
use crate::failure::Failure;
use crate::output::Output;
use crate::pairs::PairSampler;
use crate::problem::{Problem, training_drive};
use crate::report::{data::Drive, page, plots};
use crate::run_folder::RunFolder;
use crate::seed::RunSeed;
use crate::training::{Best, Training};
use crate::{blob_file::BlobFile, picture};
use serde::Serialize;

/// Unseen pairs that every training run is judged on at its end.
const UNSEEN_PAIRS: u32 = 1000;

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
    collisions: u32,
}

/// Writes everything that a finished run leaves behind.
///
/// # Errors
///
/// A file that cannot be written.
pub(super) fn finish(
    folder: &RunFolder,
    problem: &Problem,
    seed: RunSeed,
    training: &Training<'_>,
    output: &mut Output,
) -> Result<(), Failure> {
    let Some(best) = training.best() else {
        return Err(Failure::bad_input(
            "--generations: 0 generations leave no champion; 1 or more expected",
        ));
    };
    let bytes = champion::to_blob(problem, seed, best)
        .map_err(|error| Failure::bad_input(format!("the champion cannot be written: {error}")))?;
    folder.write(RunFolder::CHAMPION, &bytes)?;

    let pairs = training.pairs(best.generation)?;
    let place = |drive| training_drive(seed, best.generation, drive);
    let drives = picture::drives(problem, &best.genome, &pairs, place);
    let unseen = PairSampler::new(&problem.world, &problem.scenario)
        .unseen(seed, UNSEEN_PAIRS)
        .map_err(|error| Failure::bad_input(error.to_string()))?;
    let unseen = Evaluation::of(problem, &best.genome, &unseen, seed);
    let on_pairs = OnTrainingPairs {
        pairs: drives.len(),
        reached: drives.iter().filter(|drive| drive.outcome.reached).count(),
        clean: drives.iter().filter(|drive| drive.outcome.clean()).count(),
        collisions: drives.iter().map(|drive| drive.outcome.collisions).sum(),
    };
    draw(folder, problem, seed, training, best, drives, &unseen)?;

    let path = |name: &str| folder.join(name).display().to_string();
    let champion = BlobFile::read(&folder.join(RunFolder::CHAMPION))?;
    let generations = training.generation();
    output.line(format_args!(
        "trained {generations} generations; the champion is of generation {}, fitness {:.1}",
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
        "next      cargo run --release -- evaluate {} {}",
        folder.path().display(),
        problem.scenario.name
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
    Ok(())
}

fn draw(
    folder: &RunFolder,
    problem: &Problem,
    seed: RunSeed,
    training: &Training<'_>,
    best: &Best,
    drives: Vec<Drive>,
    unseen: &Evaluation,
) -> Result<(), Failure> {
    let plot = |name: &str, svg: &str| {
        folder.write(&format!("{}/{name}.svg", RunFolder::PLOTS), svg.as_bytes())
    };
    let history = picture::history(training.history(), drives.len());
    plot("fitness", &plots::fitness_svg(&history))?;
    plot("criteria", &plots::criteria_svg(&history))?;
    let (scene, body) = (picture::scene(problem), picture::body(problem));
    for (number, drive) in (1..).zip(&drives) {
        let title = format!("{}, pair {number}", problem.scenario.name);
        let svg = plots::trajectory_svg(&scene, &body, drive, &title);
        plot(&format!("trajectory-{number}"), &svg)?;
    }
    let reached = drives.iter().filter(|drive| drive.outcome.reached).count();
    let summary = format!(
        "After {} generations the champion reaches {reached} of {} training pairs. Of {} pairs \
         it has never seen it reaches {}, and {} without touching anything.",
        training.generation(),
        drives.len(),
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

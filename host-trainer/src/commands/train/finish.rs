//! The end of a training run: champion, plots, report, and what to do next.

use super::worlds;
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
use crate::run_folder::manifest::Input;
use crate::scenario::Pair;
use crate::seed::{RunSeed, Stream};
use crate::signals::StopFlag;
use crate::training::{Best, Training};
use crate::{blob_file::BlobFile, picture};
use serde::Serialize;

/// Unseen pairs that every training run is judged on at its end.
const UNSEEN_PAIRS: u32 = 1000;

/// Most pairs whose drives are drawn.
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
    /// What the run began with, if not with random networks.
    #[serde(skip_serializing_if = "Option::is_none")]
    from: Option<&'a Input>,
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

/// Which pairs' drives are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Pairs {
    /// Those of the champion's generation.
    Training,
    /// Those that it is judged on at its end.
    Unseen,
}

/// The drives that the report shows.
#[derive(Debug)]
struct Films {
    pairs: Pairs,
    /// How many pairs there are.
    of: usize,
    drives: Vec<Drive>,
}

impl Films {
    /// Those of the first pairs. Drive `i` gets the random numbers of `place(i)`.
    fn of(
        problem: &Problem,
        best: &Best,
        kind: Pairs,
        pairs: &[Pair],
        place: impl Fn(u32) -> Stream,
    ) -> Self {
        let drawn = &pairs[..pairs.len().min(DRAWN_PAIRS)];
        let drives = picture::drives(problem, &best.genome, drawn, place);
        Self { pairs: kind, of: pairs.len(), drives }
    }

    /// What the report says of them; nothing where it shows all training pairs.
    fn note(&self) -> String {
        let shown = self.drives.len() as u64;
        match self.pairs {
            Pairs::Training if self.drives.len() == self.of => String::new(),
            Pairs::Training => format!(" The first {} are shown.", counted(shown, "training pair")),
            Pairs::Unseen => format!(
                " It was trained in random worlds; those of the first generation and of the champion's \
                 lie in the folder {} beside this page. Shown are drives of the first {} in this one.",
                RunFolder::WORLDS,
                counted(shown, "unseen pair")
            ),
        }
    }
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
    from: Option<&Input>,
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

    let unseen = problem
        .sampler()
        .unseen(seed, UNSEEN_PAIRS)
        .map_err(|error| Failure::bad_input(error.to_string()))?;
    let never_seen = |index| evaluation_drive(seed, index);
    let (Some(trained), Some(outcomes)) = (
        training.drives_of(best, stop)?,
        evaluation::outcomes(problem, &best.genome, &unseen, never_seen, stop),
    ) else {
        return Ok(Finished::Stopped);
    };
    let on_pairs = OnTrainingPairs {
        pairs: trained.len(),
        reached: trained.iter().filter(|outcome| outcome.reached).count(),
        clean: trained.iter().filter(|outcome| Outcome::clean(outcome)).count(),
        collisions: trained.iter().map(|outcome| u64::from(outcome.collisions)).sum(),
    };
    let films = if let Some(spec) = problem.scenario.training.worlds {
        if spec.renew_every > 0 {
            worlds::write(folder, training, best.generation)?;
        }
        // Its training pairs lie elsewhere.
        Films::of(problem, best, Pairs::Unseen, &unseen, never_seen)
    } else {
        let place = |drive| training_drive(seed, best.generation, drive);
        Films::of(problem, best, Pairs::Training, &training.pairs_of(best)?, place)
    };
    let unseen = Evaluation::summary(&outcomes, seed);
    draw(folder, problem, seed, from, training, best, films, &on_pairs, &unseen)?;

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
        from,
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
    from: Option<&Input>,
    training: &Training<'_>,
    best: &Best,
    films: Films,
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
    for (number, drive) in (1..).zip(&films.drives) {
        let title = format!("{}, pair {number}", problem.scenario.name);
        let svg = plots::trajectory_svg(&scene, &body, drive, &title);
        plot(&format!("trajectory-{number}"), &svg)?;
    }
    let note = films.note();
    let summary = format!(
        "After {} the champion reaches {} of {}.{note} Of {} pairs it has never seen it \
         reaches {}, and {} without touching anything.",
        counted(training.generation(), "generation"),
        on_pairs.reached,
        counted(on_pairs.pairs as u64, "training pair"),
        unseen.pairs,
        unseen.reached_share(),
        unseen.clean_share()
    );
    let mut provenance = vec![
        ("evosteer".to_owned(), env!("CARGO_PKG_VERSION").to_owned()),
        ("scenario".to_owned(), problem.scenario.name.clone()),
        ("seed".to_owned(), seed.to_string()),
        ("network".to_owned(), problem.topology().to_string()),
        ("generation of the champion".to_owned(), best.generation.to_string()),
        ("fitness of the champion".to_owned(), format!("{:.1}", best.cost.value())),
    ];
    if let Some(Input { path, sha256 }) = from {
        let champion = format!("{}, SHA-256 {sha256}", path.display());
        provenance.insert(3, ("began with".to_owned(), champion));
    }
    let title = format!("{}, seed {seed}", problem.scenario.name);
    let data = picture::report(problem, title, summary, films.drives, history, provenance);
    folder.write(RunFolder::REPORT, page::render(&data).as_bytes())
}

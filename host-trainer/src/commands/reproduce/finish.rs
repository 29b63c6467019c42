//! The end of a reproduction: numbers, pictures and the report; and what is said about them.

use crate::failure::Failure;
use crate::output::Output;
use crate::report::page;
use crate::reproduce::results::{Row, percent, range};
use crate::reproduce::{Plan, Results, Setup, Trial, study, table};
use crate::run_folder::RunFolder;
use crate::seed::RunSeed;
use serde::Serialize;
use std::fmt::Display;

/// One row per scene, variant and seed.
const CSV: &str = "results.csv";

/// All numbers.
const JSON: &str = "results.json";

/// What `--json` prints.
#[derive(Debug, Serialize)]
struct Report<'a> {
    folder: String,
    report: String,
    #[serde(flatten)]
    results: &'a Results,
}

/// A trial that is done, in a line.
pub(super) fn brief(setup: &Setup, seed: RunSeed, trial: &Trial) -> impl Display {
    let (scene, method) = (setup.scene.name(), setup.method.name);
    let Some(stage) = trial.stages.first() else { return String::new() };
    format!(
        "{scene} {method} seed {seed}: training {} of {}, unseen {}, clean {}",
        stage.training_reached(),
        stage.training.len(),
        percent(stage.unseen.reached_share().value()),
        percent(stage.unseen.clean_share().value())
    )
}

/// Writes everything that a finished reproduction leaves behind, the report last.
///
/// # Errors
///
/// A file that cannot be written.
pub(super) fn finish(
    folder: &RunFolder,
    plan: &Plan,
    setups: &[Setup],
    trials: &[Vec<Trial>],
    output: &mut Output,
) -> Result<(), Failure> {
    let results = Results::of(plan, setups, trials);
    let shown = study::of(plan, setups, trials, &results)?;
    let mut json = serde_json::to_vec_pretty(&results)
        .map_err(|error| Failure::bad_input(format!("{JSON} cannot be written: {error}")))?;
    json.push(b'\n');
    folder.write(JSON, &json)?;
    folder.write(CSV, table::csv(&results).as_bytes())?;
    for (name, svg) in &shown.pictures {
        folder.write(&format!("{}/{name}.svg", RunFolder::PLOTS), svg.as_bytes())?;
    }
    folder.write(RunFolder::REPORT, page::render_study(&shown.study).as_bytes())?;
    say(&results, output);
    let path = |name: &str| folder.join(name).display().to_string();
    output.line(format_args!("report  {}  (open it in a browser)", path(RunFolder::REPORT)));
    output.line(format_args!("numbers {} and {}", path(CSV), path(JSON)));
    output.json(&Report {
        folder: folder.path().display().to_string(),
        report: path(RunFolder::REPORT),
        results: &results,
    });
    Ok(())
}

fn say(results: &Results, output: &mut Output) {
    for scene in &results.scenes {
        let paper = match scene.papers_success_rate {
            Some(rate) => format!("; the paper says {:.0} % of the targets", 100.0 * rate),
            None => String::new(),
        };
        output.line(format_args!("{} ({}){paper}", scene.scene.name(), scene.scene.figures()));
        let widest = scene.rows.iter().map(|row| row.variant.chars().count()).max().unwrap_or(0);
        for row in &scene.rows {
            output.line(format_args!("  {:widest$}  {}", row.variant, in_a_line(row)));
        }
    }
    output.line("(training pairs of all seeds with their 95 % interval; unseen: median over the seeds, least to most)");
}

fn in_a_line(row: &Row) -> String {
    format!(
        "training {}; unseen reached {}, clean {}",
        row.training,
        range(&row.unseen_reached),
        range(&row.unseen_clean)
    )
}

//! One champion in several scenarios: a line of each, and all drives together.

use super::{EvaluateArgs, Report, Task};
use crate::blob_file::BlobFile;
use crate::evaluation::Share;
use crate::failure::Failure;
use crate::output::Output;
use serde::Serialize;

/// What `--json` prints.
#[derive(Debug, Serialize)]
struct Table {
    scenarios: Vec<Report>,
    /// All drives of all scenarios.
    drives: u32,
    reached: f64,
    reached_interval: [f64; 2],
    clean: f64,
    clean_interval: [f64; 2],
}

/// Evaluates in each scenario and prints the table.
///
/// # Errors
///
/// A scenario that is refused, or a world in which no pair is found; `--stress`, which is about
/// one scenario.
pub(super) fn print(
    args: &EvaluateArgs,
    champion: &BlobFile,
    scenarios: &[String],
    output: &mut Output,
) -> Result<(), Failure> {
    if args.stress {
        return Err(Failure::bad_input(format!(
            "--stress: found {} scenarios, expected one",
            scenarios.len()
        )));
    }
    let (mut reports, mut rows) = (Vec::new(), Vec::new());
    let (mut reached, mut clean) = (Share { count: 0, of: 0 }, Share { count: 0, of: 0 });
    // Everything that can be refused is, before anything drives.
    let tasks: Result<Vec<Task<'_>>, Failure> =
        scenarios.iter().map(|typed| Task::new(args, champion, typed, output)).collect();
    let tasks = tasks?;
    let mut names: Vec<&str> = tasks.iter().map(|task| &*task.problem.scenario.name).collect();
    names.sort_unstable();
    let are_different = names.windows(2).all(|two| two[0] != two[1]);
    for (typed, task) in scenarios.iter().zip(tasks) {
        let evaluation = task.evaluation(champion);
        let shares = [evaluation.reached_share(), evaluation.clean_share()];
        for (all, share) in [&mut reached, &mut clean].into_iter().zip(shares) {
            *all = Share { count: all.count + share.count, of: all.of + share.of };
        }
        let name = if are_different { &task.problem.scenario.name } else { typed };
        rows.push((name.clone(), shares));
        reports.push(task.report(champion, evaluation, None));
    }
    rows.push((format!("all {}", scenarios.len()), [reached, clean]));
    let widest = rows.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    let what = if args.which.listed { "listed pairs" } else { "unseen pairs" };
    let drivable = if args.drivable { ", those that are drivable" } else { "" };
    output.line(format_args!(
        "{}, {what}, seed {}{drivable}",
        champion.path().display(),
        args.seed
    ));
    output.line(format_args!("  {:widest$}  drives  {:24}clean", "", "reached"));
    for (name, [reached, clean]) in &rows {
        // A share pads itself only as text.
        let reached_text = reached.to_string();
        output.line(format_args!("  {name:widest$}  {:6}  {reached_text:24}{clean}", reached.of));
    }
    output.line("  (shares with their 95 % confidence intervals)");
    output.json(&Table {
        scenarios: reports,
        drives: clean.of,
        reached: reached.value(),
        reached_interval: reached.interval(),
        clean: clean.value(),
        clean_interval: clean.interval(),
    });
    Ok(())
}

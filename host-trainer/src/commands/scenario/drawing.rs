//! A scenario as a picture: its world, its listed pairs, and drawn ones.

use crate::failure::Failure;
use crate::picture;
use crate::problem::Problem;
use crate::report::data::Task;
use crate::report::tasks_svg;
use crate::scenario::{Pair, PairSource};
use crate::seed::RunSeed;

/// The picture, with `count` unseen pairs as `evaluate --seed` draws them. Listed pairs are
/// numbered, drawn ones have an `u` before their number.
///
/// # Errors
///
/// A world in which no pair is found.
pub(super) fn draw(problem: &Problem, count: u32, seed: RunSeed) -> Result<String, Failure> {
    let scenario = &problem.scenario;
    let unseen = match count {
        0 => Vec::new(),
        _ => problem
            .sampler()
            .unseen(seed, count)
            .map_err(|error| Failure::bad_input(format!("{}: {error}", scenario.name)))?,
    };
    let listed = match &scenario.pairs.source {
        PairSource::Listed(pairs) => pairs.as_slice(),
        PairSource::Drawn { .. } => &[],
    };
    let mut tasks = tasks("", listed);
    tasks.extend(self::tasks("u", &unseen));
    Ok(tasks_svg(&picture::scene(problem), &picture::body(problem), &tasks))
}

fn tasks(prefix: &str, pairs: &[Pair]) -> Vec<Task> {
    let task = |(number, pair): (u32, &Pair)| Task {
        label: format!("{prefix}{number}"),
        start: pair.start,
        goal: pair.goal,
    };
    (1..).zip(pairs).map(task).collect()
}

//! The trials of a reproduction: what is kept already, and the rest.

use super::finish;
use crate::commands::advice::counted;
use crate::failure::{Failure, FailureKind};
use crate::output::{Output, TrialProgress};
use crate::reproduce::trial::Task;
use crate::reproduce::workers::{self, Event};
use crate::reproduce::{Plan, Setup, Trial};
use crate::run_folder::RunFolder;
use crate::seed::RunSeed;
use crate::signals::StopFlag;

/// Every trial, read or done: one list per setup, by seed.
///
/// # Errors
///
/// A trial that cannot be read or kept; a signal.
pub(super) fn all(
    folder: &RunFolder,
    plan: &Plan,
    setups: &[Setup],
    threads: usize,
    stop: &StopFlag,
    output: &mut Output,
) -> Result<Vec<Vec<Trial>>, Failure> {
    let mut all: Vec<Vec<Option<Trial>>> = Vec::new();
    for setup in setups {
        all.push(
            plan.seeds().map(|seed| Trial::read(setup, seed, folder)).collect::<Result<_, _>>()?,
        );
    }
    let seeds: Vec<RunSeed> = plan.seeds().collect();
    let places =
        (0..setups.len()).flat_map(|setup| (0..seeds.len()).map(move |seed| (setup, seed)));
    let missing: Vec<(usize, usize)> =
        places.filter(|(setup, seed)| all[*setup][*seed].is_none()).collect();
    let jobs: Vec<Task<'_>> = missing
        .iter()
        .map(|(setup, seed)| Task { setup: &setups[*setup], seed: seeds[*seed] })
        .collect();
    let total = setups.len() * seeds.len();
    let done = total - jobs.len();
    output.status(format_args!(
        "{}: {}, {}, {}, {} ({done} done), {}, in {}",
        plan.scenes.iter().map(|scene| scene.name()).collect::<Vec<_>>().join(", "),
        counted(plan.methods.len() as u64, "method"),
        counted(plan.seeds, "seed"),
        counted(plan.pairs, "unseen pair"),
        counted(total as u64, "trial"),
        counted(threads as u64, "thread"),
        folder.path().display()
    ));
    let work = jobs.iter().map(|job| job.setup.work()).sum();
    let mut progress = TrialProgress::start(done as u64, total as u64, work);
    let result = workers::run(&jobs, threads, stop, |event| {
        match event {
            Event::Generation { job } => progress.advance(jobs[job].setup.work_of_a_generation()),
            Event::Done { job, trial } => {
                let Task { setup, seed } = jobs[job];
                trial.write(setup, folder)?;
                progress.trial(output, finish::brief(setup, seed, &trial));
                let (setup, seed) = missing[job];
                all[setup][seed] = Some(trial);
            }
        }
        Ok(())
    });
    progress.finish();
    result?;
    none_missing(all, stop)
}

/// The trials, if every one is done.
///
/// # Errors
///
/// [`FailureKind::Interrupted`]: only a signal leaves a trial undone.
pub(super) fn none_missing<T>(
    all: Vec<Vec<Option<T>>>,
    stop: &StopFlag,
) -> Result<Vec<Vec<T>>, Failure> {
    let total: usize = all.iter().map(Vec::len).sum();
    let done = all.iter().flatten().flatten().count();
    let whole: Option<Vec<Vec<T>>> =
        all.into_iter().map(|trials| trials.into_iter().collect()).collect();
    whole.ok_or_else(|| {
        let signal = stop.requested().unwrap_or_default();
        let message =
            format!("stopped after {done} of {}, each kept", counted(total as u64, "trial"));
        Failure::new(FailureKind::Interrupted { signal }, message)
    })
}

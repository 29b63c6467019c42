//! Many trials at once: each on its own few threads, the next one as soon as one is done.
//!
//! A generation of the paper's is too little work for many threads; whole trials keep them busy,
//! and wait for each other only at the end. What a trial gives does not depend on where it runs.

use crate::failure::Failure;
use crate::signals::StopFlag;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{self, Sender};
use std::thread;

/// A trial to be done.
pub trait Job: Sync {
    /// What it gives.
    type Trial: Send;

    /// Does it on the current rayon pool; none if `stop` was raised meanwhile, or `judged` (called
    /// after every generation) says no.
    ///
    /// # Errors
    ///
    /// What makes the trial impossible.
    fn run(
        &self,
        stop: &StopFlag,
        judged: impl FnMut() -> bool,
    ) -> Result<Option<Self::Trial>, Failure>;
}

/// What happened in one of the jobs.
#[derive(Debug)]
pub enum Event<T> {
    /// A generation was judged.
    Generation {
        /// Which job.
        job: usize,
    },
    /// A trial is done.
    Done {
        /// Which job.
        job: usize,
        /// What it gave.
        trial: T,
    },
}

/// Does the jobs on so many threads and tells `each` what happens, in this thread. Returns early,
/// with the jobs that were under way given up, when `stop` is raised or `each` fails.
///
/// # Errors
///
/// The first failure of a job or of `each`.
pub fn run<J: Job>(
    jobs: &[J],
    threads: usize,
    stop: &StopFlag,
    mut each: impl FnMut(Event<J::Trial>) -> Result<(), Failure>,
) -> Result<(), Failure> {
    let workers = threads.min(jobs.len()).max(1);
    let next = AtomicUsize::new(0);
    thread::scope(|scope| {
        let (tell, told) = mpsc::channel();
        for worker in 0..workers {
            let share = threads / workers + usize::from(worker < threads % workers);
            let (tell, next) = (tell.clone(), &next);
            scope.spawn(move || {
                if let Err(failure) = work(jobs, share.max(1), next, stop, &tell) {
                    // Nobody listens any more where another failure came first.
                    let _ = tell.send(Err(failure));
                }
            });
        }
        drop(tell);
        // Leaving this loop drops `told`: then workers find nobody to tell, and end.
        told.into_iter().try_for_each(|event| each(event?))
    })
}

fn work<J: Job>(
    jobs: &[J],
    threads: usize,
    next: &AtomicUsize,
    stop: &StopFlag,
    tell: &Sender<Result<Event<J::Trial>, Failure>>,
) -> Result<(), Failure> {
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(threads)
        .build()
        .map_err(|error| Failure::bad_input(format!("--threads: {error}")))?;
    while stop.requested().is_none() {
        let job = next.fetch_add(1, Ordering::Relaxed);
        let Some(todo) = jobs.get(job) else { break };
        let judged = || tell.send(Ok(Event::Generation { job })).is_ok();
        let Some(trial) = pool.install(|| todo.run(stop, judged))? else { break };
        if tell.send(Ok(Event::Done { job, trial })).is_err() {
            break;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::trial::Task;
    use crate::reproduce::{Trial, sample};
    use crate::seed::RunSeed;

    fn trials(threads: usize) -> Vec<Trial> {
        let plan = sample::plan();
        let setups = plan.setups().unwrap();
        let seeds = plan.seeds();
        let jobs: Vec<Task<'_>> = setups
            .iter()
            .flat_map(|setup| seeds.clone().map(move |seed| Task { setup, seed }))
            .collect();
        let mut done: Vec<Option<Trial>> = vec![None; jobs.len()];
        run(&jobs, threads, &StopFlag::default(), |event| {
            if let Event::Done { job, trial } = event {
                done[job] = Some(trial);
            }
            Ok(())
        })
        .unwrap();
        done.into_iter().map(Option::unwrap).collect()
    }

    #[test]
    fn trials_are_the_same_on_any_number_of_threads() {
        let alone = trials(1);
        assert!(alone.len() > 3 && trials(2) == alone && trials(7) == alone);
    }

    #[test]
    fn a_raised_flag_ends_the_work_without_half_a_trial() {
        let setups = sample::plan().setups().unwrap();
        let jobs = [1, 2, 3].map(|seed| Task { setup: &setups[0], seed: RunSeed(seed) });
        let stop = StopFlag::default();
        let mut done = 0;
        run(&jobs, 2, &stop, |event| {
            done += usize::from(matches!(event, Event::Done { .. }));
            stop.request(2);
            Ok(())
        })
        .unwrap();
        assert!(done < 3);
    }

    #[test]
    fn a_result_that_cannot_be_kept_ends_the_work() {
        let setups = sample::plan().setups().unwrap();
        let jobs = [1, 2, 3, 4].map(|seed| Task { setup: &setups[0], seed: RunSeed(seed) });
        let mut events = 0;
        let failed = run(&jobs, 1, &StopFlag::default(), |_| {
            events += 1;
            Err(Failure::bad_input("full"))
        });
        assert_eq!((failed.unwrap_err().to_string(), events), ("full".to_owned(), 1));
    }
}

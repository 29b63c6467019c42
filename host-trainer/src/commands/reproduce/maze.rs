//! `evosteer reproduce medium-maze`: novelty search beside a search for the goal, and beside what
//! the literature says of both.

use super::trials::none_missing;
use super::{ReproduceArgs, Which, enough_seeds_after, fewer_seeds};
use crate::commands::advice::counted;
use crate::failure::Failure;
use crate::output::{Output, TrialProgress};
use crate::report::page;
use crate::reproduce::maze::course::{Course, Published, SOURCE};
use crate::reproduce::maze::results::{CourseResults, MazeRow, thousands};
use crate::reproduce::maze::trial::MazeTask;
use crate::reproduce::maze::{MazeMethod, MazePlan, MazeResults, MazeSetup, MazeTrial, study};
use crate::reproduce::workers::{self, Event};
use crate::run_folder::RunFolder;
use crate::seed::RunSeed;
use crate::signals::StopFlag;
use serde::Serialize;
use std::fmt::Display;

/// Seeds of an experiment that does not say how many: as many as the literature has.
const SEEDS: u32 = 40;

/// One row per course, method and seed.
const CSV: &str = "results.csv";

/// All numbers.
const JSON: &str = "results.json";

/// An experiment that is to be done.
pub(super) struct Mazes {
    folder: RunFolder,
    plan: MazePlan,
    setups: Vec<MazeSetup>,
}

/// What `--json` prints.
#[derive(Debug, Serialize)]
struct Report<'a> {
    folder: String,
    report: String,
    #[serde(flatten)]
    results: &'a MazeResults,
}

impl Which {
    /// The courses of a maze; none of a scene of the paper.
    pub(super) fn courses(self) -> Vec<Course> {
        match self {
            Self::Open | Self::Obstacles | Self::Complex | Self::All => Vec::new(),
            Self::MediumMaze => vec![Course::MediumMaze, Course::MediumMazeClean],
            Self::SwitchbackMaze => vec![Course::SwitchbackMaze, Course::SwitchbackMazeClean],
            Self::Mazes => Course::ALL.to_vec(),
        }
    }
}

impl Mazes {
    /// A new folder with its plan.
    pub(super) fn begin(args: &ReproduceArgs) -> Result<Self, Failure> {
        if args.pairs.is_some() {
            return Err(Failure::bad_input(
                "--pairs: found a number of unseen pairs for a maze, which has one pair of its own; \
                 expected none",
            ));
        }
        let plan = MazePlan {
            evosteer: env!("CARGO_PKG_VERSION").to_owned(),
            courses: args.scene.courses(),
            methods: methods(args.methods.as_deref())?,
            seed: args.seed.0,
            seeds: args.seeds.unwrap_or(SEEDS),
            generations: args.generations,
            population: args.population,
        };
        enough_seeds_after(plan.seed, plan.seeds)?;
        // Everything that can be refused is, before a folder exists.
        let setups = plan.setups()?;
        let path = args.out.clone().unwrap_or_else(|| args.scene.folder());
        let folder = RunFolder::create(&path)?;
        plan.write(&folder)?;
        Ok(Self { folder, plan, setups })
    }

    /// The experiment in a folder, or the folder where it holds none of mazes.
    pub(super) fn resume(
        folder: RunFolder,
        seeds: Option<u32>,
    ) -> Result<Result<Self, RunFolder>, Failure> {
        let Some(mut plan) = MazePlan::read(&folder)? else { return Ok(Err(folder)) };
        if let Some(seeds) = seeds
            && seeds != plan.seeds
        {
            if seeds < plan.seeds {
                return Err(fewer_seeds(folder.path(), plan.seeds));
            }
            plan.seeds = seeds;
            enough_seeds_after(plan.seed, plan.seeds)?;
            plan.write(&folder)?;
        }
        let setups = plan.setups()?;
        Ok(Ok(Self { folder, plan, setups }))
    }

    /// Where it is kept.
    pub(super) fn folder(&self) -> &RunFolder {
        &self.folder
    }

    /// Does what is not done yet, and writes and says what came out.
    pub(super) fn go(
        &self,
        threads: usize,
        stop: &StopFlag,
        output: &mut Output,
    ) -> Result<(), Failure> {
        let trials = self.trials(threads, stop, output)?;
        self.finish(&trials, output)
    }

    fn trials(
        &self,
        threads: usize,
        stop: &StopFlag,
        output: &mut Output,
    ) -> Result<Vec<Vec<MazeTrial>>, Failure> {
        let Self { folder, plan, setups } = self;
        let read = |setup| {
            plan.seeds().map(|seed| MazeTrial::read(setup, seed, folder)).collect::<Result<_, _>>()
        };
        let mut all: Vec<Vec<Option<MazeTrial>>> =
            setups.iter().map(read).collect::<Result<_, _>>()?;
        let mut jobs = Vec::new();
        let mut missing = Vec::new();
        for (place, (setup, trials)) in setups.iter().zip(&all).enumerate() {
            let undone = plan.seeds().zip(trials).enumerate().filter(|(_, (_, t))| t.is_none());
            for (index, (seed, _)) in undone {
                jobs.push(MazeTask { setup, seed });
                missing.push((place, index));
            }
        }
        let total = setups.len() * plan.seeds as usize;
        let done = total - jobs.len();
        output.status(format_args!(
            "{}: {}, {}, {} ({done} done), {}, in {}",
            plan.courses.iter().map(|course| course.name()).collect::<Vec<_>>().join(", "),
            counted(plan.methods.len() as u64, "method"),
            counted(plan.seeds, "seed"),
            counted(total as u64, "trial"),
            counted(threads as u64, "thread"),
            folder.path().display()
        ));
        // How long a trial takes shows only when its goal is reached: each counts the same.
        let mut progress = TrialProgress::start(done as u64, total as u64, jobs.len() as u64);
        let result = workers::run(&jobs, threads, stop, |event| {
            if let Event::Done { job, trial } = event {
                let MazeTask { setup, seed } = jobs[job];
                trial.write(setup, folder)?;
                progress.advance(1);
                progress.trial(output, brief(setup, seed, &trial));
                let (setup, seed) = missing[job];
                all[setup][seed] = Some(trial);
            }
            Ok(())
        });
        progress.finish();
        result?;
        none_missing(all, stop)
    }

    fn finish(&self, trials: &[Vec<MazeTrial>], output: &mut Output) -> Result<(), Failure> {
        let Self { folder, plan, setups } = self;
        let results = MazeResults::of(plan, setups, trials);
        let shown = study::of(plan, setups, trials, &results)?;
        let mut json = serde_json::to_vec_pretty(&results)
            .map_err(|error| Failure::bad_input(format!("{JSON} cannot be written: {error}")))?;
        json.push(b'\n');
        folder.write(JSON, &json)?;
        folder.write(CSV, results.csv().as_bytes())?;
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
}

/// The methods that are meant; all where none is named.
fn methods(names: Option<&[String]>) -> Result<Vec<MazeMethod>, Failure> {
    let known = MazeMethod::ALL;
    let Some(names) = names else { return Ok(known.to_vec()) };
    if let Some(name) = names.iter().find(|name| known.iter().all(|method| method.name() != *name))
    {
        let expected = known.map(MazeMethod::name).join(", ");
        return Err(Failure::bad_input(format!(
            "--methods: found `{name}`, which is for the paper's scenes; expected some of: {expected}"
        )));
    }
    Ok(known.into_iter().filter(|method| names.iter().any(|name| name == method.name())).collect())
}

/// A trial that is done, in a line.
fn brief(setup: &MazeSetup, seed: RunSeed, trial: &MazeTrial) -> impl Display {
    let end = if trial.solved { "reached" } else { "not reached" };
    let (course, method) = (setup.course.name(), setup.method.name());
    format!("{course} {method} seed {seed}: {end} after {} evaluations", trial.evaluations)
}

fn say(results: &MazeResults, output: &mut Output) {
    let names = results.courses.iter().flat_map(|course| &course.rows);
    let widest = names.map(|row| row.method.name().len()).max().unwrap_or(0);
    for course in &results.courses {
        let CourseResults { course, rule, published, rows } = course;
        output.line(format_args!("{}: {rule}", course.name()));
        for row in rows {
            output.line(format_args!("  {:widest$}  {}", row.method.name(), in_a_line(row)));
        }
        for Published { method, solved, runs, mean, deviation } in *published {
            let deviation =
                deviation.map(|sd| format!(", sd {}", thousands(sd))).unwrap_or_default();
            output.line(format_args!(
                "  {:widest$}  {solved} of {runs} published; evaluations mean {}{deviation}",
                method.name(),
                thousands(*mean)
            ));
        }
    }
    if results.courses.iter().any(|course| !course.published.is_empty()) {
        output.line(format_args!("(published: {SOURCE})"));
    }
}

fn in_a_line(row: &MazeRow) -> String {
    let of_budget = format!("within {} evaluations", thousands(row.budget as f64));
    let Some(all) = &row.evaluations else {
        return format!("solved {} {of_budget}", row.solved);
    };
    let deviation = all.deviation.map(|sd| format!(", sd {}", thousands(sd))).unwrap_or_default();
    format!(
        "solved {} {of_budget}; mean {}{deviation}, median {} ({} to {})",
        row.solved,
        thousands(all.mean),
        thousands(all.spread.median),
        thousands(all.spread.least),
        thousands(all.spread.most)
    )
}

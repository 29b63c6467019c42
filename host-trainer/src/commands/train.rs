//! `evosteer train`: the main job, from a scenario to a champion and its report.

mod beginning;
mod finish;
mod worlds;

use beginning::Beginning;
use finish::Finished;

use super::advice::{counted, in_shell, this_program};
use super::number::whole;
use super::setup::{ScenarioOptions, can_draw, problem};
use super::threads::Threads;
use crate::checkpoint::Checkpoints;
use crate::failure::{Failure, FailureKind};
use crate::output::{Output, Progress};
use crate::problem::Problem;
use crate::run_folder::manifest::Input;
use crate::run_folder::{Manifest, Metrics, RunFolder};
use crate::scenario::{Preset, Scenario, Setting, TrainingSpec};
use crate::seed::RunSeed;
use crate::signals::StopFlag;
use crate::training::{Snapshot, Training, depends_on_generations};
use controller_core::blob;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Evolves a controller
///
/// Writes a run folder with the champion, metrics, plots, checkpoints and a report that opens
/// offline. Ctrl-C stops at once, with a checkpoint to resume from. One seed gives one champion,
/// on any number of threads and across interruptions.
#[derive(Clone, Debug, clap::Args)]
pub struct TrainArgs {
    /// A scenario: the name of a shipped one, a file, or a run folder for its scenario
    #[arg(default_value = "obstacles")]
    scenario: String,

    /// The run folder; a new one under runs/ if not given
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Begin with a champion and mutants of it instead of with random networks: the scene of a
    /// shipped one, a weight blob, or a run folder
    #[arg(long, value_name = "CHAMPION")]
    from: Option<PathBuf>,

    /// Go on with the run in this folder, perhaps to more --generations; its scenario, seed and
    /// population stay
    #[arg(
        long,
        value_name = "DIR",
        conflicts_with_all = ["scenario", "out", "from", "seed", "population", "preset", "set"]
    )]
    resume: Option<PathBuf>,

    /// Seed of every random draw
    #[arg(long, default_value_t = RunSeed(1), allow_negative_numbers = true)]
    seed: RunSeed,

    #[command(flatten)]
    threads: Threads,

    /// Generations to run, in all
    #[arg(
        long,
        value_name = "N",
        value_parser = whole(TrainingSpec::GENERATIONS),
        allow_negative_numbers = true
    )]
    generations: Option<u32>,

    /// Individuals per generation, of each island
    #[arg(
        long,
        value_name = "N",
        value_parser = whole(TrainingSpec::POPULATION),
        allow_negative_numbers = true
    )]
    population: Option<u32>,

    #[command(flatten)]
    options: ScenarioOptions,

    /// Longest time between two checkpoints; 0 writes one after every generation
    #[arg(
        long,
        value_name = "SECONDS",
        default_value_t = 2,
        value_parser = whole(0..=3600_u16),
        allow_negative_numbers = true
    )]
    checkpoint_every: u16,

    /// Print the result as one JSON object
    #[arg(long)]
    pub json: bool,
}

/// A run, ready to go on.
struct Run {
    folder: RunFolder,
    seed: RunSeed,
    problem: Problem,
    beginning: Option<Beginning>,
    checkpoints: Checkpoints,
    snapshot: Option<Snapshot>,
}

/// Trains.
///
/// # Errors
///
/// Anything wrong with scenario, options or run folder; a signal, after the checkpoint is
/// written.
pub fn run(args: &TrainArgs, stop: &StopFlag, output: &mut Output) -> Result<(), Failure> {
    let pool = args.threads.pool()?;
    let run = match &args.resume {
        Some(folder) => Run::resume(folder, args.generations, output)?,
        None => Run::begin(args, output)?,
    };
    let go_on = format!("{} train --resume {}", this_program(), in_shell(run.folder.path()));
    let save_every = Duration::from_secs(args.checkpoint_every.into());
    let done = pool.install(|| run.go(save_every, stop, output));
    done.map_err(|failure| match failure.kind() {
        FailureKind::Interrupted { .. } => {
            Failure::new(failure.kind(), format!("{failure}\ngo on with: {go_on}"))
        }
        FailureKind::InputOutput => {
            let message = format!("{failure}\nwhen that is solved, go on with: {go_on}");
            Failure::new(failure.kind(), message)
        }
        FailureKind::Different | FailureKind::BadInput | FailureKind::Busy => failure,
    })
}

impl Run {
    fn begin(args: &TrainArgs, output: &mut Output) -> Result<Self, Failure> {
        let mut settings = args.options.settings();
        for (option, key, value) in [
            ("--generations", "training.generations", args.generations),
            ("--population", "training.population", args.population),
        ] {
            settings.extend(value.map(|value| Setting::option(option, key, value)));
        }
        let problem = problem(&args.scenario, args.options.preset, &settings)?;
        // Everything that can be refused is, before a folder exists.
        let beginning = match &args.from {
            Some(path) => Some(Beginning::read(path)?),
            None if args.options.preset == Some(Preset::Refine) => return Err(beginning::missing()),
            None => None,
        };
        if let Some(beginning) = &beginning {
            beginning.check(&problem, output)?;
        }
        let from = beginning.as_ref().map(|beginning| beginning.input().clone());
        let genome = beginning.as_ref().map(Beginning::genome);
        let training = Training::begin(&problem, args.seed, genome)?;
        can_draw(&problem, &args.scenario, &settings, args.seed)?;
        training.can_begin()?;
        let folder = match &args.out {
            Some(path) => RunFolder::create(path)?,
            None => RunFolder::choose(Path::new("runs"), &problem.scenario.name, args.seed.0)?,
        };
        manifest(args.seed, &problem.scenario, from)?.write(&folder)?;
        if let Some(beginning) = &beginning {
            beginning.copy_to(&folder)?;
        }
        worlds::write(&folder, &training, 0)?;
        drop(training);
        let (checkpoints, _) = Checkpoints::open::<Snapshot>(&folder)?;
        Ok(Self { folder, seed: args.seed, problem, beginning, checkpoints, snapshot: None })
    }

    fn resume(path: &Path, generations: Option<u32>, output: &mut Output) -> Result<Self, Failure> {
        let folder = RunFolder::resume(path)?;
        let mut manifest = Manifest::<Scenario>::read(&folder)?;
        let (checkpoints, loaded) = Checkpoints::open::<Snapshot>(&folder)?;
        for warning in loaded.iter().flat_map(|loaded| &loaded.warnings) {
            output.warning(warning);
        }
        let from = manifest.from.clone();
        let beginning = from.map(|from| Beginning::of_run(&folder, from)).transpose()?;
        if let Some(generations) = generations
            && generations != manifest.scenario.training.generations
        {
            if depends_on_generations(&manifest.scenario) {
                return Err(Failure::bad_input(format!(
                    "--generations: the run in {} changes its pairs, its mutation, its share of stressed \
                     drives or its number of islands from its first generation to its last, generation {}; \
                     expected that number, or a new run",
                    path.display(),
                    manifest.scenario.training.generations
                )));
            }
            let done = loaded.as_ref().map_or(0, |loaded| loaded.generation);
            if u64::from(generations) < done {
                return Err(Failure::bad_input(format!(
                    "--generations: {} of the run in {} are done already; expected as many or more",
                    counted(done, "generation"),
                    path.display()
                )));
            }
            manifest.scenario.training.generations = generations;
            manifest = self::manifest(RunSeed(manifest.seed), &manifest.scenario, manifest.from)?;
            manifest.write(&folder)?;
        }
        Ok(Self {
            folder,
            beginning,
            seed: RunSeed(manifest.seed),
            problem: Problem::new(manifest.scenario)?,
            checkpoints,
            snapshot: loaded.map(|loaded| loaded.state),
        })
    }

    fn go(self, save_every: Duration, stop: &StopFlag, output: &mut Output) -> Result<(), Failure> {
        let Self { folder, seed, problem, beginning, mut checkpoints, snapshot } = self;
        let from = beginning.as_ref().map(Beginning::input);
        let genome = beginning.as_ref().map(Beginning::genome);
        let mut training = Training::begin(&problem, seed, genome)?;
        let mut saved_generation = None;
        if let Some(snapshot) = snapshot {
            training.restore(snapshot).map_err(|error| {
                let folder = folder.path().display();
                Failure::bad_input(format!(
                    "the checkpoint in {folder} does not belong to this run: {error}"
                ))
            })?;
            saved_generation = Some(training.generation());
        }
        let total = problem.scenario.training.generations;
        let scenario = &problem.scenario.name;
        output.status(format_args!(
            "{scenario}: {}, {}, {}, seed {}, {}, in {}",
            problem.scenario.training.individuals_in_words(),
            counted(total, "generation"),
            problem.topology(),
            seed,
            counted(rayon::current_num_threads() as u64, "thread"),
            folder.path().display()
        ));
        let mut metrics = Metrics::start(&folder, training.history())?;
        let mut progress = Progress::start(training.generation(), total);
        let mut saved = Instant::now();
        let mut save = |training: &Training<'_>| {
            let generation = training.generation();
            if saved_generation == Some(generation) {
                return Ok(());
            }
            checkpoints.save(&folder, u64::from(generation), &training.snapshot())?;
            saved_generation = Some(generation);
            Ok::<(), Failure>(())
        };
        while !training.is_over() && stop.requested().is_none() {
            let begun = Instant::now();
            let Some(&row) = training.step_unless(stop)? else { break };
            // A clock that did not move must not make the speed infinite.
            let elapsed = begun.elapsed().max(Duration::from_nanos(1));
            let steps_per_second = row.live_steps as f64 / elapsed.as_secs_f64();
            metrics.append(&row, steps_per_second)?;
            progress.update(output, &row, steps_per_second);
            if saved.elapsed() >= save_every {
                save(&training)?;
                saved = Instant::now();
            }
        }
        progress.finish();
        metrics.sync()?;
        save(&training)?;
        if training.is_over()
            && finish::finish(&folder, &problem, seed, from, &training, stop, output)?
                == Finished::Whole
        {
            return Ok(());
        }
        // Only a signal brings the loop or the finish to an early end.
        let signal = stop.requested().unwrap_or_default();
        let message = format!(
            "stopped after generation {} of {total}, checkpoint written",
            training.generation()
        );
        Err(Failure::new(FailureKind::Interrupted { signal }, message))
    }
}

fn manifest(
    seed: RunSeed,
    scenario: &Scenario,
    from: Option<Input>,
) -> Result<Manifest<Scenario>, Failure> {
    let mut inputs = Vec::new();
    if let Some(map) = &scenario.world.map {
        inputs.push(Input::of_file(&map.yaml)?);
        let image = crate::map::image(&map.yaml)?;
        inputs.push(Input::of_file(&image)?);
    }
    let manifest = Manifest::new(seed.0, scenario.clone(), blob::VERSION, inputs)?;
    Ok(Manifest { from, ..manifest })
}

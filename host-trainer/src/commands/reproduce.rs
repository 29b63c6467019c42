//! `evosteer reproduce`: the paper's experiments over many seeds, beside the paper.

mod finish;
mod maze;
mod trials;

use super::advice::{counted, in_shell, this_program};
use super::number::whole;
use super::threads::Threads;
use crate::failure::{Failure, FailureKind};
use crate::output::Output;
use crate::reproduce::maze::MazeMethod;
use crate::reproduce::method::{self, Method};
use crate::reproduce::{PaperScene, Plan, Setup, Trial};
use crate::run_folder::RunFolder;
use crate::scenario::{Preset, TrainingSpec};
use crate::seed::RunSeed;
use crate::signals::StopFlag;
use clap::ValueEnum;
use maze::Mazes;
use std::path::{Path, PathBuf};
use std::thread::available_parallelism;

/// Does the paper's experiments over many seeds, beside the paper's figures; mazes too
///
/// Trains the paper's method in its scenes with its populations and generations, and what the paper
/// advises (more neurons, recurrent links, more generations), on the same seeds; judges every
/// champion on pairs it has never seen. Writes a folder with report.html, plots, results.csv and
/// results.json. Ctrl-C keeps the runs that are done; --resume goes on.
///
/// With a maze: novelty search (Lehman and Stanley 2011) beside the same search told the distance
/// to the goal, and told nothing, each until the goal is reached.
#[derive(Clone, Debug, clap::Args)]
pub struct ReproduceArgs {
    /// Which of the paper's scenes, or which maze
    #[arg(value_enum, default_value_t = Which::All)]
    scene: Which,

    /// The folder for the results; runs/reproduce-SCENE if not given
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Go on with the reproduction in this folder, perhaps to more --seeds; all else stays
    #[arg(
        long,
        value_name = "DIR",
        conflicts_with_all = ["scene", "out", "seed", "pairs", "methods", "generations", "population"]
    )]
    resume: Option<PathBuf>,

    /// How many seeds; 20 if not given, 40 in a maze
    #[arg(
        long,
        value_name = "N",
        value_parser = whole(1..=10_000_u32),
        allow_negative_numbers = true
    )]
    seeds: Option<u32>,

    /// The first seed; the others follow it
    #[arg(long, default_value_t = RunSeed(1), allow_negative_numbers = true)]
    seed: RunSeed,

    /// Unseen pairs that each champion is judged on; 1000 if not given
    #[arg(
        long,
        value_name = "N",
        value_parser = whole(1..=1_000_000_u32),
        allow_negative_numbers = true
    )]
    pairs: Option<u32>,

    /// Methods to try beside the paper's, separated by commas; all but `robust`, which takes minutes
    /// for each run, if not given, `paper` for none; in a maze some of novelty, distance and chance
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = parse_method)]
    methods: Option<Vec<String>>,

    /// Generations, instead of the paper's or the preset's
    #[arg(
        long,
        value_name = "N",
        value_parser = whole(TrainingSpec::GENERATIONS),
        allow_negative_numbers = true
    )]
    generations: Option<u32>,

    /// Individuals per generation, of each island, instead of the paper's or the preset's
    #[arg(
        long,
        value_name = "N",
        value_parser = whole(TrainingSpec::POPULATION),
        allow_negative_numbers = true
    )]
    population: Option<u32>,

    #[command(flatten)]
    threads: Threads,

    /// Print the results as one JSON object
    #[arg(long)]
    pub json: bool,
}

/// The paper's scenes, one or all, and mazes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Which {
    /// Without obstacles (Fig. 3)
    Open,
    /// With five boxes (Fig. 4 to 6)
    Obstacles,
    /// The hardest one (Fig. 7 and 8)
    Complex,
    /// All of the paper's
    All,
    /// The medium maze of novelty search
    MediumMaze,
    /// A longer one
    SwitchbackMaze,
    /// Both mazes
    Mazes,
}

impl Which {
    fn scenes(self) -> Vec<PaperScene> {
        match self {
            Self::Open => vec![PaperScene::Open],
            Self::Obstacles => vec![PaperScene::Obstacles],
            Self::Complex => vec![PaperScene::Complex],
            Self::All => PaperScene::ALL.to_vec(),
            Self::MediumMaze | Self::SwitchbackMaze | Self::Mazes => Vec::new(),
        }
    }

    fn folder(self) -> PathBuf {
        let name = match self {
            Self::Open => "open",
            Self::Obstacles => "obstacles",
            Self::Complex => "complex",
            Self::All => "all",
            Self::MediumMaze => "medium-maze",
            Self::SwitchbackMaze => "switchback-maze",
            Self::Mazes => "mazes",
        };
        Path::new("runs").join(format!("reproduce-{name}"))
    }
}

fn parse_method(text: &str) -> Result<String, String> {
    let of_mazes = MazeMethod::ALL.map(MazeMethod::name);
    let names = method::all().into_iter().map(|method| method.name);
    let names: Vec<&str> = names.chain(of_mazes).collect();
    let found = names.iter().find(|name| **name == text);
    found
        .map(|name| (*name).to_owned())
        .ok_or_else(|| format!("expected some of: {}", names.join(", ")))
}

/// Unseen pairs of a reproduction that does not say how many.
const PAIRS: u32 = 1000;

/// Seeds of a reproduction that does not say how many.
const SEEDS: u32 = 20;

/// Reproduces.
///
/// # Errors
///
/// Anything wrong with the options or the folder; a signal, after the runs that are done are kept.
pub fn run(args: &ReproduceArgs, stop: &StopFlag, output: &mut Output) -> Result<(), Failure> {
    let todo = match &args.resume {
        Some(path) => resume(path, args.seeds)?,
        None if args.scene.courses().is_empty() => begin(args)?,
        None => Todo::Mazes(Mazes::begin(args)?),
    };
    let cores = || available_parallelism().map_or(1, usize::from);
    let threads = args.threads.number().unwrap_or_else(cores);
    let go_on = format!("{} reproduce --resume {}", this_program(), in_shell(todo.folder().path()));
    let done = match &todo {
        Todo::Scenes(folder, plan, setups) => {
            trials::all(folder, plan, setups, threads, stop, output)
                .and_then(|trials| finish::finish(folder, plan, setups, &trials, output))
        }
        Todo::Mazes(mazes) => mazes.go(threads, stop, output),
    };
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

/// What is to be done, and where.
enum Todo {
    Scenes(RunFolder, Plan, Vec<Setup>),
    Mazes(Mazes),
}

impl Todo {
    fn folder(&self) -> &RunFolder {
        match self {
            Self::Scenes(folder, ..) => folder,
            Self::Mazes(mazes) => mazes.folder(),
        }
    }
}

fn begin(args: &ReproduceArgs) -> Result<Todo, Failure> {
    let of_scenes = |name: &String| method::by_name(name).is_some();
    if let Some(name) = args.methods.iter().flatten().find(|name| !of_scenes(name)) {
        let names: Vec<&str> = method::all().iter().map(|method| method.name).collect();
        return Err(Failure::bad_input(format!(
            "--methods: found `{name}`, which is for mazes; expected some of: {}",
            names.join(", ")
        )));
    }
    let chosen = |method: &Method| {
        method.name == method::PAPER.name
            || args.methods.as_ref().map_or(method.preset == Preset::Paper, |names| {
                names.iter().any(|name| name == method.name)
            })
    };
    let methods = method::all().into_iter().filter(chosen);
    let plan = Plan {
        evosteer: env!("CARGO_PKG_VERSION").to_owned(),
        scenes: args.scene.scenes(),
        methods: methods.map(|method| method.name.to_owned()).collect(),
        seed: args.seed.0,
        seeds: args.seeds.unwrap_or(SEEDS),
        pairs: args.pairs.unwrap_or(PAIRS),
        generations: args.generations,
        population: args.population,
    };
    enough_seeds_after(plan.seed, plan.seeds)?;
    // Everything that can be refused is, before a folder exists.
    let setups = plan.setups()?;
    let path = args.out.clone().unwrap_or_else(|| args.scene.folder());
    let folder = RunFolder::create(&path)?;
    plan.write(&folder)?;
    Ok(Todo::Scenes(folder, plan, setups))
}

fn resume(path: &Path, seeds: Option<u32>) -> Result<Todo, Failure> {
    let folder = RunFolder::resume_reproduction(path)?;
    Trial::remove_strays(&folder)?;
    let folder = match Mazes::resume(folder, seeds)? {
        Ok(mazes) => return Ok(Todo::Mazes(mazes)),
        Err(folder) => folder,
    };
    let mut plan = Plan::read(&folder)?;
    if let Some(seeds) = seeds
        && seeds != plan.seeds
    {
        if seeds < plan.seeds {
            return Err(fewer_seeds(path, plan.seeds));
        }
        plan.seeds = seeds;
        enough_seeds_after(plan.seed, plan.seeds)?;
        plan.write(&folder)?;
    }
    let setups = plan.setups()?;
    Ok(Todo::Scenes(folder, plan, setups))
}

/// Refuses fewer seeds than are done.
fn fewer_seeds(path: &Path, seeds: u32) -> Failure {
    Failure::bad_input(format!(
        "--seeds: the reproduction in {} has {}; expected as many or more",
        path.display(),
        counted(seeds, "seed")
    ))
}

/// Refuses seeds past the last one there is.
fn enough_seeds_after(first: u64, seeds: u32) -> Result<(), Failure> {
    if first.checked_add(u64::from(seeds)).is_some() {
        return Ok(());
    }
    Err(Failure::bad_input(format!(
        "--seed: {} after {} go past the largest seed; expected a smaller first one",
        counted(seeds, "seed"),
        first
    )))
}

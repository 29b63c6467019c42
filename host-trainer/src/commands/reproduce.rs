//! `evosteer reproduce`: the paper's experiments over many seeds, beside the paper.

mod finish;
mod trials;

use super::advice::{counted, in_shell, this_program};
use super::number::whole;
use super::threads::Threads;
use crate::failure::{Failure, FailureKind};
use crate::output::Output;
use crate::reproduce::{PaperScene, Plan, Setup, Trial, method};
use crate::run_folder::RunFolder;
use crate::scenario::TrainingSpec;
use crate::seed::RunSeed;
use crate::signals::StopFlag;
use clap::ValueEnum;
use std::path::{Path, PathBuf};
use std::thread::available_parallelism;

/// Does the paper's experiments over many seeds, beside the paper's figures
///
/// Trains the paper's method in its scenes with its populations and generations, and what the paper
/// advises (more neurons, recurrent links, more generations), on the same seeds; judges every
/// champion on pairs it has never seen. Writes a folder with report.html, plots, results.csv and
/// results.json. Ctrl-C keeps the runs that are done; --resume goes on.
#[derive(Clone, Debug, clap::Args)]
pub struct ReproduceArgs {
    /// Which of the paper's scenes
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

    /// How many seeds; 20 if not given
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

    /// Unseen pairs that each champion is judged on
    #[arg(
        long,
        value_name = "N",
        default_value_t = 1000,
        value_parser = whole(1..=1_000_000_u32),
        allow_negative_numbers = true
    )]
    pairs: u32,

    /// Methods to try beside the paper's, separated by commas; all if not given, `paper` for none
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = parse_method)]
    methods: Option<Vec<String>>,

    /// Generations, instead of the paper's
    #[arg(
        long,
        value_name = "N",
        value_parser = whole(TrainingSpec::GENERATIONS),
        allow_negative_numbers = true
    )]
    generations: Option<u32>,

    /// Individuals per generation, instead of the paper's
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

/// The paper's scenes, one or all.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Which {
    /// Without obstacles (Fig. 3)
    Open,
    /// With five boxes (Fig. 4 to 6)
    Obstacles,
    /// The hardest one (Fig. 7 and 8)
    Complex,
    /// All of them
    All,
}

impl Which {
    fn scenes(self) -> Vec<PaperScene> {
        match self {
            Self::Open => vec![PaperScene::Open],
            Self::Obstacles => vec![PaperScene::Obstacles],
            Self::Complex => vec![PaperScene::Complex],
            Self::All => PaperScene::ALL.to_vec(),
        }
    }

    fn folder(self) -> PathBuf {
        let name = match self.scenes()[..] {
            [scene] => scene.name(),
            _ => "all",
        };
        Path::new("runs").join(format!("reproduce-{name}"))
    }
}

fn parse_method(text: &str) -> Result<String, String> {
    let names: Vec<&str> = method::all().iter().map(|method| method.name).collect();
    let found = names.iter().find(|name| **name == text);
    found
        .map(|name| (*name).to_owned())
        .ok_or_else(|| format!("expected some of: {}", names.join(", ")))
}

/// Seeds of a reproduction that does not say how many.
const SEEDS: u32 = 20;

/// Reproduces.
///
/// # Errors
///
/// Anything wrong with the options or the folder; a signal, after the runs that are done are kept.
pub fn run(args: &ReproduceArgs, stop: &StopFlag, output: &mut Output) -> Result<(), Failure> {
    let (folder, plan, setups) = match &args.resume {
        Some(path) => resume(path, args.seeds)?,
        None => begin(args)?,
    };
    let cores = || available_parallelism().map_or(1, usize::from);
    let threads = args.threads.number().unwrap_or_else(cores);
    let go_on = format!("{} reproduce --resume {}", this_program(), in_shell(folder.path()));
    let done = trials::all(&folder, &plan, &setups, threads, stop, output)
        .and_then(|trials| finish::finish(&folder, &plan, &setups, &trials, output));
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

fn begin(args: &ReproduceArgs) -> Result<(RunFolder, Plan, Vec<Setup>), Failure> {
    let chosen = |name: &str| {
        name == method::PAPER.name
            || args.methods.as_ref().is_none_or(|names| names.iter().any(|n| n == name))
    };
    let methods = method::all().into_iter().map(|method| method.name.to_owned());
    let plan = Plan {
        evosteer: env!("CARGO_PKG_VERSION").to_owned(),
        scenes: args.scene.scenes(),
        methods: methods.filter(|name| chosen(name)).collect(),
        seed: args.seed.0,
        seeds: args.seeds.unwrap_or(SEEDS),
        pairs: args.pairs,
        generations: args.generations,
        population: args.population,
    };
    enough_seeds(&plan)?;
    // Everything that can be refused is, before a folder exists.
    let setups = plan.setups()?;
    let path = args.out.clone().unwrap_or_else(|| args.scene.folder());
    let folder = RunFolder::create(&path)?;
    plan.write(&folder)?;
    Ok((folder, plan, setups))
}

fn resume(path: &Path, seeds: Option<u32>) -> Result<(RunFolder, Plan, Vec<Setup>), Failure> {
    let folder = RunFolder::resume_reproduction(path)?;
    Trial::remove_strays(&folder)?;
    let mut plan = Plan::read(&folder)?;
    if let Some(seeds) = seeds
        && seeds != plan.seeds
    {
        if seeds < plan.seeds {
            return Err(Failure::bad_input(format!(
                "--seeds: the reproduction in {} has {}; expected as many or more",
                path.display(),
                counted(plan.seeds, "seed")
            )));
        }
        plan.seeds = seeds;
        enough_seeds(&plan)?;
        plan.write(&folder)?;
    }
    let setups = plan.setups()?;
    Ok((folder, plan, setups))
}

/// Refuses seeds past the last one there is.
fn enough_seeds(plan: &Plan) -> Result<(), Failure> {
    if plan.seed.checked_add(u64::from(plan.seeds)).is_some() {
        return Ok(());
    }
    Err(Failure::bad_input(format!(
        "--seed: {} after {} go past the largest seed; expected a smaller first one",
        counted(plan.seeds, "seed"),
        plan.seed
    )))
}

//! From what was typed to a problem that is known to make sense.

use super::advice::in_shell;
use crate::blob_file::BlobFile;
use crate::failure::Failure;
use crate::output::Output;
use crate::pairs::NoPair;
use crate::problem::{Problem, Replaced, adopt_car};
use crate::run_folder::{Manifest, RunFolder};
use crate::scenario::{
    self, Complaint, Pair, PairSource, PairSpec, Preset, Scenario, Setting, Source,
};
use crate::seed::RunSeed;
use crate::training::too_large;
use std::path::Path;

/// Options that every command with a scenario has.
#[derive(Clone, Debug, Default, clap::Args)]
pub(super) struct ScenarioOptions {
    /// `paper` changes nothing; `robust` replaces how the scenario learns; `refine` goes on from a
    /// champion; `generalist` learns in random worlds; `novelty` finds the way through a maze
    #[arg(long, value_name = "NAME", value_parser = parse_preset)]
    pub(super) preset: Option<Preset>,

    /// Any key of a scenario file, such as `--set episode.step_limit=400`; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    pub(super) set: Vec<String>,
}

fn parse_preset(text: &str) -> Result<Preset, String> {
    let names = Preset::ALL.map(Preset::name);
    let found = Preset::ALL.into_iter().find(|preset| preset.name() == text);
    found.ok_or_else(|| format!("expected one of: {}", names.join(", ")))
}

impl ScenarioOptions {
    /// The `--set` options as settings.
    pub(super) fn settings(&self) -> Vec<Setting> {
        self.set.iter().map(|text| Setting::set(text)).collect()
    }
}

/// Which start/goal pairs a champion drives.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct WhichPairs {
    /// Drive the scenario's own listed pairs instead of drawn ones
    #[arg(long, conflicts_with = "pairs")]
    pub(super) listed: bool,
}

impl WhichPairs {
    /// The listed pairs, or `count` pairs that no training has seen.
    ///
    /// # Errors
    ///
    /// A scenario without listed pairs, or a world in which no pair is found.
    pub(super) fn pairs(
        &self,
        problem: &Problem,
        typed: &str,
        options: &ScenarioOptions,
        count: u32,
        seed: RunSeed,
    ) -> Result<Vec<Pair>, Failure> {
        let name = &problem.scenario.name;
        match &problem.scenario.pairs.source {
            PairSource::Listed(pairs) if self.listed => Ok(pairs.clone()),
            PairSource::Drawn { .. } if self.listed => Err(Failure::bad_input(format!(
                "--listed: the scenario {name} lists no pairs; leave the option out to draw some"
            ))),
            _ => problem
                .sampler()
                .unseen(seed, count)
                .map_err(|none| no_pair(typed, &options.settings(), none)),
        }
    }
}

/// Shows that training and the evaluation at its end find their pairs; `typed` and `settings` are
/// those of [`problem`].
///
/// # Errors
///
/// A world in which no pair is found.
pub(super) fn can_draw(
    problem: &Problem,
    typed: &str,
    settings: &[Setting],
    seed: RunSeed,
) -> Result<(), Failure> {
    let sampler = problem.sampler();
    sampler
        .training(&problem.scenario, seed, 0)
        .and_then(|_| sampler.unseen(seed, 1))
        .map(|_| ())
        .map_err(|none| no_pair(typed, settings, none))
}

/// Refuses a world in which no pair is found, with the place of what asks for too much.
fn no_pair(typed: &str, settings: &[Setting], none: NoPair) -> Failure {
    let complaint =
        Complaint::new("pairs.min_distance_m", "no pair can be drawn", none.to_string())
            .or_at("world.target_radius_m")
            .or_at("pairs.count")
            .or_at("world")
            .help("lower `pairs.min_distance_m` or `world.target_radius_m`, or remove obstacles");
    match source(typed) {
        Ok(source) => scenario::refuse(&source, settings, &[complaint]),
        Err(failure) => failure,
    }
}

/// Finds, reads, builds and checks a scenario; `settings` win over the file.
///
/// # Errors
///
/// Everything that can be wrong with it, with its place.
pub(super) fn problem(
    name: &str,
    preset: Option<Preset>,
    settings: &[Setting],
) -> Result<Problem, Failure> {
    problem_with(name, preset, settings, |_| Ok(()))
}

/// The same with the car that a champion was trained with, and what of the scenario's car that
/// replaces.
///
/// # Errors
///
/// As [`problem`].
pub(super) fn problem_for(
    champion: &BlobFile,
    name: &str,
    options: &ScenarioOptions,
    output: &mut Output,
) -> Result<(Problem, Vec<Replaced>), Failure> {
    let mut replaced = Vec::new();
    let problem = problem_with(name, options.preset, &options.settings(), |scenario| {
        replaced = adopt_car(scenario, champion.blob().header());
        for change in &replaced {
            output.note(format_args!("driving with the champion's {change}"));
        }
        check_car(scenario, champion)
    })?;
    Ok((problem, replaced))
}

/// Refuses a car that no scenario could describe: a blob's numbers are only known to be
/// numbers, and its step may be too long for the scenario's body.
fn check_car(scenario: &Scenario, champion: &BlobFile) -> Result<(), Failure> {
    let car = Scenario {
        vehicle: scenario.vehicle.clone(),
        sensors: scenario.sensors.clone(),
        episode: scenario.episode,
        ..Preset::default().scenario()
    };
    let label = format!("the car of {}", champion.path().display());
    let source = Source::new(label, scenario::to_toml(&car), Path::new(""));
    scenario::load(&source, None, &[]).map(|_| ())
}

/// A scenario's text by what a person types: a name, a file, or a run folder.
fn source(name: &str) -> Result<Source, Failure> {
    let path = Path::new(name);
    let is_name = scenario::all_shipped().iter().any(|entry| entry.name == name);
    if is_name || !path.join(RunFolder::MANIFEST).is_file() {
        return scenario::find(name);
    }
    let manifest = Manifest::<Scenario>::read_in(path)?;
    let label = format!("the scenario of {}", path.display());
    Ok(Source::new(label, scenario::to_toml(&manifest.scenario), Path::new("")))
}

/// What to type for this scenario after the run in `folder` has finished: its name if that is
/// enough, else the folder.
pub(super) fn shortest_name(scenario: &Scenario, folder: &Path) -> String {
    let named = || {
        scenario::all_shipped().iter().find(|entry| entry.name == scenario.name)?;
        scenario::load(&scenario::find(&scenario.name).ok()?, None, &[]).ok()
    };
    // How a champion was found does not matter to who drives there.
    let Some(named) = named() else { return in_shell(folder) };
    let min_distance = named.pairs.min_distance;
    let pairs = PairSpec { min_distance, ..scenario.pairs.clone() };
    let Scenario { training, network, fitness, .. } = *scenario;
    if *scenario == (Scenario { training, network, fitness, pairs, ..named }) {
        scenario.name.clone()
    } else {
        in_shell(folder)
    }
}

fn problem_with(
    name: &str,
    preset: Option<Preset>,
    settings: &[Setting],
    adapt: impl FnOnce(&mut Scenario) -> Result<(), Failure>,
) -> Result<Problem, Failure> {
    let source = source(name)?;
    let mut scenario = scenario::load(&source, preset, settings)?;
    adapt(&mut scenario)?;
    let problem = Problem::new(scenario)?;
    let impossible = problem.world.impossibilities(&problem.scenario).into_iter();
    let complaints: Vec<Complaint> = impossible
        .map(|found| Complaint::new(found.key, "this task is impossible", found.problem))
        .chain(too_large(&problem.scenario))
        .collect();
    if complaints.is_empty() {
        Ok(problem)
    } else {
        Err(scenario::refuse(&source, settings, &complaints))
    }
}

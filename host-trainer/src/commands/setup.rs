//! From what was typed to a problem that is known to make sense.

use crate::blob_file::BlobFile;
use crate::failure::Failure;
use crate::output::Output;
use crate::pairs::PairSampler;
use crate::problem::{Problem, adopt_car};
use crate::scenario::{self, Complaint, Pair, PairSource, Preset, Setting};
use crate::seed::RunSeed;

/// Options that every command with a scenario has.
#[derive(Clone, Debug, Default, clap::Args)]
pub(super) struct ScenarioOptions {
    /// What holds where the scenario says nothing
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
        count: u32,
        seed: RunSeed,
    ) -> Result<Vec<Pair>, Failure> {
        let name = &problem.scenario.name;
        match &problem.scenario.pairs.source {
            PairSource::Listed(pairs) if self.listed => Ok(pairs.clone()),
            PairSource::Drawn { .. } if self.listed => Err(Failure::bad_input(format!(
                "--listed: the scenario {name} lists no pairs; leave the option out to draw some"
            ))),
            _ => PairSampler::new(&problem.world, &problem.scenario)
                .unseen(seed, count)
                .map_err(|error| Failure::bad_input(format!("{name}: {error}"))),
        }
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
    problem_with(name, preset, settings, |_| ())
}

/// The same with the car that a champion was trained with.
///
/// # Errors
///
/// As [`problem`].
pub(super) fn problem_for(
    champion: &BlobFile,
    name: &str,
    options: &ScenarioOptions,
    output: &mut Output,
) -> Result<Problem, Failure> {
    let mut changes = Vec::new();
    let problem = problem_with(name, options.preset, &options.settings(), |scenario| {
        changes = adopt_car(scenario, champion.blob().header());
    })?;
    for change in changes {
        output.status(format_args!("note: the champion's own {change}"));
    }
    Ok(problem)
}

fn problem_with(
    name: &str,
    preset: Option<Preset>,
    settings: &[Setting],
    adapt: impl FnOnce(&mut scenario::Scenario),
) -> Result<Problem, Failure> {
    let source = scenario::find(name)?;
    let mut scenario = scenario::load(&source, preset, settings)?;
    adapt(&mut scenario);
    let problem = Problem::new(scenario)?;
    let complaints: Vec<Complaint> = problem
        .world
        .impossibilities(&problem.scenario)
        .into_iter()
        .map(|found| Complaint::new(found.key, "this task is impossible", found.problem))
        .collect();
    if complaints.is_empty() {
        Ok(problem)
    } else {
        Err(scenario::refuse(&source, settings, &complaints))
    }
}

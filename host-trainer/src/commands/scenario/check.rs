//! `evosteer scenario check`: is it sound, and what is it?

use super::super::setup::{ScenarioOptions, problem};
use super::summary::Summary;
use crate::failure::Failure;
use crate::output::Output;
use crate::pairs::{NoPair, PairSampler};
use crate::problem::Problem;
use crate::scenario::{self, Complaint, Setting};
use crate::seed::RunSeed;

/// Checks a scenario and says what it is
///
/// Everything that `train` and `evaluate` would refuse is refused: settings, geometry, the map,
/// listed pairs that cannot be driven, and a world in which no pair can be drawn.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct CheckArgs {
    /// A scenario: the name of a shipped one, or a file
    scenario: String,

    #[command(flatten)]
    options: ScenarioOptions,

    /// Print the result as one JSON object
    #[arg(long)]
    pub(super) json: bool,
}

/// Checks a scenario.
///
/// # Errors
///
/// Everything that is wrong with it, with its place.
pub(super) fn run(args: &CheckArgs, output: &mut Output) -> Result<(), Failure> {
    let settings = args.options.settings();
    let problem = problem(&args.scenario, args.options.preset, &settings)?;
    can_draw(&problem, RunSeed(1)).map_err(|none| refusal(&args.scenario, &settings, none))?;
    let summary = Summary::of(&problem);
    summary.print(output);
    output.json(&summary);
    Ok(())
}

/// Shows that training and evaluation find their pairs.
fn can_draw(problem: &Problem, seed: RunSeed) -> Result<(), NoPair> {
    let sampler = PairSampler::new(&problem.world, &problem.scenario);
    sampler.training(&problem.scenario, seed, 0)?;
    sampler.unseen(seed, 1)?;
    Ok(())
}

fn refusal(name: &str, settings: &[Setting], none: NoPair) -> Failure {
    let complaint =
        Complaint::new("pairs.min_distance_m", "no pair can be drawn", none.to_string())
            .or_at("world.target_radius_m")
            .or_at("pairs.count")
            .or_at("world")
            .help("lower `pairs.min_distance_m` or `world.target_radius_m`, or remove obstacles");
    match scenario::find(name) {
        Ok(source) => scenario::refuse(&source, settings, &[complaint]),
        Err(failure) => failure,
    }
}

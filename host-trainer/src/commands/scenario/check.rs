//! `evosteer scenario check`: is it sound, and what is it?

use super::super::setup::{ScenarioOptions, can_draw, problem};
use super::summary::Summary;
use crate::failure::Failure;
use crate::output::Output;
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
    can_draw(&problem, &args.scenario, &settings, RunSeed(1))?;
    let summary = Summary::of(&problem);
    summary.print(output);
    output.json(&summary);
    Ok(())
}

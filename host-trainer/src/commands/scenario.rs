//! `evosteer scenario`: list, check, draw, import and generate what controllers are trained on.

mod check;
mod drawing;
mod generate;
mod import;
mod list;
mod show;
mod summary;
#[cfg(test)]
mod tests;
mod written;

use crate::failure::Failure;
use crate::output::Output;

/// Lists, checks, draws, imports and generates scenarios
#[derive(Clone, Debug, clap::Args)]
pub struct ScenarioArgs {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Clone, Debug, clap::Subcommand)]
enum Verb {
    List(list::ListArgs),
    Check(check::CheckArgs),
    Show(show::ShowArgs),
    Import(import::ImportArgs),
    Generate(generate::GenerateArgs),
}

impl ScenarioArgs {
    /// Whether the result goes to a machine.
    pub fn wants_json(&self) -> bool {
        match &self.verb {
            Verb::List(args) => args.json,
            Verb::Check(args) => args.json,
            Verb::Show(args) => args.json,
            Verb::Import(args) => args.json,
            Verb::Generate(args) => args.json,
        }
    }
}

/// Runs one of the verbs.
///
/// # Errors
///
/// A scenario, a map or options that are refused, or a file that cannot be written.
pub fn run(args: &ScenarioArgs, output: &mut Output) -> Result<(), Failure> {
    match &args.verb {
        Verb::List(args) => list::run(args, output),
        Verb::Check(args) => check::run(args, output),
        Verb::Show(args) => show::run(args, output),
        Verb::Import(args) => import::run(args, output),
        Verb::Generate(args) => generate::run(args, output),
    }
}

//! `evosteer scenario list`: the scenarios that come with the program.

use crate::failure::Failure;
use crate::output::Output;
use crate::scenario::{self, Scenario};
use serde::Serialize;

/// Lists the scenarios that come with the program, one line each
#[derive(Clone, Debug, clap::Args)]
pub(super) struct ListArgs {
    /// Print the result as one JSON object
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Debug, Serialize)]
struct Report {
    scenarios: Vec<Line>,
}

#[derive(Debug, Serialize)]
struct Line {
    name: String,
    description: String,
}

/// Lists them.
///
/// # Errors
///
/// None, as long as what is shipped loads.
pub(super) fn run(_: &ListArgs, output: &mut Output) -> Result<(), Failure> {
    let mut scenarios = Vec::new();
    for entry in scenario::all_shipped() {
        let source = scenario::find(entry.name)?;
        let Scenario { name, description, .. } = scenario::load(&source, None, &[])?;
        scenarios.push(Line { name, description });
    }
    let widest = scenarios.iter().map(|line| line.name.len()).max().unwrap_or(0);
    for Line { name, description } in &scenarios {
        output.line(format_args!("{name:<widest$}  {description}"));
    }
    output.json(&Report { scenarios });
    Ok(())
}

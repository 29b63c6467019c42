//! The command line: what was typed, and the exit code it ends in.

use crate::commands::{
    bench, demo, evaluate, export, inspect, replay, reproduce, scenario, train, verify,
};
use crate::failure::Failure;
use crate::output::Output;
use crate::signals::{self, StopFlag};
use crate::vector::Instructions;
use clap::{Parser, Subcommand};
use std::ffi::OsString;
use std::process::ExitCode;

/// Evolves a neural steering controller for a small car in a simulator, and gets it onto the car
#[derive(Debug, Parser)]
#[command(name = "evosteer", version, arg_required_else_help = true, max_term_width = 100)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Train(train::TrainArgs),
    Evaluate(evaluate::EvaluateArgs),
    Reproduce(reproduce::ReproduceArgs),
    Replay(replay::ReplayArgs),
    Demo(demo::DemoArgs),
    Scenario(scenario::ScenarioArgs),
    Export(export::ExportArgs),
    Inspect(inspect::InspectArgs),
    Verify(verify::VerifyArgs),
    Bench(bench::BenchArgs),
}

impl Command {
    fn wants_json(&self) -> bool {
        match self {
            Self::Train(args) => args.json,
            Self::Evaluate(args) => args.json,
            Self::Reproduce(args) => args.json,
            Self::Replay(args) => args.json,
            Self::Demo(args) => args.json,
            Self::Scenario(args) => args.wants_json(),
            Self::Export(args) => args.json,
            Self::Inspect(args) => args.json,
            Self::Verify(args) => args.json,
            Self::Bench(args) => args.json,
        }
    }

    fn run(&self, output: &mut Output) -> Result<(), Failure> {
        signals::survive_a_full_file()?;
        Instructions::choose()?;
        match self {
            // Only what trains has something to save when it is asked to stop.
            Self::Train(args) => train::run(args, &StopFlag::install()?, output),
            Self::Reproduce(args) => reproduce::run(args, &StopFlag::install()?, output),
            Self::Evaluate(args) => evaluate::run(args, output),
            Self::Replay(args) => replay::run(args, output),
            Self::Demo(args) => demo::run(args, output),
            Self::Scenario(args) => scenario::run(args, output),
            Self::Export(args) => export::run(args, output),
            Self::Inspect(args) => inspect::run(args, output),
            Self::Verify(args) => verify::run(args, output),
            Self::Bench(args) => bench::run(args, output),
        }
    }
}

/// Runs the command line and returns the process's exit code.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let cli = match Cli::try_parse_from(arguments) {
        Ok(cli) => cli,
        Err(error) => return refuse(&error),
    };
    let mut output = Output::new(cli.command.wants_json());
    let done = cli.command.run(&mut output);
    if let Err(failure) = &done {
        output.status(format_args!("error: {failure}"));
    }
    let said = finish(output);
    match done.and(said) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => ExitCode::from(failure.exit_code()),
    }
}

/// Says on standard error that standard output broke, if it did.
fn finish(output: Output) -> Result<(), Failure> {
    output.finish().inspect_err(|failure| {
        Output::new(false).status(format_args!("error: {failure}"));
    })
}

/// Prints help and version to standard output, refusals to standard error with exit code 2.
fn refuse(error: &clap::Error) -> ExitCode {
    let mut output = Output::new(false);
    let text = error.render();
    if error.use_stderr() {
        output.status(text.to_string().trim_end());
        return ExitCode::from(2);
    }
    output.line(text.to_string().trim_end());
    match finish(output) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => ExitCode::from(failure.exit_code()),
    }
}

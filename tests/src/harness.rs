//! A small test harness for tests that may be impossible on this machine.
//!
//! Cargo's own captures what a passing test prints, so a test left out for want of a tool would look
//! like one that passed. Here it is reported as ignored, with what is missing; where `CI` is set, nothing may
//! be left out and it fails.

use std::process::ExitCode;
use std::time::Instant;

use crate::checkout;

/// Why a test did not pass.
#[derive(Debug)]
pub enum Trouble {
    /// What it checks does not hold.
    Failed(String),
    /// It cannot run here: something is missing, and how to get it.
    NotRun(String),
}

impl From<checkout::Trouble> for Trouble {
    fn from(trouble: checkout::Trouble) -> Self {
        match trouble {
            checkout::Trouble::Missing(said) => Self::NotRun(said),
            checkout::Trouble::Failed(said) => Self::Failed(said),
        }
    }
}

/// A test: its name is the sentence that it proves.
pub type Test = (&'static str, fn() -> Result<(), Trouble>);

/// Runs the tests whose names match the command line, in order, and reports like cargo's harness.
///
/// Takes `--list`, `--exact`, `--skip NAME` and names or parts of names, and passes over the other flags of
/// cargo's harness.
pub fn main(tests: &[Test]) -> ExitCode {
    let filter = Filter::from_arguments(std::env::args().skip(1));
    if filter.list {
        for (name, _) in tests {
            println!("{name}: test");
        }
        return ExitCode::SUCCESS;
    }
    let nothing_left_out =
        std::env::var_os("CI").is_some_and(|value| value != "false" && !value.is_empty());
    let chosen: Vec<&Test> = tests.iter().filter(|(name, _)| filter.takes(name)).collect();
    let started = Instant::now();
    let (mut passed, mut ignored) = (0, 0);
    let mut failures = Vec::new();
    println!("\nrunning {} tests", chosen.len());
    for (name, test) in &chosen {
        match test() {
            Ok(()) => {
                println!("test {name} ... ok");
                passed += 1;
            }
            Err(Trouble::NotRun(why)) if !nothing_left_out => {
                println!("test {name} ... ignored, NOT RUN: {why}");
                ignored += 1;
            }
            Err(Trouble::NotRun(why)) => {
                println!("test {name} ... FAILED");
                failures.push((name, format!("NOT RUN, and CI is set: {why}")));
            }
            Err(Trouble::Failed(why)) => {
                println!("test {name} ... FAILED");
                failures.push((name, why));
            }
        }
    }
    for (name, why) in &failures {
        println!("\n---- {name} ----\n{why}");
    }
    let verdict = if failures.is_empty() { "ok" } else { "FAILED" };
    println!(
        "\ntest result: {verdict}. {passed} passed; {} failed; {ignored} ignored; 0 measured; \
         {} filtered out; finished in {:.2}s\n",
        failures.len(),
        tests.len() - chosen.len(),
        started.elapsed().as_secs_f64()
    );
    if failures.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

#[derive(Debug, Default, PartialEq, Eq)]
struct Filter {
    list: bool,
    exact: bool,
    ignored_only: bool,
    names: Vec<String>,
    skipped: Vec<String>,
}

impl Filter {
    fn from_arguments(arguments: impl Iterator<Item = String>) -> Self {
        let mut filter = Self::default();
        let mut arguments = arguments;
        while let Some(argument) = arguments.next() {
            match argument.as_str() {
                "--list" => filter.list = true,
                "--exact" => filter.exact = true,
                "--ignored" => filter.ignored_only = true,
                "--skip" => filter.skipped.extend(arguments.next()),
                "--test-threads" | "--format" | "--color" | "--logfile" | "-Z" => {
                    arguments.next();
                }
                flag if flag.starts_with('-') => {}
                name => filter.names.push(name.to_owned()),
            }
        }
        filter
    }

    fn takes(&self, name: &str) -> bool {
        let matches =
            |part: &String| if self.exact { name == part } else { name.contains(part.as_str()) };
        !self.ignored_only
            && (self.names.is_empty() || self.names.iter().any(matches))
            && !self.skipped.iter().any(matches)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filter(line: &str) -> Filter {
        Filter::from_arguments(line.split_whitespace().map(str::to_owned))
    }

    #[test]
    fn names_and_skips_choose_as_in_cargos_harness() {
        assert!(filter("").takes("a_board_replays"));
        assert!(filter("board --nocapture --test-threads 1").takes("a_board_replays"));
        assert!(!filter("board --exact").takes("a_board_replays"));
        assert!(!filter("--skip replays").takes("a_board_replays"));
        assert!(!filter("--ignored").takes("a_board_replays"));
    }
}

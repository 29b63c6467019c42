//! What `verify` says: a table for people, one object for machines.

use equivalence_tests::compare::{Difference, Drive, Tally};
use serde::Serialize;

use super::super::advice::counted;
use crate::output::Output;

/// The whole comparison.
#[derive(Debug, Serialize)]
pub(super) struct Report {
    /// Steps that each machine drove.
    steps: u64,
    /// Steps of each drive.
    steps_per_drive: u32,
    /// Drives, each with weights and a course.
    drives: usize,
    /// Weight sets among them.
    weight_sets: usize,
    /// Ways of the host that were compared with one drive at a time.
    pub(super) host: Vec<Machine>,
    /// Boards that were.
    pub(super) boards: Vec<Machine>,
    /// Bits that differ, over all machines.
    differing_bits: u64,
}

/// One machine's agreement with one drive at a time on the host.
#[derive(Debug, Serialize)]
pub(super) struct Machine {
    name: String,
    steps: u64,
    differing_bits: u64,
    /// As a sentence; null where nothing differs.
    first_difference: Option<String>,
}

impl Machine {
    pub(super) fn new(name: impl Into<String>, tally: Tally) -> Self {
        let Tally { steps, differing_bits, first } = tally;
        let first_difference = first.as_ref().map(Difference::to_string);
        Self { name: name.into(), steps, differing_bits, first_difference }
    }
}

impl Report {
    pub(super) fn new(weight_sets: usize, steps_per_drive: u32, drives: &[Drive]) -> Self {
        Self {
            steps: drives.iter().map(|drive| u64::from(drive.case.steps)).sum(),
            steps_per_drive,
            drives: drives.len(),
            weight_sets,
            host: Vec::new(),
            boards: Vec::new(),
            differing_bits: 0,
        }
    }

    /// What every machine drives.
    pub(super) fn task(&self) -> String {
        let Self { weight_sets, drives, steps_per_drive, .. } = self;
        format!(
            "{} in {} of {}",
            counted(*weight_sets as u64, "weight set"),
            counted(*drives as u64, "drive"),
            counted(*steps_per_drive, "step")
        )
    }

    /// The first difference that any machine has, and which machine it is.
    pub(super) fn first_difference(&self) -> Option<String> {
        self.machines().find_map(|machine| {
            let difference = machine.first_difference.as_ref()?;
            Some(format!("{} computes other bits: {difference}", machine.name))
        })
    }

    /// Prints table and object.
    pub(super) fn print(&mut self, output: &mut Output) {
        self.differing_bits = self.machines().map(|machine| machine.differing_bits).sum();
        output.line(format_args!("{:26} {:>10}  {:>14}", "machine", "steps", "differing bits"));
        let alone = "host, one drive at a time";
        output.line(format_args!("{alone:26} {:>10}  {:>14}", self.steps, "the reference"));
        for Machine { name, steps, differing_bits, .. } in self.machines() {
            output.line(format_args!("{name:26} {steps:>10}  {differing_bits:>14}"));
        }
        output.line(format_args!("{}: commands, outputs, hidden values, poses", self.task()));
        output.json(self);
    }

    fn machines(&self) -> impl Iterator<Item = &Machine> {
        self.host.iter().chain(&self.boards)
    }
}

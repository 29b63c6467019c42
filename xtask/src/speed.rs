//! `cargo xtask speed`: what a step costs on a Cortex-M4F, counted in QEMU and held to goals.
//!
//! The firmware's example `speed` does the counting; its counts are exact, and the same on every run of
//! one compiler's program.

mod code;
mod row;

use crate::boards;
use crate::failure::Failure;
use crate::firmware;
use crate::options::Options;
use crate::page::{self, Place};
use crate::qemu;
use crate::targets::Toolchain;
use code::Code;
use row::Row;

/// Where the table stands.
const TABLE: Place = Place { page: "docs/on-the-chip.md", command: "speed" };

/// The board whose system timer the example reads.
const BOARD: &str = "mps2-an386";

/// 2⁷ ns an instruction: the example turns ticks of the timer into instructions by this.
const CLOCK: [&str; 2] = ["--icount", "7"];

/// What a network step with the default tanh may take at most.
struct Goal {
    recurrence: &'static str,
    instructions: u32,
    /// Code and weights.
    flash: u32,
}

/// What a good compiler made of the same network with constant weights before there was this one.
const GOALS: [Goal; 2] = [
    Goal { recurrence: "feedforward", instructions: 1600, flash: 4200 },
    Goal { recurrence: "elman", instructions: 2550, flash: 6400 },
];

/// Bytes of stack that a network step may take at most.
const STACK: u32 = 200;

/// Bytes of a network's state: two layers of 12 numbers.
const STATE: u32 = 96;

/// Counts, compares with the goals and with the table in the documentation, and prints the table.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let board = boards::named(BOARD)?;
    let program = firmware::build_example(board, "speed", options)?;
    let log = qemu::log(board, &program, &CLOCK)?;
    let elf = std::fs::read(&program)
        .map_err(|error| Failure::failed(format!("{}: {error}", program.display())))?;
    let code =
        Code::of(&elf).map_err(|why| Failure::failed(format!("{}: {why}", program.display())))?;
    let rows = row::read(&log, |address| code.bytes(address))?;
    let table = row::table(&rows);
    print!("{table}");
    let missed = missed(&rows);
    if !missed.is_empty() {
        return Err(Failure::failed(missed.join("; ")));
    }
    let compiler = Toolchain::find(options.targets, board.triple)?.version_line()?;
    page::keep(&TABLE, &compiler, &table)
}

/// Every goal that is not reached, as a sentence.
fn missed(rows: &[Row]) -> Vec<String> {
    let mut missed = Vec::new();
    let mut expect = |row: &Row, what: &str, found: u32, most: u32| {
        if found > most {
            missed.push(format!("{row}: {what}: found {found}, expected at most {most}"));
        }
    };
    for goal in &GOALS {
        let Some(row) = rows.iter().find(|row| row.is_default_step_of(goal.recurrence)) else {
            return vec![format!("no count of the {} step", goal.recurrence)];
        };
        expect(row, "instructions", row.max, goal.instructions);
        expect(row, "bytes of code and weights", row.code + row.weights, goal.flash);
    }
    for row in rows.iter().filter(|row| row.is_default_step()) {
        expect(row, "instructions that depend on the inputs", row.max - row.min, 0);
        expect(row, "bytes of stack", row.stack, STACK);
        expect(row, "bytes of state", row.state, STATE);
    }
    missed
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows() -> Vec<Row> {
        ["feedforward", "self", "elman"].map(Row::of_default_step).into()
    }

    #[test]
    fn each_goal_is_missed_by_one_too_many() {
        assert_eq!(missed(&rows()), [""; 0]);
        type Spoil = fn(&mut Row);
        let spoil: [(Spoil, &str); 5] = [
            (|row| (row.min, row.max) = (2551, 2551), "instructions: found 2551"),
            (|row| row.code += 1, "bytes of code and weights: found 6401"),
            (|row| row.min -= 1, "instructions that depend on the inputs: found 1"),
            (|row| row.stack += 1, "bytes of stack: found 201"),
            (|row| row.state += 4, "bytes of state: found 100"),
        ];
        for (spoil, said) in spoil {
            let mut rows = rows();
            spoil(&mut rows[2]);
            let missed = missed(&rows);
            assert!(matches!(missed.as_slice(), [one] if one.contains(said)), "{missed:?}");
        }
    }

    #[test]
    fn a_step_that_was_not_counted_is_a_missed_goal() {
        assert_eq!(missed(&rows()[..2]), ["no count of the elman step"]);
    }
}

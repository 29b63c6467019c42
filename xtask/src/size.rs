//! `cargo xtask size`: what each board's program takes of its memory, held to bounds and to the README's table.

mod heap;
mod row;

use crate::boards;
use crate::elf;
use crate::failure::Failure;
use crate::firmware;
use crate::options::Options;
use crate::page::{self, Place};
use crate::qemu;
use crate::stack;
use crate::targets::Toolchain;
use row::Row;

/// Where the table stands.
const TABLE: Place = Place { page: "README.md", command: "size" };

/// What a run on an emulated Cortex-M says of its stack, before the number.
const USED: &str = "stack: at most ";

/// Builds every board, runs those that paint their stack, checks, and prints the table.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let mut rows = Vec::new();
    for board in boards::ALL {
        let elf = firmware::build(board, options)?;
        let log = qemu::log(board, &elf, &[])?;
        let used = used(&log);
        // Only Cortex-M boards paint their stack; one that no longer says so is not passed over.
        if used.is_none() && board.triple.starts_with("thumb") {
            return Err(Failure::failed(format!("{}: its log has no \"{USED}…\"", board.name)));
        }
        rows.push(row(board.name, &elf, used)?);
    }
    for real in boards::REAL {
        let elf = firmware::build_program(&real.program, options)?;
        rows.push(row(real.program.name, &elf, None)?);
    }
    let table = row::table(&rows);
    print!("{table}");
    let missed: Vec<String> = rows.iter().flat_map(Row::missed).collect();
    if !missed.is_empty() {
        return Err(Failure::failed(missed.join("; ")));
    }
    let compiler = Toolchain::find(options.targets, boards::ALL[0].triple)?.version_line()?;
    page::keep(&TABLE, &compiler, &table)
}

fn row(name: &'static str, program: &std::path::Path, used: Option<u32>) -> Result<Row, Failure> {
    let unreadable = |why: String| Failure::failed(format!("{}: {why}", program.display()));
    let bytes = std::fs::read(program).map_err(|error| unreadable(error.to_string()))?;
    let size = elf::size(&bytes).map_err(|why| unreadable(why.into()))?;
    let address = |name| elf::address(&bytes, name).map_err(|why| unreadable(why.into()));
    let weights = address("_weights_start")?.zip(address("_weights_end")?);
    let (graph, bound) = stack::of(program)?;
    let holds = bound.holds();
    Ok(Row {
        name,
        flash: size.flash,
        weights: weights.map_or(0, |(start, end)| end - start),
        ram: size.ram,
        bound: holds.then_some(bound.bytes),
        used,
        heap: heap::calls(&graph),
    })
}

/// The number in the log of a run; a board without the paint says none.
fn used(log: &str) -> Option<u32> {
    log.split_once(USED)?.1.split_whitespace().next()?.parse().ok()
}

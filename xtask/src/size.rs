//! `cargo xtask size`: what each board's program takes of its memory.

use crate::boards;
use crate::elf;
use crate::failure::Failure;
use crate::firmware;
use crate::options::Options;

/// Builds the boards and prints a table for the README.
pub(crate) fn run(options: &Options) -> Result<(), Failure> {
    let mut table =
        String::from("| board | flash, bytes | static RAM, bytes |\n| --- | ---: | ---: |\n");
    for board in boards::chosen(options)? {
        let program = firmware::build(board, options)?;
        let unreadable = |why: String| Failure::failed(format!("{}: {why}", program.display()));
        let bytes = std::fs::read(&program).map_err(|error| unreadable(error.to_string()))?;
        let size = elf::size(&bytes).map_err(|why| unreadable(why.to_string()))?;
        table += &format!("| {} | {} | {} |\n", board.name, size.flash, size.ram);
    }
    print!("{table}");
    Ok(())
}

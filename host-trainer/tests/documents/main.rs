//! The documents say what the program does: their commands are run, their tables compared, their
//! links followed.
//!
//! After a change that is meant, `EVOSTEER_BLESS=1 cargo test -p host-trainer --test documents`
//! writes the printed outputs and the generated tables anew; read the difference before you
//! commit it.

mod architecture;
mod champions;
mod commands;
mod console;
mod lamp;
mod links;
mod pages;
mod presets;
mod promises;
mod run_folder;
mod scenario_keys;

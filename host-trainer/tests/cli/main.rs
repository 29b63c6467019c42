//! The program as its users meet it: the built binary, its files, its words and its exit codes.

mod beginnings;
mod bench;
mod handles;
mod help;
mod interruptions;
mod machines;
mod next_steps;
mod refusals;
mod reproduce;
mod run_folders;
mod same_seed;
mod speed;
#[cfg(unix)]
mod streams;
mod verify;

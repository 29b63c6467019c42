//! Simulate, evolve, export: the host half of evosteer.

pub mod bench;
pub mod blob_file;
pub mod brain;
pub mod car;
pub mod champion;
pub mod checkpoint;
pub mod cli;
pub mod commands;
pub mod disturbances;
pub mod drivable;
pub mod episode;
pub mod evaluation;
pub mod evolve;
pub mod export;
pub mod failure;
pub mod files;
pub mod fingerprint;
pub mod fitness;
pub mod map;
pub mod output;
pub mod pairs;
pub mod picture;
pub mod problem;
pub mod report;
pub mod reproduce;
pub mod run_folder;
pub mod scenario;
pub mod seed;
pub mod signals;
pub mod stress;
pub mod training;
pub mod vector;
pub mod wide;
pub mod world;

#[cfg(test)]
mod sample_blob;
#[cfg(test)]
mod test_process;
#[cfg(test)]
mod test_tools;

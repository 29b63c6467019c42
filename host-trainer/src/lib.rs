//! Simulate, evolve, export: the host half of evosteer.

pub mod blob_file;
pub mod checkpoint;
pub mod evolve;
pub mod export;
pub mod failure;
pub mod files;
pub mod fingerprint;
pub mod map;
pub mod output;
pub mod report;
pub mod run_folder;
pub mod scenario;
pub mod seed;
pub mod signals;

#[cfg(test)]
mod sample_blob;
#[cfg(test)]
mod test_process;
#[cfg(test)]
mod test_tools;

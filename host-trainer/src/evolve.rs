//! The search: knows genomes and costs, never drives.

pub mod ga;

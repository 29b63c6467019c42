//! Simulate, evolve, export: the host half of evosteer.

pub mod failure;

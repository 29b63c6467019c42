//! The paper's genetic algorithm.

mod settings;

pub use settings::{GaSpec, Mutation, Selection, SettingError};

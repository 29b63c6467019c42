//! The verbs of `evosteer`, one module each: its options and what it does.

mod blob_summary;
pub mod export;
pub mod inspect;

//! The verbs of `evosteer`, one module each: its options and what it does.

mod advice;
pub mod bench;
mod blob_summary;
pub mod demo;
pub mod evaluate;
pub mod export;
mod film;
pub mod inspect;
mod number;
pub mod replay;
pub mod reproduce;
pub mod scenario;
mod setup;
mod threads;
pub mod train;
pub mod verify;

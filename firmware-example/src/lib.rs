//! The driving program of a car-like robot, and the boards it runs on.
//!
//! Everything that decides is in the library, builds without the standard library and is tested on the host;
//! a board's binary under `src/bin` is wiring only.
#![cfg_attr(not(test), no_std)]

#[cfg(all(target_os = "none", feature = "emulated"))]
pub mod emulated;

//! The driving program of a car-like robot, and the boards it runs on.
//!
//! Everything that decides is in the library, builds without the standard library and is tested on the
//! host; a board's binary under `src/bin` is wiring only.
//!
//! | look in | for |
//! | --- | --- |
//! | [`app`] | the program that drives a car |
//! | [`drivers`] | its hardware over `embedded-hal` traits |
//! | [`hardware`] | the types of one car's parts |
//! | [`chassis`], [`fan`] | the car as the control loop sees it; filtered range readings |
//! | [`weights`], [`fit`] | the blob in flash, and whether it was trained for this car |
//! | `weights_region` (on a board only) | where that blob lies |
//! | [`calibration`] | pulses, limits and beam mounts of one car |
//! | [`arming`], [`indicator`], [`journal`] | the button, the lamp, the log |
//! | [`odometry`] | where the car believes it is, for the log |
//! | [`clock`] | time, and the watchdog |
//! | [`brain`] | a controller for whichever network and tanh a blob names, open to inspection |
//! | [`closed_loop`] | driving through a room with the weights in flash, as a digest |
//! | [`proof`] | this program as a machine whose every value is compared with the host's |
//! | [`replay`] | running recorded drives again and comparing bits |
//! | [`recorded`] | the drives that every emulated board replays |
//! | `pico2` (on that board only) | its calibration, clock, watchdog, log, and how it fails |
//! | `emulated` (on a board only) | how such a board logs, panics and ends |
#![cfg_attr(not(test), no_std)]

pub mod app;
pub mod arming;
pub mod brain;
pub mod calibration;
pub mod chassis;
pub mod clock;
pub mod closed_loop;
pub mod drivers;
#[cfg(all(target_os = "none", feature = "emulated"))]
pub mod emulated;
#[cfg(all(
    target_os = "none",
    feature = "cortex-m",
    any(feature = "emulated", feature = "board-pico2")
))]
mod exceptions;
pub mod fan;
mod figures;
pub mod fit;
pub mod hardware;
pub mod indicator;
pub mod journal;
#[cfg(all(target_os = "none", any(feature = "emulated", feature = "board-pico2")))]
mod last_words;
pub mod odometry;
#[cfg(all(target_os = "none", feature = "board-pico2"))]
pub mod pico2;
pub mod proof;
pub mod recorded;
pub mod replay;
#[cfg(any(feature = "sabotage-reordered-sum", feature = "sabotage-fused-sum"))]
mod sabotage;
pub mod weights;
#[cfg(target_os = "none")]
pub mod weights_region;

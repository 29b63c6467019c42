//! The same drives on host and chip, compared bit by bit.
//!
//! What a board needs builds without the standard library; the rest has the feature `std`.
//!
//! | look in | for |
//! | --- | --- |
//! | [`room`], [`course`] | what a closed loop drives through: walls, starts, faults of the sensors |
//! | [`closed_loop`] | one step, and every value that is compared after it |
//! | [`files`] | the cases a machine is given and the results it returns |
//! | [`prove`] | from the one file to the other: what runs on every machine |
//! | [`random`] | random numbers by place |
//! | `weight_sets` | generated weights of every kind |
//! | `on_host`, `side_by_side` | the host's answers, one drive at a time and many in lanes |
//! | `compare` | differing bits, and the first difference by its place |
//! | `checkout` | boards, built and run by `cargo xtask` |
//! | `recorded_drives`, `drive` | the recorded drives, made anew from seeds |
//! | `harness` | tests that may be impossible here and then say so |
//!
//! Everything is made of `controller-core` only, so no simulator setting can change it.
#![cfg_attr(not(any(test, feature = "std")), no_std)]

pub mod closed_loop;
pub mod course;
pub mod files;
pub mod prove;
pub mod random;
pub mod room;

#[cfg(feature = "std")]
pub mod checkout;
#[cfg(feature = "std")]
pub mod compare;
#[cfg(feature = "std")]
pub mod drive;
#[cfg(feature = "std")]
pub mod harness;
#[cfg(feature = "std")]
pub mod on_host;
#[cfg(feature = "std")]
pub mod recorded_drives;
#[cfg(feature = "std")]
pub mod side_by_side;
#[cfg(feature = "std")]
pub mod weight_sets;

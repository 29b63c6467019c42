//! The same cases on host and chip, compared bit by bit.
//!
//! | look in | for |
//! | --- | --- |
//! | [`cases`] | the recorded drives, made anew from seeds |
//! | [`drive`] | a drive from weights and a room to blob and recording |
//! | [`harness`] | tests that may be impossible here and then say so |
//!
//! The drives are recorded with `controller-core` only, so no simulator setting can change them.

pub mod cases;
pub mod drive;
pub mod harness;

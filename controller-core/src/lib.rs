//! From beam readings to a steering command, with the same bits on every machine.
//!
//! One control period takes a [`observation::Reading`], runs the network and returns a
//! [`controller::Command`]. [`control_loop::tick`] does this against anything that can
//! sense and actuate: the simulator, a recording, or a board.
//!
//! | look in | for | promise |
//! | --- | --- | --- |
//! | [`units`] | steer angle, step length | every value is safe to send to an actuator |
//! | [`observation`] | readings, and how they become seven inputs | the only place that scales |
//! | [`activation`] | tanh, in three named forms | one bound each, over every finite `f32` |
//! | [`network`] | the forward pass | one fixed order of arithmetic |
//! | [`controller`] | one decision, with the fail-safe | a bad reading stops the car at once |
//! | [`control_loop`] | one control period, with its faults | no error leaves an old command in force |
//! | [`actuator`] | servo rate and dead time | shared by simulator and car |
//! | [`blob`] | trained weights as bytes | any input decodes or is refused with a cause |
//! | [`recording`] | a drive as words | replayed anywhere, the first differing bit has a name |
//! | [`motion`], [`geometry`], [`trig`] | the kinematic bicycle, beams, contacts | shared by simulator and closed-loop proofs |
//! | [`lane`] | the number type of all arithmetic | a lane of a wide run equals the scalar run |
//!
//! Nothing here allocates, reads a clock, draws a random number or contains `unsafe`.
//!
//! # The equality contract
//!
//! All arithmetic is `f32`, made of `+ − × ÷ √`, comparisons and selections, which IEEE 754
//! defines to the last bit. Sums run from the bias upward in index order, products are never
//! fused, and no function of a host's or compiler's mathematics library is called. Results
//! are compared as bits.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(target_endian = "big")]
compile_error!(
    "weight blobs are read in place as little-endian words; big-endian machines are not supported"
);

#[cfg(all(target_arch = "x86", not(target_feature = "sse2")))]
compile_error!("x87 arithmetic rounds differently: build for a target with SSE2");

pub mod activation;
pub mod actuator;
pub mod blob;
pub mod control_loop;
pub mod controller;
pub mod geometry;
pub mod lane;
pub mod motion;
pub mod network;
pub mod observation;
pub mod recording;
mod sentences;
pub mod trig;
pub mod units;

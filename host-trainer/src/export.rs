//! A weight blob in the forms that boards and their tools take.
//!
//! | form | module | for |
//! | --- | --- | --- |
//! | `bin` | – | a debug probe, which is told the address |
//! | `hex` | [`intel_hex`] | a debug probe or a vendor's tool; holds the address |
//! | `uf2` | [`uf2`], [`family`] | a board that shows itself as a drive; holds address and chip family |
//! | `rs` | [`rust_source`] | weights that are compiled into the program |
//!
//! [`board`] is the one place that knows where on a board the weights lie and what its car can
//! do; [`placement`] refuses addresses that cannot work, and [`fit`] says what the car would
//! refuse.

pub mod board;
pub mod family;
pub mod fit;
pub mod intel_hex;
pub mod placement;
pub mod rust_source;
pub mod uf2;

//! The car's hardware over `embedded-hal` 1.0 traits.
//!
//! | look in | for |
//! | --- | --- |
//! | [`rangefinder`] | what five range sensors report, and how they fail |
//! | [`tof_array`] | five VL53L0X on one I²C bus, given their addresses one by one |
//! | [`target_beacon`] | which beams see the target's infrared beacon |
//! | [`pulse`] | pulse widths as duty cycles |
//! | [`servo`], [`motor`] | steer angle and speed as pulse widths |

pub mod motor;
mod plausible_bus;
pub mod pulse;
pub mod rangefinder;
pub mod servo;
pub mod target_beacon;
pub mod tof_array;

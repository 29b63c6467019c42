//! The pictures and pages people look at, drawn from plain data.
//!
//! Nothing here simulates or evolves: a caller fills the types in [`data`] and gets text
//! back. The same data always gives the same bytes, so a picture can be compared, and
//! nothing in it says when or where it was made unless the caller writes that in.
//!
//! | look in | for |
//! | --- | --- |
//! | [`data`] | what a report is made from |
//! | [`loops`] | whether a drive ended up repeating itself (the paper's Fig. 8) |
//! | [`plots`] | fitness and partial criteria over generations, the path of a drive |
//! | [`map`] | the world as an SVG file, to scale |
//! | [`stress`] | what each disturbance costs, over its size |
//! | [`page`] | `report.html` and `replay.html`, which open without a network |
//! | [`study`] | what a report over many runs is made from |

pub mod data;
pub mod loops;
pub mod map;
pub mod page;
pub mod plots;
pub mod stress;
pub mod study;

mod palette;
mod svg;

pub use map::{scene_svg, tasks_svg};

//! The fixed workload on this machine: how fast, and whether correct.
//!
//! 160 networks (7-12-12-1, Elman, 553 weights) drive 5 pairs of 300 steps among 36 walls. A car
//! that has crashed or arrived starts its drive again, so that every simulator makes the same
//! 240 000 steps. A paper-size run is 200 generations of that, bred from each other.
//!
//! | look in | for |
//! | --- | --- |
//! | [`workload`] | the scenario, and the population that every simulator starts from |
//! | [`golden`] | 256 single steps that another program computed in 64 bits |
//! | [`speed`] | steps per second, and the time of a paper-size run |
//! | [`mod@reference`] | the same steps with parry2d's beams and contacts |
//! | [`parts`] | beams, contacts and networks, each by itself |
//! | [`operations`] | how much arithmetic a step is |

pub mod golden;
pub mod operations;
pub mod parts;
pub mod reference;
pub mod speed;
pub mod workload;

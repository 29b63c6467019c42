//! The paper's experiments again, many seeds of each, beside what the paper says.
//!
//! A [`Method`] is a way to train. A [`Trial`] is one training by one method from one seed, looked
//! at after one or more numbers of generations: a longer run is the same run seen later. A
//! *variant* is a method after so many generations, and a row of every table.
//!
//! | look in | for |
//! | --- | --- |
//! | [`claim`] | the paper's scenes, figures and sentences, each with what stands beside it |
//! | [`method`] | the list of what is tried: the paper's method, its advice, our presets |
//! | [`plan`] | what is to be done: enough to repeat it or to go on |
//! | [`setup`] | a scene with a method, built |
//! | [`trial`], [`workers`] | one training and its judgement; many at once |
//! | [`failures`] | how drives that did not arrive ended, and the one that is shown (Fig. 8) |
//! | [`spread`] | medians, quartiles and intervals over seeds; seed against seed |
//! | [`results`], [`table`] | all numbers, as `results.json` and as `results.csv` |
//! | [`study`] | trials and numbers as the report shows them |
//! | [`maze`] | not the paper's: novelty search in mazes, beside its own literature |
//!
//! Equal plans give equal bytes, on any number of threads and across interruptions.

pub mod claim;
pub mod failures;
pub mod maze;
pub mod method;
pub mod plan;
pub mod results;
pub mod setup;
pub mod spread;
pub mod study;
pub mod table;
pub mod trial;
pub mod workers;

#[cfg(test)]
mod sample;

pub use claim::PaperScene;
pub use method::Method;
pub use plan::Plan;
pub use results::Results;
pub use setup::Setup;
pub use trial::Trial;

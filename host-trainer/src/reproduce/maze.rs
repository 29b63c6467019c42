//! The experiment of Lehman and Stanley 2011: does a search that ignores the goal find the way
//! through a maze sooner than one that goes by the distance to it?
//!
//! | look in | for |
//! | --- | --- |
//! | [`course`] | the mazes with their rules, and what the literature says of them |
//! | [`method`] | novelty, distance and chance: one search, told three things |
//! | [`plan`] | what is to be done: enough to repeat it or to go on |
//! | [`trial`] | one search from one seed, until the goal is reached or the budget is spent |
//! | [`results`] | all numbers, as `results.json` and as `results.csv` |
//! | [`study`] | trials and numbers as the report shows them |
//!
//! Equal plans give equal bytes, on any number of threads and across interruptions.

pub mod course;
pub mod method;
pub mod plan;
pub mod results;
pub mod study;
pub mod trial;

pub use course::Course;
pub use method::MazeMethod;
pub use plan::{MazePlan, MazeSetup};
pub use results::MazeResults;
pub use trial::MazeTrial;

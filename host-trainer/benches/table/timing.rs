//! Time of a piece of work, and the middle of several.

use std::time::Instant;

/// Nanoseconds for each of `count` pieces of work.
pub(crate) fn nanoseconds(count: usize, work: impl FnOnce()) -> f64 {
    let begun = Instant::now();
    work();
    begun.elapsed().as_secs_f64() * 1e9 / count.max(1) as f64
}

/// The time in the middle.
pub(crate) fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

//! The option `--threads`.

use super::number::whole;
use crate::failure::Failure;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// How many threads a command works with.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct Threads {
    /// Threads to work with; all cores if not given
    #[arg(
        long,
        value_name = "N",
        value_parser = whole(1..=1024_u16),
        allow_negative_numbers = true
    )]
    threads: Option<u16>,
}

impl Threads {
    /// The number, if one was given.
    pub(super) fn number(&self) -> Option<usize> {
        self.threads.map(usize::from)
    }

    /// A pool of so many threads.
    ///
    /// # Errors
    ///
    /// Threads that the system refuses.
    pub(super) fn pool(&self) -> Result<ThreadPool, Failure> {
        ThreadPoolBuilder::new()
            .num_threads(self.number().unwrap_or(0))
            .build()
            .map_err(|error| Failure::bad_input(format!("--threads: {error}")))
    }
}

//! How a run went, generation by generation, as CSV.

use std::fmt::{self, Write as _};
use std::fs::{self, File};
use std::io::{ErrorKind, Write as _};

use serde::{Deserialize, Serialize};

use super::RunFolder;
use crate::failure::Failure;

/// One generation: fitness of the population, and the best individual's criteria.
///
/// The criteria are the terms of the paper's equation 3 without their weights, summed over
/// the start/goal pairs; its Fig. 6 shows them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MetricsRow {
    /// From 0.
    pub generation: u32,
    /// Smallest fitness; fitness is minimised.
    pub best: f64,
    /// Mean fitness of the population.
    pub mean: f64,
    /// Largest fitness.
    pub worst: f64,
    /// Collisions of the best individual.
    pub collisions: u64,
    /// Distance to the target at the end of the drive, metres.
    pub distance_to_target: f64,
    /// Pairs whose target was reached, so bonuses earned.
    pub bonus: u32,
    /// Metres driven.
    pub path_length: f64,
    /// Share of the pairs reached by the best individual, 0 to 1.
    pub reached: f64,
    /// Share of the pairs it reached without one collision, 0 to 1.
    pub clean: f64,
    /// Share of the pairs reached, over the whole population, 0 to 1.
    pub population_reached: f64,
    /// Control steps simulated in this generation, all individuals and pairs.
    pub live_steps: u64,
}

impl MetricsRow {
    /// First line of `metrics.csv`.
    pub const HEADER: &'static str = "generation,best,mean,worst,collisions,distance_to_target,\
         bonus,path_length,reached,clean,population_reached,live_steps";
}

/// A line of `metrics.csv`. Numbers are the shortest that read back as the same bits.
impl fmt::Display for MetricsRow {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            generation,
            best,
            mean,
            worst,
            collisions,
            distance_to_target,
            bonus,
            path_length,
            reached,
            clean,
            population_reached,
            live_steps,
        } = self;
        write!(
            f,
            "{generation},{best},{mean},{worst},{collisions},{distance_to_target},\
             {bonus},{path_length},{reached},{clean},{population_reached},{live_steps}"
        )
    }
}

/// `metrics.csv`, the same bytes for the same seed, and `timing.csv`, which is not.
#[derive(Debug)]
pub struct Metrics {
    metrics: Table,
    timing: Table,
}

impl Metrics {
    /// First line of `timing.csv`.
    pub const TIMING_HEADER: &'static str = "generation,steps_per_second";

    /// Begins both files with the rows of the generations done so far (none in a new run).
    ///
    /// On resume `history` comes from the checkpoint: rows that a killed process wrote past
    /// it, or wrote half, are gone and will be written again.
    ///
    /// # Errors
    ///
    /// Input/output, naming the file.
    pub fn start(folder: &RunFolder, history: &[MetricsRow]) -> Result<Self, Failure> {
        let mut metrics = format!("{}\n", MetricsRow::HEADER);
        for row in history {
            let _ = writeln!(metrics, "{row}");
        }
        let mut timing = format!("{}\n", Self::TIMING_HEADER);
        let done = history.last().map(|row| row.generation);
        for line in kept_timing(folder, done)? {
            let _ = writeln!(timing, "{line}");
        }
        Ok(Self {
            metrics: Table::start(folder, RunFolder::METRICS, &metrics)?,
            timing: Table::start(folder, RunFolder::TIMING, &timing)?,
        })
    }

    /// Adds a generation: simulated control steps per second of wall clock go to
    /// `timing.csv`, all else to `metrics.csv`.
    ///
    /// # Errors
    ///
    /// Input/output, naming the file.
    pub fn append(&mut self, row: &MetricsRow, steps_per_second: f64) -> Result<(), Failure> {
        self.metrics.append(&format!("{row}\n"))?;
        self.timing.append(&format!("{},{steps_per_second:.0}\n", row.generation))
    }

    /// Makes everything appended so far survive a power cut.
    ///
    /// # Errors
    ///
    /// Input/output, naming the file.
    pub fn sync(&self) -> Result<(), Failure> {
        self.metrics.sync()?;
        self.timing.sync()
    }
}

/// Whole lines of `timing.csv` up to and with generation `done`.
fn kept_timing(folder: &RunFolder, done: Option<u32>) -> Result<Vec<String>, Failure> {
    let Some(done) = done else { return Ok(Vec::new()) };
    let path = folder.join(RunFolder::TIMING);
    let bytes = match fs::read(&path) {
        Ok(bytes) => bytes,
        Err(cause) if cause.kind() == ErrorKind::NotFound => return Ok(Vec::new()),
        Err(cause) => return Err(Failure::io("read", &path, &cause)),
    };
    let text = String::from_utf8_lossy(&bytes);
    let is_kept = |line: &&str| {
        line.split_once(',').is_some_and(|(generation, speed)| {
            generation.parse::<u32>().is_ok_and(|generation| generation <= done)
                && speed.strip_suffix('\n').is_some_and(|speed| speed.parse::<f64>().is_ok())
        })
    };
    Ok(text.split_inclusive('\n').filter(is_kept).map(|line| line.trim_end().to_owned()).collect())
}

/// A text file that grows by whole lines.
#[derive(Debug)]
struct Table {
    path: std::path::PathBuf,
    file: File,
}

impl Table {
    fn start(folder: &RunFolder, name: &str, text: &str) -> Result<Self, Failure> {
        folder.write(name, text.as_bytes())?;
        let path = folder.join(name);
        let file = File::options()
            .append(true)
            .open(&path)
            .map_err(|cause| Failure::io("open", &path, &cause))?;
        Ok(Self { path, file })
    }

    fn append(&mut self, line: &str) -> Result<(), Failure> {
        // One write call, so that a reader such as `tail -f` sees whole lines.
        self.file
            .write_all(line.as_bytes())
            .map_err(|cause| Failure::io("write", &self.path, &cause))
    }

    fn sync(&self) -> Result<(), Failure> {
        self.file.sync_all().map_err(|cause| Failure::io("write", &self.path, &cause))
    }
}

#[cfg(test)]
mod tests;

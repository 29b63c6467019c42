//! How far training is: a bar on a terminal, a line now and then elsewhere.

use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::Output;
use crate::run_folder::MetricsRow;

/// Shows each generation as it is done, on standard error.
#[derive(Debug)]
pub struct Progress {
    total: u32,
    display: Display,
}

#[derive(Debug)]
enum Display {
    Bar(ProgressBar),
    Lines { last: Option<Instant> },
}

impl Progress {
    /// Longest time between two plain lines while generations are being done.
    const INTERVAL: Duration = Duration::from_secs(5);

    /// Begins at generation `done` (0 in a new run) of `total`.
    pub fn start(done: u32, total: u32) -> Self {
        let display = if Output::is_interactive() {
            let bar =
                ProgressBar::with_draw_target(Some(u64::from(total)), ProgressDrawTarget::stderr());
            // wide_msg is cut to the terminal's width; a line that wraps would tear.
            let style = ProgressStyle::with_template("{bar:16} {pos}/{len} eta {eta}  {wide_msg}");
            bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
            bar.set_position(u64::from(done));
            bar.reset_eta();
            Display::Bar(bar)
        } else {
            Display::Lines { last: None }
        };
        Self { total, display }
    }

    /// Shows a generation that is done.
    ///
    /// Plain lines come for the first and the last generation, for every tenth part of the
    /// run, and otherwise every five seconds.
    pub fn update(&mut self, output: &mut Output, row: &MetricsRow, steps_per_second: f64) {
        let done = row.generation.saturating_add(1);
        match &mut self.display {
            Display::Bar(bar) => {
                bar.set_message(brief(row, steps_per_second));
                bar.set_position(u64::from(done));
            }
            Display::Lines { last } => {
                let part = (self.total / 10).max(1);
                let due = last.is_none_or(|last| last.elapsed() >= Self::INTERVAL)
                    || done.is_multiple_of(part)
                    || done == self.total;
                if due {
                    *last = Some(Instant::now());
                    let summary = summary(row, steps_per_second);
                    output.status(format_args!("generation {done}/{}  {summary}", self.total));
                }
            }
        }
    }

    /// Prints through `say` without tearing the bar.
    pub fn with_output(&self, output: &mut Output, say: impl FnOnce(&mut Output)) {
        match &self.display {
            Display::Bar(bar) => bar.suspend(|| say(output)),
            Display::Lines { .. } => say(output),
        }
    }

    /// Takes the bar away; its last state stays on the screen.
    pub fn finish(self) {
        if let Display::Bar(bar) = self.display {
            bar.abandon();
        }
    }
}

/// One generation in a line of a log.
fn summary(row: &MetricsRow, steps_per_second: f64) -> String {
    format!("mean {:.1}  {}", row.mean, brief(row, steps_per_second))
}

/// One generation beside a bar, where 80 columns are all there is.
fn brief(row: &MetricsRow, steps_per_second: f64) -> String {
    format!(
        "best {:.1}  reached {:.0} %  {} steps/s",
        row.best,
        100.0 * row.reached,
        with_prefix(steps_per_second)
    )
}

/// Three digits and a prefix: 1234567 becomes `1.23 M`.
fn with_prefix(number: f64) -> String {
    let (scaled, prefix) = match number {
        n if n >= 999.5e6 => (n / 1e9, " G"),
        n if n >= 999.5e3 => (n / 1e6, " M"),
        n if n >= 999.5 => (n / 1e3, " k"),
        n => (n, ""),
    };
    let decimals = match scaled {
        s if s >= 99.95 || prefix.is_empty() => 0,
        s if s >= 9.995 => 1,
        _ => 2,
    };
    format!("{scaled:.decimals$}{prefix}")
}

#[cfg(test)]
mod tests;

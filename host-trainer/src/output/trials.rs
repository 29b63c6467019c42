//! How far many trials are: a bar on a terminal, a line now and then elsewhere.

use std::fmt::Display;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use super::Output;

/// Shows trials as they are done, on standard error, with the time that is left.
#[derive(Debug)]
pub struct TrialProgress {
    trials: u64,
    done: u64,
    work: u64,
    worked: u64,
    begun: Instant,
    last: Option<Instant>,
    bar: Option<ProgressBar>,
}

impl TrialProgress {
    /// Longest time between two plain lines while trials are being done.
    const INTERVAL: Duration = Duration::from_secs(5);

    /// Begins where `done` of `trials` are done already and `work` is left, in any unit.
    pub fn start(done: u64, trials: u64, work: u64) -> Self {
        let bar = Output::is_interactive().then(|| {
            let bar = ProgressBar::with_draw_target(Some(work), ProgressDrawTarget::stderr());
            let style = ProgressStyle::with_template("{bar:16} {prefix}  {wide_msg}");
            bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
            bar
        });
        let mut progress =
            Self { trials, done, work, worked: 0, begun: Instant::now(), last: None, bar };
        progress.advance(0);
        progress
    }

    /// Some of the work is done.
    pub fn advance(&mut self, work: u64) {
        self.worked += work;
        if let Some(bar) = &self.bar {
            let left = time_left(self.begun.elapsed(), self.worked, self.work);
            bar.set_prefix(format!("{}/{}{left}", self.done, self.trials));
            bar.set_position(self.worked);
        }
    }

    /// A trial is done, as `line` says.
    ///
    /// Plain lines come for the first and the last, for every tenth part of the trials, and
    /// otherwise every five seconds.
    pub fn trial(&mut self, output: &mut Output, line: impl Display) {
        self.done += 1;
        if let Some(bar) = &self.bar {
            bar.set_message(line.to_string());
            return;
        }
        let part = (self.trials / 10).max(1);
        let due = self.last.is_none_or(|last| last.elapsed() >= Self::INTERVAL)
            || self.done.is_multiple_of(part)
            || self.done == self.trials;
        if due {
            self.last = Some(Instant::now());
            let left = time_left(self.begun.elapsed(), self.worked, self.work);
            output.status(format_args!("trial {}/{}{left}  {line}", self.done, self.trials));
        }
    }

    /// Takes the bar away; its last state stays on the screen.
    pub fn finish(self) {
        if let Some(bar) = self.bar {
            bar.abandon();
        }
    }
}

/// `, 3 min left` at the speed so far; nothing where that says nothing.
fn time_left(elapsed: Duration, worked: u64, work: u64) -> String {
    if worked == 0 || worked >= work {
        return String::new();
    }
    let seconds = elapsed.as_secs_f64() * (work - worked) as f64 / worked as f64;
    match seconds {
        s if s < 90.0 => format!(", {s:.0} s left"),
        s if s < 90.0 * 60.0 => format!(", {:.0} min left", s / 60.0),
        s => format!(", {:.1} h left", s / 3600.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::Page;

    #[test]
    fn the_time_left_is_that_of_the_speed_so_far() {
        let left = |seconds, worked| time_left(Duration::from_secs(seconds), worked, 100);
        assert_eq!(left(10, 0), "");
        assert_eq!(left(10, 20), ", 40 s left");
        assert_eq!(left(60, 10), ", 9 min left");
        assert_eq!(left(3600, 25), ", 3.0 h left");
        assert_eq!([left(9, 100), left(9, 101)], ["", ""]);
    }

    #[test]
    fn quick_trials_print_the_first_the_last_and_every_tenth_part() {
        let stderr = Page::default();
        let mut output = Output::to(false, std::io::sink(), stderr.clone());
        let mut progress = TrialProgress { bar: None, ..TrialProgress::start(0, 40, 400) };
        for number in 1..=40 {
            progress.advance(10);
            progress.trial(&mut output, format_args!("seed {number}"));
        }
        progress.finish();
        let text = stderr.text();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 11, "{lines:?}");
        assert!(lines[0].starts_with("trial 1/40, 0 s left  seed 1"), "{}", lines[0]);
        assert_eq!(lines[10], "trial 40/40  seed 40");
    }
}

//! Adds up what the test programs report.

use std::time::Duration;

/// Sums of cargo test's `test result:` lines.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Tally {
    passed: u64,
    failed: u64,
    ignored: u64,
    measured: u64,
    filtered_out: u64,
}

impl Tally {
    /// Tests that passed so far.
    pub(super) fn passed(&self) -> u64 {
        self.passed
    }

    /// Takes one line of output; any other than a result line changes nothing.
    pub(super) fn read(&mut self, line: &str) {
        let Some((_, counts)) =
            line.strip_prefix("test result: ").and_then(|rest| rest.split_once(". "))
        else {
            return;
        };
        for part in counts.split("; ") {
            let Some((count, what)) = part.split_once(' ') else { continue };
            let Ok(count) = count.parse::<u64>() else { continue };
            match what {
                "passed" => self.passed += count,
                "failed" => self.failed += count,
                "ignored" => self.ignored += count,
                "measured" => self.measured += count,
                "filtered out" => self.filtered_out += count,
                _ => {}
            }
        }
    }

    /// The closing line, in the form each test program uses.
    pub(super) fn summary(&self, all_steps_passed: bool, took: Duration) -> String {
        let verdict = if all_steps_passed && self.failed == 0 { "ok" } else { "FAILED" };
        let Self { passed, failed, ignored, measured, filtered_out } = self;
        format!(
            "test result: {verdict}. {passed} passed; {failed} failed; {ignored} ignored; {measured} measured; \
             {filtered_out} filtered out; finished in {:.2}s",
            took.as_secs_f64()
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_of_several_programs_add_up_to_one_line_of_the_same_form() {
        let mut tally = Tally::default();
        for line in [
            "running 12 tests",
            "test result: ok. 11 passed; 0 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.52s",
            "test result: FAILED. 3 passed; 2 failed; 0 ignored; 0 measured; 4 filtered out; finished in 9.00s",
            "test network::tests::result: ok",
        ] {
            tally.read(line);
        }
        assert_eq!(
            tally.summary(true, Duration::from_millis(9_520)),
            "test result: FAILED. 14 passed; 2 failed; 1 ignored; 0 measured; 4 filtered out; finished in 9.52s"
        );
    }

    #[test]
    fn a_failed_step_fails_the_summary_though_no_test_failed() {
        let mut tally = Tally::default();
        tally.read("test result: ok. 1 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.00s");
        assert!(
            tally
                .summary(false, Duration::ZERO)
                .starts_with("test result: FAILED. 1 passed; 0 failed")
        );
    }
}

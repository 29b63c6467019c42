//! When control periods begin, and how late they are.

use crate::clock::Micros;

/// Begins a period every so many microseconds.
#[derive(Clone, Copy, Debug)]
pub(super) struct Schedule {
    due: Micros,
    period: u64,
}

/// How late a period began.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Lateness {
    /// Microseconds, if they are a tenth of the period or more.
    pub(super) noteworthy: Option<u64>,
    /// Whole periods that nobody used before this one.
    pub(super) missed: u32,
}

impl Schedule {
    /// The first period is due at this moment; a period of 0 counts as 1.
    pub(super) fn new(due: Micros, period: u64) -> Self {
        Self { due, period: period.max(1) }
    }

    /// When the next period is due.
    pub(super) fn due(&self) -> Micros {
        self.due
    }

    /// Begins the period that is due. Small delays do not add up; after a whole missed period
    /// the rhythm starts anew, so that no periods follow each other too fast.
    pub(super) fn begin(&mut self, now: Micros) -> Lateness {
        let late = now.since(self.due);
        let missed = late.checked_div(self.period).unwrap_or(0);
        let from = if missed == 0 { self.due } else { now };
        self.due = from.after(self.period);
        Lateness {
            noteworthy: (late > 0 && late >= self.period / 10).then_some(late),
            missed: u32::try_from(missed).unwrap_or(u32::MAX),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_delays_do_not_add_up() {
        let mut schedule = Schedule::new(Micros(0), 50_000);
        for step in 0..1000 {
            let due = schedule.due();
            assert_eq!(due, Micros(50_000 * step));
            assert_eq!(schedule.begin(due.after(900)), Lateness { noteworthy: None, missed: 0 });
        }
    }

    #[test]
    fn a_tenth_of_a_period_is_noted_and_a_whole_one_is_missed() {
        let mut schedule = Schedule::new(Micros(0), 50_000);
        assert_eq!(schedule.begin(Micros(5_000)), Lateness { noteworthy: Some(5_000), missed: 0 });
        assert_eq!(
            schedule.begin(Micros(150_000)),
            Lateness { noteworthy: Some(100_000), missed: 2 }
        );
        assert_eq!(schedule.due(), Micros(200_000), "a whole period after the late one");
    }
}

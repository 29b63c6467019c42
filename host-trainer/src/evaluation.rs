//! How good is a controller where it has never been? Shares over many drives, with intervals.

use crate::episode::Outcome;
use crate::problem::{Problem, evaluation_drive};
use crate::scenario::Pair;
use crate::seed::{RunSeed, Stream};
use crate::signals::StopFlag;
use crate::vector::Instructions;
use crate::wide::Fleet;
use serde::Serialize;

/// A share of drives, with its 95 % confidence interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// Drives that count.
    pub count: u32,
    /// All drives, at least 1.
    pub of: u32,
}

impl Share {
    /// The share, 0 to 1.
    pub fn value(self) -> f64 {
        f64::from(self.count) / f64::from(self.of)
    }

    /// Wilson's score interval at 95 % (E. B. Wilson, 1927): honest for shares near 0 and 1.
    ///
    /// ```
    /// use host_trainer::evaluation::Share;
    ///
    /// let [low, high] = Share { count: 20, of: 1000 }.interval();
    /// assert_eq!(format!("{low:.4} {high:.4}"), "0.0130 0.0307");
    /// ```
    pub fn interval(self) -> [f64; 2] {
        const Z: f64 = 1.959_963_984_540_054;
        let (p, n) = (self.value(), f64::from(self.of));
        let middle = p + Z * Z / (2.0 * n);
        let spread = Z * (p * (1.0 - p) / n + Z * Z / (4.0 * n * n)).sqrt();
        let scale = 1.0 + Z * Z / n;
        [((middle - spread) / scale).max(0.0), ((middle + spread) / scale).min(1.0)]
    }
}

/// A percentage and its interval: `31.4 % (28.6 to 34.3)`.
impl std::fmt::Display for Share {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let [low, high] = self.interval().map(|bound| 100.0 * bound);
        write!(f, "{:.1} % ({low:.1} to {high:.1})", 100.0 * self.value())
    }
}

/// Drives every pair with the controller over `genome`, in parallel; drive `i` gets the random
/// numbers of `place(i)`. None if `stop` was raised meanwhile.
///
/// # Panics
///
/// If the genome is not of the problem's topology.
pub fn outcomes(
    problem: &Problem,
    genome: &[f32],
    pairs: &[Pair],
    place: impl Fn(u32) -> Stream + Sync,
    stop: &StopFlag,
) -> Option<Vec<Outcome>> {
    let fleet = Fleet { problem, genomes: genome, pairs, random: &place, again: false };
    assert_eq!(genome.len(), problem.topology().weights(), "the problem's topology");
    fleet.drive(Instructions::in_use(), stop).map(|drives| drives.outcomes)
}

/// How a controller did over many drives.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Evaluation {
    /// Drives.
    pub pairs: u32,
    /// Seed of pairs, noise and randomised cars.
    pub seed: u64,
    /// Share of drives that touched the target within the step limit.
    pub reached: f64,
    /// Its 95 % interval.
    pub reached_interval: [f64; 2],
    /// Share of drives that reached without one collision.
    pub clean: f64,
    /// Its 95 % interval.
    pub clean_interval: [f64; 2],
    /// Mean control periods of the drives that reached; none if none did.
    pub mean_steps_when_reached: Option<f64>,
    /// Mean collisions per drive.
    pub mean_collisions: f64,
    #[serde(skip)]
    shares: [Share; 2],
}

impl Evaluation {
    /// Drives every pair with the controller over `genome`, in parallel. None if `stop` was
    /// raised meanwhile.
    ///
    /// # Panics
    ///
    /// If the genome is not of the problem's topology, or there is no pair.
    pub fn of(
        problem: &Problem,
        genome: &[f32],
        pairs: &[Pair],
        seed: RunSeed,
        stop: &StopFlag,
    ) -> Option<Self> {
        let place = |index| evaluation_drive(seed, index);
        outcomes(problem, genome, pairs, place, stop).map(|outcomes| Self::summary(&outcomes, seed))
    }

    /// Counts how drives ended; there must be at least one.
    pub fn summary(outcomes: &[Outcome], seed: RunSeed) -> Self {
        let of = outcomes.len() as u32;
        let count = |counts: fn(&Outcome) -> bool| Share {
            count: outcomes.iter().filter(|outcome| counts(outcome)).count() as u32,
            of,
        };
        let (reached, clean) = (count(|outcome| outcome.reached), count(Outcome::clean));
        let (mut steps, mut collisions) = (0.0, 0.0);
        for outcome in outcomes {
            collisions += f64::from(outcome.collisions) / f64::from(of);
            if outcome.reached {
                steps += f64::from(outcome.steps) / f64::from(reached.count);
            }
        }
        Self {
            pairs: of,
            seed: seed.0,
            reached: reached.value(),
            reached_interval: reached.interval(),
            clean: clean.value(),
            clean_interval: clean.interval(),
            mean_steps_when_reached: (reached.count > 0).then_some(steps),
            mean_collisions: collisions,
            shares: [reached, clean],
        }
    }

    /// Reached, as a share.
    pub fn reached_share(&self) -> Share {
        self.shares[0]
    }

    /// Clean, as a share.
    pub fn clean_share(&self) -> Share {
        self.shares[1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected: statsmodels.stats.proportion.proportion_confint(method="wilson").
    #[test]
    fn wilson_intervals_are_the_published_ones() {
        let interval = |count, of| {
            let [low, high] = Share { count, of }.interval();
            format!("{low:.5} {high:.5}")
        };
        assert_eq!(interval(0, 10), "0.00000 0.27753");
        assert_eq!(interval(10, 10), "0.72247 1.00000");
        assert_eq!(interval(5, 10), "0.23659 0.76341");
    }

    #[test]
    fn a_drive_counts_as_clean_only_if_it_reached_without_touching_anything() {
        let outcome = |reached, collisions| Outcome {
            reached,
            collisions,
            steps: 40,
            path_length: 4.0,
            distance_to_target: 1.0,
            end: [0.0; 2],
        };
        let drives = [outcome(true, 0), outcome(true, 2), outcome(false, 0), outcome(false, 9)];
        let evaluation = Evaluation::summary(&drives, RunSeed(1));
        assert_eq!((evaluation.reached, evaluation.clean), (0.5, 0.25));
        assert_eq!(evaluation.mean_steps_when_reached, Some(40.0));
        assert_eq!(evaluation.mean_collisions, 2.75);
    }
}

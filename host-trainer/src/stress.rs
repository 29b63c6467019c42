//! How much worse does a controller drive when the car is not what was promised?
//!
//! Real sensors are noisy, servos slow, wheels a little askew. Each such [`Factor`] is put on
//! alone and then all together, at several times its [`Factor::full`] size, on the same pairs:
//! the differences are due to the disturbance, not to other pairs.

mod change;
mod factor;

use crate::disturbances::Disturbances;
use crate::episode::Outcome;
use crate::evaluation::{Share, outcomes};
use crate::problem::Problem;
use crate::scenario::Pair;
use crate::seed::Stream;
use crate::signals::StopFlag;
use serde::Serialize;

pub use change::Change;
pub use factor::Factor;

/// Times of its full size at which a factor is tried: half, full, double.
pub const SCALES: [f32; 3] = [0.5, 1.0, 2.0];

/// The scale by which factors are compared.
const FULL: f32 = 1.0;

/// A car whose control periods last this long, seconds, with every factor at its full size.
pub fn in_full(car: Disturbances, period: f32) -> Disturbances {
    with(&Factor::ALL, FULL, car, period)
}

/// The same without one of the factors.
pub fn in_full_but(left_out: Factor, car: Disturbances, period: f32) -> Disturbances {
    let others: Vec<Factor> =
        Factor::ALL.into_iter().filter(|factor| *factor != left_out).collect();
    with(&others, FULL, car, period)
}

/// The same with these factors at this scale.
fn with(factors: &[Factor], scale: f32, mut car: Disturbances, period: f32) -> Disturbances {
    for factor in factors {
        factor.disturb(factor.full() * scale, period, &mut car);
    }
    car
}

/// How a controller drives with and without disturbances.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Stress {
    /// The car as described, nothing left to chance: what the levels are compared with.
    pub calm: Level,
    /// Every factor alone.
    #[serde(rename = "stress")]
    pub factors: Vec<Alone>,
    /// All factors at once.
    pub together: Vec<Level>,
    /// The factor that costs most at its full size; none if these pairs show no cost of any.
    pub weakest: Option<Factor>,
}

/// One factor, all others absent.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Alone {
    /// Which.
    pub factor: Factor,
    /// What it does, in words.
    pub about: &'static str,
    /// What its magnitudes are in.
    pub unit: &'static str,
    /// By size. One that comes to nothing is left out: dead time below a control period, a
    /// servo no slower than the car's own.
    pub levels: Vec<Level>,
}

/// How the pairs went at one strength.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Level {
    /// Times the full size.
    pub scale: f32,
    /// The size, in the factor's unit; none where several factors act or none does.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub magnitude: Option<f32>,
    /// Share of drives that reached the target.
    pub reached: f64,
    /// Its 95 % interval.
    pub reached_interval: [f64; 2],
    /// Share of drives that reached it without one collision.
    pub clean: f64,
    /// Its 95 % interval.
    pub clean_interval: [f64; 2],
    /// What became of the share that reached.
    pub reached_change: Change,
    /// What became of the share that drove clean.
    pub clean_change: Change,
}

impl Level {
    fn new(scale: f32, magnitude: Option<f32>, outcomes: &[Outcome], calm: &[Outcome]) -> Self {
        let share = |counts: fn(&Outcome) -> bool| Share {
            count: outcomes.iter().filter(|outcome| counts(outcome)).count() as u32,
            of: outcomes.len() as u32,
        };
        let change = |counts: fn(&Outcome) -> bool| {
            Change::between(calm.iter().map(counts).zip(outcomes.iter().map(counts)))
        };
        let reached: fn(&Outcome) -> bool = |outcome| outcome.reached;
        Self {
            scale,
            magnitude,
            reached: share(reached).value(),
            reached_interval: share(reached).interval(),
            clean: share(Outcome::clean).value(),
            clean_interval: share(Outcome::clean).interval(),
            reached_change: change(reached),
            clean_change: change(Outcome::clean),
        }
    }
}

impl Stress {
    /// Drives every pair at every level; drive `i` gets the random numbers of `place(i)`. The
    /// problem comes back as it was. None if `stop` was raised meanwhile.
    ///
    /// # Panics
    ///
    /// If the genome is not of the problem's topology, or there is no pair.
    pub fn test(
        problem: &mut Problem,
        genome: &[f32],
        pairs: &[Pair],
        place: impl Fn(u32) -> Stream + Sync,
        stop: &StopFlag,
    ) -> Option<Self> {
        let written = Disturbances::of(&problem.scenario);
        let stress = Self::of(written.without_chance(), problem.scenario.episode.period, |d| {
            problem.disturb(d);
            outcomes(problem, genome, pairs, &place, stop)
        });
        problem.disturb(written);
        stress
    }

    /// The same for whatever `drive` makes of a car's disturbances.
    fn of(
        calm: Disturbances,
        period: f32,
        mut drive: impl FnMut(Disturbances) -> Option<Vec<Outcome>>,
    ) -> Option<Self> {
        let calm_outcomes = drive(calm)?;
        let mut level = |scale, factors: &[Factor]| {
            let disturbed = with(factors, scale, calm, period);
            let magnitude = match factors {
                [factor] => Some(factor.full() * scale),
                _ => None,
            };
            // Two levels of nothing: no such level, and still an answer.
            if disturbed == calm {
                return Some(None);
            }
            let outcomes = drive(disturbed)?;
            Some(Some(Level::new(scale, magnitude, &outcomes, &calm_outcomes)))
        };
        let mut levels = |factors: &[Factor]| {
            let levels: Option<Vec<_>> =
                SCALES.into_iter().map(|scale| level(scale, factors)).collect();
            levels.map(|levels| levels.into_iter().flatten().collect::<Vec<Level>>())
        };
        let mut alone = Vec::new();
        for factor in Factor::ALL {
            let (about, unit) = (factor.about(), factor.unit());
            alone.push(Alone { factor, about, unit, levels: levels(&[factor])? });
        }
        Some(Self {
            together: levels(&Factor::ALL)?,
            calm: Level::new(0.0, None, &calm_outcomes, &calm_outcomes),
            weakest: weakest(&alone, |level| level.clean_change)
                .or_else(|| weakest(&alone, |level| level.reached_change)),
            factors: alone,
        })
    }
}

impl Alone {
    /// What this factor does at its full size.
    pub fn at_full(&self) -> Option<&Level> {
        self.levels.iter().find(|level| level.scale == FULL)
    }
}

/// The factor whose full size costs most, of those whose cost is more than chance.
fn weakest(alone: &[Alone], change: fn(&Level) -> Change) -> Option<Factor> {
    let cost = |alone: &Alone| {
        let change = change(alone.at_full()?);
        change.is_a_fall().then_some((alone.factor, change.by))
    };
    let costs = alone.iter().filter_map(cost);
    costs.min_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(factor, _)| factor)
}

#[cfg(test)]
mod tests;

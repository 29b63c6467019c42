//! All numbers: `results.json`, `results.csv`, and what `--json` prints.

use super::course::{Course, Published, SOURCE};
use super::method::MazeMethod;
use super::plan::{MazePlan, MazeSetup};
use super::trial::MazeTrial;
use crate::evaluation::Share;
use crate::reproduce::results::Counted;
use crate::reproduce::spread::{SeedBySeed, Spread};
use serde::Serialize;
use std::fmt::Write;

/// Everything.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MazeResults {
    /// Version of evosteer.
    pub evosteer: String,
    /// The first seed.
    pub seed: u64,
    /// How many seeds.
    pub seeds: u32,
    /// Where the published numbers are from.
    pub source: &'static str,
    /// The courses, in order.
    pub courses: Vec<CourseResults>,
}

/// One course.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CourseResults {
    /// Its name.
    pub course: Course,
    /// What a wall does.
    pub rule: &'static str,
    /// What the literature says of it.
    pub published: &'static [Published],
    /// A row per method.
    pub rows: Vec<MazeRow>,
}

/// One method on one course.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MazeRow {
    /// What selects.
    pub method: MazeMethod,
    /// Individuals of a generation.
    pub population: u32,
    /// Most individuals that a run may judge.
    pub budget: u64,
    /// Runs in which the goal was reached.
    pub solved: Counted,
    /// Evaluations of those runs; none where there is none.
    pub evaluations: Option<Evaluations>,
    /// Seed by seed against the first method: who needed fewer evaluations.
    pub against_first: Option<SeedBySeed>,
    /// Every run.
    pub runs: Vec<Run>,
}

/// Evaluations of the runs that reached the goal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Evaluations {
    /// On average.
    pub mean: f64,
    /// Standard deviation of a sample; none of a single run.
    pub deviation: Option<f64>,
    /// Median, quartiles, least and most.
    #[serde(flatten)]
    pub spread: Spread,
}

/// One run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Run {
    /// Its seed.
    pub seed: u64,
    /// Whether the goal was reached.
    pub solved: bool,
    /// Individuals that were judged, those of the last generation included.
    pub evaluations: u64,
}

impl Evaluations {
    /// Of at least one run.
    fn of(values: &[f64]) -> Option<Self> {
        let spread = Spread::of(values.iter().copied())?;
        let count = values.len() as f64;
        let (mut sum, mut squares) = (0.0, 0.0);
        for value in values {
            sum += value;
        }
        let mean = sum / count;
        for value in values {
            squares += (value - mean) * (value - mean);
        }
        let deviation = (values.len() > 1).then(|| (squares / (count - 1.0)).sqrt());
        Some(Self { mean, deviation, spread })
    }
}

impl MazeResults {
    /// Counts: one list of trials per setup, by seed.
    pub fn of(plan: &MazePlan, setups: &[MazeSetup], trials: &[Vec<MazeTrial>]) -> Self {
        let together: Vec<_> = setups.iter().zip(trials).collect();
        let courses = together.chunk_by(|(a, _), (b, _)| a.course == b.course).map(|methods| {
            let course = methods[0].0.course;
            let first = methods[0].1;
            let row = |(place, (setup, trials)): (usize, &(&MazeSetup, &Vec<MazeTrial>))| {
                MazeRow::of(setup, trials, (place > 0).then_some(first))
            };
            let rows = methods.iter().enumerate().map(row).collect();
            CourseResults { course, rule: course.rule(), published: course.published(), rows }
        });
        Self {
            evosteer: plan.evosteer.clone(),
            seed: plan.seed,
            seeds: plan.seeds,
            source: SOURCE,
            courses: courses.collect(),
        }
    }

    /// A line per course, method and seed.
    pub fn csv(&self) -> String {
        let mut csv = String::from("course,method,seed,solved,evaluations\n");
        for course in &self.courses {
            for row in &course.rows {
                for run in &row.runs {
                    let (course, method) = (course.course.name(), row.method.name());
                    let Run { seed, solved, evaluations } = run;
                    // Writing into a String cannot fail.
                    let _ = writeln!(csv, "{course},{method},{seed},{solved},{evaluations}");
                }
            }
        }
        csv
    }
}

impl MazeRow {
    fn of(setup: &MazeSetup, trials: &[MazeTrial], first: Option<&Vec<MazeTrial>>) -> Self {
        let solved: Vec<f64> = trials
            .iter()
            .filter(|trial| trial.solved)
            .map(|trial| trial.evaluations as f64)
            .collect();
        // What is left of the budget, so that more is better; a run that failed is behind all.
        let left = |trial: &MazeTrial| {
            let left = setup.budget().saturating_sub(trial.evaluations);
            trial.solved.then_some(left)
        };
        let against = |first: &Vec<MazeTrial>| {
            SeedBySeed::of(trials.iter().zip(first).map(|(own, first)| (left(own), left(first))))
        };
        let run = |trial: &MazeTrial| Run {
            seed: trial.seed,
            solved: trial.solved,
            evaluations: trial.evaluations,
        };
        Self {
            method: setup.method,
            population: setup.problem.scenario.training.population,
            budget: setup.budget(),
            solved: Counted::from(Share { count: solved.len() as u32, of: trials.len() as u32 }),
            evaluations: Evaluations::of(&solved),
            against_first: first.map(against),
            runs: trials.iter().map(run).collect(),
        }
    }
}

/// A number of evaluations with its thousands apart: `18 274`.
pub fn thousands(value: f64) -> String {
    let digits = format!("{value:.0}");
    let mut text = String::new();
    for (place, digit) in digits.chars().enumerate() {
        if place > 0 && (digits.len() - place).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(digit);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected: Python's statistics.mean, stdev and median.
    #[test]
    fn evaluations_have_their_mean_and_the_deviation_of_a_sample() {
        let Evaluations { mean, deviation, spread } =
            Evaluations::of(&[500.0, 250.0, 1000.0, 250.0]).unwrap();
        assert_eq!((mean, spread.median), (500.0, 375.0));
        assert!((deviation.unwrap() - 353.553_390_593).abs() < 1e-6, "{deviation:?}");
        assert_eq!(Evaluations::of(&[750.0]).unwrap().deviation, None);
        assert_eq!(Evaluations::of(&[]), None);
    }

    #[test]
    fn thousands_stand_apart() {
        assert_eq!([0.0, 999.4, 18_274.0, 1e6].map(thousands), ["0", "999", "18 274", "1 000 000"]);
    }
}

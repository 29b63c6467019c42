//! 256 single steps of the workload that another program computed in 64 bits.
//!
//! `golden.csv` holds, per step: individual and pair, the pose, the hidden outputs of the step
//! before (five decimals), and what must come out: the inputs of the network, its output, the
//! next pose, crash and arrival. Ours are 32 bits wide, so numbers may differ by
//! [`TOLERANCE`]; crash and arrival may not differ.

use super::workload;
use crate::episode::start_pose;
use crate::problem::Problem;
use crate::scenario::Pair;
use crate::seed::{Purpose, RunSeed};
use controller_core::control_loop::{Actuate, Sense};
use controller_core::motion::Pose;
use std::f64::consts::TAU;

use crate::car::SimulatedCar;

/// Most that a number may differ by.
pub const TOLERANCE: f64 = 2e-4;

/// Columns of the file.
const COLUMNS: usize = 42;

/// How the golden steps came out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comparison {
    /// Steps compared.
    pub steps: usize,
    /// Those with a number beyond the tolerance, or another crash or arrival.
    pub misses: usize,
    /// The largest difference of a number.
    pub worst: f64,
}

/// Computes the golden steps as a drive does, and compares.
pub fn compare(problem: &Problem) -> Comparison {
    let genomes = workload::population(workload::POPULATION);
    let rows: Vec<[f64; COLUMNS]> =
        include_str!("golden.csv").lines().skip(1).filter_map(numbers).collect();
    let mut all = Comparison { steps: rows.len(), misses: 0, worst: 0.0 };
    for row in &rows {
        let (difference, same_end) = step(problem, &genomes, row);
        all.worst = all.worst.max(difference);
        if !(difference <= TOLERANCE && same_end) {
            all.misses += 1;
        }
    }
    all
}

fn numbers(line: &str) -> Option<[f64; COLUMNS]> {
    let numbers: Vec<f64> = line.split(',').filter_map(|field| field.parse().ok()).collect();
    numbers.try_into().ok()
}

/// The largest difference of one step, and whether it ends as it should.
fn step(problem: &Problem, genomes: &[f32], row: &[f64; COLUMNS]) -> (f64, bool) {
    let [individual, pair, ..] = row.map(|number| number as usize);
    let hidden: Vec<f32> = row[5..29].iter().map(|output| *output as f32).collect();
    let (inputs, next) = (&row[29..36], &row[36..40]);
    let length = problem.topology().weights();
    let genome = &genomes[individual * length..][..length];
    let pair = Pair {
        start: [row[2] as f32, row[3] as f32, row[4] as f32],
        goal: workload::pairs(problem)[pair].goal,
    };
    let (world, model, spec) = (&problem.world, problem.model(), &problem.scenario.episode);
    let mut random = RunSeed(0).stream(Purpose::Episode, 0, 0);
    let start: Pose<f32> = start_pose(world, model, spec, &pair, &mut random);
    let mut car = SimulatedCar::new(world, problem.lookout(), model, start, pair.goal, random);
    let scaling = problem.scaling();
    let brain = problem.brain(genome);
    let (Ok(reading), Ok(brain)) = (car.sense(), brain) else { return (f64::INFINITY, false) };
    let seen = scaling.encoding.inputs(&reading.sight(), scaling.range);
    let Some(outputs) = brain.outputs(&seen, &hidden) else { return (f64::INFINITY, false) };
    let command = scaling.command(&outputs);
    let Ok(()) = car.actuate(command);
    // A blocked car keeps its place; the reference says where it would be.
    let (steer, length) = (command.steer.radians(), command.step.metres());
    let moved = start.driven(steer, length, problem.scenario.vehicle.wheelbase);
    let turn = f64::from(moved.heading) - next[3];
    let differences = [
        f64::from(outputs[0]) - next[0],
        f64::from(moved.x) - next[1],
        f64::from(moved.y) - next[2],
        turn - (turn / TAU).round() * TAU,
    ];
    let inputs = seen.iter().zip(inputs).map(|(seen, input)| f64::from(*seen) - input);
    let worst = differences.into_iter().chain(inputs).fold(0.0, |worst: f64, difference| {
        // NaN counts as a difference.
        if difference.abs() <= worst { worst } else { difference.abs() }
    });
    let [hit, reached] = [row[40] != 0.0, row[41] != 0.0];
    (worst, car.collided == hit && (car.reached || hit) == (reached || hit))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_256_golden_steps_come_out() {
        let comparison = compare(&workload::problem().unwrap());
        assert_eq!((comparison.steps, comparison.misses), (256, 0), "{comparison:?}");
        assert!(comparison.worst > 0.0 && comparison.worst < TOLERANCE);
    }

    /// The check must be able to fail.
    #[test]
    fn another_wheelbase_misses_golden_steps() {
        let mut scenario = workload::problem().unwrap().scenario;
        scenario.vehicle.wheelbase = 0.301;
        let comparison = compare(&Problem::new(scenario).unwrap());
        assert!(comparison.misses > 100, "{comparison:?}");
    }
}

//! What a step of the workload's network costs.

use crate::row::Row;
use crate::timing::{median, nanoseconds};
use host_trainer::bench::{parts, workload};
use host_trainer::problem::Problem;
use host_trainer::vector::Instructions;
use host_trainer::wide::SLOTS;

const ROUNDS: usize = 7;

/// Steps of one network that are timed together.
const STEPS: usize = 40_000;

/// Nanoseconds per step and car: of one network alone (none), and side by side.
pub(crate) type Times = Vec<(Option<Instructions>, f64)>;

/// Measures.
pub(crate) fn measure(problem: &Problem, sets: &[Instructions]) -> Times {
    let genomes = workload::population(16);
    let weights = problem.topology().weights();
    let ways: Vec<Option<Instructions>> =
        std::iter::once(None).chain(sets.iter().copied().map(Some)).collect();
    let mut times: Vec<Vec<f64>> = vec![Vec::new(); ways.len()];
    for _ in 0..ROUNDS {
        for (way, times) in ways.iter().zip(&mut times) {
            times.push(match way {
                None => nanoseconds(STEPS, || parts::step_alone(&genomes[..weights], STEPS)),
                Some(set) => {
                    let rounds = STEPS / set.width();
                    let cars = set.width() * SLOTS * rounds;
                    nanoseconds(cars, || parts::step_together(&genomes, rounds, *set))
                }
            });
        }
    }
    ways.into_iter().zip(times.into_iter().map(median)).collect()
}

/// Its lines of the table.
pub(crate) fn rows(times: &Times) -> Vec<Row> {
    let alone = times.first().map_or(f64::NAN, |(_, time)| *time);
    let row = |(way, time): &(Option<Instructions>, f64)| match way {
        None => Row::new("network step", "alone", *time, "ns"),
        Some(set) => {
            let case = format!("{set}, {} side by side", set.width() * SLOTS);
            Row::new("network step", case, *time, "ns").beside_time("alone", alone)
        }
    };
    times.iter().map(row).collect()
}

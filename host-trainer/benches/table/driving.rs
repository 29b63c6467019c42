//! Steps per second of the fixed workload, and the time of a paper-size run.

use crate::row::Row;
use crate::timing::median;
use host_trainer::bench::reference::{self, Reference};
use host_trainer::bench::{golden, speed, workload};
use host_trainer::car::body_of;
use host_trainer::problem::Problem;
use host_trainer::vector::Instructions;
use rayon::ThreadPool;

const ROUNDS: usize = 5;

/// Individuals that drive where each car is alone: a fifth of the generation.
const FEW: usize = 32;

/// Paper-size runs.
const RUNS: usize = 3;

/// How fast the workload went.
pub(crate) struct Driving {
    /// Of each set of instructions: million steps per second on one thread, and on two.
    together: Vec<(Instructions, [f64; 2])>,
    alone: f64,
    parry2d: [f64; 2],
    run: f64,
    evolution: f64,
}

/// Measures.
///
/// # Panics
///
/// If a golden step comes out otherwise: a speed would mean nothing.
pub(crate) fn measure(problem: &Problem, sets: &[Instructions]) -> Driving {
    let golden = golden::compare(problem);
    assert_eq!(golden.misses, 0, "golden steps come out otherwise: {golden:?}");
    let body = body_of(&problem.scenario.vehicle);
    let reference = Reference::new(problem.world.segments(), &body);
    let genomes = workload::population(workload::POPULATION);
    let few = &genomes[..genomes.len() / workload::POPULATION * FEW];
    let pools = [1, 2].map(pool);
    let million = |measurement: speed::Measurement| measurement.steps_per_second() * 1e-6;

    let mut alone = Vec::new();
    let mut parry2d: [Vec<f64>; 2] = Default::default();
    let mut together: Vec<[Vec<f64>; 2]> = sets.iter().map(|_| Default::default()).collect();
    for round in 0..=ROUNDS {
        alone.push(million(speed::generation_alone(problem, few)));
        for threads in 0..2 {
            let pool = &pools[threads];
            let theirs = pool.install(|| reference::generation(problem, &reference, few));
            parry2d[threads].push(million(theirs));
            for (set, rates) in sets.iter().zip(&mut together) {
                let ours = pool.install(|| speed::generation(problem, &genomes, *set).0);
                rates[threads].push(million(ours));
            }
        }
        if round == 0 {
            // The first round fills caches and visits every place.
            alone.clear();
            parry2d.iter_mut().chain(together.iter_mut().flatten()).for_each(Vec::clear);
        }
    }
    let widest = Instructions::of_this_cpu();
    let run = |_| pools[1].install(|| speed::run(problem, widest)).expect("part of the program");
    let mut runs: Vec<speed::Run> = (0..RUNS).map(run).collect();
    runs.sort_by_key(|run| run.whole.time);
    let run = runs[RUNS / 2];
    Driving {
        together: sets
            .iter()
            .copied()
            .zip(together.into_iter().map(|rates| rates.map(median)))
            .collect(),
        alone: median(alone),
        parry2d: parry2d.map(median),
        run: run.whole.time.as_secs_f64(),
        evolution: run.evolution.as_secs_f64(),
    }
}

fn pool(threads: usize) -> ThreadPool {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads")
}

impl Driving {
    /// Nanoseconds that one thread takes for a step with these instructions.
    pub(crate) fn step(&self, set: Instructions) -> Option<f64> {
        let (_, [one_thread, _]) = self.together.iter().find(|(known, _)| *known == set)?;
        Some(1e3 / one_thread)
    }

    pub(crate) fn rows(&self) -> Vec<Row> {
        const UNIT: &str = "million steps/s";
        let mut rows = vec![
            Row::new("drives with parry2d", "one by one, 1 thread", self.parry2d[0], UNIT),
            Row::new("drives with parry2d", "one by one, 2 threads", self.parry2d[1], UNIT),
            Row::new("drives", "one by one, 1 thread", self.alone, UNIT)
                .beside_rate("parry2d", self.parry2d[0]),
        ];
        for (set, rates) in &self.together {
            for (threads, rate, parry2d) in
                [("1 thread", rates[0], self.parry2d[0]), ("2 threads", rates[1], self.parry2d[1])]
            {
                let lanes = set.width();
                let case =
                    format!("{set}, {lanes} lane{}, {threads}", if lanes == 1 { "" } else { "s" });
                rows.push(Row::new("drives", case, rate, UNIT).beside_rate("parry2d", parry2d));
            }
        }
        let steps = 48.0;
        let run = Row::new("paper-size run", "48 million steps, 2 threads", self.run, "s");
        rows.push(run.beside_time("parry2d, by its rate,", steps / self.parry2d[1]));
        rows.push(Row::new(
            "paper-size run",
            "evolution's share",
            100.0 * self.evolution / self.run,
            "%",
        ));
        rows
    }
}

//! Training is the same, bit for bit, on any number of threads and after any interruption.

use crate::worlds::from_toml;
use host_trainer::problem::Problem;
use host_trainer::seed::RunSeed;
use host_trainer::training::{Snapshot, Training};
use rayon::ThreadPoolBuilder;

/// A small run with everything random that there is.
const NOISY: &str = "
    [world]
    boxes = [[4, 4, 6, 6]]
    circles = [[2, 8, 0.5]]
    [sensors]
    noise_m = 0.02
    dropout = 0.02
    [network]
    recurrence = 'elman'
    [episode]
    step_limit = 120
    start_offset_m = 0.1
    start_turn_deg = 10
    randomise = { wheelbase = 0.1, step = 0.1, steer_offset_deg = 2 }
    [pairs]
    count = 3
    resample = true
    [training]
    population = 21
";

const EXACT: &str = "
    [world]
    boxes = [[4, 4, 6, 6]]
    [episode]
    step_limit = 120
    [training]
    population = 21
";

fn bytes(training: &Training<'_>) -> Vec<u8> {
    postcard::to_allocvec(&training.snapshot()).unwrap()
}

fn trained(problem: &Problem, threads: usize, generations: u32) -> Vec<u8> {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        let mut training = Training::new(problem, RunSeed(5)).unwrap();
        for _ in 0..generations {
            training.step().unwrap();
        }
        bytes(&training)
    })
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    for settings in [EXACT, NOISY] {
        let problem = Problem::new(from_toml(settings)).unwrap();
        let alone = trained(&problem, 1, 3);
        for threads in [2, 7] {
            assert!(trained(&problem, threads, 3) == alone, "{threads} threads: {settings}");
        }
    }
}

#[test]
fn a_run_goes_on_from_its_snapshot_as_if_nothing_had_happened() {
    for settings in [EXACT, NOISY] {
        let problem = Problem::new(from_toml(settings)).unwrap();
        let mut first = Training::new(&problem, RunSeed(5)).unwrap();
        for _ in 0..2 {
            first.step().unwrap();
        }
        let saved: Snapshot = postcard::from_bytes(&bytes(&first)).unwrap();
        let mut resumed = Training::new(&problem, RunSeed(5)).unwrap();
        resumed.restore(saved).unwrap();
        assert_eq!(resumed.generation(), 2);
        for _ in 0..2 {
            resumed.step().unwrap();
        }
        assert!(bytes(&resumed) == trained(&problem, 1, 4), "{settings}");
    }
}

#[test]
fn another_seed_gives_another_run() {
    let problem = Problem::new(from_toml(EXACT)).unwrap();
    let mut costs = Vec::new();
    for seed in [5, 6] {
        let mut training = Training::new(&problem, RunSeed(seed)).unwrap();
        costs.push(training.step().unwrap().best);
    }
    assert_ne!(costs[0], costs[1]);
}

#[test]
fn a_snapshot_of_another_network_is_refused() {
    let problem = Problem::new(from_toml(EXACT)).unwrap();
    let wider = Problem::new(from_toml(&format!("{EXACT}\n[network]\nhidden = 16"))).unwrap();
    let snapshot = Training::new(&problem, RunSeed(5)).unwrap().snapshot();
    let mut other = Training::new(&wider, RunSeed(5)).unwrap();
    assert!(other.restore(snapshot).is_err());
}

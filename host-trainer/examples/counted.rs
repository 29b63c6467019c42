//! A fixed amount of work on one thread, for a program that counts instructions: `cargo xtask
//! bench --counted` runs it under callgrind.
//!
//! `EVOSTEER_INSTRUCTIONS` chooses the vectors. Each function named `counted_…` is called once,
//! after everything that happens only once has happened; the first words printed are the steps
//! that each of them is about.

use controller_core::geometry::Body;
use controller_core::motion::Pose;
use host_trainer::bench::{parts, speed, workload};
use host_trainer::car::body_of;
use host_trainer::problem::Problem;
use host_trainer::vector::Instructions;
use host_trainer::world::{Fan, Lookout};
use std::hint::black_box;

/// As many as the widest vectors have lanes.
const INDIVIDUALS: usize = 16;

fn main() {
    if let Err(failure) = Instructions::choose() {
        eprintln!("counted: {failure}");
        std::process::exit(2);
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a thread");
    pool.install(count);
}

fn count() {
    let problem = workload::problem().expect("part of the program");
    let genomes = workload::population(INDIVIDUALS);
    let sensors = &problem.scenario.sensors;
    let fan = Fan::new(&sensors.beams, sensors.range);
    let body = body_of(&problem.scenario.vehicle);
    let lookout = problem.world.lookout(fan.range(), body);
    let steps = problem.scenario.episode.step_limit as usize;
    let poses = parts::poses(&problem, INDIVIDUALS, steps);
    for _ in 0..3 {
        black_box(drives(&problem, &genomes));
        parts::look(&lookout, &fan, &poses, Instructions::in_use());
        parts::touch(&lookout, &body, &poses, Instructions::in_use());
    }
    let driven = counted_drives(&problem, &genomes);
    counted_beams(&lookout, &fan, &poses);
    counted_contacts(&lookout, &body, &poses);
    counted_networks(&genomes, steps);
    assert_eq!(driven as usize, poses.len());
    println!("{driven} steps");
}

fn drives(problem: &Problem, genomes: &[f32]) -> u64 {
    speed::generation(problem, genomes, Instructions::in_use()).0.steps
}

#[inline(never)]
fn counted_drives(problem: &Problem, genomes: &[f32]) -> u64 {
    black_box(drives(black_box(problem), genomes))
}

#[inline(never)]
fn counted_beams(lookout: &Lookout, fan: &Fan, poses: &[Pose<f32>]) {
    parts::look(black_box(lookout), fan, poses, Instructions::in_use());
    black_box(());
}

#[inline(never)]
fn counted_contacts(lookout: &Lookout, body: &Body<f32>, poses: &[Pose<f32>]) {
    parts::touch(black_box(lookout), body, poses, Instructions::in_use());
    black_box(());
}

/// Steps of the networks of as many individuals as there are lanes, until all have made theirs.
#[inline(never)]
fn counted_networks(genomes: &[f32], steps: usize) {
    let set = Instructions::in_use();
    parts::step_together(black_box(genomes), steps * INDIVIDUALS / set.width(), set);
    black_box(());
}

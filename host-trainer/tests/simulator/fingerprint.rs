//! The bits of whole drives, pinned: any change of arithmetic shows up here as a decision.

use crate::worlds::{PAPER, random, shipped};
use host_trainer::fingerprint::sha256;
use host_trainer::problem::Problem;
use host_trainer::seed::RunSeed;
use std::fmt::Write;

/// All pose bits of ten drives with a fixed genome of random weights.
fn drives(name: &str) -> String {
    let problem = Problem::new(shipped(name)).unwrap();
    let mut stream = random(81);
    let weights = problem.topology().weights();
    let genome: Vec<f32> = (0..weights).map(|_| stream.within(-1.0, 1.0)).collect();
    let pairs = problem.sampler().unseen(RunSeed(8), 10).unwrap();
    let mut brain = problem.brain(&genome).unwrap();
    let mut bits = Vec::new();
    let (mut steps, mut collisions) = (0, 0);
    for pair in &pairs {
        let (outcome, trace) = problem.drive_traced(brain.as_mut(), pair, random(0));
        for pose in trace.steps.iter().map(|step| step.pose).chain([trace.end.unwrap().pose]) {
            for value in [pose.x, pose.y, pose.heading] {
                bits.extend(value.to_bits().to_le_bytes());
            }
        }
        steps += outcome.steps;
        collisions += outcome.collisions;
    }
    format!("{name}: {steps} steps, {collisions} collisions, {}", &sha256(&bits)[..16])
}

/// A change here means that every seed of every earlier run now means something else: say so in
/// the changelog.
#[test]
fn a_fixed_controller_drives_the_same_bits_in_every_release() {
    let mut found = String::new();
    for name in PAPER.into_iter().chain(["depot", "barn_000", "medium_maze"]) {
        writeln!(found, "{}", drives(name)).unwrap();
    }
    insta::assert_snapshot!(found);
}

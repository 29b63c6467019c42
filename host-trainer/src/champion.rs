//! The winner, as the bytes that go onto the car.

pub mod shipped;

use crate::evolve::Cost;
use crate::fingerprint;
use crate::problem::Problem;
use crate::seed::{Purpose, RunSeed};
use crate::training::Best;
use controller_core::blob::{self, EncodeError, Header, Provenance};
use controller_core::observation::INPUTS;

/// Self-test triples in a champion's blob.
const SELF_TESTS: u8 = 4;

/// Writes the champion of a run as a weight blob.
///
/// # Errors
///
/// A genome that the blob format refuses.
pub fn to_blob(problem: &Problem, seed: RunSeed, best: &Best) -> Result<Vec<u8>, EncodeError> {
    let header = header(problem, seed, best);
    let self_tests = self_tests(problem, seed, best);
    // Aligned for reading in place: encoding ends by reading back what it wrote.
    let mut words = vec![0u32; header.blob_len().div_ceil(4)];
    let bytes: &mut [u8] = bytemuck::cast_slice_mut(&mut words);
    let length = blob::encode(&header, &best.genome, &self_tests, bytes)?;
    Ok(bytes[..length].to_vec())
}

/// The header of a champion that this problem's training would give: its car and its network.
pub(crate) fn car(problem: &Problem) -> Header {
    let best = Best { genome: Vec::new(), cost: Cost::new(0.0), generation: 0, kept: Vec::new() };
    header(problem, RunSeed(0), &best)
}

fn header(problem: &Problem, seed: RunSeed, best: &Best) -> Header {
    let scenario = &problem.scenario;
    let version = |part: &str| part.parse().expect("cargo's version parts are numbers");
    let digest = fingerprint::scenario(scenario);
    Header {
        topology: problem.topology(),
        activation: scenario.network.activation,
        scaling: problem.scaling(),
        period: scenario.episode.period,
        wheelbase: scenario.vehicle.wheelbase,
        beams: scenario.sensors.beams,
        self_tests: SELF_TESTS,
        provenance: Provenance {
            seed: seed.0,
            generation: best.generation,
            scenario_hash: std::array::from_fn(|i| digest[i]),
            tool: [
                version(env!("CARGO_PKG_VERSION_MAJOR")),
                version(env!("CARGO_PKG_VERSION_MINOR")),
                version(env!("CARGO_PKG_VERSION_PATCH")),
            ],
            scenario: Provenance::stored_name(&scenario.name),
        },
    }
}

/// Random inputs and states with the outputs that this machine computes for them.
fn self_tests(problem: &Problem, seed: RunSeed, best: &Best) -> Vec<f32> {
    let brain = problem.brain(&best.genome).expect("a champion has the network's length");
    let mut random = seed.stream(Purpose::SelfTest, best.generation, 0);
    let mut words = Vec::new();
    for _ in 0..SELF_TESTS {
        let inputs: [f32; INPUTS] = std::array::from_fn(|_| random.unit());
        let hidden: Vec<f32> = brain.hidden().iter().map(|_| random.within(-1.0, 1.0)).collect();
        let outputs = brain.outputs(&inputs, &hidden).expect("as many as the brain has");
        words.extend([&inputs[..], &hidden, &outputs].concat());
    }
    words
}

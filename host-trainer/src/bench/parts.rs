//! The parts of a step, each by itself, so that they can be timed and counted.
//!
//! What they work on is what they meet in the workload's drives; how, is what the wide engine
//! does.

use super::workload;
use crate::problem::{Problem, training_drive};
use crate::seed::RunSeed;
use crate::vector::{Instructions, Kernel, Slots, Vector, Weight};
use crate::wide::{SLOTS, step_of_slots};
use crate::world::{Fan, Glance, Lookout};
use controller_core::activation::Rational;
use controller_core::geometry::Body;
use controller_core::motion::Pose;
use controller_core::network::{Elman, Network, State};
use controller_core::observation::{BEAMS, INPUTS};
use std::hint::black_box;

/// Neurons in each hidden layer of the workload's network.
const HIDDEN: usize = 12;

const WEIGHTS: usize = Network::<Elman, f32, INPUTS, HIDDEN, 1>::topology(true).weights();

/// Where the workload's cars stand: `steps` control periods of the first `individuals`, all cars
/// at one time, then all at the next. A drive that has ended begins again.
pub fn poses(problem: &Problem, individuals: usize, steps: usize) -> Vec<Pose<f32>> {
    let genomes = workload::population(individuals);
    let mut traces = Vec::new();
    for genome in genomes.chunks(problem.topology().weights()) {
        let mut brain = problem.brain(genome).expect("the workload's topology");
        for pair in workload::pairs(problem) {
            let random = training_drive(RunSeed(1), 0, 0);
            traces.push(problem.drive_traced(brain.as_mut(), pair, random).1.steps);
        }
    }
    let at = |step: usize| traces.iter().map(move |trace| trace[step % trace.len()].pose);
    (0..steps).flat_map(at).collect()
}

/// The beams of cars at these poses, as many side by side as the wide engine drives; a few at the
/// end are left out.
pub fn look(lookout: &Lookout, fan: &Fan, poses: &[Pose<f32>], set: Instructions) {
    struct Look<'a>(&'a Lookout, &'a Fan, &'a [Pose<f32>]);
    impl Kernel for Look<'_> {
        type Output = ();
        #[inline(always)]
        fn run<V: Vector>(self) {
            let Self(lookout, fan, poses) = self;
            let mut glance = Glance::<V, SLOTS, { SLOTS * BEAMS }>::default();
            for poses in poses.chunks_exact(SLOTS * V::WIDTH) {
                let poses = side_by_side::<V>(black_box(poses));
                lookout.look(fan, &poses, &[u32::MAX; SLOTS], &mut glance);
                black_box(&glance.distances);
            }
        }
    }
    set.run(Look(lookout, fan, poses));
}

/// How far the beams of a car at this pose reach, metres.
pub fn distances(lookout: &Lookout, fan: &Fan, pose: &Pose<f32>) -> [f32; BEAMS] {
    let mut glance = Glance::<f32, 1, BEAMS>::default();
    lookout.look(fan, &[*pose], &[1], &mut glance);
    let [distances] = glance.distances;
    distances
}

/// The contacts of cars at these poses, likewise.
pub fn touch(lookout: &Lookout, body: &Body<f32>, poses: &[Pose<f32>], set: Instructions) {
    struct Touch<'a>(&'a Lookout, &'a Body<f32>, &'a [Pose<f32>]);
    impl Kernel for Touch<'_> {
        type Output = ();
        #[inline(always)]
        fn run<V: Vector>(self) {
            let Self(lookout, body, poses) = self;
            for poses in poses.chunks_exact(SLOTS * V::WIDTH) {
                let poses = side_by_side::<V>(black_box(poses));
                black_box(lookout.touches(body, &poses, &[u32::MAX; SLOTS]));
            }
        }
    }
    set.run(Touch(lookout, body, poses));
}

/// Poses in the lanes of vectors.
#[inline(always)]
fn side_by_side<V: Vector>(poses: &[Pose<f32>]) -> [Pose<V>; SLOTS] {
    let zero = V::from(0.0);
    let mut wide = [Pose { x: zero, y: zero, heading: zero, cos: zero, sin: zero }; SLOTS];
    for (wide, poses) in wide.iter_mut().zip(poses.chunks_exact(V::WIDTH)) {
        for (lane, pose) in poses.iter().enumerate() {
            wide.x.lanes_mut()[lane] = pose.x;
            wide.y.lanes_mut()[lane] = pose.y;
            wide.heading.lanes_mut()[lane] = pose.heading;
            wide.cos.lanes_mut()[lane] = pose.cos;
            wide.sin.lanes_mut()[lane] = pose.sin;
        }
    }
    wide
}

/// Steps of one network.
///
/// # Panics
///
/// If the genome is not of the workload's topology.
pub fn step_alone(genome: &[f32], steps: usize) {
    let network = Network::<Elman, f32, INPUTS, HIDDEN, 1>::new(genome, true);
    let network = network.expect("the workload's topology");
    let mut state = State::reset();
    let mut inputs = [0.5; INPUTS];
    for _ in 0..steps {
        inputs[0] = network.step_alone(Rational, &mut state, black_box(&inputs))[0];
    }
    black_box(inputs);
}

/// Steps of as many networks as these instructions have lanes, each for [`SLOTS`] cars.
///
/// # Panics
///
/// If the genomes are too few, or not of the workload's topology.
pub fn step_together(genomes: &[f32], steps: usize, set: Instructions) {
    struct Together<'a>(&'a [f32], usize);
    impl Kernel for Together<'_> {
        type Output = ();
        #[inline(always)]
        fn run<V: Vector>(self) {
            let mut weights = vec![Weight([V::from(0.0)]); WEIGHTS];
            for (lane, genome) in self.0.chunks(WEIGHTS).enumerate() {
                for (weight, gene) in weights.iter_mut().zip(genome) {
                    weight.0[0].lanes_mut()[lane] = *gene;
                }
            }
            let network = Network::<Elman, Weight<V, 1>, INPUTS, HIDDEN, 1>::new(&weights, true);
            let network = network.expect("the workload's topology");
            let mut state = State::<Slots<V, SLOTS>, HIDDEN>::reset();
            let mut next = state;
            let (mut before, mut after) = (&mut state, &mut next);
            let mut inputs = [Slots::<V, SLOTS>::from(0.5); INPUTS];
            for _ in 0..self.1 {
                let seen = black_box(&inputs);
                let [answer] =
                    step_of_slots(&network, Rational, black_box(&*before), black_box(after), seen);
                inputs[0] = answer;
                std::mem::swap(&mut before, &mut after);
            }
            black_box(&inputs);
        }
    }
    set.run(Together(&genomes[..WEIGHTS * set.width()], steps));
}

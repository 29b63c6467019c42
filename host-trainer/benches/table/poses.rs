//! Where cars look from, and in which order: many drives side by side, step by step.

use crate::scenes::Scene;
use controller_core::geometry::Body;
use controller_core::motion::Pose;
use host_trainer::seed::{Purpose, RunSeed, Stream};
use std::f32::consts::PI;

/// Places that cars set out from: as many as a training has pairs, or a few more.
const STARTS: usize = 16;

/// Cars side by side, as in a block of 16 lanes.
const CARS: usize = 80;

const STEPS: usize = 1500;

/// Steps after which a car starts again.
const EPISODE: usize = 300;

/// Poses of cars that steer at random, and start again where they touch something or after a
/// while: all cars' first step, then all cars' second.
pub(crate) fn random_drives(scene: &Scene, body: &Body<f32>) -> Vec<Pose<f32>> {
    let mut random = RunSeed(1).stream(Purpose::Episode, 0, 0);
    let starts: [Pose<f32>; STARTS] = std::array::from_fn(|_| start(scene, body, &mut random));
    let mut cars: [(Pose<f32>, f32); CARS] = std::array::from_fn(|car| (starts[car % STARTS], 0.0));
    let mut poses = Vec::with_capacity(CARS * STEPS);
    for step in 0..STEPS {
        for (car, (pose, angle)) in cars.iter_mut().enumerate() {
            if random.index(20) == 0 {
                *angle = random.within(-0.6, 0.6);
            }
            let moved = pose.driven(*angle, 0.1, 0.3);
            let again = step % EPISODE == EPISODE - 1 || scene.world.touches(body, &moved);
            *pose = if again { starts[car % STARTS] } else { moved };
            poses.push(*pose);
        }
    }
    poses
}

fn start(scene: &Scene, body: &Body<f32>, random: &mut Stream) -> Pose<f32> {
    let (low, high) = (scene.world.bounds.min, scene.world.bounds.max);
    loop {
        let (x, y) = (random.within(low[0], high[0]), random.within(low[1], high[1]));
        let pose = Pose::new(x, y, random.within(-PI, PI));
        if scene.is_free([x, y]) && !scene.world.touches(body, &pose) {
            return pose;
        }
    }
}

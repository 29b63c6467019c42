//! Scenarios, worlds and random places that several tests use.

use controller_core::control_loop::Decide;
use controller_core::controller::Command;
use controller_core::geometry::Ray;
use controller_core::motion::Pose;
use controller_core::observation::{INPUTS, Reading, ReadingError};
use controller_core::units::{SteerAngle, StepLength};
use host_trainer::brain::Brain;
use host_trainer::scenario::{self, Scenario, Source};
use host_trainer::seed::{Purpose, RunSeed, Stream};
use host_trainer::world::World;
use std::f32::consts::PI;
use std::path::{Path, PathBuf};

/// The paper's scenes.
pub(crate) const PAPER: [&str; 3] = ["open", "obstacles", "complex"];

/// A shipped scenario.
pub(crate) fn shipped(name: &str) -> Scenario {
    scenario::load(&scenario::find(name).unwrap(), None, &[]).unwrap()
}

/// A scenario from TOML; the paper's preset stands behind it.
pub(crate) fn from_toml(text: &str) -> Scenario {
    let source = Source::new("test.toml", text, Path::new(""));
    scenario::load(&source, None, &[]).unwrap_or_else(|failure| panic!("{failure}"))
}

/// The world of a scenario.
pub(crate) fn world_of(scenario: &Scenario) -> World {
    World::new(scenario).unwrap()
}

/// A file of the repository's `scenarios/` folder.
pub(crate) fn scenario_file(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios").join(path)
}

/// Random numbers of a test.
pub(crate) fn random(seed: u64) -> Stream {
    RunSeed(seed).stream(Purpose::Episode, 0, 0)
}

/// A random pose in a world's bounds.
pub(crate) fn random_pose(world: &World, random: &mut Stream) -> Pose<f32> {
    let ([x0, y0], [x1, y1]) = (world.bounds.min, world.bounds.max);
    Pose::new(random.within(x0, x1), random.within(y0, y1), random.within(-PI, PI))
}

/// A random ray from a place that is not inside an obstacle.
pub(crate) fn random_ray(world: &World, random: &mut Stream) -> Ray<f32> {
    loop {
        let pose = random_pose(world, random);
        if !world.is_inside_obstacle([pose.x, pose.y]) {
            return Ray { origin: (pose.x, pose.y), direction: (pose.cos, pose.sin) };
        }
    }
}

/// A brain that follows a script instead of a network.
pub(crate) struct Script<F>(pub(crate) F);

impl<F: FnMut(&Reading) -> Command> Decide for Script<F> {
    fn decide(&mut self, reading: Result<&Reading, ReadingError>) -> Command {
        reading.map_or(Command::STOP, &mut self.0)
    }
}

impl<F: FnMut(&Reading) -> Command> Brain for Script<F> {
    fn reset(&mut self) {}

    fn hidden(&self) -> Vec<f32> {
        Vec::new()
    }

    fn outputs(&self, _: &[f32; INPUTS], _: &[f32]) -> Option<Vec<f32>> {
        None
    }
}

/// Steer this way and drive this far, radians and metres.
pub(crate) fn command(steer: f32, step: f32) -> Command {
    Command { steer: SteerAngle::from_radians(steer), step: StepLength::from_metres(step) }
}

/// Always the same command.
pub(crate) fn always(steer: f32, step: f32) -> impl Brain {
    Script(move |_: &Reading| command(steer, step))
}

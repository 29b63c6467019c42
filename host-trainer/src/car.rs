//! The simulated car: beams in, motion out, through the same control loop as a real one.

mod misreading;
mod model;

use crate::scenario::{Scenario, StepLength, VehicleSpec};
use crate::seed::Stream;
use crate::world::{Glance, Lookout, World, distance};
use controller_core::actuator::Actuator;
use controller_core::control_loop::{Actuate, Sense};
use controller_core::controller::{Command, Scaling};
use controller_core::geometry::{Body, Disc};
use controller_core::motion::Pose;
use controller_core::observation::{BEAMS, Echo, Reading, ReadingError};
use std::convert::Infallible;

pub(crate) use misreading::Misreading;
pub use model::CarModel;
pub(crate) use model::Exemplar;
use model::Hit;

/// The car's body around its front axle.
pub fn body_of(vehicle: &VehicleSpec) -> Body<f32> {
    Body {
        rear: vehicle.front_overhang - vehicle.length,
        front: vehicle.front_overhang,
        half_width: vehicle.width * 0.5,
    }
}

/// How the network's inputs and outputs relate to the scenario's car.
pub fn scaling_of(scenario: &Scenario) -> Scaling {
    let (step_lower, step_upper) = match scenario.vehicle.step {
        StepLength::Constant(step) => (step, step),
        StepLength::Variable { lower, upper } => (lower, upper),
    };
    Scaling {
        encoding: scenario.sensors.encoding,
        range: scenario.sensors.range,
        steer_limit: scenario.vehicle.steer_limit,
        step_lower,
        step_upper,
    }
}

/// A car on its way through a world.
#[derive(Debug)]
pub struct SimulatedCar<'a> {
    world: &'a World,
    lookout: &'a Lookout,
    model: &'a CarModel,
    target: Disc<f32>,
    pose: Pose<f32>,
    actuator: Actuator,
    exemplar: Exemplar,
    random: Stream,
    /// What the sensors last reported, noise included.
    pub reported: [Echo; BEAMS],
    /// Metres driven.
    pub path_length: f32,
    /// Control periods in which the body touched an obstacle.
    pub collisions: u32,
    /// Whether the last period ended in a collision.
    pub collided: bool,
    /// Whether the target has been touched.
    pub reached: bool,
    /// What the car did in the last period, after dead time and servo.
    pub done: Command,
}

impl<'a> SimulatedCar<'a> {
    /// A car at its start. `random` decides noise, dropped beams and the randomised vehicle.
    pub fn new(
        world: &'a World,
        lookout: &'a Lookout,
        model: &'a CarModel,
        start: Pose<f32>,
        goal: [f32; 2],
        mut random: Stream,
    ) -> Self {
        let exemplar = model.exemplar(&mut random);
        Self {
            world,
            lookout,
            model,
            target: Disc { centre: (goal[0], goal[1]), radius: world.target_radius },
            pose: start,
            actuator: model.actuator(),
            exemplar,
            random,
            reported: [Echo::Nothing; BEAMS],
            path_length: 0.0,
            collisions: 0,
            collided: false,
            reached: false,
            done: Command::STOP,
        }
    }

    /// Where the car stands.
    pub fn pose(&self) -> &Pose<f32> {
        &self.pose
    }

    /// Distance from the front axle to the middle of the target, metres.
    pub fn distance_to_target(&self) -> f32 {
        let (x, y) = self.target.centre;
        distance([self.pose.x, self.pose.y], [x, y])
    }

    /// What the beams see from here, without noise.
    pub fn echoes(&self) -> [Echo; BEAMS] {
        self.hits().map(echo)
    }

    fn hits(&self) -> [Hit<f32>; BEAMS] {
        let mut glance = Glance::<f32, 1, BEAMS>::default();
        self.lookout.look(self.model.fan(), &[self.pose], &[1], &mut glance);
        let Glance { rays: [rays], distances: [walls], .. } = glance;
        std::array::from_fn(|beam| {
            self.model.hit(walls[beam], rays.ray(beam).to_disc(&self.target))
        })
    }
}

fn echo(hit: Hit<f32>) -> Echo {
    match hit {
        Hit { target: true, distance, .. } => Echo::Target(distance),
        Hit { wall: true, distance, .. } => Echo::Wall(distance),
        Hit { .. } => Echo::Nothing,
    }
}

impl Sense for SimulatedCar<'_> {
    fn sense(&mut self) -> Result<Reading, ReadingError> {
        let mut hits = self.hits();
        if self.model.is_disturbed() {
            let Misreading { error } = self.model.misreading(&mut self.random);
            for (hit, error) in hits.iter_mut().zip(error) {
                *hit = self.model.misread(*hit, error);
            }
        }
        self.reported = hits.map(echo);
        Reading::new(self.reported.map(Some), 0, self.model.range())
    }
}

impl Actuate for SimulatedCar<'_> {
    type Error = Infallible;

    /// Moves one control period. Whether the drive goes on is the caller's business.
    fn actuate(&mut self, command: Command) -> Result<(), Infallible> {
        self.done = self.actuator.act(command);
        let steer = self.done.steer.radians() + self.exemplar.steer_offset;
        let step = self.done.step.metres() * self.exemplar.step_scale;
        let Pose { x, y, .. } = self.pose;
        let moved = self.pose.driven(steer, step, self.exemplar.wheelbase);
        // A blocked car turns on the spot, and its body may come to lie across a wall; from
        // there, a step could end on the far side of it.
        self.collided = self.lookout.touches(self.model.body(), &[moved], &[1]) != [0]
            || (self.collided && self.world.separates([x, y], [moved.x, moved.y]));
        if self.collided {
            self.collisions += 1;
            self.pose = moved.held_at(&self.pose);
        } else {
            self.pose = moved;
            self.path_length += step;
        }
        let ended = self.collided && self.model.stops_on_collision();
        self.reached = !ended && self.model.touches_target(&self.pose, &self.target);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::{find, load};
    use crate::seed::{Purpose, RunSeed};

    #[test]
    fn what_is_drawn_does_not_depend_on_what_is_seen() {
        let mut scenario = load(&find("open").unwrap(), None, &[]).unwrap();
        (scenario.sensors.noise, scenario.sensors.dropout) = (0.02, 0.1);
        scenario.sensors.range = 2.0;
        let (world, model) = (World::new(&scenario).unwrap(), CarModel::new(&scenario));
        let lookout = model.lookout(&world);
        let next_word_from = |start: [f32; 2]| {
            let pose = Pose::new(start[0], start[1], 0.0);
            let random = RunSeed(1).stream(Purpose::Episode, 0, 0);
            let mut car = SimulatedCar::new(&world, &lookout, &model, pose, [9.0, 9.0], random);
            let seeing = car.echoes().iter().filter(|echo| **echo != Echo::Nothing).count();
            car.sense().unwrap();
            (seeing, car.random.word())
        };
        let (nothing, from_the_middle) = next_word_from([5.0, 5.0]);
        let (something, from_the_wall) = next_word_from([9.0, 5.0]);
        assert!(nothing == 0 && something > 0, "{nothing}, {something}");
        assert_eq!(from_the_middle, from_the_wall);
    }
}

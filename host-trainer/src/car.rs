//! The simulated car: beams in, motion out, through the same control loop as a real one.

use crate::scenario::{
    OnCollision, RandomiseSpec, ReachedBy, Scenario, SensorSpec, StepLength, VehicleSpec,
};
use crate::seed::Stream;
use crate::world::{World, distance};
use controller_core::actuator::Actuator;
use controller_core::control_loop::{Actuate, Sense};
use controller_core::controller::{Command, Scaling};
use controller_core::geometry::{Body, Disc, Ray};
use controller_core::motion::Pose;
use controller_core::observation::{BEAMS, BeamMount, Echo, Reading, ReadingError};
use controller_core::trig::sin_cos;
use std::convert::Infallible;

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

/// Everything about the car that does not change during a drive.
#[derive(Clone, Debug)]
pub struct CarModel {
    body: Body<f32>,
    wheelbase: f32,
    actuator: Actuator,
    beams: [Beam; BEAMS],
    range: f32,
    noise: f32,
    dropout: f32,
    on_collision: OnCollision,
    reached_by: ReachedBy,
    randomise: RandomiseSpec,
}

/// A beam's mount, ready to be turned by the car's heading.
#[derive(Clone, Copy, Debug)]
struct Beam {
    x: f32,
    y: f32,
    cos: f32,
    sin: f32,
}

impl From<&BeamMount> for Beam {
    fn from(mount: &BeamMount) -> Self {
        let (sin, cos) = sin_cos(mount.angle);
        Self { x: mount.x, y: mount.y, cos, sin }
    }
}

impl CarModel {
    /// The scenario's car.
    pub fn new(scenario: &Scenario) -> Self {
        let Scenario { vehicle, sensors, episode, .. } = scenario;
        let SensorSpec { beams, range, noise, dropout, .. } = sensors;
        let turn_per_period = vehicle.servo_rate.map(|rate| rate * episode.period);
        Self {
            body: body_of(vehicle),
            wheelbase: vehicle.wheelbase,
            actuator: Actuator::new(usize::from(vehicle.delay_periods), turn_per_period),
            beams: beams.each_ref().map(Beam::from),
            range: *range,
            noise: *noise,
            dropout: *dropout,
            on_collision: episode.on_collision,
            reached_by: episode.reached_by,
            randomise: episode.randomise,
        }
    }

    /// The body around the front axle.
    pub fn body(&self) -> &Body<f32> {
        &self.body
    }
}

/// A car on its way through a world.
#[derive(Debug)]
pub struct SimulatedCar<'a> {
    world: &'a World,
    model: &'a CarModel,
    target: Disc<f32>,
    pose: Pose<f32>,
    actuator: Actuator,
    wheelbase: f32,
    step_scale: f32,
    steer_offset: f32,
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
        model: &'a CarModel,
        start: Pose<f32>,
        goal: [f32; 2],
        mut random: Stream,
    ) -> Self {
        let mut scale = |half_width: f32| match half_width {
            0.0 => 1.0,
            half_width => random.within(1.0 - half_width, 1.0 + half_width),
        };
        let wheelbase = model.wheelbase * scale(model.randomise.wheelbase);
        let step_scale = scale(model.randomise.step);
        let steer_offset = match model.randomise.steer_offset {
            0.0 => 0.0,
            most => random.within(-most, most),
        };
        Self {
            world,
            model,
            target: Disc { centre: (goal[0], goal[1]), radius: world.target_radius },
            pose: start,
            actuator: model.actuator.clone(),
            wheelbase,
            step_scale,
            steer_offset,
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
        self.model.beams.map(|beam| {
            let Pose { cos, sin, .. } = self.pose;
            let ray = Ray {
                origin: self.pose.to_world(beam.x, beam.y),
                direction: (cos * beam.cos - sin * beam.sin, sin * beam.cos + cos * beam.sin),
            };
            let wall = self.world.distance(&ray, self.model.range);
            let target = ray.to_disc(&self.target);
            // A wall wins a tie: nothing is seen through it.
            if target < wall && target <= self.model.range {
                Echo::Target(target)
            } else if wall <= self.model.range {
                Echo::Wall(wall)
            } else {
                Echo::Nothing
            }
        })
    }

    /// The same through an imperfect sensor.
    fn disturbed(&mut self, echo: Echo) -> Echo {
        let Self { model, random, .. } = self;
        let mut noisy = |distance: f32| match model.noise {
            0.0 => distance,
            sigma => (distance + sigma * random.normal()).clamp(0.0, model.range),
        };
        let echo = match echo {
            Echo::Nothing => Echo::Nothing,
            Echo::Wall(distance) => Echo::Wall(noisy(distance)),
            Echo::Target(distance) => Echo::Target(noisy(distance)),
        };
        if model.dropout > 0.0 && random.chance(model.dropout) { Echo::Nothing } else { echo }
    }

    fn touches_target(&self) -> bool {
        match self.model.reached_by {
            ReachedBy::Body => self.model.body.touches_disc(&self.pose, &self.target),
            ReachedBy::ReferencePoint => self.distance_to_target() <= self.target.radius,
        }
    }
}

impl Sense for SimulatedCar<'_> {
    fn sense(&mut self) -> Result<Reading, ReadingError> {
        self.reported = self.echoes().map(|echo| self.disturbed(echo));
        Reading::new(self.reported.map(Some), 0, self.model.range)
    }
}

impl Actuate for SimulatedCar<'_> {
    type Error = Infallible;

    /// Moves one control period. Whether the drive goes on is the caller's business.
    fn actuate(&mut self, command: Command) -> Result<(), Infallible> {
        self.done = self.actuator.act(command);
        let steer = self.done.steer.radians() + self.steer_offset;
        let step = self.done.step.metres() * self.step_scale;
        let Pose { x, y, .. } = self.pose;
        let moved = self.pose.driven(steer, step, self.wheelbase);
        // A blocked car turns on the spot, and its body may come to lie across a wall; from
        // there, a step could end on the far side of it.
        self.collided = self.world.touches(&self.model.body, &moved)
            || (self.collided && self.world.separates([x, y], [moved.x, moved.y]));
        if self.collided {
            self.collisions += 1;
            self.pose = moved.held_at(&self.pose);
        } else {
            self.pose = moved;
            self.path_length += step;
        }
        let ended = self.collided && self.model.on_collision == OnCollision::Stop;
        self.reached = !ended && self.touches_target();
        Ok(())
    }
}

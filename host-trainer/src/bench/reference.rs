//! The same workload with parry2d for eyes and bumpers: what a step costs without beams and
//! contacts of our own, and whether theirs agree with ours.
//!
//! A program that takes what is there casts a ray at a `Polyline` for each beam and asks for an
//! intersection with a `Cuboid` for the body. Everything else, the network above all, is
//! [`episode`](crate::episode)'s own.

use super::speed::Measurement;
use super::workload;
use crate::brain::Brain;
use crate::car::CarModel;
use crate::problem::Problem;
use crate::scenario::Pair;
use controller_core::control_loop::{Actuate, Sense, tick};
use controller_core::controller::Command;
use controller_core::geometry::{Body, Disc, Ray, Segment};
use controller_core::motion::Pose;
use controller_core::observation::{BEAMS, Echo, Reading, ReadingError};
use parry2d::math::{Pose as At, Vector};
use parry2d::query::{self, RayCast};
use parry2d::shape::{Ball, Cuboid, Polyline};
use rayon::prelude::*;
use std::convert::Infallible;
use std::time::Instant;

/// Walls, and the body of a car among them, in parry2d's types.
pub struct Reference {
    walls: Polyline,
    body: Cuboid,
    /// Metres from the front axle to the body's middle.
    middle: f32,
}

impl Reference {
    /// Builds parry2d's tree over the walls.
    pub fn new(walls: &[Segment<f32>], body: &Body<f32>) -> Self {
        let ends = |wall: &Segment<f32>| [point(wall.a), point(wall.b)];
        let indices = (0..walls.len() as u32).map(|wall| [2 * wall, 2 * wall + 1]);
        Self {
            walls: Polyline::new(walls.iter().flat_map(ends).collect(), Some(indices.collect())),
            body: Cuboid::new(Vector::new((body.front - body.rear) * 0.5, body.half_width)),
            middle: (body.front + body.rear) * 0.5,
        }
    }

    /// Distance along the ray to the nearest wall, metres; infinity if there is none within
    /// `range`.
    pub fn distance(&self, ray: &Ray<f32>, range: f32) -> f32 {
        self.walls.cast_local_ray(&cast(ray), range, true).unwrap_or(f32::INFINITY)
    }

    /// Whether the body at this pose touches a wall.
    pub fn touches(&self, pose: &Pose<f32>) -> bool {
        let at = At::new(point(pose.to_world(self.middle, 0.0)), pose.heading);
        let met = query::intersection_test(&at, &self.body, &At::IDENTITY, &self.walls);
        met.is_ok_and(|met| met.intersecting)
    }
}

fn point((x, y): (f32, f32)) -> Vector {
    Vector::new(x, y)
}

fn cast(ray: &Ray<f32>) -> query::Ray {
    query::Ray::new(point(ray.origin), point(ray.direction))
}

/// A car that asks parry2d. It has the scenario's body and beams; servo, dead time and noise,
/// which the workload does not have, are left out.
struct ReferenceCar<'a> {
    reference: &'a Reference,
    model: &'a CarModel,
    wheelbase: f32,
    pose: Pose<f32>,
    target: Disc<f32>,
    collided: bool,
    reached: bool,
}

impl<'a> ReferenceCar<'a> {
    fn new(reference: &'a Reference, problem: &'a Problem, pair: &Pair) -> Self {
        let [x, y, heading] = pair.start;
        Self {
            reference,
            model: problem.model(),
            wheelbase: problem.scenario.vehicle.wheelbase,
            pose: Pose::new(x, y, heading),
            target: Disc { centre: pair.goal.into(), radius: problem.world.target_radius },
            collided: false,
            reached: false,
        }
    }

    fn echoes(&self) -> [Echo; BEAMS] {
        let ball = Ball::new(self.target.radius);
        let at = At::translation(self.target.centre.0, self.target.centre.1);
        let range = self.model.range();
        self.model.fan().rays(&self.pose).map(|ray| {
            let wall = self.reference.distance(&ray, range);
            // A target around the beam's start is hit at 0, and is not seen from inside.
            let target = ball.cast_ray(&at, &cast(&ray), range, true).filter(|hit| *hit > 0.0);
            match target {
                Some(target) if target < wall => Echo::Target(target),
                _ if wall <= range => Echo::Wall(wall),
                _ => Echo::Nothing,
            }
        })
    }
}

impl Sense for ReferenceCar<'_> {
    fn sense(&mut self) -> Result<Reading, ReadingError> {
        Reading::new(self.echoes().map(Some), 0, self.model.range())
    }
}

impl Actuate for ReferenceCar<'_> {
    type Error = Infallible;

    fn actuate(&mut self, command: Command) -> Result<(), Infallible> {
        let moved =
            self.pose.driven(command.steer.radians(), command.step.metres(), self.wheelbase);
        self.collided = self.reference.touches(&moved);
        self.pose = if self.collided { moved.held_at(&self.pose) } else { moved };
        self.reached = !self.collided && self.model.touches_target(&self.pose, &self.target);
        Ok(())
    }
}

/// Drives the workload on the current rayon pool, as [`speed::generation`](super::speed::generation)
/// does: with the same steps, but each car alone and with parry2d.
pub fn generation(problem: &Problem, reference: &Reference, genomes: &[f32]) -> Measurement {
    let begun = Instant::now();
    let one = |genome: &[f32]| {
        let mut brain = problem.brain(genome).expect("the workload's topology");
        let drives = workload::pairs(problem).iter();
        drives.map(|pair| drive(problem, reference, brain.as_mut(), pair)).sum::<u64>()
    };
    let steps = genomes.par_chunks(problem.topology().weights()).map(one).sum();
    Measurement { steps, time: begun.elapsed() }
}

/// Drives a pair again and again until the step limit; returns the steps.
fn drive(problem: &Problem, reference: &Reference, brain: &mut dyn Brain, pair: &Pair) -> u64 {
    let start = || ReferenceCar::new(reference, problem, pair);
    let mut car = start();
    brain.reset();
    let limit = problem.scenario.episode.step_limit;
    for _ in 0..limit {
        // A simulated reading is always good and a simulated actuator never refuses.
        let _ = tick(&mut car, brain);
        if car.collided || car.reached {
            car = start();
            brain.reset();
        }
    }
    limit.into()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::episode::Step;
    use crate::problem::training_drive;
    use crate::seed::RunSeed;

    /// Most that a distance may differ by, metres.
    const TOLERANCE: f32 = 2e-4;

    /// Every step of the first drives of some individuals, with the pair it belongs to.
    fn steps(problem: &Problem) -> Vec<(&Pair, Step)> {
        let genomes = workload::population(40);
        let mut steps = Vec::new();
        for genome in genomes.chunks(problem.topology().weights()) {
            let mut brain = problem.brain(genome).unwrap();
            for pair in workload::pairs(problem) {
                let random = training_drive(RunSeed(1), 0, 0);
                let (_, trace) = problem.drive_traced(brain.as_mut(), pair, random);
                steps.extend(trace.steps.into_iter().map(|step| (pair, step)));
            }
        }
        steps
    }

    fn number(echo: Echo, range: f32) -> f32 {
        match echo {
            Echo::Nothing => range,
            Echo::Wall(distance) | Echo::Target(distance) => distance,
        }
    }

    /// A beam at a corner may end before or behind it, and one that meets a wall at a shallow
    /// angle somewhat nearer or farther: so does ours when it is turned by a hair.
    fn is_doubtful(problem: &Problem, pose: &Pose<f32>, beam: usize, found: f32) -> bool {
        let distances = [-1e-4, 0.0, 1e-4].map(|turn| {
            let turned = Pose::new(pose.x, pose.y, pose.heading + turn);
            let ray = problem.model().fan().rays(&turned)[beam];
            problem.world.distance(&ray, 10.0).min(10.0)
        });
        let least = distances.into_iter().fold(f32::INFINITY, f32::min);
        let most = distances.into_iter().fold(0.0, f32::max);
        (least - TOLERANCE..=most + TOLERANCE).contains(&found)
    }

    #[test]
    fn parry2d_sees_and_touches_what_the_simulator_does() {
        let problem = workload::problem().unwrap();
        let body = *problem.model().body();
        let reference = Reference::new(problem.world.segments(), &body);
        let (mut contacts, mut doubtful) = (0, 0);
        let steps = steps(&problem);
        for (pair, Step { pose, echoes, command, collided, .. }) in &steps {
            let mut car = ReferenceCar::new(&reference, &problem, pair);
            car.pose = *pose;
            for (beam, (theirs, ours)) in car.echoes().into_iter().zip(*echoes).enumerate() {
                let [theirs, ours] = [theirs, ours].map(|echo| number(echo, 10.0));
                if (theirs - ours).abs() > TOLERANCE {
                    doubtful += 1;
                    assert!(is_doubtful(&problem, pose, beam, theirs), "{pose:?} beam {beam}");
                }
            }
            let Ok(()) = car.actuate(*command);
            contacts += usize::from(*collided);
            if car.collided != *collided {
                let moved = pose.driven(command.steer.radians(), command.step.metres(), 0.3);
                let with = |more: f32| Body {
                    rear: body.rear - more,
                    front: body.front + more,
                    half_width: body.half_width + more,
                };
                let [more, less] =
                    [3e-4, -3e-4].map(|more| problem.world.touches(&with(more), &moved));
                assert!(more && !less, "{moved:?}: parry2d says {}", car.collided);
            }
        }
        assert!(steps.len() > 4000 && contacts > 100, "{} steps, {contacts}", steps.len());
        // Of five beams each.
        assert!(doubtful * 100 < steps.len(), "{doubtful} beams in {} steps", steps.len());
    }

    #[test]
    fn a_generation_makes_every_step_whatever_happens_on_the_way() {
        let problem = workload::problem().unwrap();
        let reference = Reference::new(problem.world.segments(), problem.model().body());
        let measurement = generation(&problem, &reference, &workload::population(2));
        assert_eq!(measurement.steps, 2 * 5 * 300);
    }
}

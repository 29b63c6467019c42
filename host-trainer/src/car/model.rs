//! What does not change about the car during a drive, and what follows from it: for one car or,
//! over wide lanes, for many at once.

use super::body_of;
use crate::scenario::{OnCollision, RandomiseSpec, ReachedBy, Scenario, SensorSpec};
use crate::seed::Stream;
use crate::world::{Fan, Lookout, World};
use controller_core::actuator::Actuator;
use controller_core::geometry::{Body, Disc};
use controller_core::lane::Lane;
use controller_core::motion::Pose;

/// Everything about the car that does not change during a drive.
#[derive(Clone, Debug)]
pub struct CarModel {
    body: Body<f32>,
    wheelbase: f32,
    delay: usize,
    turn_per_period: Option<f32>,
    fan: Fan,
    /// Standard deviation of a distance, metres.
    pub(super) noise: f32,
    /// Probability that a beam sees nothing.
    pub(super) dropout: f32,
    on_collision: OnCollision,
    reached_by: ReachedBy,
    randomise: RandomiseSpec,
}

/// How one car differs from the described one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Exemplar {
    /// Metres between the axles.
    pub(crate) wheelbase: f32,
    /// What a step's length is multiplied by.
    pub(crate) step_scale: f32,
    /// What is added to every steer angle, radians.
    pub(crate) steer_offset: f32,
}

/// What a beam ends on, for any number of cars.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hit<L: Lane> {
    /// On the target.
    pub(crate) target: L::Mask,
    /// On an obstacle.
    pub(crate) wall: L::Mask,
    /// Metres to where it ends, or the range where it meets neither.
    pub(crate) distance: L,
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
            delay: usize::from(vehicle.delay_periods),
            turn_per_period,
            fan: Fan::new(beams, *range),
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

    /// Longest distance a beam reports, metres.
    pub(crate) fn range(&self) -> f32 {
        self.fan.range()
    }

    /// Control periods between deciding and acting.
    pub(crate) fn delay(&self) -> usize {
        self.delay
    }

    /// Most that the wheels turn in a control period, radians; none if they turn at once.
    pub(crate) fn turn_per_period(&self) -> Option<f32> {
        self.turn_per_period
    }

    /// Whether a collision ends a drive.
    pub(crate) fn stops_on_collision(&self) -> bool {
        self.on_collision == OnCollision::Stop
    }

    /// Whether a reading depends on chance.
    pub(crate) fn is_disturbed(&self) -> bool {
        self.noise != 0.0 || self.dropout > 0.0
    }

    /// Servo and dead time at the start of a drive.
    pub(super) fn actuator(&self) -> Actuator {
        Actuator::new(self.delay, self.turn_per_period)
    }

    /// One car among those that the scenario allows.
    pub(crate) fn exemplar(&self, random: &mut Stream) -> Exemplar {
        let mut scale = |half_width: f32| match half_width {
            0.0 => 1.0,
            half_width => random.within(1.0 - half_width, 1.0 + half_width),
        };
        let wheelbase = self.wheelbase * scale(self.randomise.wheelbase);
        let step_scale = scale(self.randomise.step);
        let steer_offset = match self.randomise.steer_offset {
            0.0 => 0.0,
            most => random.within(-most, most),
        };
        Exemplar { wheelbase, step_scale, steer_offset }
    }

    /// The world as this car sees and touches it.
    pub fn lookout(&self, world: &World) -> Lookout {
        world.lookout(self.range(), self.body)
    }

    /// The car's beams.
    pub(crate) fn fan(&self) -> &Fan {
        &self.fan
    }

    /// What beams end on whose nearest obstacle is at `wall` and whose target at `target`,
    /// metres. A wall wins a tie: nothing is seen through it.
    #[inline(always)]
    pub(crate) fn hit<L: Lane>(&self, wall: L, target: L) -> Hit<L> {
        let range = L::from(self.range());
        let on_target = target.lt(wall) & target.le(range);
        let on_wall = wall.le(range) & !on_target;
        let distance = L::select(on_target, target, L::select(on_wall, wall, range));
        Hit { target: on_target, wall: on_wall, distance }
    }

    /// Whether cars at these poses have reached their targets.
    #[inline(always)]
    pub(crate) fn touches_target<L: Lane>(&self, pose: &Pose<L>, target: &Disc<L>) -> L::Mask {
        match self.reached_by {
            ReachedBy::Body => {
                let Body { rear, front, half_width } = self.body;
                let body = Body {
                    rear: L::from(rear),
                    front: L::from(front),
                    half_width: L::from(half_width),
                };
                body.touches_disc(pose, target)
            }
            ReachedBy::ReferencePoint => {
                let (dx, dy) = (pose.x - target.centre.0, pose.y - target.centre.1);
                (dx * dx + dy * dy).sqrt().le(target.radius)
            }
        }
    }
}

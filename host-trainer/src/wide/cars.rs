//! One car in each lane: what they see, and how they move.

use super::starts::Start;
use super::tape::Source;
use crate::car::{CarModel, Misreading};
use crate::episode::Outcome;
use crate::seed::Stream;
use crate::vector::{Vector, ones};
use crate::world::{Rays, World, distance};
use controller_core::actuator::turned;
use controller_core::geometry::Disc;
use controller_core::motion::Pose;
use controller_core::observation::{BEAMS, Sight};

/// Cars side by side. Lanes without a drive hold a car that stands still; nobody asks it.
#[derive(Debug)]
pub(super) struct Cars<'a, V> {
    pub(super) pose: Pose<V>,
    target: Disc<V>,
    /// How far the target is along each beam, metres.
    to_target: [V; BEAMS],
    wheelbase: V,
    step_scale: V,
    steer_offset: V,
    steer: V,
    /// Commands on their way to the wheels and the motor, as many as the dead time has periods.
    waiting: Vec<[V; 2]>,
    due: usize,
    path_length: V,
    collisions: V,
    /// 1 where the last period ended in a collision, else 0.
    blocked: V,
    /// Where noise and dropped beams come from, and what they are in this period.
    source: Source<'a>,
    misreading: Misreading<V>,
    /// Lanes with a drive, as bits.
    pub(super) live: u32,
}

/// Which cars' period ended how, as bits.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ends {
    /// In a collision.
    pub(super) collided: u32,
    /// At the target.
    pub(super) reached: u32,
}

impl<'a, V: Vector> Cars<'a, V> {
    /// Cars of this model that stand somewhere and whose sensors are disturbed by that source.
    pub(super) fn new(model: &CarModel, target_radius: f32, source: Source<'a>) -> Self {
        let zero = V::from(0.0);
        let one = V::from(1.0);
        Self {
            pose: Pose { x: zero, y: zero, heading: zero, cos: one, sin: zero },
            target: Disc { centre: (zero, zero), radius: V::from(target_radius) },
            to_target: [zero; BEAMS],
            wheelbase: one,
            step_scale: one,
            steer_offset: zero,
            steer: zero,
            waiting: vec![[zero; 2]; model.delay()],
            due: 0,
            path_length: zero,
            collisions: zero,
            blocked: zero,
            source,
            misreading: Misreading { error: [zero; BEAMS] },
            live: 0,
        }
    }

    /// Puts a car at its start, from where it drives this pair of the fleet to its goal.
    pub(super) fn put(
        &mut self,
        lane: usize,
        Start { pose, exemplar }: &Start,
        (pair, goal): (usize, [f32; 2]),
        random: impl FnOnce() -> Stream,
    ) {
        let numbers = [
            pose.x,
            pose.y,
            pose.heading,
            pose.cos,
            pose.sin,
            goal[0],
            goal[1],
            exemplar.wheelbase,
            exemplar.step_scale,
            exemplar.steer_offset,
            0.0,
            0.0,
            0.0,
            0.0,
        ];
        for (place, number) in self.numbers().into_iter().zip(numbers) {
            place.lanes_mut()[lane] = number;
        }
        for value in self.waiting.iter_mut().flatten() {
            value.lanes_mut()[lane] = 0.0;
        }
        self.source.begin(lane, pair, random);
        self.live |= 1 << lane;
    }

    /// Every number of a car but for the commands on their way.
    #[inline(always)]
    fn numbers(&mut self) -> [&mut V; 14] {
        let Self { pose, target, .. } = self;
        [
            &mut pose.x,
            &mut pose.y,
            &mut pose.heading,
            &mut pose.cos,
            &mut pose.sin,
            &mut target.centre.0,
            &mut target.centre.1,
            &mut self.wheelbase,
            &mut self.step_scale,
            &mut self.steer_offset,
            &mut self.steer,
            &mut self.path_length,
            &mut self.collisions,
            &mut self.blocked,
        ]
    }

    /// Has the car in a lane go on in a lane of others of the same model.
    pub(super) fn shift(&mut self, lane: usize, others: &mut Self, to: usize) {
        for (place, number) in others.numbers().into_iter().zip(self.numbers()) {
            place.lanes_mut()[to] = number.lanes()[lane];
        }
        // Others may have stood still meanwhile: what is due next is in another place there.
        let periods = self.waiting.len();
        for later in 0..periods {
            let commands = &self.waiting[(self.due + later) % periods];
            let places = &mut others.waiting[(others.due + later) % periods];
            for (place, command) in places.iter_mut().zip(commands) {
                place.lanes_mut()[to] = command.lanes()[lane];
            }
        }
        self.source.shift(lane, &mut others.source, to);
        self.live &= !(1 << lane);
        others.live |= 1 << to;
    }

    /// How the drive in this lane has gone so far.
    pub(super) fn outcome(&self, lane: usize, steps: u32, reached: bool) -> Outcome {
        let at = |(x, y): (V, V)| [x.lanes()[lane], y.lanes()[lane]];
        let end = at((self.pose.x, self.pose.y));
        Outcome {
            reached,
            collisions: self.collisions.lanes()[lane] as u32,
            steps,
            path_length: self.path_length.lanes()[lane],
            distance_to_target: distance(end, at(self.target.centre)),
            end,
        }
    }

    /// Where the car in this lane stands.
    #[cfg(test)]
    pub(super) fn pose_of(&self, lane: usize) -> Pose<f32> {
        crate::vector::pose_in_lane(&self.pose, lane)
    }

    /// Draws or looks up what the beams will misread in this period.
    #[inline(never)]
    pub(super) fn misread(&mut self, model: &CarModel) {
        let error = &mut self.misreading.error;
        self.source.next(self.live, model, |lane, misreading| {
            for (all, error) in error.iter_mut().zip(misreading.error) {
                all.lanes_mut()[lane] = error;
            }
        });
    }

    /// Finds out how far the target is along these beams.
    #[inline(always)]
    pub(super) fn aim(&mut self, rays: &Rays<V>) {
        for (beam, distance) in self.to_target.iter_mut().enumerate() {
            *distance = rays.ray(beam).to_disc(&self.target);
        }
    }

    /// What the beams report that meet walls at these distances.
    #[inline(always)]
    pub(super) fn sense(&self, model: &CarModel, walls: &[V; BEAMS]) -> Sight<V> {
        let (zero, one) = (V::from(0.0), V::from(1.0));
        let mut sight =
            Sight { distance: [zero; BEAMS], wall: [zero; BEAMS], target: [zero; BEAMS] };
        for (beam, (wall, target)) in walls.iter().zip(self.to_target).enumerate() {
            let mut hit = model.hit(*wall, target);
            if model.is_disturbed() {
                hit = model.misread(hit, self.misreading.error[beam]);
            }
            sight.distance[beam] = hit.distance;
            sight.wall[beam] = V::select(hit.wall, one, zero);
            sight.target[beam] = V::select(hit.target, one, zero);
        }
        sight
    }

    /// Where cars come to stand that follow these commands, steer angles and step lengths, and how
    /// far they drive.
    #[inline(always)]
    pub(super) fn driven(
        &mut self,
        (mut angle, mut length): (V, V),
        model: &CarModel,
    ) -> (Pose<V>, V) {
        if let Some(waiting) = self.waiting.get_mut(self.due) {
            let [due_angle, due_length] = *waiting;
            *waiting = [angle, length];
            (angle, length) = (due_angle, due_length);
            self.due = (self.due + 1) % self.waiting.len();
        }
        self.steer = match model.turn_per_period() {
            None => angle,
            Some(most) => turned(self.steer, angle, most),
        };
        let step = length * self.step_scale;
        (self.pose.driven(self.steer + self.steer_offset, step, self.wheelbase), step)
    }

    /// Puts cars there, or holds those that touch something there.
    #[inline(always)]
    pub(super) fn act(
        &mut self,
        (moved, step): (&Pose<V>, V),
        mut hits: u32,
        model: &CarModel,
        world: &World,
    ) -> Ends {
        let zero = V::from(0.0);
        let was_blocked = V::bits(zero.lt(self.blocked));
        // A blocked car may jump over a wall that its body lies across.
        for lane in ones(was_blocked & self.live & !hits) {
            let at = |pose: &Pose<V>| [pose.x.lanes()[lane], pose.y.lanes()[lane]];
            hits |= u32::from(world.separates(at(&self.pose), at(moved))) << lane;
        }
        let mut blocked = zero;
        for lane in ones(hits) {
            blocked.lanes_mut()[lane] = 1.0;
        }
        self.blocked = blocked;
        let collided = zero.lt(blocked);
        self.collisions = self.collisions + blocked;
        self.path_length = V::select(collided, self.path_length, self.path_length + step);
        self.pose.x = V::select(collided, self.pose.x, moved.x);
        self.pose.y = V::select(collided, self.pose.y, moved.y);
        (self.pose.heading, self.pose.cos, self.pose.sin) = (moved.heading, moved.cos, moved.sin);
        let mut reached = V::bits(model.touches_target(&self.pose, &self.target));
        let collided = V::bits(zero.lt(self.blocked)) & self.live;
        if model.stops_on_collision() {
            reached &= !collided;
        }
        Ends { collided, reached: reached & self.live }
    }
}

//! A block of cars: lanes for individuals, slots for their drives.

use super::cars::Cars;
use super::forward::Networks;
use super::queue::{Job, Queue};
use super::tape::Tapes;
use super::{Done, Fleet, SLOTS, Tally};
use crate::car::CarModel;
use crate::episode::{Outcome, start_pose};
use crate::vector::{Vector, ones};
use controller_core::observation::BEAMS;

/// The cars of one thread.
pub(super) struct Block<'a, V> {
    fleet: &'a Fleet<'a>,
    queue: &'a Queue<'a>,
    networks: Networks<V>,
    cars: [Cars<'a, V>; SLOTS],
    /// Of each lane: what is left of its job.
    jobs: Vec<Job>,
    /// Of each slot and lane.
    drives: Vec<[Drive; SLOTS]>,
    /// Control periods since the block began.
    clock: u64,
    /// The earliest control period in which a drive's time is up.
    next_deadline: u64,
    /// Whether a lane may have something to fill it with.
    has_room: bool,
    outcomes: Vec<(usize, Outcome)>,
    tally: Tally,
}

/// What a car is doing.
#[derive(Clone, Debug, Default)]
struct Drive {
    pair: usize,
    begun: u64,
    deadline: u64,
    /// The first outcome of a drive that is driven again.
    first: Option<Outcome>,
}

impl<'a, V: Vector> Block<'a, V> {
    /// A block without drives.
    pub(super) fn new(fleet: &'a Fleet<'a>, queue: &'a Queue<'a>, tapes: &'a Tapes) -> Self {
        let problem = fleet.problem;
        let (model, radius) = (problem.model(), problem.world.target_radius);
        let cars = || Cars::new(model, radius, tapes.source(model, V::WIDTH));
        Self {
            fleet,
            queue,
            networks: Networks::new(problem.topology(), problem.activation()),
            cars: [(); SLOTS].map(|()| cars()),
            jobs: vec![Job::default(); V::WIDTH],
            drives: (0..V::WIDTH).map(|_| Default::default()).collect(),
            clock: 0,
            next_deadline: u64::MAX,
            has_room: true,
            outcomes: Vec::with_capacity(fleet.individuals() * fleet.pairs.len()),
            tally: Tally::default(),
        }
    }

    /// What was driven.
    pub(super) fn done(self) -> Done {
        (self.outcomes, self.tally)
    }

    /// Gives every idle car something to do, if there is anything. False once all is done.
    #[inline(always)]
    pub(super) fn fill(&mut self) -> bool {
        if self.has_room {
            self.refill();
        }
        let mut live = 0;
        for cars in &self.cars {
            live |= cars.live;
        }
        live != 0 && !self.queue.is_stopped()
    }

    #[inline(never)]
    fn refill(&mut self) {
        self.has_room = false;
        for lane in 0..V::WIDTH {
            for slot in 0..SLOTS {
                if self.cars[slot].live >> lane & 1 == 0
                    && let Some(pair) = self.next_pair(lane)
                {
                    let begun = self.clock;
                    let deadline =
                        begun + u64::from(self.fleet.problem.scenario.episode.step_limit);
                    self.drives[lane][slot] = Drive { pair, begun, deadline, first: None };
                    self.next_deadline = self.next_deadline.min(deadline);
                    self.start(lane, slot);
                }
            }
        }
    }

    /// What a lane drives next: its own job, more for the same individual, or, once its cars
    /// are all idle, another individual.
    fn next_pair(&mut self, lane: usize) -> Option<usize> {
        let job = &mut self.jobs[lane];
        if let Some(pair) = job.pairs.next() {
            return Some(pair);
        }
        let busy = self.cars.iter().any(|cars| cars.live >> lane & 1 == 1);
        *job = if busy { self.queue.take_more(job.individual)? } else { self.queue.take()? };
        if !busy {
            let length = self.fleet.problem.topology().weights();
            let start = job.individual * length;
            self.networks.load(lane, &self.fleet.genomes[start..start + length]);
        }
        job.pairs.next()
    }

    /// Puts a car at the start of its drive.
    fn start(&mut self, lane: usize, slot: usize) {
        let problem = self.fleet.problem;
        let model: &CarModel = problem.model();
        let index = self.drives[lane][slot].pair;
        let pair = &self.fleet.pairs[index];
        let mut random = (self.fleet.random)(index as u32);
        let spec = &problem.scenario.episode;
        let pose = start_pose(&problem.world, model, spec, pair, &mut random);
        let exemplar = model.exemplar(&mut random);
        self.cars[slot].put(lane, &pose, pair.goal, &exemplar, (index, random));
        self.networks.forget(slot, lane);
    }

    /// One control period of every car.
    #[inline(always)]
    pub(super) fn step(&mut self) {
        let problem = self.fleet.problem;
        let (model, world, scaling) = (problem.model(), &problem.world, problem.scaling());
        let (lookout, fan) = (problem.lookout(), model.fan());
        let mut poses = [self.cars[0].pose; SLOTS];
        let mut rays = [fan.rays(&poses[0]); SLOTS];
        let mut live = [0; SLOTS];
        for slot in 0..SLOTS {
            poses[slot] = self.cars[slot].pose;
            rays[slot] = fan.rays(&poses[slot]);
            live[slot] = self.cars[slot].live;
            if model.is_disturbed() {
                // Long before it is used: numbers written one by one take a while until they can
                // be read as a vector.
                self.cars[slot].misread(model);
            }
        }
        let walls = lookout.distances::<V, SLOTS, { SLOTS * BEAMS }>(fan, &poses, &rays, &live);
        for slot in 0..SLOTS {
            let sight = self.cars[slot].sense(model, &rays[slot], &walls[slot]);
            let inputs = scaling.encoding.inputs(&sight, scaling.range);
            for (all, input) in self.networks.inputs.iter_mut().zip(inputs) {
                all.0[slot] = input;
            }
        }
        self.networks.step();
        self.clock += 1;
        let [steer, speed] = self.networks.outputs;
        let has_speed = problem.topology().outputs == 2;
        let mut steps = [V::from(0.0); SLOTS];
        for slot in 0..SLOTS {
            let command = if has_speed {
                scaling.commands(&[steer.0[slot], speed.0[slot]])
            } else {
                scaling.commands(&[steer.0[slot]])
            };
            (poses[slot], steps[slot]) = self.cars[slot].driven(command, model);
        }
        let hits = lookout.touches(&poses, &live);
        for slot in 0..SLOTS {
            self.tally.steps += u64::from(live[slot].count_ones());
            let moved = (&poses[slot], steps[slot]);
            let ends = self.cars[slot].act(moved, hits[slot], model, world);
            let mut ended = ends.reached;
            if model.stops_on_collision() {
                ended |= ends.collided;
            }
            if ended != 0 {
                self.end(slot, ended, ends.reached);
            }
        }
        if self.clock >= self.next_deadline {
            self.end_overdue();
        }
    }

    /// Every car with a drive: the drive, its steps so far, pose and hidden outputs.
    #[cfg(test)]
    pub(super) fn look(
        &mut self,
    ) -> Vec<(usize, usize, controller_core::motion::Pose<f32>, Vec<f32>)> {
        let mut cars = Vec::new();
        for slot in 0..SLOTS {
            for lane in ones(self.cars[slot].live) {
                let drive = &self.drives[lane][slot];
                let index = self.jobs[lane].individual * self.fleet.pairs.len() + drive.pair;
                let (pose, hidden) =
                    (self.cars[slot].pose_of(lane), self.networks.hidden(slot, lane));
                cars.push((index, (self.clock - drive.begun) as usize, pose, hidden));
            }
        }
        cars
    }

    /// Ends drives, or begins them again.
    #[inline(never)]
    fn end(&mut self, slot: usize, ended: u32, reached: u32) {
        for lane in ones(ended) {
            let has_reached = reached >> lane & 1 == 1;
            self.tally.reached += u64::from(has_reached);
            self.tally.stopped += u64::from(!has_reached);
            let drive = &mut self.drives[lane][slot];
            let steps = (self.clock - drive.begun) as u32;
            let outcome = self.cars[slot].outcome(lane, steps, has_reached);
            let first = *drive.first.get_or_insert(outcome);
            if self.fleet.again && self.clock < drive.deadline {
                drive.begun = self.clock;
                self.start(lane, slot);
            } else {
                self.keep(lane, slot, first);
            }
        }
    }

    /// Ends drives whose time is up.
    #[inline(never)]
    fn end_overdue(&mut self) {
        self.next_deadline = u64::MAX;
        for slot in 0..SLOTS {
            for lane in ones(self.cars[slot].live) {
                let drive = &self.drives[lane][slot];
                if self.clock < drive.deadline {
                    self.next_deadline = self.next_deadline.min(drive.deadline);
                } else {
                    let steps = (self.clock - drive.begun) as u32;
                    let outcome = self.cars[slot].outcome(lane, steps, false);
                    let outcome = drive.first.unwrap_or(outcome);
                    self.keep(lane, slot, outcome);
                }
            }
        }
    }

    fn keep(&mut self, lane: usize, slot: usize, outcome: Outcome) {
        let pair = self.drives[lane][slot].pair;
        let index = self.jobs[lane].individual * self.fleet.pairs.len() + pair;
        self.outcomes.push((index, outcome));
        self.cars[slot].live &= !(1 << lane);
        self.has_room = true;
    }
}

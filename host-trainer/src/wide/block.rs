//! A block of cars: lanes for individuals, slots for their drives, as long as that keeps cars busy.

use super::cars::Cars;
use super::forward::Networks;
use super::queue::{Job, Queue};
use super::starts::{Starts, begin};
use super::{Done, Fleet, SLOTS, Tally, Work};
use crate::episode::Outcome;
use crate::vector::{Vector, ones};
use crate::world::Glance;
use controller_core::observation::BEAMS;

/// Once one in so many of all cars' control periods was waited for the rest of a lane, each car is
/// given weights of its own. These are more bytes to read: by measurement a period takes 5 to 15 %
/// longer.
const PATIENCE: u64 = 5;

/// The cars of one thread.
pub(super) struct Block<'a, V> {
    fleet: &'a Fleet<'a>,
    queue: &'a Queue<'a>,
    starts: &'a Starts,
    networks: Networks<V>,
    cars: [Cars<'a, V>; SLOTS],
    glance: Glance<V, SLOTS, { SLOTS * BEAMS }>,
    /// Of each lane and slot: whose weights its car has.
    individuals: Vec<[Option<usize>; SLOTS]>,
    /// Of each lane and slot.
    drives: Vec<[Drive; SLOTS]>,
    /// Control periods since the block began.
    clock: u64,
    /// The earliest control period in which a drive's time is up.
    next_deadline: u64,
    /// Whether an idle car may find something to drive.
    has_room: bool,
    /// Cars that are idle for no other reason than that others of their lane are not.
    waiting: usize,
    /// Control periods that cars have waited so, all together.
    waited: u64,
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
    pub(super) fn new(Work { fleet, queue, starts, tapes }: Work<'a>) -> Self {
        let problem = fleet.problem;
        let (model, radius) = (problem.model(), problem.world.target_radius);
        let cars = || Cars::new(model, radius, tapes.source(model, V::WIDTH));
        Self {
            fleet,
            queue,
            starts,
            networks: Networks::new(problem.topology(), problem.activation()),
            cars: [(); SLOTS].map(|()| cars()),
            glance: Glance::default(),
            individuals: vec![[None; SLOTS]; V::WIDTH],
            drives: (0..V::WIDTH).map(|_| Default::default()).collect(),
            clock: 0,
            next_deadline: u64::MAX,
            has_room: true,
            waiting: 0,
            waited: 0,
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
        if self.waiting > 0 {
            self.wait();
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
        let lanes = if self.queue.has_drives() { V::WIDTH } else { 0 };
        for lane in 0..lanes {
            for slot in 0..SLOTS {
                if self.cars[slot].live >> lane & 1 == 0
                    && let Some(pair) = self.next_pair(lane, slot)
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
        self.waiting = 0;
        if !self.queue.has_drives() {
            self.close_ranks();
        } else if self.networks.may_separate() {
            self.waiting = self.idle();
        }
    }

    /// What a car drives next: another pair for the individual whose weights it has, or, once
    /// all that share them are idle, one for another individual.
    fn next_pair(&mut self, lane: usize, slot: usize) -> Option<usize> {
        let individual = self.individuals[lane][slot];
        if let Some(pair) = individual.and_then(|individual| self.queue.take_more(individual)) {
            return Some(pair);
        }
        let sharing = self.networks.sharing(slot);
        if self.cars[sharing.clone()].iter().any(|cars| cars.live >> lane & 1 == 1) {
            return None;
        }
        let Job { individual, pair } = self.queue.take()?;
        self.individuals[lane][sharing].fill(Some(individual));
        let length = self.fleet.problem.topology().weights();
        let start = individual * length;
        self.networks.load(slot, lane, &self.fleet.genomes[start..start + length]);
        Some(pair)
    }

    fn idle(&self) -> usize {
        let live: u32 = self.cars.iter().map(|cars| cars.live.count_ones()).sum();
        SLOTS * V::WIDTH - live as usize
    }

    /// Lets cars wait for the rest of their lane, unless they have waited too much by now.
    fn wait(&mut self) {
        self.waited += self.waiting as u64;
        if self.waited * PATIENCE > (self.clock + 1) * (SLOTS * V::WIDTH) as u64 {
            self.separate();
        }
    }

    /// Gives each car weights of its own and whatever there is to drive.
    pub(super) fn separate(&mut self) {
        self.networks.separate();
        self.refill();
    }

    /// Once nothing is left to begin: has cars of the last slots take the places of those in the first
    /// that are done, so that whole slots are empty, which neither look around nor touch anything.
    fn close_ranks(&mut self) {
        let enough = (SLOTS * V::WIDTH - self.idle()).div_ceil(V::WIDTH);
        if self.cars[enough..].iter().all(|cars| cars.live == 0) {
            return;
        }
        if self.networks.may_separate() {
            self.networks.separate();
        } else if self.networks.sharing(0).len() > 1 {
            return;
        }
        let mut free = 0..enough * V::WIDTH;
        for slot in enough..SLOTS {
            for lane in ones(self.cars[slot].live) {
                let is_free =
                    |place: &usize| self.cars[place / V::WIDTH].live >> (place % V::WIDTH) & 1 == 0;
                let place = free.find(is_free).expect("there is room for every car");
                self.shift((slot, lane), (place / V::WIDTH, place % V::WIDTH));
            }
        }
    }

    /// Moves a car, with its drive and its network, from one slot and lane to another.
    fn shift(&mut self, (slot, lane): (usize, usize), to @ (to_slot, to_lane): (usize, usize)) {
        self.individuals[to_lane][to_slot] = self.individuals[lane][slot];
        self.drives[to_lane][to_slot] = std::mem::take(&mut self.drives[lane][slot]);
        let [from_cars, to_cars] = self
            .cars
            .get_disjoint_mut([slot, to_slot])
            .expect("cars go from the last slots to the first");
        from_cars.shift(lane, to_cars, to_lane);
        self.networks.shift((slot, lane), to);
    }

    /// Puts a car at the start of its drive.
    fn start(&mut self, lane: usize, slot: usize) {
        let pair = self.drives[lane][slot].pair;
        let goal = self.fleet.pairs[pair].goal;
        let (fleet, cars) = (self.fleet, &mut self.cars[slot]);
        if let Some(start) = self.starts.kept(fleet, pair) {
            cars.put(lane, start, (pair, goal), || begin(fleet, pair).1);
        } else {
            let (start, random) = begin(fleet, pair);
            cars.put(lane, &start, (pair, goal), || random);
        }
        self.networks.forget(slot, lane);
    }

    /// One control period of every car.
    #[inline(always)]
    pub(super) fn step(&mut self) {
        let problem = self.fleet.problem;
        let (model, world, scaling) = (problem.model(), &problem.world, problem.scaling());
        let (lookout, fan) = (problem.lookout(), model.fan());
        let mut poses = [self.cars[0].pose; SLOTS];
        let mut live = [0; SLOTS];
        for slot in 0..SLOTS {
            live[slot] = self.cars[slot].live;
            if live[slot] == 0 {
                continue;
            }
            poses[slot] = self.cars[slot].pose;
            if model.is_disturbed() {
                // Long before it is used: numbers written one by one take a while until they can
                // be read as a vector.
                self.cars[slot].misread(model);
            }
        }
        lookout.ask(fan, &poses, &live, &mut self.glance);
        // Meanwhile what walls they may see is loaded.
        for (cars, rays) in self.cars.iter_mut().zip(&self.glance.rays) {
            if cars.live != 0 {
                cars.aim(rays);
            }
        }
        lookout.see(fan, &poses, &live, &mut self.glance);
        for (slot, cars) in self.cars.iter().enumerate() {
            if cars.live == 0 {
                continue;
            }
            let sight = cars.sense(model, &self.glance.distances[slot]);
            let inputs = scaling.encoding.inputs(&sight, scaling.range);
            for (all, input) in self.networks.inputs.iter_mut().zip(inputs) {
                all.0[slot] = input;
            }
        }
        let slots = live.iter().rposition(|live| *live != 0).map_or(0, |last| last + 1);
        self.networks.step(slots);
        self.clock += 1;
        let [steer, speed] = self.networks.outputs;
        let has_speed = problem.topology().outputs == 2;
        let mut steps = [V::from(0.0); SLOTS];
        for slot in 0..SLOTS {
            if live[slot] == 0 {
                continue;
            }
            let command = if has_speed {
                scaling.commands(&[steer.0[slot], speed.0[slot]])
            } else {
                scaling.commands(&[steer.0[slot]])
            };
            (poses[slot], steps[slot]) = self.cars[slot].driven(command, model);
        }
        let hits = lookout.touches(model.body(), &poses, &live);
        for slot in 0..SLOTS {
            if live[slot] == 0 {
                continue;
            }
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

    /// Whether each car has weights of its own by now.
    #[cfg(test)]
    pub(super) fn are_separate(&self) -> bool {
        self.networks.sharing(0).len() == 1
    }

    /// How many cars have a drive, and in how many slots they are.
    #[cfg(test)]
    pub(super) fn cars_and_slots(&self) -> [usize; 2] {
        let slots = self.cars.iter().filter(|cars| cars.live != 0).count();
        [SLOTS * V::WIDTH - self.idle(), slots]
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
                let index = self.index(lane, slot);
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

    /// The place of a car's drive among all of the fleet.
    fn index(&self, lane: usize, slot: usize) -> usize {
        let individual = self.individuals[lane][slot].expect("a car has weights before it drives");
        individual * self.fleet.pairs.len() + self.drives[lane][slot].pair
    }

    fn keep(&mut self, lane: usize, slot: usize, outcome: Outcome) {
        let index = self.index(lane, slot);
        self.outcomes.push((index, outcome));
        self.cars[slot].live &= !(1 << lane);
        self.has_room = true;
    }
}

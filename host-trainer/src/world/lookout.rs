//! What beams see and bodies touch, from wherever they are.
//!
//! Positions are divided into cells and directions into parts of a turn. For each cell and part,
//! the few obstacles that a beam can meet first there, or that the body can touch, are found
//! once: those out of range, outside of the directions, or hidden behind others are left out.
//! In a crowd of small obstacles, where such lists would be long, a beam walks through a field of
//! distances instead.
//!
//! What is left is tested with the same arithmetic as ever, so distances and contacts are those of a
//! test of all obstacles, to the last bit. One thing is left to rounding: a wall that lies along a
//! beam's line, to the last digit of both, behind the car, out of range or, in a crowd, beyond what the
//! beam meets first; a test of all obstacles may compute it as met. Drives alone and in lanes both ask
//! here, so they agree about it.
//!
//! | look in | for |
//! | --- | --- |
//! | `fan` | the beams of a car |
//! | `glance` | what many cars see at once |
//! | `grid` | which cell, which part of a turn |
//! | `beams`, `later` | the tests, many beams side by side; those that have to be tested with more than others |
//! | `contact` | the bodies, side by side those that may touch something |
//! | `shelf` | what is found once for each cell |
//! | `words`, `asked` | how it is kept in few bytes, and read for many beams at once |
//! | `field` | how far beams may go at once, where lists would be long, and the few long walls there |
//! | `legends` | what names mean where obstacles are many |
//! | `kept` | what does not fit into words |
//! | `cell`, `candidate`, `cone`, `discs`, `shade`, `reach`, `rounding` | how it is found, and what may be left out |

mod asked;
mod beams;
mod candidate;
mod cell;
mod cone;
mod contact;
mod discs;
mod fan;
mod field;
mod glance;
mod grid;
mod kept;
mod later;
mod legends;
mod reach;
mod rounding;
mod shade;
mod shelf;
mod words;

use super::obstacles::Obstacles;
use crate::vector::{Vector, ones};
use asked::{Asked, ByNames, IN_HALF, Names};
use beams::Met;
use cell::BINS;
use controller_core::geometry::{Body, Ray};
use controller_core::motion::Pose;
use controller_core::observation::BEAMS;
use field::Field;
use grid::{Grid, Turned};
use later::{Added, Later};
use rounding::MOST_ERROR;
use shelf::{Question, Shelf, Sure};
use std::sync::Arc;

pub use fan::{Fan, Rays};
pub use glance::Glance;
pub use grid::Cells;
pub use shelf::Survey;

/// Distances and contacts of cars whose bodies do not reach beyond a largest one, in one world.
#[derive(Debug)]
pub struct Lookout {
    obstacles: Arc<Obstacles>,
    range: f32,
    largest: Body<f32>,
    slack: f32,
    grid: Grid,
    shelf: Shelf,
    /// In a crowd, what answers for the beams.
    field: Option<Field>,
}

impl Lookout {
    /// Prepares for beams that reach `range` metres, and for bodies within the `largest`. Costs next
    /// to nothing: cells are looked at where a car turns up. Where obstacles are many they are coarse anyway.
    pub fn new(obstacles: Arc<Obstacles>, range: f32, largest: Body<f32>, cells: Cells) -> Self {
        let [low, high] = obstacles.bounds();
        let cells = if Shelf::are_many(&obstacles) { Cells::Coarse } else { cells };
        let grid = Grid::new(low, high, cells);
        let field = Field::new(&obstacles, range, &largest);
        let shelf = Shelf::new(&obstacles, &grid, range, largest, field.is_none());
        Self { slack: shelf.slack(), obstacles, range, largest, grid, shelf, field }
    }

    /// What the cars with a bit in `live` see from these poses; what the glance says of others means nothing.
    ///
    /// A pose's heading, cosine and sine must belong together, as they do in every pose made by
    /// [`Pose::new`] and [`Pose::driven`].
    #[inline(always)]
    pub fn look<V: Vector, const N: usize, const Q: usize>(
        &self,
        fan: &Fan,
        poses: &[Pose<V>; N],
        live: &[u32; N],
        glance: &mut Glance<V, N, Q>,
    ) {
        self.ask(fan, poses, live, glance);
        self.see(fan, poses, live, glance);
    }

    /// The first half of [`Self::look`]: the beams, and what has to be loaded to know how far they go. That takes a
    /// while, in which something else can be done before the other half.
    #[inline(always)]
    pub fn ask<V: Vector, const N: usize, const Q: usize>(
        &self,
        fan: &Fan,
        poses: &[Pose<V>; N],
        live: &[u32; N],
        Glance { rays, asked, .. }: &mut Glance<V, N, Q>,
    ) {
        let cars = || (0..N).filter(|car| live[*car] != 0);
        for car in cars() {
            fan.cast(&poses[car], &mut rays[car]);
        }
        if self.field.is_some() {
            return;
        }
        // First where everything lies that is to be loaded, for which a large world has to be asked itself; then
        // loading it, then everything that is to be computed: so the CPU never waits for the one to begin the other.
        let mut cells = [V::from(0.0); N];
        for car in cars() {
            cells[car] = self.grid.locate(rays[car].ray(0).origin);
            self.shelf.fetch_shelves(cells[car]);
        }
        for car in cars() {
            let heading = Turned::by(poses[car].heading);
            let mut shelves = self.shelf.shelves(cells[car]);
            for beam in 0..BEAMS {
                if beam > 0 && !fan.has_one_origin() {
                    shelves = self.shelf.shelves(self.grid.locate(rays[car].ray(beam).origin));
                }
                let direction = (heading, fan.bins(beam));
                self.shelf.ask_seen(asked, car * BEAMS + beam, &shelves, direction);
                if fan.is_fetched(beam) {
                    self.shelf.fetch_seen::<V, Q>(asked, car * BEAMS + beam);
                }
            }
        }
    }

    /// The second half of [`Self::look`], of the same cars as the first: how far the beams go.
    #[inline(always)]
    pub fn see<V: Vector, const N: usize, const Q: usize>(
        &self,
        fan: &Fan,
        poses: &[Pose<V>; N],
        live: &[u32; N],
        Glance { rays, distances, asked, first, later }: &mut Glance<V, N, Q>,
    ) {
        if let Some(field) = &self.field {
            field.distances(&self.obstacles, rays, live, distances);
            return;
        }
        let questions = self.shelf.answer_seen::<V, Q>(asked, live);
        let (rays, distances) = (&*rays, distances.as_flattened_mut());
        let test = Test { asked, rays, distances, first, later };
        // Four times the same code, so that nobody has to ask this for each obstacle.
        let open = match (self.shelf.is_large(), self.shelf.has_discs()) {
            (false, false) => self.meet::<V, Q, false, false>(questions, test),
            (false, true) => self.meet::<V, Q, false, true>(questions, test),
            (true, false) => self.meet::<V, Q, true, false>(questions, test),
            (true, true) => self.meet::<V, Q, true, true>(questions, test),
        };
        for question in ones(open) {
            self.shelf.close_seen(asked, question, live[question / BEAMS]);
            self.shelf.fetch_whole(asked, question);
        }
        for question in ones(open) {
            let (car, beam) = (question / BEAMS, question % BEAMS);
            let (ray, distance) = (&ray_of(rays, question), &mut distances[question]);
            for lane in ones(asked.open(question)) {
                let heading = poses[car].heading.lanes()[lane];
                let ray = beams::in_lane(ray, lane);
                let distance = &mut distance.lanes_mut()[lane];
                *distance = match self.by_whole(&ray, asked, question, lane) {
                    Some(distance) => distance,
                    None => {
                        let heading = Turned::<f32, BINS>::by(heading);
                        let bin = heading.part_beside(fan.bins(beam));
                        self.settled(&ray, bin)
                    }
                };
            }
        }
    }

    /// Tests each question's beams with what its words name; returns the questions that are left open in any lane.
    #[inline(always)]
    fn meet<V: Vector, const Q: usize, const IS_LARGE: bool, const HAS_DISCS: bool>(
        &self,
        questions: ByNames,
        test: Test<'_, V, Q>,
    ) -> u32 {
        if V::SQUEEZES && !IS_LARGE {
            self.meet_without_gaps::<V, Q, HAS_DISCS>(test)
        } else {
            self.meet_by_length::<V, Q, IS_LARGE, HAS_DISCS>(questions, test)
        }
    }

    /// The same, all questions with as many names one after the other: so the CPU knows beforehand how often to go
    /// round.
    #[inline(always)]
    fn meet_by_length<V: Vector, const Q: usize, const IS_LARGE: bool, const HAS_DISCS: bool>(
        &self,
        questions: ByNames,
        Test { asked, rays, distances, .. }: Test<'_, V, Q>,
    ) -> u32 {
        let mut open = 0;
        for (names, questions) in questions.into_iter().enumerate() {
            for question in ones(questions) {
                let (ray, mut met) = (ray_of(rays, question), Met::nothing());
                for round in 0..names {
                    let names = asked.names(question, round);
                    self.test::<V, IS_LARGE, HAS_DISCS>(&mut met, &ray, names);
                }
                open |= self.finish(asked, question, &met, distances);
            }
        }
        open
    }

    /// The same in a small world, first with the first name of all, then with more names only [those that have
    /// them](later).
    #[inline(always)]
    fn meet_without_gaps<V: Vector, const Q: usize, const HAS_DISCS: bool>(
        &self,
        Test { asked, rays, distances, first, later }: Test<'_, V, Q>,
    ) -> u32 {
        let mut added = Added::default();
        for (question, first) in first.iter_mut().enumerate() {
            let ray = &ray_of(rays, question);
            let mut met = Met::nothing();
            let names = asked.longest(question);
            if names > 0 {
                self.test::<V, false, HAS_DISCS>(&mut met, ray, asked.names(question, 0));
            }
            if names > 1 && names <= IN_HALF {
                later.add(&mut added, question, ray, asked.names(question, 1));
            } else {
                later.add_none(question);
                for round in 1..names {
                    let names = asked.names(question, round);
                    self.test::<V, false, HAS_DISCS>(&mut met, ray, names);
                }
            }
            *first = met;
        }
        later.end(added);
        for vector in 0..later.vectors() {
            let (ray, mut met) = (later.ray(vector), Met::nothing());
            let mut round = 1;
            while let Some(names) = later.names(vector, round) {
                self.test::<V, false, HAS_DISCS>(&mut met, &ray, names);
                round += 1;
            }
            later.set_met(vector, &met);
        }
        let (mut taken, mut open) = (0, 0);
        for (question, met) in first.iter_mut().enumerate() {
            if let Some(more) = later.met(question, &mut taken) {
                met.and(&more);
            }
            open |= self.finish(asked, question, met, distances);
        }
        open
    }

    /// Writes down how far a question's beams go that have met this; returns the question as a bit if that is
    /// left open in any lane.
    #[inline(always)]
    fn finish<V: Vector, const Q: usize>(
        &self,
        asked: &mut Asked<Q>,
        question: usize,
        met: &Met<V>,
        distances: &mut [V],
    ) -> u32 {
        distances[question] = met.nearest(self.range);
        let doubtful = V::bits(met.doubtful(self.slack));
        u32::from(asked.leave_open::<V>(question, doubtful)) << question
    }

    /// Tests beams with what these names name.
    #[inline(always)]
    fn test<V: Vector, const IS_LARGE: bool, const HAS_DISCS: bool>(
        &self,
        met: &mut Met<V>,
        ray: &Ray<V>,
        names: Names<'_>,
    ) {
        let rows = self.shelf.edges::<V, IS_LARGE>(names);
        if HAS_DISCS {
            met.any(ray, rows);
        } else {
            met.wall(ray, rows);
        }
    }

    /// The distance along a beam whose question is open, if there is a longer list in a word.
    #[inline(never)]
    fn by_whole<const N: usize>(
        &self,
        ray: &Ray<f32>,
        asked: &Asked<N>,
        question: usize,
        lane: usize,
    ) -> Option<f32> {
        let mut met = Met::<f32>::nothing();
        let beyond = self.shelf.each_of_whole(asked, question, lane, |row| met.any(ray, *row))?;
        Some(self.within(ray, met.nearest(self.range), beyond))
    }

    /// The distance along a beam whose word does not say everything, or that passes a wall's end too closely to be
    /// sure.
    #[cold]
    #[inline(never)]
    fn settled(&self, ray: &Ray<f32>, bin: u32) -> f32 {
        let cell = self.grid.locate(ray.origin) as u32;
        let mut met = Met::<f32>::nothing();
        let question = Question::Seen(bin);
        let sure = self.shelf.each(&self.grid, &self.obstacles, cell, question, |row| {
            met.any(ray, *row);
        });
        let nearest = met.nearest(self.range);
        match sure {
            Some(Sure::UnlessDoubtful) if !met.doubtful(self.slack) => nearest,
            Some(Sure::UnlessDoubtful) => self.within(ray, nearest, 0.0),
            Some(Sure::Within(beyond)) => self.within(ray, nearest, beyond),
            None => self.within(ray, f32::INFINITY, 0.0),
        }
    }

    /// The distance along a beam that is `nearest` for all that may be met before `beyond`, metres.
    fn within(&self, ray: &Ray<f32>, nearest: f32, beyond: f32) -> f32 {
        if nearest.min(self.range) <= beyond {
            return nearest;
        }
        // What was left out and is computed as nearer is met before this.
        let reach = self.range.min(nearest + 2.0 * MOST_ERROR as f32);
        let distance = self.obstacles.distance(ray, reach).min(nearest);
        if distance <= self.range { distance } else { f32::INFINITY }
    }

    /// Whether beams walk through a field of distances, as in a crowd, instead of asking lists.
    pub fn beams_walk(&self) -> bool {
        self.field.is_some()
    }

    /// The cells visited so far.
    pub fn survey(&self) -> Survey {
        self.shelf.survey(&self.grid, &self.obstacles)
    }
}

/// Beams that are being tested, and where it is written down.
struct Test<'a, V, const Q: usize> {
    asked: &'a mut Asked<Q>,
    rays: &'a [Rays<V>],
    distances: &'a mut [V],
    first: &'a mut [Met<V>; Q],
    later: &'a mut Later<V, Q>,
}

/// The beams that a question is about.
#[inline(always)]
fn ray_of<V: Vector>(rays: &[Rays<V>], question: usize) -> Ray<V> {
    rays[question / BEAMS].ray(question % BEAMS)
}

//! How far everything is from everywhere, for worlds crowded with small obstacles: a robot's map,
//! whose walls are outlines of cells of some centimetres.
//!
//! There lists by direction are long: much is in sight, and little of it hides anything. A beam
//! rather walks (ray marching, as in C. Walsh and S. Karaman's RangeLibc, 2018): a cell knows how far the nearest
//! obstacle is, so the beam may go as far at once. Where that is next to nothing, it is tested with all
//! obstacles close by. It has ended where what it met lies nearer than it has walked.
//!
//! A few long walls, such as those around a hall, are no part of the field: each beam is tested with them
//! before it sets out.
//!
//! The distance is computed by the same arithmetic from the same walls as in a test of all, and so
//! are its bits. What the walk may not come by is a wall that runs along the beam's line, within some
//! ten-thousandths of a radian, and begins beyond what the beam meets first: rounding alone
//! decides where a test of all computes it as met, which may be before it begins.

mod tile;

use super::beams::{self, Met, NOTHING, Row};
use super::fan::Rays;
use super::grid::Grid;
use crate::vector::{MOST_LANES, RowOfLane, Vector, ones};
use crate::world::Obstacles;
use crate::world::shape::Shape;
use controller_core::geometry::{Body, Ray, Segment};
use controller_core::motion::Pose;
use controller_core::observation::BEAMS;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, Ordering};
use tile::Tile;

/// Side of a cell, metres.
const SIDE: f32 = 0.1;

/// A cell lists all obstacles in the square that goes so far beyond it, metres.
const CLOSE: f32 = 0.04;

/// A beam walks this much farther than what it has met, metres, or this part of its range: beyond, nothing
/// is computed as nearer but what runs along its line (`rounding`).
const BEYOND: f32 = 0.05;
const BEYOND_SHARE: f32 = 0.005;

/// Walls longer than this, metres, may be left out of the field. Every beam is tested with those first:
/// along them it would take many small steps.
const LONG: f64 = 3.0;

/// Most walls that are left out, the longest; among them must be all that are longer than the beams'
/// range, which rounding moves the farthest.
const MOST_LONG: usize = 16;

/// Beams on their way at a time, in vectors: the CPU works on one while it waits for the other.
const WALKS: usize = 2;

/// Steps in a row before beams are looked at that have come close to something.
const STEPS: usize = 3;

/// Obstacles in a square metre, as most of them have it around, from which on a beam walks.
const CROWD: f64 = 5.0;

/// Fewest obstacles that make a crowd.
const FEWEST: usize = 64;

/// Clearances of a world, and what is close by where they are small.
#[derive(Debug)]
pub(super) struct Field {
    grid: Grid,
    range: f32,
    beyond: f32,
    /// What rounding does to a place on a beam, metres, and more.
    margin: f32,
    /// From anywhere in each cell a beam may go this far, metres: bits of an `f32`, the least of which
    /// is that of cells with a list; 0 where nobody has been yet. After all cells comes the outside.
    clearances: Box<[AtomicU32]>,
    tiles: Box<[OnceLock<Tile>]>,
    /// The walls that are left out: those longer than the longest that is not, metres, or than [`LONG`].
    long: Box<[Row]>,
    longest: f64,
    has_discs: bool,
    /// The circle around the body: its middle, ahead of the pose, and a little more than its radius,
    /// metres.
    body_middle: f32,
    body_radius: f32,
}

impl Field {
    /// A field for beams that reach `range` metres, and for this body; none where lists by direction
    /// serve better.
    pub(super) fn new(obstacles: &Obstacles, range: f32, body: &Body<f32>) -> Option<Self> {
        let [low, high] = obstacles.bounds();
        let farthest = [low, high].into_iter().flatten().map(f32::abs).fold(range, f32::max);
        let largest = obstacles.largest() as f32;
        // For places on beams, and for contacts, which is more.
        let margin = 1.0e-4 + 24.0 * f32::EPSILON * (farthest + largest);
        let beyond = BEYOND.max(BEYOND_SHARE * range);
        let length = |wall: &Segment<f32>| Shape::from(wall).length;
        let mut lengths: Vec<f64> = obstacles.walls().iter().map(length).collect();
        let longest_kept = if lengths.len() > MOST_LONG {
            *lengths.select_nth_unstable_by(MOST_LONG, |a, b| b.total_cmp(a)).1
        } else {
            0.0
        };
        let longest = longest_kept.max(f64::from(range).min(LONG));
        let long = obstacles.walls().iter().filter(|wall| length(wall) > longest);
        let long: Box<[Row]> = long.map(beams::edge).collect();
        if margin > 0.1 * CLOSE || longest_kept > range.into() || crowd(obstacles) < CROWD {
            return None;
        }
        let grid = Grid::of_side(low, high, SIDE);
        let clearances: Box<[AtomicU32]> = bytemuck::zeroed_slice_box(grid.cells() + 1);
        clearances[grid.cells()].store(f32::INFINITY.to_bits(), Ordering::Relaxed);
        let tiles = (0..grid.tiles()).map(|_| OnceLock::new()).collect();
        let has_discs = !obstacles.discs().is_empty();
        let Body { rear, front, half_width } = *body;
        Some(Self {
            grid,
            range,
            beyond,
            margin,
            clearances,
            tiles,
            long,
            longest,
            has_discs,
            body_middle: 0.5 * (rear + front),
            body_radius: 1.001 * libm::hypotf(0.5 * (front - rear), half_width),
        })
    }

    /// How far each of these beams goes, metres: the distance to the nearest obstacle, or infinity if
    /// there is none within range. Lanes whose bit in `live` is not set hold anything.
    ///
    /// Some beams take ten times as many steps as others. A lane whose beam has ended goes on with the
    /// next one, so that none waits. What a beam meets, and after which steps, does not depend on the others.
    #[inline(always)]
    pub(super) fn distances<V: Vector, const N: usize>(
        &self,
        obstacles: &Obstacles,
        rays: &[Rays<V>; N],
        live: &[u32; N],
        distances: &mut [[V; BEAMS]; N],
    ) {
        distances.as_flattened_mut().fill(V::from(f32::INFINITY));
        let begun = self.long_ahead(rays);
        let mut walks = [Walk::<V>::new(); WALKS];
        let mut next = 0;
        loop {
            for walk in &mut walks {
                // Beams that have ended make way for others.
                for lane in ones(walk.ended) {
                    walk.hand_in(lane, self.range, distances);
                    while next < N * BEAMS * V::WIDTH {
                        let beam = next;
                        next += 1;
                        if live[beam / (BEAMS * V::WIDTH)] >> (beam % V::WIDTH) & 1 == 1 {
                            walk.take(lane, beam, rays, &begun);
                            break;
                        }
                    }
                }
            }
            if walks.iter().all(|walk| walk.taken == 0) {
                break;
            }
            for _ in 0..STEPS {
                for walk in &mut walks {
                    self.go_on(walk);
                }
            }
            for walk in &mut walks {
                self.look_around(obstacles, walk);
            }
        }
        self.find_from_outside(obstacles, rays, live, distances);
    }

    /// Lets the beams go as far as nothing is close by.
    #[inline(always)]
    fn go_on<V: Vector>(&self, walk: &mut Walk<V>) {
        let clearances = self.clearances(self.place(walk).cells);
        let goes_on = V::from(CLOSE).lt(clearances) & self.is_open(walk);
        let way = walk.way + (clearances - V::from(self.margin));
        walk.way = V::select(goes_on, way, walk.way);
    }

    /// Tests the beams that have come close to something with what is there, and finds those that
    /// have ended.
    #[inline(always)]
    fn look_around<V: Vector>(&self, obstacles: &Obstacles, walk: &mut Walk<V>) {
        let Place { cells, column, row, at } = self.place(walk);
        let clearances = self.clearances(cells);
        let is_open = self.is_open(walk);
        let unknown = V::bits(clearances.le(V::from(0.0)) & is_open);
        if unknown != 0 {
            self.visit(obstacles, cells, unknown);
            walk.ended = 0;
            return;
        }
        let is_close = clearances.le(V::from(CLOSE)) & is_open;
        let close = V::bits(is_close);
        if close != 0 {
            let close_by = self.close_by(column, row, close);
            let mut met = Met::something(walk.near);
            for round in 0..close_by.longest {
                let rows = V::rows(CloseInRound { lists: &close_by.lists, round });
                if self.has_discs {
                    met.any(&walk.ray, rows);
                } else {
                    met.wall(&walk.ray, rows);
                }
            }
            walk.near = V::select(is_close, met.near(), walk.near);
            // To the edge of the square that the list covers.
            let half = V::from(0.5 * self.grid.side() as f32 + CLOSE);
            let centre = self.grid.centre(column, row);
            let x = half + forward(centre.0 - at.0, walk.ray.direction.0);
            let y = half + forward(centre.1 - at.1, walk.ray.direction.1);
            let across = (x * walk.per_step.0).min(y * walk.per_step.1);
            let way = walk.way + (across - V::from(self.margin));
            walk.way = V::select(is_close, way, walk.way);
        }
        walk.ended = walk.taken & !V::bits(self.is_open(walk));
    }

    /// Which beams are still on their way: within range, and not well beyond what they have met.
    #[inline(always)]
    fn is_open<V: Vector>(&self, walk: &Walk<V>) -> V::Mask {
        let beyond = V::from(self.beyond);
        walk.way.le(V::from(self.range) + beyond) & walk.way.lt(walk.near + beyond)
    }

    /// How far each beam goes to the long walls alone.
    #[inline(always)]
    fn long_ahead<V: Vector, const N: usize>(&self, rays: &[Rays<V>; N]) -> [[V; BEAMS]; N] {
        let mut ahead = [[V::from(f32::INFINITY); BEAMS]; N];
        for row in &self.long {
            let [x, y, ex, ey] = *row;
            for (ahead, rays) in ahead.iter_mut().zip(rays) {
                for (beam, ahead) in ahead.iter_mut().enumerate() {
                    let mut met = Met::something(*ahead);
                    let row = [V::from(x), V::from(y), V::from(ex), V::from(ey)];
                    met.wall(&rays.ray(beam), row);
                    *ahead = met.near();
                }
            }
        }
        ahead
    }

    /// Which of the bodies at these poses may touch an obstacle, as bits: where nobody has been yet, or
    /// outside of all cells, any may.
    #[inline(always)]
    pub(super) fn may_touch<V: Vector>(&self, pose: &Pose<V>) -> u32 {
        let middle = pose.to_world(V::from(self.body_middle), V::from(0.0));
        let cells = self.grid.locate(middle);
        let reach = V::from(self.body_radius + self.margin);
        let mut may =
            self.clearances(cells).le(reach) | V::from(self.grid.cells() as f32).le(cells);
        for row in &self.long {
            let [x, y, ex, ey] = row.map(V::from);
            let (wx, wy) = (middle.0 - x, middle.1 - y);
            let length = ex * ex + ey * ey;
            let along = ((wx * ex + wy * ey) / length).max(V::from(0.0)).min(V::from(1.0));
            let (dx, dy) = (wx - along * ex, wy - along * ey);
            may = may | (dx * dx + dy * dy).le(reach * reach);
        }
        V::bits(may)
    }

    /// Where the beams of a walk are.
    #[inline(always)]
    fn place<V: Vector>(&self, walk: &Walk<V>) -> Place<V> {
        let Ray { origin: (x, y), direction: (dx, dy) } = walk.ray;
        let at = (x + dx * walk.way, y + dy * walk.way);
        let (cells, column, row) = self.grid.locate_in(at);
        Place { cells, column, row, at }
    }

    /// How far from each of these cells a beam may go.
    #[inline(always)]
    fn clearances<V: Vector>(&self, cells: V) -> V {
        let places = cells.places();
        let mut clearances = V::from(0.0);
        for (lane, clearance) in clearances.lanes_mut().iter_mut().enumerate() {
            let bits = self.clearances[places[lane] as usize].load(Ordering::Acquire);
            *clearance = f32::from_bits(bits);
        }
        clearances
    }

    /// What is close to the cells of these lanes.
    #[inline(always)]
    fn close_by<V: Vector>(&self, column: V, row: V, lanes: u32) -> CloseBy<'_> {
        let (columns, rows) = (column.places(), row.places());
        let mut all = CloseBy { lists: [&[]; MOST_LANES], longest: 0 };
        for lane in ones(lanes) {
            let (tile, place) = self.grid.in_tile(columns[lane], rows[lane]);
            if let Some(tile) = self.tiles[tile].get() {
                let list = tile.close_by(place);
                all.lists[lane] = list;
                all.longest = all.longest.max(list.len());
            }
        }
        all
    }

    /// Looks at the tiles of the cells of these lanes.
    #[cold]
    #[inline(never)]
    fn visit<V: Vector>(&self, obstacles: &Obstacles, cells: V, lanes: u32) {
        for lane in ones(lanes) {
            let tile = self.grid.tile(cells.lanes()[lane] as usize);
            let known = self.tiles[tile]
                .get_or_init(|| Tile::new(&self.grid, tile, obstacles, self.longest));
            // By each who finds it unwritten; they all write the same.
            for (cell, place) in self.grid.cells_of_tile(tile) {
                self.clearances[cell].store(known.clearance(place).to_bits(), Ordering::Release);
            }
        }
    }

    /// Asks all obstacles for beams that begin outside of all cells.
    #[inline(always)]
    fn find_from_outside<V: Vector, const N: usize>(
        &self,
        obstacles: &Obstacles,
        rays: &[Rays<V>; N],
        live: &[u32; N],
        distances: &mut [[V; BEAMS]; N],
    ) {
        let cells = V::from(self.grid.cells() as f32);
        for car in 0..N {
            for (beam, distance) in distances[car].iter_mut().enumerate() {
                let ray = &rays[car].ray(beam);
                let lost = V::bits(cells.le(self.grid.locate(ray.origin))) & live[car];
                if lost != 0 {
                    self.find(obstacles, ray, lost, distance);
                }
            }
        }
    }

    #[cold]
    #[inline(never)]
    fn find<V: Vector>(&self, obstacles: &Obstacles, ray: &Ray<V>, lanes: u32, distance: &mut V) {
        for lane in ones(lanes) {
            let found = obstacles.distance(&beams::in_lane(ray, lane), self.range);
            distance.lanes_mut()[lane] = if found <= self.range { found } else { f32::INFINITY };
        }
    }
}

/// Where beams are.
struct Place<V> {
    cells: V,
    column: V,
    row: V,
    at: (V, V),
}

/// Beams on their way, one in each lane.
#[derive(Clone, Copy)]
struct Walk<V> {
    /// Which beam it is, counted lane by lane, beam by beam, car by car.
    beam: [usize; MOST_LANES],
    ray: Ray<V>,
    /// Metres along x and y, as metres of the way; infinite along an axis.
    per_step: (V, V),
    /// How far all obstacles have been looked for, metres; infinite where no beam is.
    way: V,
    /// The nearest of what has been met.
    near: V,
    /// In which lanes there are beams, and which lanes are to get new ones, as bits.
    taken: u32,
    ended: u32,
}

/// Stands for no beam.
const NO_BEAM: usize = usize::MAX;

impl<V: Vector> Walk<V> {
    /// No beam yet.
    #[inline(always)]
    fn new() -> Self {
        let (zero, infinity) = (V::from(0.0), V::from(f32::INFINITY));
        Self {
            beam: [NO_BEAM; MOST_LANES],
            ray: Ray { origin: (zero, zero), direction: (zero, zero) },
            per_step: (infinity, infinity),
            way: infinity,
            near: infinity,
            taken: 0,
            ended: lanes::<V>(),
        }
    }

    /// Puts a beam into a lane.
    #[inline(always)]
    fn take<const N: usize>(
        &mut self,
        lane: usize,
        beam: usize,
        rays: &[Rays<V>; N],
        begun: &[[V; BEAMS]; N],
    ) {
        let (vector, from) = (beam / V::WIDTH, beam % V::WIDTH);
        let ray = &rays[vector / BEAMS].ray(vector % BEAMS);
        let (dx, dy) = (ray.direction.0.lanes()[from], ray.direction.1.lanes()[from]);
        self.beam[lane] = beam;
        self.taken |= 1 << lane;
        self.ray.origin.0.lanes_mut()[lane] = ray.origin.0.lanes()[from];
        self.ray.origin.1.lanes_mut()[lane] = ray.origin.1.lanes()[from];
        self.ray.direction.0.lanes_mut()[lane] = dx;
        self.ray.direction.1.lanes_mut()[lane] = dy;
        self.per_step.0.lanes_mut()[lane] = 1.0 / dx.abs();
        self.per_step.1.lanes_mut()[lane] = 1.0 / dy.abs();
        self.way.lanes_mut()[lane] = 0.0;
        self.near.lanes_mut()[lane] = begun[vector / BEAMS][vector % BEAMS].lanes()[from];
    }

    /// Writes down how far the beam in a lane goes, which then is empty.
    #[inline(always)]
    fn hand_in<const N: usize>(
        &mut self,
        lane: usize,
        range: f32,
        distances: &mut [[V; BEAMS]; N],
    ) {
        let beam = std::mem::replace(&mut self.beam[lane], NO_BEAM);
        self.way.lanes_mut()[lane] = f32::INFINITY;
        self.taken &= !(1 << lane);
        if beam != NO_BEAM {
            let near = self.near.lanes()[lane];
            let vector = beam / V::WIDTH;
            // The sum has the positive zero, whichever was met.
            let distance = if near <= range { near + 0.0 } else { f32::INFINITY };
            distances[vector / BEAMS][vector % BEAMS].lanes_mut()[beam % V::WIDTH] = distance;
        }
    }
}

/// All lanes, as bits.
#[inline(always)]
fn lanes<V: Vector>() -> u32 {
    u32::MAX >> (u32::BITS - V::WIDTH as u32)
}

/// An offset as seen in this direction along the same axis: positive ahead.
#[inline(always)]
fn forward<V: Vector>(offset: V, direction: V) -> V {
    V::select(direction.lt(V::from(0.0)), -offset, offset)
}

/// Obstacles close to the cell of each lane.
struct CloseBy<'a> {
    lists: [&'a [Row]; MOST_LANES],
    longest: usize,
}

/// One of them for each lane, or nothing.
struct CloseInRound<'a> {
    lists: &'a [&'a [Row]; MOST_LANES],
    round: usize,
}

impl RowOfLane for CloseInRound<'_> {
    #[inline(always)]
    fn row(&self, lane: usize) -> &Row {
        self.lists[lane].get(self.round).unwrap_or(&NOTHING)
    }
}

/// How many obstacles there are in the square metre in which an obstacle lies, on average over all
/// obstacles; none where they are few.
fn crowd(obstacles: &Obstacles) -> f64 {
    let walls = obstacles.walls().iter().map(|wall| (wall.a.0 + wall.b.0, wall.a.1 + wall.b.1));
    let discs = obstacles.discs().iter().map(|disc| (2.0 * disc.centre.0, 2.0 * disc.centre.1));
    let mut squares: Vec<[i64; 2]> =
        walls.chain(discs).map(|(x, y)| [x, y].map(|twice| (0.5 * twice).floor() as i64)).collect();
    if squares.len() < FEWEST {
        return 0.0;
    }
    squares.sort_unstable();
    let groups = squares.chunk_by(|a, b| a == b);
    let pairs: usize = groups.map(|group| group.len() * group.len()).sum();
    pairs as f64 / squares.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario;
    use crate::world::World;

    fn is_crowded(name: &str) -> bool {
        let source = scenario::find(name).unwrap();
        let scenario = scenario::load(&source, None, &[]).unwrap();
        let world = World::new(&scenario).unwrap();
        let (walls, discs) = (world.segments().to_vec(), world.discs().to_vec());
        let body = Body { rear: -0.35, front: 0.05, half_width: 0.1 };
        Field::new(&Obstacles::new(walls, discs), 10.0, &body).is_some()
    }

    #[test]
    fn beams_walk_in_maps_and_among_cylinders_and_not_in_rooms() {
        for name in ["depot", "tb3_sandbox", "barn_000", "barn_264"] {
            assert!(is_crowded(name), "{name}");
        }
        for name in ["open", "obstacles", "complex", "medium_maze"] {
            assert!(!is_crowded(name), "{name}");
        }
    }
}

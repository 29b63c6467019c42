//! The floor as a grid: where there is room, and how far each place is from a goal.

use crate::world::{World, distance};
use controller_core::geometry::Body;
use controller_core::motion::Pose;

/// Most cells of a floor.
const MAX_CELLS: usize = 1 << 18;

/// Cost of a step to a neighbour that shares an edge, and of one that shares a corner only.
const STRAIGHT: u32 = 5;
const DIAGONAL: u32 = 7;

/// A disc this much narrower than the car may pass where the car barely fits.
const NARROWER: f32 = 0.9;

/// How far out of a free cell a distance is taken over into cells beside walls.
const BESIDE: u32 = 2;

/// No way.
const FAR: u32 = u32::MAX;

/// A grid over the world's bounds.
#[derive(Debug)]
pub(super) struct Floor {
    origin: [f32; 2],
    pub(super) cell: f32,
    pub(super) width: usize,
    pub(super) height: usize,
    /// Whether something as wide as the car can stand in the middle of a cell.
    free: Vec<bool>,
    /// Whether a body whose middle lies anywhere in a cell touches nothing, however it is turned.
    roomy: Vec<bool>,
}

/// How far every cell is from one goal, in steps between cells.
#[derive(Debug)]
pub(super) struct Distances(Vec<u32>);

impl Floor {
    pub(super) fn new(world: &World, body: &Body<f32>) -> Self {
        let [x0, y0] = world.bounds.min;
        let (w, h) = (world.bounds.max[0] - x0, world.bounds.max[1] - y0);
        let half_length = (body.front - body.rear) * 0.5;
        let narrow = body.half_width.min(half_length);
        let cell = narrow.max((w * h / MAX_CELLS as f32).sqrt());
        let width = ((w / cell).ceil() as usize).max(1);
        let height = ((h / cell).ceil() as usize).max(1);
        let radius = distance([half_length, body.half_width], [0.0, 0.0]);
        let mut floor =
            Self { origin: [x0, y0], cell, width, height, free: Vec::new(), roomy: Vec::new() };
        // From a cell's middle to its corners, and what rounding may add up to.
        let roomy = radius + 0.71 * cell + 1e-3;
        for index in 0..width * height {
            let clearance = world.clearance(floor.middle(index), roomy);
            floor.free.push(clearance >= NARROWER * narrow);
            floor.roomy.push(clearance >= roomy);
        }
        floor
    }

    fn middle(&self, index: usize) -> [f32; 2] {
        let at = |origin: f32, index: usize| origin + (index as f32 + 0.5) * self.cell;
        [at(self.origin[0], index % self.width), at(self.origin[1], index / self.width)]
    }

    /// The cell that holds a point; none outside of the bounds.
    pub(super) fn at(&self, x: f32, y: f32) -> Option<usize> {
        let place = |value: f32, origin: f32, most: usize| {
            let index = (value - origin) / self.cell;
            (index >= 0.0 && index < most as f32).then_some(index as usize)
        };
        let column = place(x, self.origin[0], self.width)?;
        Some(place(y, self.origin[1], self.height)? * self.width + column)
    }

    /// Whether a body at this pose surely touches nothing.
    pub(super) fn is_roomy(&self, body: &Body<f32>, pose: &Pose<f32>) -> bool {
        let (x, y) = pose.to_world((body.front + body.rear) * 0.5, 0.0);
        self.at(x, y).is_some_and(|index| self.roomy[index])
    }

    /// How far the cells are from a disc around the goal.
    pub(super) fn distances(&self, goal: [f32; 2], radius: f32) -> Distances {
        let mut costs = vec![FAR; self.free.len()];
        // Costs in the queue differ by at most one diagonal, so a ring of lists keeps their order.
        let mut ring: [Vec<usize>; DIAGONAL as usize + 1] = Default::default();
        let reach = radius.max(self.cell);
        for (index, cost) in costs.iter_mut().enumerate() {
            if distance(self.middle(index), goal) <= reach {
                *cost = 0;
                ring[0].push(index);
            }
        }
        let mut waiting = ring[0].len();
        let mut now = 0;
        while waiting > 0 {
            let slot = now as usize % ring.len();
            let Some(index) = ring[slot].pop() else {
                now += 1;
                continue;
            };
            waiting -= 1;
            if costs[index] != now {
                continue;
            }
            self.each_neighbour(index, |neighbour, step| {
                if self.free[neighbour] && now + step < costs[neighbour] {
                    costs[neighbour] = now + step;
                    ring[(now + step) as usize % (DIAGONAL as usize + 1)].push(neighbour);
                    waiting += 1;
                }
            });
        }
        self.take_over_beside(&mut costs);
        Distances(costs)
    }

    /// Cells beside walls, where the front axle may come although something as wide as the car
    /// cannot stand there, are a little farther away than the free cells around them.
    fn take_over_beside(&self, costs: &mut [u32]) {
        for _ in 0..BESIDE {
            let mut found = Vec::new();
            for index in (0..costs.len()).filter(|index| !self.free[*index] && costs[*index] == FAR)
            {
                let mut least = FAR;
                self.each_neighbour(index, |neighbour, step| {
                    least = least.min(costs[neighbour].saturating_add(step));
                });
                found.push((index, least));
            }
            found.into_iter().for_each(|(index, cost)| costs[index] = cost);
        }
    }

    fn each_neighbour(&self, index: usize, mut f: impl FnMut(usize, u32)) {
        let (column, row) = (index % self.width, index / self.width);
        for j in row.saturating_sub(1)..(row + 2).min(self.height) {
            for i in column.saturating_sub(1)..(column + 2).min(self.width) {
                match (i != column, j != row) {
                    (false, false) => {}
                    (true, true) => f(j * self.width + i, DIAGONAL),
                    _ => f(j * self.width + i, STRAIGHT),
                }
            }
        }
    }
}

impl Distances {
    /// Cells on the way from this one to the goal; none if there is no way.
    pub(super) fn cells(&self, index: usize) -> Option<f32> {
        let cost = self.0[index];
        (cost != FAR).then_some(cost as f32 / STRAIGHT as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::car::body_of;
    use crate::scenario::{Preset, Wall};

    /// A wall from the left that leaves a gap of 1 m on the right.
    #[test]
    fn the_way_leads_around_a_wall_and_not_through_it() {
        let mut scenario = Preset::Paper.scenario();
        let wall = Wall { points: vec![[0.0, 5.0], [9.0, 5.0]], thickness: 0.0 };
        scenario.world.walls.push(wall);
        let world = World::new(&scenario).unwrap();
        let floor = Floor::new(&world, &body_of(&scenario.vehicle));
        let distances = floor.distances([1.0, 6.0], 0.1);
        let metres = |x, y| distances.cells(floor.at(x, y).unwrap()).unwrap() * floor.cell;
        // Along edges and diagonals, never more than 8 % too long.
        for (x, y, straight) in [(1.0, 8.0, 2.0), (4.0, 9.0, 3.0 * 2_f32.sqrt()), (1.0, 4.0, 16.6)]
        {
            let found = metres(x, y);
            assert!((straight - 0.3..straight * 1.09).contains(&found), "{x} {y}: {found}");
        }
        assert_eq!(floor.at(-0.1, 5.0), None);
        assert_eq!(floor.at(5.0, 10.1), None);
    }

    #[test]
    fn in_a_roomy_cell_a_body_touches_nothing_however_it_is_turned() {
        use crate::seed::{Purpose, RunSeed};
        let mut scenario = Preset::Paper.scenario();
        scenario.world.boxes.push([4.0, 4.0, 5.0, 6.0]);
        let world = World::new(&scenario).unwrap();
        let body = body_of(&scenario.vehicle);
        let floor = Floor::new(&world, &body);
        let mut random = RunSeed(1).stream(Purpose::Episode, 0, 0);
        let mut roomy = 0;
        for _ in 0..20_000 {
            let [x, y, turn] = [0.0, 0.0, 0.0].map(|_| random.within(0.0, 10.0));
            let pose = Pose::new(x, y, turn);
            if floor.is_roomy(&body, &pose) {
                roomy += 1;
                assert!(!world.touches(&body, &pose), "{x} {y} {turn}");
            }
        }
        assert!((10_000..19_000).contains(&roomy), "{roomy}");
    }
}

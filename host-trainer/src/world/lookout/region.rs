//! All poses of one cell and one sector of headings, and what they can see or touch.

use super::fan::Fan;
use crate::world::shape::{Point, Rect, Shape, dot, left};
use controller_core::geometry::Body;
use controller_core::observation::BEAMS;

/// Headings lie this much further out than their sector says, radians: many times what
/// `sin_cos`, `wrap` and the choice of a sector round away.
const TURN_MARGIN: f64 = 1.0e-5;

/// Positions in a rectangle, with headings in a sector.
#[derive(Clone, Copy, Debug)]
pub(super) struct Region {
    /// Positions of the front axle.
    pub(super) cell: Rect,
    /// The middle heading, radians.
    pub(super) heading: f64,
    /// Half the sector, radians.
    pub(super) half_sector: f64,
}

impl Region {
    fn half_turn(&self) -> f64 {
        self.half_sector + TURN_MARGIN
    }

    /// Where each beam can start and point.
    pub(super) fn cones(&self, fan: &Fan) -> [Cone; BEAMS] {
        fan.mounts().map(|[x, y, cos, sin]| {
            let turned = [
                x * libm::cos(self.heading) - y * libm::sin(self.heading),
                x * libm::sin(self.heading) + y * libm::cos(self.heading),
            ];
            let reach = libm::hypot(x, y);
            // The corner farthest from the origin bounds what adding the mount rounds away.
            let largest = self
                .cell
                .corners()
                .into_iter()
                .flatten()
                .fold(reach, |most: f64, value| most.max(value.abs()));
            let slack =
                reach * (self.half_turn() + 1.0e-6) + largest * 4.0 * f64::from(f32::EPSILON);
            let from = self.cell.moved(turned).grown(slack);
            let middle = self.heading + libm::atan2(sin, cos);
            let at = |angle: f64| [libm::cos(angle), libm::sin(angle)];
            Cone { from, right: at(middle - self.half_turn()), left: at(middle + self.half_turn()) }
        })
    }

    /// Everywhere the body can be.
    pub(super) fn reach(&self, body: &Body<f32>) -> Reach {
        let [rear, front, half] = [body.rear, body.front, body.half_width].map(f64::from);
        let farthest = libm::hypot(rear.abs().max(front.abs()), half);
        let slack = farthest * (self.half_turn() + 1.0e-6);
        Reach {
            cell: self.cell,
            ahead: [libm::cos(self.heading), libm::sin(self.heading)],
            body: Rect { low: [rear, -half], high: [front, half] }.grown(slack),
        }
    }
}

/// Beams from a rectangle, pointing between two directions less than half a turn apart.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cone {
    pub(super) from: Rect,
    right: Point,
    left: Point,
}

impl Cone {
    /// Whether a beam's line can pass the shape within `aside`, ahead of its start.
    pub(super) fn meets(&self, shape: &Shape, aside: f64) -> bool {
        let normal = left(shape.direction);
        let outward = [
            left(self.left),
            [self.right[1], -self.right[0]],
            [1.0, 0.0],
            [-1.0, 0.0],
            [0.0, 1.0],
            [0.0, -1.0],
            normal,
            [-normal[0], -normal[1]],
        ];
        // What lies between the two directions and clear of the rectangle leaves no gap to see.
        !outward.into_iter().any(|normal| {
            let away = |direction: Point| dot(direction, normal) <= 1.0e-12;
            let gap = shape.least(normal) - self.from.most(normal);
            away(self.left) && away(self.right) && gap > aside
        })
    }

    /// The beams, pointing backwards.
    pub(super) fn reversed(self) -> Self {
        let back = |[x, y]: Point| [-x, -y];
        Self { right: back(self.right), left: back(self.left), ..self }
    }
}

/// Where a body can be: an upright rectangle of positions with a turned one around each.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    cell: Rect,
    ahead: Point,
    body: Rect,
}

impl Reach {
    /// Whether the body can come within `margin` of the shape.
    pub(super) fn meets(&self, shape: &Shape, margin: f64) -> bool {
        let normal = left(shape.direction);
        let aside = left(self.ahead);
        let axes = [[1.0, 0.0], [0.0, 1.0], self.ahead, aside, normal];
        !axes.into_iter().flat_map(|axis| [axis, [-axis[0], -axis[1]]]).any(|normal| {
            let turned = [dot(normal, self.ahead), dot(normal, aside)];
            shape.least(normal) - self.cell.most(normal) - self.body.most(turned) > margin
        })
    }

    /// An upright rectangle around everything.
    pub(super) fn around(&self) -> Rect {
        let body = self.body.corners().into_iter();
        let far = body.map(|corner| libm::hypot(corner[0], corner[1])).fold(0.0, f64::max);
        self.cell.grown(far)
    }
}

#[cfg(test)]
mod tests {
    use super::super::grid::{Grid, SECTORS};
    use super::*;
    use crate::seed::{Purpose, RunSeed};
    use crate::world::shape::cross;
    use controller_core::geometry::Disc;
    use controller_core::motion::Pose;
    use controller_core::observation::BeamMount;
    use std::f32::consts::PI;

    /// Poses exactly on borders of cells and sectors, next to them, and anywhere.
    #[test]
    fn every_beam_starts_and_points_within_the_cone_of_its_place_and_the_body_lies_in_reach() {
        let mut stream = RunSeed(74).stream(Purpose::Episode, 0, 0);
        let mount = |x, y, angle: f32| BeamMount { x, y, angle };
        let fan = Fan::new(
            &[
                mount(0.0, 0.0, -0.5),
                mount(0.05, 0.0, 0.0),
                mount(-0.3, 0.1, 2.0),
                mount(0.0, -0.2, -1.5),
                mount(1.0, 1.0, 3.1),
            ],
            10.0,
        );
        let body = Body { rear: -0.35, front: 0.05, half_width: 0.1 };
        for (low, side) in [([0.0, 0.0], 0.35), ([-9_000.0, 4_000.0], 0.35), ([1.0, 2.0], 0.001)] {
            let high = [low[0] + 100.0 * side, low[1] + 100.0 * side];
            let grid = Grid::new(low, high, side, 1 << 20);
            for _ in 0..20_000 {
                let mut axis = |low: f32| {
                    let border = low + (stream.index(99) as f32 + 0.5) * side;
                    [
                        border,
                        border.next_up(),
                        border.next_down(),
                        low + stream.within(0.0, 99.0) * side,
                    ][stream.index(4)]
                };
                let (x, y) = (axis(low[0]), axis(low[1]));
                let border = (stream.index(SECTORS) as f32 - 7.5) * (PI / 8.0);
                let anywhere = stream.within(-PI, PI);
                let heading =
                    [border, border.next_up(), border.next_down(), anywhere][stream.index(4)];
                let pose = Pose::new(x, y, heading);
                let (column, row, sector) = grid.locate(&pose).unwrap();
                let region = grid.regions(column, row)[sector];
                let rays = fan.rays(&pose);
                for (cone, ray) in region.cones(&fan).iter().zip(rays) {
                    let direction = [ray.direction.0, ray.direction.1].map(f64::from);
                    assert!(cross(cone.right, direction) > 0.0, "{pose:?}");
                    assert!(cross(direction, cone.left) > 0.0, "{pose:?}");
                    let from = [ray.origin.0, ray.origin.1].map(f64::from);
                    let inside = |axis: usize| {
                        (cone.from.low[axis]..=cone.from.high[axis]).contains(&from[axis])
                    };
                    assert!(inside(0) && inside(1), "{pose:?}: {from:?} not in {cone:?}");
                }
                let reach = region.reach(&body);
                for (ahead, left) in [(0.05, 0.1), (0.05, -0.1), (-0.35, 0.1), (-0.35, -0.1)] {
                    let (x, y) = pose.to_world(ahead, left);
                    let point = Shape::from(&Disc { centre: (x, y), radius: 0.0 });
                    let rounding = 4.0 * f64::from(f32::EPSILON * low[0].abs().max(1.0));
                    assert!(reach.meets(&point, rounding), "{pose:?}: ({x}, {y})");
                }
            }
        }
    }
}

//! Where a body can be whose pose lies in one cell and one part of a turn.

use super::grid::Arc;
use crate::world::shape::{Point, Rect, Shape, dot, left};
use controller_core::geometry::Body;

/// An upright rectangle of positions with a turned one around each.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    cell: Rect,
    ahead: Point,
    body: Rect,
}

impl Reach {
    /// Everywhere the body can be.
    pub(super) fn new(cell: Rect, headings: &Arc, body: &Body<f32>) -> Self {
        let [rear, front, half] = [body.rear, body.front, body.half_width].map(f64::from);
        let farthest = libm::hypot(rear.abs().max(front.abs()), half);
        let slack = farthest * (headings.half + 1.0e-6);
        Self {
            cell,
            ahead: [libm::cos(headings.middle), libm::sin(headings.middle)],
            body: Rect { low: [rear, -half], high: [front, half] }.grown(slack),
        }
    }

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

//! Plane geometry in `f64` for deciding what can be left out; never for a distance itself.

use controller_core::geometry::{Disc, Segment};

/// A point or a direction.
pub(super) type Point = [f64; 2];

pub(super) fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

pub(super) fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

pub(super) fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

pub(super) fn length(a: Point) -> f64 {
    dot(a, a).sqrt()
}

/// Turned a quarter to the left.
pub(super) fn left(a: Point) -> Point {
    [-a[1], a[0]]
}

/// An upright rectangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rect {
    pub(super) low: Point,
    pub(super) high: Point,
}

impl Rect {
    pub(super) fn grown(self, by: f64) -> Self {
        Self {
            low: [self.low[0] - by, self.low[1] - by],
            high: [self.high[0] + by, self.high[1] + by],
        }
    }

    pub(super) fn moved(self, by: Point) -> Self {
        let plus = |point: Point| [point[0] + by[0], point[1] + by[1]];
        Self { low: plus(self.low), high: plus(self.high) }
    }

    pub(super) fn corners(&self) -> [Point; 4] {
        let ([x0, y0], [x1, y1]) = (self.low, self.high);
        [[x0, y0], [x1, y0], [x1, y1], [x0, y1]]
    }

    pub(super) fn middle(&self) -> Point {
        [(self.low[0] + self.high[0]) * 0.5, (self.low[1] + self.high[1]) * 0.5]
    }

    /// The largest value of `normal · p` in the rectangle.
    pub(super) fn most(&self, normal: Point) -> f64 {
        let pick = |axis: usize| {
            if normal[axis] < 0.0 { self.low[axis] } else { self.high[axis] }
        };
        normal[0] * pick(0) + normal[1] * pick(1)
    }
}

/// A wall, or a disc as a wall without length.
#[derive(Clone, Copy, Debug)]
pub(super) struct Shape {
    pub(super) ends: [Point; 2],
    pub(super) radius: f64,
    pub(super) length: f64,
    /// Unit vector from the first end to the second; anything for a disc.
    pub(super) direction: Point,
}

impl From<&Segment<f32>> for Shape {
    fn from(wall: &Segment<f32>) -> Self {
        let point = |(x, y): (f32, f32)| [f64::from(x), f64::from(y)];
        let ends = [point(wall.a), point(wall.b)];
        let edge = minus(ends[1], ends[0]);
        let length = length(edge);
        let direction =
            if length > 0.0 { [edge[0] / length, edge[1] / length] } else { [1.0, 0.0] };
        Self { ends, radius: 0.0, length, direction }
    }
}

impl From<&Disc<f32>> for Shape {
    fn from(disc: &Disc<f32>) -> Self {
        let centre = [f64::from(disc.centre.0), f64::from(disc.centre.1)];
        let radius = f64::from(disc.radius);
        Self { ends: [centre; 2], radius, length: 0.0, direction: [1.0, 0.0] }
    }
}

impl Shape {
    pub(super) fn is_wall(&self) -> bool {
        self.radius == 0.0 && self.length > 0.0
    }

    /// The smallest value of `normal · q` on the shape; the normal is a unit vector.
    pub(super) fn least(&self, normal: Point) -> f64 {
        dot(normal, self.ends[0]).min(dot(normal, self.ends[1])) - self.radius
    }

    /// How far the rectangle keeps from the wall's line, and on which side of it: positive left,
    /// negative right, 0 where the line meets the rectangle.
    pub(super) fn side(&self, rect: &Rect) -> f64 {
        let normal = left(self.direction);
        let line = dot(normal, self.ends[0]);
        let most = rect.most(normal) - line;
        let least = -rect.most([-normal[0], -normal[1]]) - line;
        if least > 0.0 { least } else { most.min(0.0) }
    }

    /// Distance from the rectangle to the shape, never too much.
    pub(super) fn distance(&self, rect: &Rect) -> f64 {
        let gap = |normal: Point| self.least(normal) - rect.most(normal);
        let normal = left(self.direction);
        let back = [-normal[0], -normal[1]];
        let axes = [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0], normal, back];
        let by_axes = axes.into_iter().map(gap).fold(0.0, f64::max);
        // Diagonally apart, the corner's distance is more than any of these axes shows.
        let apart = |axis: usize| {
            let least = self.ends[0][axis].min(self.ends[1][axis]);
            let most = self.ends[0][axis].max(self.ends[1][axis]);
            (least - rect.high[axis]).max(rect.low[axis] - most).max(0.0)
        };
        by_axes.max(length([apart(0), apart(1)]) - self.radius)
    }

    /// The largest distance between a point of the rectangle and one of the shape.
    pub(super) fn farthest(&self, rect: &Rect) -> f64 {
        let ends = self.ends.into_iter();
        let all = ends.flat_map(|end| rect.corners().map(|corner| length(minus(end, corner))));
        all.fold(0.0, f64::max) + self.radius
    }
}

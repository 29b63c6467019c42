//! Plane geometry in `f64` for deciding what can be left out; never for a distance itself.

use controller_core::geometry::{Disc, Segment};

/// A point or a direction.
pub(super) type Point = [f64; 2];

pub(super) fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

pub(super) fn along(a: Point, direction: Point, by: f64) -> Point {
    [a[0] + direction[0] * by, a[1] + direction[1] * by]
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
        Self { low: along(self.low, by, 1.0), high: along(self.high, by, 1.0) }
    }

    pub(super) fn joined(self, other: Self) -> Self {
        Self {
            low: [self.low[0].min(other.low[0]), self.low[1].min(other.low[1])],
            high: [self.high[0].max(other.high[0]), self.high[1].max(other.high[1])],
        }
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

    /// Distance between two shapes.
    pub(super) fn gap(&self, other: &Self) -> f64 {
        let touching = self.is_wall() && other.is_wall() && self.crosses(other);
        if touching {
            return 0.0;
        }
        let to_other = self.ends.map(|end| other.away(end));
        let to_self = other.ends.map(|end| self.away(end));
        let least = to_other.into_iter().chain(to_self).fold(f64::INFINITY, f64::min);
        (least - self.radius - other.radius).max(0.0)
    }

    /// Distance from a point to the line between the ends.
    fn away(&self, point: Point) -> f64 {
        let from = minus(point, self.ends[0]);
        let nearest = dot(from, self.direction).clamp(0.0, self.length);
        length(minus(from, [self.direction[0] * nearest, self.direction[1] * nearest]))
    }

    fn crosses(&self, other: &Self) -> bool {
        let sides = |wall: &Self, points: [Point; 2]| {
            points.map(|point| cross(wall.direction, minus(point, wall.ends[0])) > 0.0)
        };
        let [a, b] = sides(self, other.ends);
        let [c, d] = sides(other, self.ends);
        a != b && c != d
    }
}

/// Corners of the smallest convex outline around some points, counter-clockwise.
pub(super) fn hull(points: &mut [Point]) -> Vec<Point> {
    points.sort_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    let mut outline: Vec<Point> = Vec::with_capacity(points.len() + 1);
    let turns_left = |outline: &[Point], point: Point| {
        let [.., a, b] = outline else { return true };
        cross(minus(*b, *a), minus(point, *b)) > 0.0
    };
    for point in points.iter() {
        while !turns_left(&outline, *point) {
            outline.pop();
        }
        outline.push(*point);
    }
    let lower = outline.len();
    for point in points.iter().rev().skip(1) {
        while outline.len() > lower && !turns_left(&outline, *point) {
            outline.pop();
        }
        outline.push(*point);
    }
    outline.pop();
    outline
}

/// Whether a point lies at least `margin` outside of a convex outline.
pub(super) fn is_outside(outline: &[Point], point: Point, margin: f64) -> bool {
    let next = outline.iter().cycle().skip(1);
    outline.iter().zip(next).any(|(a, b)| {
        let edge = minus(*b, *a);
        cross(edge, minus(point, *a)) < -margin * length(edge)
    })
}

//! Settings that are points, shapes or lists of them.

use std::marker::PhantomData;

use super::keys::braces;
use super::number::Number;
use super::problem::Problem;
use super::reader::read_record;
use super::schema::{Codec, FARTHEST, Record};
use super::value::Found;
use super::writer::write_record;
use super::*;

const COORDINATE: Number = Number::metres(-FARTHEST, FARTHEST);

/// Most corners of one polygon; finding self-intersections compares its edges in pairs.
pub(super) const MOST_CORNERS: usize = 4096;

/// Most obstacles, corners and pairs of a file in one list.
pub(super) const MOST_ITEMS: usize = 100_000;

/// A list of anything.
pub(super) struct List<C>(pub(super) C);

impl<T, C: Codec<T>> Codec<Vec<T>> for List<C> {
    fn read(&self, found: &Found<'_>, problems: &mut Vec<Problem>) -> Option<Vec<T>> {
        let items = found.items(&self.expected(), problems)?;
        if items.len() > MOST_ITEMS {
            let detail = format!("found {} entries, expected at most {MOST_ITEMS}", items.len());
            found.refuse("is too long", detail, problems);
            return None;
        }
        let mut values = Vec::with_capacity(items.len());
        let mut bad = 0;
        for item in items {
            match self.0.read(&item, problems) {
                Some(value) => values.push(value),
                // Several bad items are worth telling; a whole list of them is one mistake.
                None if bad == 2 => return None,
                None => bad += 1,
            }
        }
        (bad == 0).then_some(values)
    }

    fn write(&self, value: &Vec<T>) -> Option<String> {
        let items: Option<Vec<String>> = value.iter().map(|item| self.0.write(item)).collect();
        let items = items.filter(|items| !items.is_empty())?;
        Some(format!("[\n    {},\n]", items.join(",\n    ")))
    }

    fn expected(&self) -> String {
        format!("a list of entries, each {}", self.0.expected())
    }
}

/// A setting that other settings can make meaningless; then it is not written.
pub(super) struct Maybe<C>(pub(super) C);

impl<T, C: Codec<T>> Codec<Option<T>> for Maybe<C> {
    fn read(&self, found: &Found<'_>, problems: &mut Vec<Problem>) -> Option<Option<T>> {
        self.0.read(found, problems).map(Some)
    }

    fn write(&self, value: &Option<T>) -> Option<String> {
        self.0.write(value.as_ref()?)
    }

    fn expected(&self) -> String {
        self.0.expected()
    }
}

/// A setting that has this value unless given; then it is not written.
pub(super) struct Unless<T, C>(pub(super) T, pub(super) C);

impl<T: PartialEq, C: Codec<T>> Codec<T> for Unless<T, C> {
    fn read(&self, found: &Found<'_>, problems: &mut Vec<Problem>) -> Option<T> {
        self.1.read(found, problems)
    }

    fn write(&self, value: &T) -> Option<String> {
        if *value == self.0 { None } else { self.1.write(value) }
    }

    fn expected(&self) -> String {
        self.1.expected()
    }
}

/// A table of its own in a list.
pub(super) struct Entry<T>(PhantomData<T>);

impl<T> Entry<T> {
    pub(super) const fn new() -> Self {
        Self(PhantomData)
    }
}

impl<T: Record + Clone + Default> Codec<T> for Entry<T> {
    fn read(&self, found: &Found<'_>, problems: &mut Vec<Problem>) -> Option<T> {
        read_record(found, T::default(), problems)
    }

    fn write(&self, value: &T) -> Option<String> {
        Some(write_record(value.clone()))
    }

    fn expected(&self) -> String {
        braces(&mut T::default())
    }
}

fn numbers<const N: usize>(
    found: &Found<'_>,
    kinds: [Number; N],
    expected: &str,
    problems: &mut Vec<Problem>,
) -> Option<[f32; N]> {
    let items: [Found<'_>; N] = found.exactly(expected, problems)?;
    let mut values = [0.0; N];
    let mut all = true;
    for ((slot, item), kind) in values.iter_mut().zip(&items).zip(kinds) {
        match kind.read(item, problems) {
            Some(value) => *slot = value,
            None => all = false,
        }
    }
    all.then_some(values)
}

fn write_numbers<const N: usize>(values: [f32; N], kinds: [Number; N]) -> Option<String> {
    let texts: Option<Vec<String>> =
        values.iter().zip(kinds).map(|(value, kind)| kind.write(value)).collect();
    Some(format!("[{}]", texts?.join(", ")))
}

/// `[x, y]`.
#[derive(Clone, Copy)]
pub(super) struct Point;

impl Codec<[f32; 2]> for Point {
    fn read(&self, found: &Found<'_>, problems: &mut Vec<Problem>) -> Option<[f32; 2]> {
        numbers(found, [COORDINATE; 2], &self.expected(), problems)
    }

    fn write(&self, value: &[f32; 2]) -> Option<String> {
        write_numbers(*value, [COORDINATE; 2])
    }

    fn expected(&self) -> String {
        "a point [x, y] in metres".to_owned()
    }
}

/// `[shortest, longest]` side of a random world.
#[derive(Clone, Copy)]
pub(super) struct Sides;

impl Sides {
    const KINDS: [Number; 2] = [Number::metres(5.0, 50.0); 2];
}

impl Codec<[f32; 2]> for Sides {
    fn read(&self, found: &Found<'_>, problems: &mut Vec<Problem>) -> Option<[f32; 2]> {
        let [shortest, longest] = numbers(found, Self::KINDS, &self.expected(), problems)?;
        if shortest <= longest {
            return Some([shortest, longest]);
        }
        let detail = format!("found {shortest} above {longest}, expected the smaller one first");
        found.refuse("is in the wrong order", detail, problems);
        None
    }

    fn write(&self, value: &[f32; 2]) -> Option<String> {
        write_numbers(*value, Self::KINDS)
    }

    fn expected(&self) -> String {
        "sides [shortest, longest] from 5 m to 50 m".to_owned()
    }
}

/// `[x, y, heading]`: metres and degrees in the file, radians in the scenario.
#[derive(Clone, Copy)]
pub(super) struct Pose;

impl Pose {
    const KINDS: [Number; 3] = [COORDINATE, COORDINATE, Number::degrees(-360.0, 360.0)];
}

impl Codec<[f32; 3]> for Pose {
    fn read(&self, found: &Found<'_>, problems: &mut Vec<Problem>) -> Option<[f32; 3]> {
        numbers(found, Self::KINDS, &self.expected(), problems)
    }

    fn write(&self, value: &[f32; 3]) -> Option<String> {
        write_numbers(*value, Self::KINDS)
    }

    fn expected(&self) -> String {
        "a pose [x, y, heading] in metres and degrees".to_owned()
    }
}

/// `[x0, y0, x1, y1]`, lower left corner first.
#[derive(Clone, Copy)]
pub(super) struct Area;

impl Codec<[f32; 4]> for Area {
    fn read(&self, found: &Found<'_>, problems: &mut Vec<Problem>) -> Option<[f32; 4]> {
        let area = numbers(found, [COORDINATE; 4], &self.expected(), problems)?;
        let [x0, y0, x1, y1] = area;
        for (axis, low, high) in [("x", x0, x1), ("y", y0, y1)] {
            if low >= high {
                let detail = format!(
                    "found {axis}0 = {low} and {axis}1 = {high}, expected {axis}0 below {axis}1"
                );
                found.refuse("is no box", detail, problems);
                return None;
            }
        }
        Some(area)
    }

    fn write(&self, value: &[f32; 4]) -> Option<String> {
        write_numbers(*value, [COORDINATE; 4])
    }

    fn expected(&self) -> String {
        "a box [x0, y0, x1, y1] in metres".to_owned()
    }
}

/// `[x, y, radius]`.
#[derive(Clone, Copy)]
pub(super) struct Disc;

impl Disc {
    const KINDS: [Number; 3] = [COORDINATE, COORDINATE, Number::metres(0.001, FARTHEST)];
}

impl Codec<Circle> for Disc {
    fn read(&self, found: &Found<'_>, problems: &mut Vec<Problem>) -> Option<Circle> {
        let [x, y, radius] = numbers(found, Self::KINDS, &self.expected(), problems)?;
        Some(Circle { centre: [x, y], radius })
    }

    fn write(&self, value: &Circle) -> Option<String> {
        let [x, y] = value.centre;
        write_numbers([x, y, value.radius], Self::KINDS)
    }

    fn expected(&self) -> String {
        "a disc [x, y, radius] in metres".to_owned()
    }
}

/// Points of an open line, no two neighbours equal.
#[derive(Clone, Copy)]
pub(super) struct Polyline;

impl Codec<Vec<[f32; 2]>> for Polyline {
    fn read(&self, found: &Found<'_>, problems: &mut Vec<Problem>) -> Option<Vec<[f32; 2]>> {
        let points = points(found, 2, &self.expected(), problems)?;
        let doubled = points.windows(2).position(|pair| pair[0] == pair[1]);
        if let Some(index) = doubled {
            repeated(found, index + 1, points[index], problems);
            return None;
        }
        Some(points)
    }

    fn write(&self, value: &Vec<[f32; 2]>) -> Option<String> {
        write_points(value)
    }

    fn expected(&self) -> String {
        "at least 2 points [[x, y], ...] in metres".to_owned()
    }
}

/// Corners of a simple polygon.
#[derive(Clone, Copy)]
pub(super) struct Polygon;

impl Codec<Vec<[f32; 2]>> for Polygon {
    fn read(&self, found: &Found<'_>, problems: &mut Vec<Problem>) -> Option<Vec<[f32; 2]>> {
        let corners = points(found, 3, &self.expected(), problems)?;
        match polygon::flaw(&corners) {
            None => Some(corners),
            Some(polygon::Flaw::Repeated { corner }) => {
                repeated(found, corner, corners[corner], problems);
                None
            }
            Some(polygon::Flaw::Crossing { edges: [a, b] }) => {
                let n = corners.len();
                let name = |edge: usize| {
                    let ([x0, y0], [x1, y1]) = (corners[edge], corners[(edge + 1) % n]);
                    format!("({x0}, {y0})–({x1}, {y1})")
                };
                let detail = format!(
                    "the edges {} and {} meet, expected a polygon whose edges meet at corners only",
                    name(a),
                    name(b)
                );
                found.refuse("crosses itself", detail, problems);
                None
            }
            Some(polygon::Flaw::Flat { area }) => {
                let detail = format!("found an area of {area} m², expected at least 1 mm²");
                found.refuse("has no area", detail, problems);
                None
            }
        }
    }

    fn write(&self, value: &Vec<[f32; 2]>) -> Option<String> {
        write_points(value)
    }

    fn expected(&self) -> String {
        "at least 3 corners [[x, y], ...] in metres".to_owned()
    }
}

fn points(
    found: &Found<'_>,
    fewest: usize,
    expected: &str,
    problems: &mut Vec<Problem>,
) -> Option<Vec<[f32; 2]>> {
    let items = found.items(expected, problems)?;
    let count = items.len();
    if !(fewest..=MOST_CORNERS).contains(&count) {
        let detail = format!("found {count}, expected {expected}, and at most {MOST_CORNERS}");
        found.refuse("has the wrong number of points", detail, problems);
        return None;
    }
    let read: Vec<_> = items.map(|item| Point.read(&item, problems)).collect();
    read.into_iter().collect()
}

fn write_points(points: &[[f32; 2]]) -> Option<String> {
    let texts: Option<Vec<String>> = points.iter().map(|point| Point.write(point)).collect();
    Some(format!("[{}]", texts?.join(", ")))
}

fn repeated(found: &Found<'_>, index: usize, [x, y]: [f32; 2], problems: &mut Vec<Problem>) {
    let detail = format!(
        "point {index}, counted from 0, is ({x}, {y}) like its neighbour, expected a piece with a length"
    );
    found.refuse("has a piece of length zero", detail, problems);
}

/// A beam's mount; one at the middle of the front axle is its angle alone.
struct Mount;

impl Codec<BeamMount> for Mount {
    fn read(&self, found: &Found<'_>, problems: &mut Vec<Problem>) -> Option<BeamMount> {
        if found.table().is_some() {
            return Entry::<BeamMount>::new().read(found, problems);
        }
        let angle = BEAM_ANGLE.read(found, problems)?;
        Some(BeamMount { angle, ..BeamMount::default() })
    }

    fn write(&self, value: &BeamMount) -> Option<String> {
        if *value == (BeamMount { angle: value.angle, ..BeamMount::default() }) {
            return BEAM_ANGLE.write(&value.angle);
        }
        Entry::<BeamMount>::new().write(value)
    }

    fn expected(&self) -> String {
        format!("angles in degrees or {}", Entry::<BeamMount>::new().expected())
    }
}

/// Where a beam may point.
pub(super) const BEAM_ANGLE: Number = Number::degrees(-180.0, 180.0);

/// Exactly five beam mounts, from the rightmost to the leftmost.
pub(super) struct Beams;

impl Codec<[BeamMount; BEAMS]> for Beams {
    fn read(&self, found: &Found<'_>, problems: &mut Vec<Problem>) -> Option<[BeamMount; BEAMS]> {
        let items: [Found<'_>; BEAMS] = found.exactly(&self.expected(), problems)?;
        let mut beams = [BeamMount::default(); BEAMS];
        for (slot, item) in beams.iter_mut().zip(&items) {
            *slot = Mount.read(item, problems)?;
        }
        if let Some(index) = beams.windows(2).position(|pair| pair[0].angle > pair[1].angle) {
            let detail = format!(
                "beam {} points farther right than beam {index}, expected angles that grow from the rightmost to the leftmost",
                index + 1
            );
            found.refuse("are in the wrong order", detail, problems);
            return None;
        }
        Some(beams)
    }

    fn write(&self, value: &[BeamMount; BEAMS]) -> Option<String> {
        let beams: Option<Vec<String>> = value.iter().map(|beam| Mount.write(beam)).collect();
        let one_line = format!("[{}]", beams?.join(", "));
        Some(if one_line.contains('{') { one_line.replace("}, ", "},\n    ") } else { one_line })
    }

    fn expected(&self) -> String {
        format!("{BEAMS} {}", Mount.expected())
    }
}

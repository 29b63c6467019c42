//! From metres to the picture's pixels, and the scale around the edge.

use std::fmt::Write;

use crate::report::palette::{INK, MUTED, PAPER, RULE};
use crate::report::svg::{Num, escape};

/// Pixels of the room's longer side.
const LONG_SIDE: f64 = 420.0;
const LEFT: f64 = 46.0;
const RIGHT: f64 = 18.0;
const TOP: f64 = 40.0;
const BOTTOM: f64 = 40.0;
/// Fonts every system has under one of these names; nothing is fetched.
pub(in crate::report) const FONTS: &str = "system-ui, 'Segoe UI', 'DejaVu Sans', sans-serif";

/// A picture of a room: equal scale in x and y, y upwards.
pub(super) struct Frame {
    /// Lower left corner of the room, metres.
    min: [f64; 2],
    /// Size of the room, metres.
    size: [f64; 2],
    /// Pixels per metre.
    pub(super) scale: f64,
}

impl Frame {
    /// Fits a room given by its lower left and upper right corner.
    pub(super) fn new(bounds: [[f32; 2]; 2]) -> Self {
        Self::sized(bounds, LONG_SIDE)
    }

    /// The same with this many pixels on the room's longer side.
    pub(super) fn sized(bounds: [[f32; 2]; 2], long_side: f64) -> Self {
        let [min, max] = bounds.map(|corner| corner.map(f64::from));
        // An empty or non-finite room still gives a well-formed picture.
        let side = |axis: usize| {
            let side = max[axis] - min[axis];
            if side.is_finite() && side > 0.0 { side } else { 1.0 }
        };
        let size = [side(0), side(1)];
        let min = min.map(|corner| if corner.is_finite() { corner } else { 0.0 });
        Self { min, size, scale: long_side / size[0].max(size[1]) }
    }

    /// Where a point in metres lies in the picture, pixels.
    pub(super) fn place(&self, point: [f32; 2]) -> [f64; 2] {
        let [x, y] = point.map(f64::from);
        let height = self.size[1] * self.scale;
        [LEFT + (x - self.min[0]) * self.scale, TOP + height - (y - self.min[1]) * self.scale]
    }

    /// The attribute that lets a group be written in metres.
    pub(super) fn transform(&self) -> String {
        let [x, y] = self.place([0.0, 0.0]);
        format!("transform=\"matrix({} 0 0 -{} {} {})\"", self.scale, self.scale, Num(x), Num(y))
    }

    /// The room as `x y width height` attributes in pixels.
    pub(super) fn room(&self) -> String {
        let [width, height] = self.size.map(|side| Num(side * self.scale));
        format!("x=\"{LEFT}\" y=\"{TOP}\" width=\"{width}\" height=\"{height}\"")
    }

    /// A complete picture: ground, scale, a heading and what is in the room.
    pub(super) fn svg(&self, name: &str, heading: &str, content: &str) -> String {
        let [width, height] = self.size.map(|side| side * self.scale);
        let (full_width, full_height) = (Num(LEFT + width + RIGHT), Num(TOP + height + BOTTOM));
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\" \
             viewBox=\"0 0 {full_width} {full_height}\" width=\"{full_width}\" \
             height=\"{full_height}\" font-family=\"{FONTS}\" font-size=\"12\">\n\
             <title>{}</title>\n\
             <rect width=\"100%\" height=\"100%\" fill=\"{PAPER}\"/>\n\
             <text x=\"{LEFT}\" y=\"24\" font-size=\"14\" font-weight=\"600\" fill=\"{INK}\">{}</text>\n\
             {}{content}</svg>\n",
            escape(name),
            escape(heading),
            self.scale_marks(),
        )
    }

    /// Grid lines and their numbers, in metres.
    fn scale_marks(&self) -> String {
        let mut lines = String::new();
        let mut numbers = String::new();
        let step = round_step(self.size[0].max(self.size[1]));
        let right = LEFT + self.size[0] * self.scale;
        let bottom = TOP + self.size[1] * self.scale;
        for tick in ticks(self.min[0], self.size[0], step) {
            let x = Num(LEFT + (tick - self.min[0]) * self.scale);
            let _ = write!(lines, "M{x} {TOP}V{}", Num(bottom));
            let (y, number) = (Num(bottom + 16.0), label(tick, step));
            let _ =
                write!(numbers, "<text x=\"{x}\" y=\"{y}\" text-anchor=\"middle\">{number}</text>");
        }
        for tick in ticks(self.min[1], self.size[1], step) {
            let y = bottom - (tick - self.min[1]) * self.scale;
            let _ = write!(lines, "M{LEFT} {}H{}", Num(y), Num(right));
            let (x, y, number) = (LEFT - 8.0, Num(y + 4.0), label(tick, step));
            let _ =
                write!(numbers, "<text x=\"{x}\" y=\"{y}\" text-anchor=\"end\">{number}</text>");
        }
        let (x, y) = (Num((LEFT + right) / 2.0), Num(bottom + 33.0));
        format!(
            "<path d=\"{lines}\" fill=\"none\" stroke=\"{RULE}\"/>\n\
             <g fill=\"{MUTED}\" font-size=\"12\">{numbers}\
             <text x=\"{x}\" y=\"{y}\" text-anchor=\"middle\">metres</text></g>\n"
        )
    }
}

/// 1, 2 or 5 times a power of ten, so that a side has five to twelve marks.
fn round_step(side: f64) -> f64 {
    let rough = side / 10.0;
    let decade = libm::pow(10.0, libm::log10(rough).floor());
    let multiple = [1.0, 2.0, 5.0].into_iter().find(|m| m * decade >= rough * 0.999);
    multiple.unwrap_or(10.0) * decade
}

fn ticks(min: f64, size: f64, step: f64) -> impl Iterator<Item = f64> {
    let first = (min / step - 1e-6).ceil();
    let count = (((min + size) / step + 1e-6).floor() - first).clamp(0.0, 50.0) as usize;
    (0..=count).map(move |i| (first + i as f64) * step)
}

/// A mark's number with as many decimals as its step needs.
fn label(tick: f64, step: f64) -> String {
    let decimals = (-libm::log10(step).floor()).clamp(0.0, 6.0) as usize;
    let text = format!("{tick:.decimals$}");
    if text.trim_start_matches('-').chars().all(|c| matches!(c, '0' | '.')) {
        return "0".to_owned();
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_round_numbers_whatever_the_size_of_the_room() {
        let marks = |min: f64, size: f64| {
            let step = round_step(size);
            ticks(min, size, step).map(|t| label(t, step)).collect::<Vec<_>>().join(" ")
        };
        assert_eq!(marks(0.0, 10.0), "0 1 2 3 4 5 6 7 8 9 10");
        assert_eq!(marks(-0.35, 0.9), "-0.3 -0.2 -0.1 0 0.1 0.2 0.3 0.4 0.5");
        assert_eq!(marks(-15.3, 30.6), "-15 -10 -5 0 5 10 15");
    }

    #[test]
    fn a_metre_is_as_long_upwards_as_sideways() {
        let frame = Frame::new([[-3.0, 2.0], [17.0, 7.0]]);
        let [origin, right, up] = [[0.0, 3.0], [1.0, 3.0], [0.0, 4.0]].map(|p| frame.place(p));
        assert_eq!(right[0] - origin[0], 21.0);
        assert_eq!(origin[1] - up[1], 21.0);
    }

    #[test]
    fn a_room_that_makes_no_sense_still_gives_a_picture() {
        for bounds in [[[0.0; 2]; 2], [[f32::NAN; 2]; 2], [[1.0, 1.0], [0.0, 0.0]]] {
            let svg = Frame::new(bounds).svg("", "", "");
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "{svg}");
        }
    }
}

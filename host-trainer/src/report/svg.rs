//! The few pieces of SVG and HTML text that several pictures share.

use std::fmt::{self, Write};

/// A number with at most three decimals and nothing superfluous: `.25`, `-3`, `0`.
///
/// What is not finite prints as 0, so that no input can make the text ill-formed.
pub(super) struct Num(pub(super) f64);

impl fmt::Display for Num {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let thousandths = thousandths(self.0);
        if thousandths < 0 {
            f.write_char('-')?;
        }
        let (whole, part) = (thousandths.unsigned_abs() / 1000, thousandths.unsigned_abs() % 1000);
        if part == 0 {
            return write!(f, "{whole}");
        }
        if whole != 0 {
            write!(f, "{whole}")?;
        }
        let digits = format!("{part:03}");
        write!(f, ".{}", digits.trim_end_matches('0'))
    }
}

/// Rounded to thousandths; 0 for what is not finite.
pub(super) fn thousandths(value: f64) -> i64 {
    // A saturating cast: NaN gives 0, and a drawing this large is no drawing any more.
    if value.is_finite() { (value * 1000.0).round() as i64 } else { 0 }
}

/// Text that can stand in an element or in a double-quoted attribute.
pub(super) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            // XML has no way to write most control characters.
            c if c.is_control() && !matches!(c, '\n' | '\t') => out.push('\u{fffd}'),
            c => out.push(c),
        }
    }
    out
}

/// Builds the `d` of a path from absolute points, written as differences, which is a third
/// of the size on a grid map. Rounding happens before differencing, so it never adds up.
#[derive(Default)]
pub(super) struct PathText {
    text: String,
    pen: Option<(i64, i64)>,
}

impl PathText {
    /// Starts a new line at a point, unless the pen is already there.
    pub(super) fn move_to(&mut self, point: [f64; 2]) {
        let to = quantised(point);
        if self.pen != Some(to) {
            let _ = write!(self.text, "M{} {}", Num(point[0]), Num(point[1]));
            self.pen = Some(to);
        }
    }

    /// Draws a line to a point.
    pub(super) fn line_to(&mut self, point: [f64; 2]) {
        let to = quantised(point);
        let from = self.pen.unwrap_or(to);
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let (x, y) = (Num(dx as f64 / 1000.0), Num(dy as f64 / 1000.0));
        let _ = match (dx, dy) {
            (_, 0) => write!(self.text, "h{x}"),
            (0, _) => write!(self.text, "v{y}"),
            _ => write!(self.text, "l{x} {y}"),
        };
        self.pen = Some(to);
    }

    /// Joins the line's end to its start.
    pub(super) fn close(&mut self) {
        self.text.push('z');
        self.pen = None;
    }

    /// A full circle.
    pub(super) fn circle(&mut self, centre: [f64; 2], radius: f64) {
        let r = Num(radius);
        let (left, y) = (Num(centre[0] - radius), Num(centre[1]));
        let (out, back) = (Num(2.0 * radius), Num(-2.0 * radius));
        let _ = write!(self.text, "M{left} {y}a{r} {r} 0 1 1 {out} 0a{r} {r} 0 1 1 {back} 0z");
        self.pen = None;
    }

    /// The finished text.
    pub(super) fn finish(self) -> String {
        self.text
    }
}

fn quantised(point: [f64; 2]) -> (i64, i64) {
    (thousandths(point[0]), thousandths(point[1]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_carry_three_decimals_and_nothing_superfluous() {
        let written = [0.0, -0.0004, 0.25, -0.05, 12.0, -2.7654, 1e-9, f64::NAN, f64::INFINITY]
            .map(|n| Num(n).to_string());
        assert_eq!(written, ["0", "0", ".25", "-.05", "12", "-2.765", "0", "0", "0"]);
    }

    #[test]
    fn a_path_ends_exactly_where_its_last_point_is_however_many_steps_led_there() {
        let mut path = PathText::default();
        path.move_to([0.0, 0.0]);
        for step in 1..=3 {
            path.line_to([f64::from(step) / 3.0, 0.0]);
        }
        assert_eq!(path.finish(), "M0 0h.333h.334h.333");
    }

    #[test]
    fn markup_in_a_name_stays_text() {
        assert_eq!(escape("<a b=\"c\">&'\u{1}"), "&lt;a b=&quot;c&quot;&gt;&amp;&#39;\u{fffd}");
    }
}

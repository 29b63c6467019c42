//! What disturbances cost, as curves: a panel for each, the share over the size.

use std::fmt::Write;

use super::map::FONTS;
use super::palette::{GOAL, INK, MUTED, PAPER, PATH, RULE};
use super::svg::{Num, escape};

/// One disturbance.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// What it is.
    pub title: String,
    /// Its sizes, ascending, the first of them none.
    pub points: Vec<Point>,
}

/// How the drives went at one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Times the full size.
    pub scale: f64,
    /// Share that reached and share that drove clean, 0 to 1, each with its interval.
    pub shares: [(f64, [f64; 2]); 2],
}

/// What the two shares are called, and their colours.
const CURVES: [(&str, &str); 2] = [("reached", GOAL), ("clean", PATH)];

const COLUMNS: usize = 3;
/// Pixels of a panel with its margins, and of its plot.
const PANEL: [f64; 2] = [270.0, 190.0];
const PLOT: [f64; 2] = [210.0, 120.0];
const MARGIN: [f64; 2] = [44.0, 40.0];
/// Room above the panels.
const HEAD: f64 = 58.0;

/// A panel for each disturbance; the same data gives the same bytes.
pub fn stress_svg(title: &str, panels: &[Panel]) -> String {
    let rows = panels.len().div_ceil(COLUMNS);
    let (width, height) = (PANEL[0] * COLUMNS as f64, HEAD + PANEL[1] * rows as f64);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {w} {h}\" width=\"{w}\" \
         height=\"{h}\" font-family=\"{FONTS}\" font-size=\"11\">\n<title>{title}</title>\n\
         <rect width=\"{w}\" height=\"{h}\" fill=\"{PAPER}\"/>\n\
         <text x=\"{x}\" y=\"24\" font-size=\"15\" fill=\"{INK}\">{title}</text>\n",
        w = Num(width),
        h = Num(height),
        x = Num(MARGIN[0]),
        title = escape(title),
    );
    for (index, (name, colour)) in CURVES.into_iter().enumerate() {
        let x = MARGIN[0] + 80.0 * index as f64;
        let _ = writeln!(
            out,
            "<path d=\"M{} 42h18\" stroke=\"{colour}\" stroke-width=\"2\"/><text x=\"{}\" y=\"46\" \
             fill=\"{INK}\">{name}</text>",
            Num(x),
            Num(x + 24.0),
        );
    }
    for (index, panel) in panels.iter().enumerate() {
        let x = MARGIN[0] + PANEL[0] * (index % COLUMNS) as f64;
        let y = HEAD + MARGIN[1] + PANEL[1] * (index / COLUMNS) as f64;
        let _ = writeln!(out, "<g transform=\"translate({} {})\">", Num(x), Num(y));
        out += &axes(panel);
        for curve in 0..CURVES.len() {
            out += &line(panel, curve);
        }
        out += "</g>\n";
    }
    out + "</svg>\n"
}

/// Where a size and a share lie in a panel whose largest size is `most`.
fn place(scale: f64, share: f64, most: f64) -> [f64; 2] {
    [PLOT[0] * scale / most, PLOT[1] * (1.0 - share)]
}

/// The largest size of a panel.
fn most(panel: &Panel) -> f64 {
    panel.points.iter().map(|point| point.scale).fold(1.0, f64::max)
}

fn axes(panel: &Panel) -> String {
    let mut out = format!("<text y=\"-10\" fill=\"{INK}\">{}</text>\n", escape(&panel.title));
    for percent in [0, 50, 100] {
        let [x, y] = place(0.0, f64::from(percent) / 100.0, 1.0);
        let _ = writeln!(
            out,
            "<path d=\"M{} {}h{}\" stroke=\"{RULE}\"/><text x=\"-6\" y=\"{}\" text-anchor=\"end\" \
             fill=\"{MUTED}\">{percent} %</text>",
            Num(x),
            Num(y),
            Num(PLOT[0]),
            Num(y + 4.0),
        );
    }
    for point in &panel.points {
        let [x, _] = place(point.scale, 0.0, most(panel));
        let label = if point.scale == 0.0 { "none".into() } else { format!("×{}", point.scale) };
        let _ = writeln!(
            out,
            "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\" fill=\"{MUTED}\">{label}</text>",
            Num(x),
            Num(PLOT[1] + 16.0),
        );
    }
    out
}

/// One share over the size, with its intervals.
fn line(panel: &Panel, curve: usize) -> String {
    let (_, colour) = CURVES[curve];
    let most = most(panel);
    let (mut points, mut bars) = (String::new(), String::new());
    for point in &panel.points {
        let (share, [low, high]) = point.shares[curve];
        let [x, y] = place(point.scale, share, most);
        let [_, top] = place(point.scale, high, most);
        let [_, bottom] = place(point.scale, low, most);
        let _ = write!(points, "{},{} ", Num(x), Num(y));
        let _ = write!(bars, "M{} {}V{}", Num(x), Num(top), Num(bottom));
    }
    format!(
        "<polyline points=\"{}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"2\"/>\n\
         <path d=\"{bars}\" stroke=\"{colour}\" stroke-width=\"4\" stroke-opacity=\".35\"/>\n",
        points.trim_end(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn point(scale: f64, clean: f64) -> Point {
        Point { scale, shares: [(1.0, [0.99, 1.0]), (clean, [clean - 0.1, clean + 0.1])] }
    }

    #[test]
    fn a_curve_runs_from_none_on_the_left_to_the_largest_size_on_the_right() {
        let points = vec![point(0.0, 0.5), point(1.0, 0.5), point(2.0, 0.25)];
        let picture = stress_svg("a & b", &[Panel { title: "servo <time>".into(), points }]);
        // The plot is 210 by 120 pixels, 0 % at the bottom.
        assert!(picture.contains("points=\"0,60 105,60 210,90\""), "{picture}");
        assert!(picture.contains("points=\"0,0 105,0 210,0\""), "{picture}");
        assert!(picture.contains("M210 78V102"), "the interval of the last point: {picture}");
        for text in [">none<", ">×1<", ">×2<", "servo &lt;time&gt;", "a &amp; b"] {
            assert!(picture.contains(text), "{text}: {picture}");
        }
    }

    #[test]
    fn without_a_panel_there_is_a_picture_all_the_same() {
        assert!(stress_svg("none", &[]).ends_with("</svg>\n"));
    }
}

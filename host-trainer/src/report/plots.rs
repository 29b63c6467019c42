//! Curves over generations (the paper's Figs. 5 and 6) and the path of a drive.
//!
//! The only module that knows kuva.

mod seeds;

use kuva::backend::svg::SvgBackend;
use kuva::prelude::{
    Figure, Layout, LegendPosition, LinePlot, Plot, ScatterPlot, Theme, TickFormat,
};

use super::data::Generation;
use super::map::FONTS;
use super::palette::{BAND, COLLISION, GOAL, INK, LOOP, MUTED, PAPER, PATH, RULE};
use super::svg::escape;

pub use super::map::trajectory_svg;
pub use seeds::{Band, Line, SeedPanel, Strip, seeds_svg, strips_svg};

/// Pixels of one panel.
const PANEL: (f64, f64) = (460.0, 300.0);

/// Points of one curve; a panel is about 400 pixels wide.
const MOST_POINTS: usize = 800;

/// One curve of a panel.
struct Curve {
    name: Option<&'static str>,
    colour: &'static str,
    width: f64,
    value: Value,
}

/// What a curve shows of a generation.
type Value = fn(&Generation) -> f64;

/// Fitness over generations (the paper's Fig. 5), lower is better: on the left the best
/// individual on its own scale, on the right the whole population, whose worst members
/// would flatten it.
///
/// Values that are not finite leave a gap; no history gives an empty picture.
pub fn fitness_svg(history: &[Generation]) -> String {
    let best = Curve { name: None, colour: PATH, width: 2.2, value: |g| g.best };
    let population = [
        Curve { name: Some("worst"), colour: BAND, width: 1.2, value: |g| g.worst },
        Curve { name: Some("mean"), colour: LOOP, width: 1.6, value: |g| g.mean },
        Curve { name: Some("best"), colour: PATH, width: 2.2, value: |g| g.best },
    ];
    let panels = vec![
        panel("Best individual", "fitness (lower is better)", &[best], None, history),
        panel("Whole population", "fitness (lower is better)", &population, None, history),
    ];
    figure("fitness", "Fitness over generations", 1, panels)
}

/// The four partial criteria of the best individual over generations (the paper's Fig. 6):
/// collisions, distance to the target, targets reached (what the bonus is paid for) and
/// path length, each summed over the start/goal pairs.
pub fn criteria_svg(history: &[Generation]) -> String {
    let criterion = |title, unit, colour, value: Value| {
        let curve = Curve { name: None, colour, width: 2.0, value };
        panel(title, unit, &[curve], Some(0.0), history)
    };
    let pairs = history.iter().map(|g| g.pairs).max().unwrap_or(0).max(1);
    let (reached, whole_pairs) =
        criterion("Targets reached", "pairs", GOAL, |g| f64::from(g.reached));
    let whole_pairs = whole_pairs
        .with_y_axis_max(f64::from(pairs) * 1.04)
        .with_y_tick_step(f64::from(pairs.div_ceil(6)))
        .with_y_tick_format(TickFormat::Integer);
    let panels = vec![
        criterion("Collisions", "moves in contact", COLLISION, |g| g.collisions),
        criterion("Distance to target at the end", "metres", LOOP, |g| g.distance),
        (reached, whole_pairs),
        criterion("Path length", "metres", PATH, |g| g.length),
    ];
    figure("criteria", "Partial criteria over generations", 2, panels)
}

/// Curves with their axes; the vertical one shows `floor` too, if there is one.
fn panel(
    title: &str,
    unit: &str,
    curves: &[Curve],
    floor: Option<f64>,
    history: &[Generation],
) -> (Vec<Plot>, Layout) {
    let plots: Vec<Plot> = curves
        .iter()
        .flat_map(|curve| {
            let mut name = curve.name;
            runs(history, curve.value).map(move |points| {
                if let [point] = points[..] {
                    // A line needs two.
                    let dot = ScatterPlot::new().with_data([point]).with_color(curve.colour);
                    return dot.with_size(3.0).into();
                }
                let line = LinePlot::new()
                    .with_data(points)
                    .with_color(curve.colour)
                    .with_stroke_width(curve.width);
                match name.take() {
                    Some(name) => line.with_legend(name).into(),
                    None => line.into(),
                }
            })
        })
        .collect();
    let last = f64::from(history.iter().map(|g| g.number).max().unwrap_or(0).max(1));
    let values = curves.iter().flat_map(|curve| history.iter().map(curve.value));
    let y = Axis::over(values.filter(|value| value.is_finite()).chain(floor));
    let layout = layout(&plots, title, unit, last, &y);
    (plots, layout)
}

/// Generations to the right, up to `last`, and the vertical axis.
fn layout(plots: &[Plot], title: &str, unit: &str, last: f64, y: &Axis) -> Layout {
    let (generations, _) = tick_step(last);
    let mut layout = Layout::auto_from_plots(plots);
    // kuva measures the labels on this range.
    layout.y_range = (y.low, y.high);
    lettered(layout, title)
        .with_x_label("generation")
        .with_y_label(unit)
        .with_x_axis_min(0.0)
        .with_x_axis_max(last)
        .with_x_tick_step(generations.max(1.0))
        .with_x_tick_format(TickFormat::Integer)
        .with_y_axis_min(y.low)
        .with_y_axis_max(y.high)
        .with_y_tick_step(y.step)
        .with_y_tick_format(TickFormat::Fixed(y.decimals))
        .with_legend_position(LegendPosition::OutsideRightTop)
}

/// Colours and letters that all panels share.
fn lettered(layout: Layout, title: &str) -> Layout {
    layout
        .with_theme(theme())
        .with_title(title)
        .with_font_family(FONTS)
        .with_title_size(15)
        .with_label_size(12)
        .with_tick_size(11)
        .with_body_size(12)
}

/// A vertical axis from one tick to another.
struct Axis {
    low: f64,
    high: f64,
    step: f64,
    decimals: usize,
}

impl Axis {
    /// The axis for these finite values. It has a height even if they are all the same.
    fn over(values: impl Iterator<Item = f64>) -> Self {
        let ends = |ends: Option<(f64, f64)>, value: f64| {
            Some(ends.map_or((value, value), |(low, high)| (low.min(value), high.max(value))))
        };
        let (mut low, mut high) = values.fold(None, ends).unwrap_or((0.0, 1.0));
        let size = low.abs().max(high.abs());
        if high - low <= 1e-6 * size {
            // A criterion that stays at zero has nothing below it.
            let room = (0.01 * size).max(1.0);
            (low, high) = (if size == 0.0 { low } else { low - room }, high + room);
        }
        let (step, decimals) = tick_step(high - low);
        let (low, high) = ((low / step).floor() * step, (high / step).ceil() * step);
        Self { low, high, step, decimals }
    }
}

/// A round distance between the ticks of an axis of this length, 1, 2 or 5 times a power of
/// ten, and the decimals that its multiples have.
fn tick_step(length: f64) -> (f64, usize) {
    const MOST_STEPS: f64 = 6.0;
    let least = length / MOST_STEPS;
    let mut exponent = libm::log10(least).floor() as i32;
    // Rounding must not skip a step that fits.
    let fits = |factor: &f64| factor * libm::pow(10.0, f64::from(exponent)) >= least * (1.0 - 1e-9);
    let factor = [1.0, 2.0, 5.0].into_iter().find(fits).unwrap_or_else(|| {
        exponent += 1;
        1.0
    });
    let decimals = usize::try_from(-exponent).unwrap_or(0);
    (factor * libm::pow(10.0, f64::from(exponent)), decimals)
}

/// The finite stretches of a curve.
fn runs(history: &[Generation], value: Value) -> impl Iterator<Item = Vec<(f64, f64)>> {
    history
        .chunk_by(move |a, b| value(a).is_finite() == value(b).is_finite())
        .filter(move |run| run.iter().all(|g| value(g).is_finite()))
        .map(move |run| thinned(run.iter().map(|g| (f64::from(g.number), value(g))).collect()))
}

/// At most about [`MOST_POINTS`] points that look the same: of every stretch narrower than
/// a pixel, its lowest and its highest.
fn thinned(points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    if points.len() <= MOST_POINTS {
        return points;
    }
    let stretch = points.len().div_ceil(MOST_POINTS / 2);
    let by_height = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
    let mut kept = Vec::with_capacity(MOST_POINTS);
    for stretch in points.chunks(stretch) {
        let (low, high) = (stretch.iter().min_by(by_height), stretch.iter().max_by(by_height));
        let mut ends: Vec<(f64, f64)> = low.into_iter().chain(high).copied().collect();
        ends.sort_by(|a, b| a.0.total_cmp(&b.0));
        ends.dedup();
        kept.extend(ends);
    }
    kept
}

fn theme() -> Theme {
    Theme {
        background: PAPER.into(),
        axis_color: MUTED.into(),
        grid_color: RULE.into(),
        tick_color: MUTED.into(),
        text_color: INK.into(),
        legend_bg: PAPER.into(),
        legend_border: RULE.into(),
        ..Theme::light()
    }
}

/// Panels in a grid of so many rows.
fn figure(id: &str, title: &str, rows: usize, panels: Vec<(Vec<Plot>, Layout)>) -> String {
    let columns = panels.len().div_ceil(rows);
    let (plots, layouts) = panels.into_iter().unzip();
    let scene = Figure::new(rows, columns)
        .with_plots(plots)
        .with_layouts(layouts)
        .with_cell_size(PANEL.0, PANEL.1)
        .render();
    let svg = SvgBackend::new().with_pretty(true).render_scene(&scene);
    tidy(&svg, id, title)
}

/// What kuva 0.6 leaves open: a `viewBox`, so that the picture scales; a title for screen
/// readers; ids that are the same in every run (its own come from a process-wide counter)
/// and differ between the pictures of a page.
fn tidy(svg: &str, id: &str, title: &str) -> String {
    const KUVA_ID: &str = "kuva-clip-";
    let mut numbers: Vec<&str> = Vec::new();
    let mut out = String::with_capacity(svg.len());
    let mut pieces = svg.split(KUVA_ID);
    out.push_str(pieces.next().unwrap_or_default());
    for piece in pieces {
        let digits = piece.bytes().take_while(u8::is_ascii_digit).count();
        let (number, rest) = piece.split_at(digits);
        let place = numbers.iter().position(|&n| n == number).unwrap_or_else(|| {
            numbers.push(number);
            numbers.len() - 1
        });
        out.push_str(&format!("{id}-clip-{place}{rest}"));
    }
    let size = |name: &str| {
        let (_, rest) = out.split_once(&format!("{name}=\""))?;
        rest.split_once('"').map(|(value, _)| value.to_owned())
    };
    let (width, height) = (size("width").unwrap_or_default(), size("height").unwrap_or_default());
    let title = escape(title);
    let out =
        out.replacen("<svg ", &format!("<svg role=\"img\" viewBox=\"0 0 {width} {height}\" "), 1);
    out.replacen(">\n", &format!(">\n  <title>{title}</title>\n"), 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_run_keeps_its_spikes_when_it_is_thinned() {
        let mut points: Vec<(f64, f64)> = (0..50_000).map(|n| (f64::from(n), 1.0)).collect();
        points[31_417].1 = -70.0;
        points[31_418].1 = 90.0;
        let thin = thinned(points);
        assert!(thin.len() <= MOST_POINTS);
        assert!(thin.contains(&(31_417.0, -70.0)) && thin.contains(&(31_418.0, 90.0)));
        assert!(thin.is_sorted_by(|a, b| a.0 < b.0));
    }

    #[test]
    fn ids_differ_between_pictures_and_not_between_runs() {
        let kuvas = "<svg width=\"4\" height=\"3\">\n<clipPath id=\"kuva-clip-41\"/>\
                     <g clip-path=\"url(#kuva-clip-41)\"/><clipPath id=\"kuva-clip-7\"/></svg>";
        assert_eq!(
            tidy(kuvas, "fitness", "A & B"),
            "<svg role=\"img\" viewBox=\"0 0 4 3\" width=\"4\" height=\"3\">\n  \
             <title>A &amp; B</title>\n<clipPath id=\"fitness-clip-0\"/>\
             <g clip-path=\"url(#fitness-clip-0)\"/><clipPath id=\"fitness-clip-1\"/></svg>"
        );
    }
}

//! Many runs in one picture: bands over generations, and one dot per run.

use kuva::prelude::{BandPlot, Layout, LinePlot, Plot, StripPlot, TickFormat};

use super::{Axis, figure, layout, lettered};
use crate::report::palette::{BAND, BODY, COLLISION, GOAL, INK, LOOP, MUTED, PATH};

/// What lines are told apart by, in this order; the first is the one that matters.
const COLOURS: [&str; 7] = [PATH, LOOP, GOAL, COLLISION, BAND, BODY, INK];

/// A panel over generations.
#[derive(Clone, Debug, Default)]
pub struct SeedPanel {
    /// Its title.
    pub title: String,
    /// What the vertical axis counts.
    pub unit: &'static str,
    /// Values that the vertical axis must show.
    pub shown: Vec<f64>,
    /// Areas behind the lines, the widest first.
    pub bands: Vec<Band>,
    /// Lines; the first is drawn on top.
    pub lines: Vec<Line>,
}

/// An area between two curves.
#[derive(Clone, Debug, Default)]
pub struct Band {
    /// Its lower edge, by generation.
    pub low: Vec<f64>,
    /// Its upper edge.
    pub high: Vec<f64>,
}

/// A curve.
#[derive(Clone, Debug, Default)]
pub struct Line {
    /// Its name in the legend, if it has one.
    pub name: Option<String>,
    /// Its values, by generation.
    pub values: Vec<f64>,
}

/// A panel with one dot per run, in rows by group.
#[derive(Clone, Debug, Default)]
pub struct Strip {
    /// Its title.
    pub title: String,
    /// What the horizontal axis counts, 0 to 100.
    pub unit: &'static str,
    /// Name of each group, and its values.
    pub groups: Vec<(String, Vec<f64>)>,
}

/// Panels over generations, in so many rows.
///
/// Every value must be finite.
pub fn seeds_svg(id: &str, title: &str, rows: usize, panels: &[SeedPanel]) -> String {
    figure(id, title, rows, panels.iter().map(over_generations).collect())
}

fn over_generations(panel: &SeedPanel) -> (Vec<Plot>, Layout) {
    let bands = panel.bands.iter().map(|Band { low, high }| {
        let band = BandPlot::new(place(low), low.iter().copied(), high.iter().copied());
        band.with_color(PATH).with_opacity(0.16).into()
    });
    let lines = panel.lines.iter().enumerate().map(|(index, of)| line(index, of));
    // The legend keeps their order, and the first is drawn once more, on top.
    let on_top = panel.lines.first().map(|first| line(0, &Line { name: None, ..first.clone() }));
    let plots: Vec<Plot> = bands.chain(lines).chain(on_top).collect();
    let edges = panel.bands.iter().flat_map(|band| band.low.iter().chain(&band.high));
    let values = edges.chain(panel.lines.iter().flat_map(|line| &line.values));
    let longest = panel.lines.iter().map(|line| line.values.len()).max().unwrap_or(0);
    let last = longest.saturating_sub(1).max(1) as f64;
    let axis = Axis::over(values.chain(&panel.shown).copied());
    let layout = layout(&plots, &panel.title, panel.unit, last, &axis);
    (plots, layout)
}

fn line(index: usize, Line { name, values }: &Line) -> Plot {
    let points = place(values).into_iter().zip(values.iter().copied()).collect();
    let line = LinePlot::new()
        .with_data(super::thinned(points))
        .with_color(COLOURS[index % COLOURS.len()])
        .with_stroke_width(if index == 0 { 2.4 } else { 1.3 });
    match name {
        Some(name) => line.with_legend(name).into(),
        None => line.into(),
    }
}

/// The number of each value's generation.
fn place(values: &[f64]) -> Vec<f64> {
    (0..values.len()).map(|generation| generation as f64).collect()
}

/// One dot per run in rows by group, panels side by side; the median is the larger dot.
pub fn strips_svg(id: &str, title: &str, panels: &[Strip]) -> String {
    figure(id, title, 1, panels.iter().map(in_rows).collect())
}

fn in_rows(strip: &Strip) -> (Vec<Plot>, Layout) {
    let mut dots = StripPlot::new().with_horizontal(true).with_swarm().with_point_size(2.6);
    let mut medians = StripPlot::new().with_horizontal(true).with_center().with_point_size(5.0);
    // kuva counts rows from below.
    for (name, values) in strip.groups.iter().rev() {
        let mut sorted = values.clone();
        sorted.sort_by(f64::total_cmp);
        let (low, high) = (sorted.get((sorted.len().max(1) - 1) / 2), sorted.get(sorted.len() / 2));
        let median = low.zip(high).map(|(low, high)| (low + high) / 2.0);
        dots = dots.with_group(name.as_str(), values.iter().copied());
        medians = medians.with_group(name.as_str(), median);
    }
    let plots: Vec<Plot> = vec![
        dots.with_color(MUTED).with_marker_opacity(0.75).into(),
        medians.with_color(PATH).into(),
    ];
    let layout = lettered(Layout::auto_from_plots(&plots), &strip.title)
        .with_x_label(strip.unit)
        .with_x_axis_min(0.0)
        .with_x_axis_max(100.0)
        .with_x_tick_step(20.0)
        .with_x_tick_format(TickFormat::Integer);
    (plots, layout)
}

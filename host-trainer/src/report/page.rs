//! `report.html` and `replay.html`: one file each, readable without a network.
//!
//! The page carries its own style and script and forbids itself, by a content security
//! policy, to load anything else. Obstacles are in it once, as an SVG path that the plots
//! point at and the replay reads. Everything but the replay works without JavaScript.

mod embed;
mod outcomes;
mod settings;
mod study;

pub use study::render_study;

use super::data::ReportData;
use super::{map, palette, plots, svg::escape};

const PAGE: &str = include_str!("page/assets/page.html");
const REPLAY: &str = include_str!("page/assets/replay.html");
const STYLE: &str = include_str!("page/assets/style.css");
/// In the order they run; each uses only what comes before it, or is called later.
const SCRIPT: [&str; 5] = [
    include_str!("page/assets/data.js"),
    include_str!("page/assets/view.js"),
    include_str!("page/assets/paint.js"),
    include_str!("page/assets/player.js"),
    include_str!("page/assets/controls.js"),
];

/// The report of a run: outcomes, replay, paths, learning curves, settings, provenance.
/// Parts without data are left out.
pub fn render(data: &ReportData) -> String {
    let parts = [
        outcomes::tiles(&data.drives),
        replay(data),
        outcomes::table(&data.drives),
        paths(data),
        learning(data),
        settings::settings(&data.settings),
        settings::provenance(&data.provenance),
    ];
    page(data, "report", &parts.concat())
}

/// The replay with its outcomes, and where the champion comes from.
pub fn render_replay(data: &ReportData) -> String {
    let parts =
        [replay(data), outcomes::table(&data.drives), settings::provenance(&data.provenance)];
    page(data, "replay", &parts.concat())
}

fn page(data: &ReportData, kind: &str, main: &str) -> String {
    let summary = match data.summary.as_str() {
        "" => String::new(),
        text => format!("<p>{}</p>\n", escape(text)),
    };
    let slots = [
        ("title", escape(&data.title)),
        ("kind", kind.to_owned()),
        ("style", palette::style_sheet() + STYLE),
        ("world", map::shared_world(&data.scene)),
        ("summary", summary),
        ("main", main.to_owned()),
        ("data", embed::json(data)),
        ("script", format!("(() => {{\n{}}})();\n", SCRIPT.concat())),
    ];
    fill(PAGE, &slots)
}

fn replay(data: &ReportData) -> String {
    if data.drives.is_empty() { String::new() } else { REPLAY.to_owned() }
}

/// One small map per drive.
fn paths(data: &ReportData) -> String {
    if data.drives.is_empty() {
        return String::new();
    }
    let figures: String = data
        .drives
        .iter()
        .enumerate()
        .map(|(index, drive)| {
            let title = format!("Drive {}", index + 1);
            let svg = map::trajectory_on_shared_world(&data.scene, &data.body, drive, &title);
            format!("<figure>{svg}</figure>\n")
        })
        .collect();
    section("paths", "Paths", &format!("<div class=\"figures\">\n{figures}</div>\n"))
}

fn learning(data: &ReportData) -> String {
    if data.history.is_empty() {
        return String::new();
    }
    let content = format!(
        "<figure class=\"wide\">{}</figure>\n<figure class=\"wide\">{}\
         <figcaption>Of the best individual of each generation, summed over its start/goal \
         pairs.</figcaption></figure>\n",
        plots::fitness_svg(&data.history),
        plots::criteria_svg(&data.history),
    );
    section("learning", "Learning", &content)
}

/// A part of the page with its heading.
fn section(id: &str, heading: &str, content: &str) -> String {
    format!(
        "<section id=\"{id}\" aria-labelledby=\"{id}-heading\">\n\
         <h2 id=\"{id}-heading\">{heading}</h2>\n{content}</section>\n"
    )
}

/// Puts values where `{{name}}` stands. A value is never searched for slots itself, so a
/// scenario called `{{data}}` is only a strange name.
fn fill(template: &str, slots: &[(&str, String)]) -> String {
    let mut out = String::new();
    let mut rest = template;
    while let Some((before, after)) = rest.split_once("{{") {
        out.push_str(before);
        let (name, after) = after.split_once("}}").unwrap_or((after, ""));
        if let Some((_, value)) = slots.iter().find(|(slot, _)| *slot == name) {
            out.push_str(value);
        }
        rest = after;
    }
    out.push_str(rest);
    out
}

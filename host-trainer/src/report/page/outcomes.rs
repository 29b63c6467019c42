//! How the drives ended: a few key figures, and a table with a row per drive.

use std::fmt::Write;

use super::section;
use crate::report::data::Drive;
use crate::report::svg::escape;

/// Three grades that a colour can show.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Clean,
    Reached,
    Missed,
}

impl Kind {
    pub(super) fn of(drive: &Drive) -> Self {
        match (drive.outcome.reached, drive.outcome.clean()) {
            (_, true) => Self::Clean,
            (true, false) => Self::Reached,
            (false, false) => Self::Missed,
        }
    }

    /// Its class in the style sheet.
    pub(super) fn class(self) -> &'static str {
        match self {
            Self::Clean => "good",
            Self::Reached => "part",
            Self::Missed => "bad",
        }
    }
}

/// Shares over all drives, in large type.
pub(super) fn tiles(drives: &[Drive]) -> String {
    if drives.is_empty() {
        return String::new();
    }
    let count = |what: fn(&Drive) -> bool| drives.iter().filter(|d| what(d)).count();
    let reached = count(|d| d.outcome.reached);
    let length: f32 = drives.iter().filter(|d| d.outcome.reached).map(|d| d.outcome.length).sum();
    let mean = match reached {
        0 => "\u{2013}".to_owned(),
        n => format!("{:.1} m", length / n as f32),
    };
    let collisions: u64 = drives.iter().map(|d| u64::from(d.outcome.collisions)).sum();
    let figures = [
        ("Reached", format!("{reached} of {}", drives.len())),
        ("Clean", format!("{} of {}", count(|d| d.outcome.clean()), drives.len())),
        ("Loops or stuck", count(|d| d.loop_period.is_some()).to_string()),
        ("Collisions", collisions.to_string()),
        ("Mean path when reached", mean),
    ];
    let mut out = String::from("<dl class=\"tiles\">\n");
    for (name, value) in figures {
        let _ = writeln!(out, "<div><dt>{name}</dt><dd>{value}</dd></div>");
    }
    out + "</dl>\n"
}

/// One row per drive, each with a link that shows it in the replay.
pub(super) fn table(drives: &[Drive]) -> String {
    if drives.is_empty() {
        return String::new();
    }
    let mut rows = String::new();
    for (index, drive) in drives.iter().enumerate() {
        let number = index + 1;
        let ([x, y, heading], [goal_x, goal_y]) = (drive.start, drive.goal);
        let outcome = drive.outcome;
        let _ = writeln!(
            rows,
            "<tr><th scope=\"row\"><a href=\"#drive={number}\">{number}</a></th>\
             <td><span class=\"{}\">{}</span></td>\
             <td class=\"n\">{x:.2}, {y:.2}, {:.0}°</td><td class=\"n\">{goal_x:.2}, {goal_y:.2}</td>\
             <td class=\"n\">{}</td><td class=\"n\">{:.2}</td><td class=\"n\">{}</td>\
             <td class=\"n\">{:.2}</td></tr>",
            Kind::of(drive).class(),
            escape(&drive.verdict()),
            heading.to_degrees(),
            outcome.steps,
            outcome.length,
            outcome.collisions,
            outcome.distance,
        );
    }
    let table = format!(
        "<div class=\"scroll\"><table>\n<thead><tr><th scope=\"col\">Drive</th>\
         <th scope=\"col\">Outcome</th><th scope=\"col\" class=\"n\">Start x, y, heading</th>\
         <th scope=\"col\" class=\"n\">Goal x, y</th><th scope=\"col\" class=\"n\">Moves</th>\
         <th scope=\"col\" class=\"n\">Path, m</th><th scope=\"col\" class=\"n\">Collisions</th>\
         <th scope=\"col\" class=\"n\">Left to target, m</th></tr></thead>\n\
         <tbody>\n{rows}</tbody></table></div>\n"
    );
    section("outcomes", "Outcomes", &table)
}

//! What disturbances cost, as a table and as a picture.

use crate::output::Output;
use crate::report::stress::{Panel, Point, stress_svg};
use crate::stress::{Alone, Level, SCALES, Stress};

/// Prints the shares at every level, and which factor costs most.
pub(super) fn print(stress: &Stress, output: &mut Output) {
    output.line("stress: one disturbance at a time, then all, on the same pairs, in %");
    output.line("                                    clean                  reached");
    output.line("                     full size   half   full double     half   full double");
    let Stress { calm, factors, together, weakest } = stress;
    row(output, "none", "", &[Level { scale: 1.0, ..*calm }]);
    for alone in factors {
        row(output, alone.factor.name(), &full_size(alone), &alone.levels);
    }
    row(output, "all together", "", together);
    let Some(weakest) = weakest else {
        output.line("weakest: none; these pairs show no cost of any disturbance alone");
        return;
    };
    let alone = factors.iter().find(|alone| alone.factor == *weakest);
    if let Some(level) = alone.and_then(|alone| alone.at_full()) {
        let (what, change) = if level.clean_change.is_a_fall() {
            ("clean", level.clean_change)
        } else {
            ("reached", level.reached_change)
        };
        let [low, high] = change.interval;
        output.line(format_args!(
            "weakest: {}: {what} falls by {:.1} points ({:.1} to {:.1}) at full size",
            weakest.name(),
            -percent(change.by),
            -percent(high),
            -percent(low),
        ));
    }
}

/// The curves of every factor and of all together.
pub(super) fn picture(title: String, stress: &Stress) -> String {
    let point = |level: &Level| Point {
        scale: f64::from(level.scale),
        shares: [(level.reached, level.reached_interval), (level.clean, level.clean_interval)],
    };
    let panel = |title: String, levels: &[Level]| Panel {
        title,
        points: std::iter::once(&stress.calm).chain(levels).map(point).collect(),
    };
    let alone = stress.factors.iter().map(|alone| {
        panel(format!("{}: ×1 is {}", alone.factor.name(), full_size(alone)), &alone.levels)
    });
    let together = panel("all together".to_owned(), &stress.together);
    let panels: Vec<Panel> = alone.chain([together]).collect();
    stress_svg(&title, &panels)
}

/// A factor's full size with its unit.
fn full_size(alone: &Alone) -> String {
    match (alone.factor.full(), alone.unit) {
        (share, "share") => format!("{} %", percent(share.into()).round()),
        (full, unit) => format!("{full} {unit}"),
    }
}

fn row(output: &mut Output, name: &str, full: &str, levels: &[Level]) {
    let cells = |share: fn(&Level) -> f64| {
        let cell = |scale: f32| match levels.iter().find(|level| level.scale == scale) {
            Some(level) => format!(" {:>6.1}", percent(share(level))),
            None => format!(" {:>6}", "-"),
        };
        SCALES.map(cell).concat()
    };
    let (clean, reached) = (cells(|level| level.clean), cells(|level| level.reached));
    output.line(format_args!("  {name:<16} {full:>11}{clean}  {reached}"));
}

fn percent(share: f64) -> f64 {
    100.0 * share
}

//! A line of the table.

use serde::Serialize;

/// One result, and what it is compared with.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Row {
    what: &'static str,
    case: String,
    result: f64,
    unit: &'static str,
    reference: Option<f64>,
    reference_is: Option<&'static str>,
    /// How many times better than the reference; below 1 is worse.
    ratio: Option<f64>,
}

impl Row {
    pub(crate) fn new(
        what: &'static str,
        case: impl Into<String>,
        result: f64,
        unit: &'static str,
    ) -> Self {
        let (reference, reference_is, ratio) = (None, None, None);
        Self { what, case: case.into(), result, unit, reference, reference_is, ratio }
    }

    /// Compared with something of which more is better.
    pub(crate) fn beside_rate(self, name: &'static str, rate: f64) -> Self {
        let ratio = Some(self.result / rate);
        Self { reference: Some(rate), reference_is: Some(name), ratio, ..self }
    }

    /// Compared with something of which less is better.
    pub(crate) fn beside_time(self, name: &'static str, time: f64) -> Self {
        let ratio = Some(time / self.result);
        Self { reference: Some(time), reference_is: Some(name), ratio, ..self }
    }
}

/// As one JSON array.
pub(crate) fn json(rows: &[Row]) -> String {
    serde_json::to_string_pretty(rows).expect("numbers and words")
}

/// As a Markdown table.
pub(crate) fn table(rows: &[Row]) -> String {
    let mut cells =
        vec![["what", "case", "result", "unit", "beside it", "ratio"].map(String::from)];
    cells.extend(rows.iter().map(|row| {
        let beside = match (row.reference_is, row.reference) {
            (Some(name), Some(number)) => format!("{name} {}", digits(number)),
            _ => String::new(),
        };
        let ratio = row.ratio.map(digits).unwrap_or_default();
        [row.what.into(), row.case.clone(), digits(row.result), row.unit.into(), beside, ratio]
    }));
    let width = |column: usize| {
        cells.iter().map(|row| row[column].chars().count()).max().unwrap_or_default()
    };
    let widths: [usize; 6] = std::array::from_fn(width);
    let mut text = String::new();
    for (index, row) in cells.iter().enumerate() {
        let padded: [String; 6] = std::array::from_fn(|column| {
            let (cell, width) = (&row[column], widths[column]);
            if matches!(column, 2 | 5) {
                format!("{cell:>width$}")
            } else {
                format!("{cell:<width$}")
            }
        });
        text += &format!("| {} |\n", padded.join(" | "));
        if index == 0 {
            let line: [String; 6] = std::array::from_fn(|column| {
                let dashes = "-".repeat(widths[column].max(4) - 1);
                if matches!(column, 2 | 5) { format!("{dashes}:") } else { format!("{dashes}-") }
            });
            text += &format!("| {} |\n", line.join(" | "));
        }
    }
    text
}

/// About three significant digits.
fn digits(number: f64) -> String {
    match number.abs() {
        size if size < 0.095 => format!("{number:.4}"),
        size if size >= 99.95 => format!("{number:.0}"),
        size if size >= 9.995 => format!("{number:.1}"),
        _ => format!("{number:.2}"),
    }
}

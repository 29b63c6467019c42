//! Settings and provenance as tables.

use std::fmt::Write;

use serde_json::{Map, Number, Value};

use super::section;
use crate::report::svg::escape;

/// A longer list is shown by its beginning and its length.
const LONGEST_TEXT: usize = 160;

/// The resolved settings: a table per group, with dotted names inside it, as `--set` takes
/// them. Anything but an object with members gives nothing.
pub(super) fn settings(settings: &Value) -> String {
    let Value::Object(settings) = settings else { return String::new() };
    if settings.is_empty() {
        return String::new();
    }
    let mut general = String::new();
    let mut tables = String::new();
    for (name, value) in settings {
        match value {
            Value::Object(group) => {
                let mut rows = String::new();
                flatten("", group, &mut rows);
                let _ = writeln!(tables, "<div><h3>{}</h3>{}</div>", escape(name), table(&rows));
            }
            plain => general.push_str(&row(name, &text(plain))),
        }
    }
    if !general.is_empty() {
        tables = format!("<div><h3>general</h3>{}</div>\n{tables}", table(&general));
    }
    section("settings", "Settings", &format!("<div class=\"settings\">\n{tables}</div>\n"))
}

/// Where the result comes from.
pub(super) fn provenance(rows: &[(String, String)]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let rows: String = rows.iter().map(|(name, value)| row(name, value)).collect();
    let table = format!("<div class=\"provenance\">{}</div>\n", table(&rows));
    section("provenance", "Provenance", &table)
}

fn flatten(prefix: &str, group: &Map<String, Value>, rows: &mut String) {
    for (name, value) in group {
        let name = if prefix.is_empty() { name.clone() } else { format!("{prefix}.{name}") };
        match value {
            Value::Object(inner) if !inner.is_empty() => flatten(&name, inner, rows),
            plain => rows.push_str(&row(&name, &text(plain))),
        }
    }
}

fn table(rows: &str) -> String {
    format!("<table><tbody>{rows}</tbody></table>")
}

fn row(name: &str, value: &str) -> String {
    format!("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", escape(name), escape(value))
}

/// A value as a person would type it.
fn text(value: &Value) -> String {
    match value {
        Value::Null => "\u{2013}".to_owned(),
        Value::Bool(true) => "yes".to_owned(),
        Value::Bool(false) => "no".to_owned(),
        Value::Number(number) => decimal(number),
        Value::String(text) => text.clone(),
        Value::Array(items) => shortened(&list(items), items.len()),
        Value::Object(members) => {
            let members = members.iter().map(|(name, value)| format!("{name} = {}", text(value)));
            format!("{{{}}}", members.collect::<Vec<_>>().join(", "))
        }
    }
}

fn list(items: &[Value]) -> String {
    format!("[{}]", items.iter().map(text).collect::<Vec<_>>().join(", "))
}

fn shortened(text: &str, items: usize) -> String {
    match text.char_indices().nth(LONGEST_TEXT) {
        None => text.to_owned(),
        Some((end, _)) => format!("{}\u{2026} ({items} in all)", &text[..end]),
    }
}

/// Settings are single-precision, and JSON values double: 0.1 must not become
/// 0.10000000149011612.
fn decimal(number: &Number) -> String {
    match number.as_f64() {
        Some(double) if number.is_f64() && f64::from(double as f32) == double => {
            (double as f32).to_string()
        }
        _ => number.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn values_read_as_they_were_typed() {
        let value = json!([0.1_f32, 0.1_f64, 120, true, null, "sus", { "lower": 0.05_f32 }]);
        assert_eq!(text(&value), "[0.1, 0.1, 120, yes, \u{2013}, sus, {lower = 0.05}]");
    }

    #[test]
    fn nested_settings_get_the_names_that_set_takes() {
        let html = settings(&json!({ "training": { "ga": { "rate": 0.1 }, "population": 80 } }));
        let names: Vec<&str> =
            html.split("<th scope=\"row\">").skip(1).filter_map(|s| s.split('<').next()).collect();
        assert_eq!(names, ["ga.rate", "population"]);
        assert!(html.contains("<h3>training</h3>"));
    }

    #[test]
    fn a_long_list_is_cut_and_counted() {
        let cut = text(&json!(vec![[1, 2]; 500]));
        assert!(
            cut.starts_with("[[1, 2], [1, 2]") && cut.ends_with("\u{2026} (500 in all)"),
            "{cut}"
        );
        assert!(cut.len() < 200);
    }

    #[test]
    fn without_settings_there_is_no_section() {
        assert_eq!(settings(&Value::Null) + &settings(&json!({})), "");
    }
}

//! Writes settings as TOML that a person can read and change.

use super::Scenario;
use super::schema::{Codec, Record, Visit};

/// The scenario as a scenario file that says everything: loading it gives the same scenario,
/// whatever the preset.
pub fn to_toml(scenario: &Scenario) -> String {
    let mut writer = Writer::default();
    scenario.clone().visit(&mut writer);
    writer.text
}

/// One table as `{ key = value, ... }`.
pub(super) fn write_record(mut record: impl Record) -> String {
    let mut inline = Inline::default();
    record.visit(&mut inline);
    format!("{{ {} }}", inline.entries.join(", "))
}

#[derive(Default)]
struct Writer {
    text: String,
    /// Keys of the sections we are in.
    sections: Vec<&'static str>,
}

impl Visit for Writer {
    fn value<T>(&mut self, key: &'static str, slot: &mut T, codec: impl Codec<T>, about: &str) {
        let Some(value) = codec.write(slot) else { return };
        let line = if value.contains('\n') {
            format!("# {about}\n{key} = {value}\n")
        } else if about.is_empty() {
            format!("{key} = {value}\n")
        } else {
            let setting = format!("{key} = {value}");
            format!("{setting:<28} # {about}\n")
        };
        self.text.push_str(&line);
    }

    fn section(&mut self, key: &'static str, record: &mut impl Record) {
        self.sections.push(key);
        self.text.push_str(&format!("\n[{}]\n", self.sections.join(".")));
        record.visit(self);
        self.sections.pop();
    }

    fn optional_section<R: Record>(&mut self, key: &'static str, slot: &mut Option<R>, _: R) {
        if let Some(record) = slot {
            self.section(key, record);
        }
    }
}

#[derive(Default)]
struct Inline {
    entries: Vec<String>,
}

impl Visit for Inline {
    fn value<T>(&mut self, key: &'static str, slot: &mut T, codec: impl Codec<T>, _about: &str) {
        if let Some(value) = codec.write(slot) {
            self.entries.push(format!("{key} = {value}"));
        }
    }

    fn section(&mut self, _key: &'static str, record: &mut impl Record) {
        // No table of a list has tables in it; if one ever does, its keys stay visible.
        record.visit(self);
    }

    fn optional_section<R: Record>(&mut self, key: &'static str, slot: &mut Option<R>, _: R) {
        if let Some(record) = slot {
            self.section(key, record);
        }
    }
}

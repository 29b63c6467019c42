//! Writes settings as TOML that a person can read and change.

use super::schema::{Codec, Record, Visit};
use super::{Preset, Scenario};

/// The scenario as a scenario file that says everything: loading it gives the same scenario.
pub fn to_toml(scenario: &Scenario) -> String {
    text_of(&settings_of(scenario))
}

/// The scenario as a scenario file that says what differs from the paper's settings, and always
/// the size of the room: loading it gives the same scenario.
pub fn to_toml_beside_paper(scenario: &Scenario) -> String {
    let usual = settings_of(&Preset::Paper.scenario());
    let mut settings = settings_of(scenario);
    settings.retain(|setting| {
        let same = |other: &Setting| setting.section == other.section && setting.text == other.text;
        ["min_m", "max_m"].contains(&setting.key) || !usual.iter().any(same)
    });
    text_of(&settings)
}

/// One setting as it stands in a file.
struct Setting {
    /// Names of its sections, joined by dots; empty at the top.
    section: String,
    key: &'static str,
    /// One line or more.
    text: String,
}

fn settings_of(scenario: &Scenario) -> Vec<Setting> {
    let mut writer = Writer::default();
    scenario.clone().visit(&mut writer);
    writer.settings
}

fn text_of(settings: &[Setting]) -> String {
    let mut text = String::new();
    let mut section = "";
    for setting in settings {
        if setting.section != section {
            section = &setting.section;
            text.push_str(&format!("\n[{section}]\n"));
        }
        text.push_str(&setting.text);
    }
    text
}

/// One table as `{ key = value, ... }`.
pub(super) fn write_record(mut record: impl Record) -> String {
    let mut inline = Inline::default();
    record.visit(&mut inline);
    format!("{{ {} }}", inline.entries.join(", "))
}

#[derive(Default)]
struct Writer {
    settings: Vec<Setting>,
    /// Keys of the sections we are in.
    sections: Vec<&'static str>,
}

impl Visit for Writer {
    fn value<T>(&mut self, key: &'static str, slot: &mut T, codec: impl Codec<T>, about: &str) {
        let Some(value) = codec.write(slot) else { return };
        let text = if value.contains('\n') {
            format!("# {about}\n{key} = {value}\n")
        } else if about.is_empty() {
            format!("{key} = {value}\n")
        } else {
            let setting = format!("{key} = {value}");
            format!("{setting:<28} # {about}\n")
        };
        self.settings.push(Setting { section: self.sections.join("."), key, text });
    }

    fn section(&mut self, key: &'static str, record: &mut impl Record) {
        self.sections.push(key);
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

//! The reference of scenario files is the program's own list of settings.

use host_trainer::scenario::{Key, all_keys};

use super::pages;

const PAGE: &str = "docs/scenario-files.md";
const BEGIN: &str = "<!-- begin of the generated list -->\n";
const END: &str = "<!-- end of the generated list -->\n";

fn table() -> String {
    let mut text = String::new();
    let mut section = None;
    for key in all_keys() {
        let (table, name) = key.path.rsplit_once('.').unwrap_or(("", &key.path));
        if section.as_deref() != Some(table) {
            let heading =
                if table.is_empty() { "top level".to_owned() } else { format!("[{table}]") };
            text += &format!(
                "\n### {heading}\n\n| key | what | allowed | default |\n| --- | --- | --- | --- |\n"
            );
            section = Some(table.to_owned());
        }
        text += &row(name, &key);
    }
    text + "\n"
}

fn row(name: &str, key: &Key) -> String {
    let Key { expected, about, default, .. } = key;
    // A file's name is its scenario's; a map without a file is none.
    let default = match default.as_str() {
        "" | "\"\"" | "\"unnamed\"" => String::new(),
        default => format!("`{default}`"),
    };
    format!("| `{name}` | {about} | {expected} | {default} |\n").replace("  |", " |")
}

#[test]
fn every_setting_is_listed_with_its_range_and_default() {
    let page = pages::read(PAGE);
    let (head, rest) = page.split_once(BEGIN).expect(BEGIN);
    let (_, tail) = rest.split_once(END).expect(END);
    pages::expect(PAGE, &format!("{head}{BEGIN}{}{END}{tail}", table()));
}

//! The page about scenario files shows what each preset puts over a file.

use super::pages;
use host_trainer::scenario::Preset;

const PAGE: &str = "docs/scenario-files.md";

fn shown(page: &str, preset: &str) -> String {
    let begin = format!("<!-- begin of the preset {preset} -->\n");
    let end = format!("<!-- end of the preset {preset} -->\n");
    let (head, rest) = page.split_once(&begin).unwrap_or_else(|| panic!("{PAGE}: no {begin}"));
    let (_, tail) = rest.split_once(&end).unwrap_or_else(|| panic!("{PAGE}: no {end}"));
    let file = pages::read(&format!("host-trainer/src/scenario/{preset}.toml"));
    let (_, settings) = file.split_once("\n\n").expect("a comment about the preset");
    format!("{head}{begin}\n```toml\n{settings}```\n\n{end}{tail}")
}

#[test]
fn every_preset_over_the_paper_is_shown_as_it_is() {
    let mut page = pages::read(PAGE);
    for preset in Preset::ALL.into_iter().filter(|preset| *preset != Preset::Paper) {
        page = shown(&page, preset.name());
    }
    pages::expect(PAGE, &page);
}

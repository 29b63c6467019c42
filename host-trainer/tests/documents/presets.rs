//! The page about scenario files shows what a preset puts over a file.

use super::pages;

const PAGE: &str = "docs/scenario-files.md";
const BEGIN: &str = "<!-- begin of the preset -->\n";
const END: &str = "<!-- end of the preset -->\n";

#[test]
fn the_preset_robust_is_shown_as_it_is() {
    let page = pages::read(PAGE);
    let (head, rest) = page.split_once(BEGIN).expect(BEGIN);
    let (_, tail) = rest.split_once(END).expect(END);
    let preset = pages::read("host-trainer/src/scenario/robust.toml");
    let (_, settings) = preset.split_once("\n\n").expect("a comment about the preset");
    let shown = format!("\n```toml\n{settings}```\n\n");
    pages::expect(PAGE, &format!("{head}{BEGIN}{shown}{END}{tail}"));
}

//! Links lead somewhere.

use super::pages;

/// Targets of `[text](target)` and of `<img src="target">`, code left out.
fn targets(text: &str) -> Vec<&str> {
    let prose = text.split("```").step_by(2);
    let mut found = Vec::new();
    for part in prose {
        for (opens, closes) in [("](", ')'), ("src=\"", '"')] {
            found.extend(part.split(opens).skip(1).filter_map(|rest| rest.split(closes).next()));
        }
    }
    found
}

#[test]
fn every_link_between_pages_and_files_leads_somewhere() {
    for page in pages::all() {
        let text = pages::read(&page);
        let folder = pages::root().join(&page).parent().unwrap().to_owned();
        for target in targets(&text) {
            if target.starts_with("http") {
                continue;
            }
            let (file, section) = target.split_once('#').unwrap_or((target, ""));
            let path = if file.is_empty() { pages::root().join(&page) } else { folder.join(file) };
            assert!(path.exists(), "{page}: nothing is at {target}");
            if !section.is_empty() {
                let there = std::fs::read_to_string(&path).unwrap();
                let known =
                    there.lines().any(|line| line.starts_with('#') && anchor(line) == section);
                assert!(known, "{page}: no heading of {file} is #{section}");
            }
        }
    }
}

/// The name a heading gets on the usual forges.
fn anchor(heading: &str) -> String {
    let text = heading.trim_start_matches('#').trim().to_lowercase();
    let kept = text.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
    kept.map(|c| if c == ' ' { '-' } else { c }).collect()
}

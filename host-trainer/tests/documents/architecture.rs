//! The architecture page names what there is, and all of it.

use super::pages;

const PAGE: &str = "ARCHITECTURE.md";

/// The crates whose modules the page lists, by the heading of their table, and their folders.
const CRATES: [(&str, &str); 4] = [
    ("controller-core", "controller-core"),
    ("host-trainer", "host-trainer"),
    ("firmware-example", "firmware-example"),
    ("equivalence-tests", "tests"),
];

/// The modules that a crate's front page declares with these words.
fn modules(folder: &str, declared_by: &str) -> Vec<String> {
    let front = pages::read(&format!("{folder}/src/lib.rs"));
    let declared = front.lines().filter_map(|line| line.strip_prefix(declared_by));
    declared.filter_map(|name| Some(name.strip_suffix(';')?.to_owned())).collect()
}

fn section<'a>(page: &'a str, package: &str) -> &'a str {
    let heading = format!("### Modules of {package}\n");
    let (_, rest) = page.split_once(&heading).unwrap_or_else(|| panic!("{PAGE}: no {heading}"));
    rest.split("\n#").next().unwrap_or(rest)
}

#[test]
fn the_page_lists_every_public_module_and_none_that_is_not_there() {
    let page = pages::read(PAGE);
    for (package, folder) in CRATES {
        let rows = pages::rows_of_code(section(&page, package));
        let mut listed: Vec<String> = rows
            .iter()
            .flat_map(|row| row[0].split(", "))
            .map(|name| name.trim_matches('`').to_owned())
            .collect();
        let public = modules(folder, "pub mod ");
        let private = modules(folder, "mod ");
        assert!(public.len() > 2, "{package} has hardly any module");
        for name in &public {
            assert!(listed.contains(name), "{PAGE}: no row for {name} of {package}");
        }
        listed.retain(|name| !public.contains(name));
        for name in &listed {
            assert!(private.contains(name), "{PAGE}: {package} has no module {name}");
        }
    }
}

#[test]
fn every_file_and_folder_that_the_page_names_exists() {
    let page = pages::read(PAGE);
    let prose: String = page.split("```").step_by(2).collect();
    let spans = prose.split('`').skip(1).step_by(2);
    let paths = spans.filter(|span| {
        let source = [".rs", ".md", ".toml", ".json"].iter().any(|end| span.ends_with(end));
        !span.contains(['<', ' ', '*']) && (span.ends_with('/') || (source && span.contains('/')))
    });
    let mut count = 0;
    for path in paths {
        let exists = ["", "controller-core/src", "host-trainer/src"]
            .iter()
            .any(|base| pages::root().join(base).join(path).exists());
        assert!(exists, "{PAGE}: there is no {path}");
        count += 1;
    }
    assert!(count > 5, "the page names hardly any file");
}

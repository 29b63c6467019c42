//! Where the pages are, and how they are written anew.

use std::fs;
use std::path::{Path, PathBuf};

/// The repository.
pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// Every page of the documentation, relative to the repository; sorted.
pub(crate) fn all() -> Vec<String> {
    let mut found = Vec::new();
    for folder in [
        "",
        "docs",
        "champions",
        "controller-core",
        "controller-core/docs",
        "firmware-example",
        "firmware-example/boards/pico2",
        "host-trainer",
        "scenarios",
    ] {
        for entry in fs::read_dir(root().join(folder)).unwrap() {
            let name = entry.unwrap().file_name().into_string().unwrap();
            if name.ends_with(".md") {
                found.push(if folder.is_empty() { name } else { format!("{folder}/{name}") });
            }
        }
    }
    found.sort();
    found
}

/// A page's text.
pub(crate) fn read(page: &str) -> String {
    fs::read_to_string(root().join(page)).unwrap_or_else(|error| panic!("{page}: {error}"))
}

/// Compares a page with what it should be, or writes it where that was asked for.
pub(crate) fn expect(page: &str, expected: &str) {
    let found = read(page);
    if found == expected {
        return;
    }
    if std::env::var_os("EVOSTEER_BLESS").is_some() {
        fs::write(root().join(page), expected).unwrap();
        return;
    }
    let lines = || expected.lines().zip(found.lines()).enumerate();
    let (number, (wanted, there)) =
        lines().find(|(_, (wanted, there))| wanted != there).unwrap_or_default();
    panic!(
        "{page}:{}: differs from what the program says\n    page: {there}\n program: {wanted}\n\
         if the change is meant: EVOSTEER_BLESS=1 cargo test -p host-trainer --test documents",
        number + 1
    );
}

/// The cells of every table row that begins with a code span, such as `` | `name` | what | ``.
pub(crate) fn rows_of_code(text: &str) -> Vec<Vec<&str>> {
    let rows = text.lines().filter(|line| line.starts_with("| `"));
    rows.map(|row| row.trim_matches('|').split('|').map(str::trim).collect()).collect()
}

//! A table in the documentation: kept true wherever the compiler is the one it was made with.

use std::path::Path;

use crate::failure::Failure;
use crate::process;

/// Where a table stands, and the command that makes it.
pub(crate) struct Place {
    /// The page, from the repository's top folder.
    pub(crate) page: &'static str,
    /// The word after `cargo xtask`; the marks around the table name it.
    pub(crate) command: &'static str,
}

/// Behind the compiler's version, above the table.
const BEHIND: &str = " -->\n";

/// Set, the table is written anew instead of compared.
const BLESS: &str = "EVOSTEER_BLESS";

/// Fails if the page shows another table for this compiler.
pub(crate) fn keep(place: &Place, compiler: &str, table: &str) -> Result<(), Failure> {
    keep_within(place, compiler, table, 0.0)
}

/// The same, but numbers may differ by this share of the page's.
pub(crate) fn keep_within(
    place: &Place,
    compiler: &str,
    table: &str,
    margin: f64,
) -> Result<(), Failure> {
    let page = process::root().join(place.page);
    let text = std::fs::read_to_string(&page).map_err(|error| at(&page, &error.to_string()))?;
    let shown = Shown::find(place, &text).map_err(|why| at(&page, &why))?;
    if std::env::var_os(BLESS).is_some() {
        let blessed = shown.replaced(place, &text, compiler, table);
        return std::fs::write(&page, blessed).map_err(|error| at(&page, &error.to_string()));
    }
    if shown.compiler != compiler {
        eprintln!(
            "xtask: {} shows {}, this is {compiler}: not compared",
            place.page, shown.compiler
        );
        return Ok(());
    }
    match shown.first_difference(table, margin) {
        None => Ok(()),
        Some((found, expected)) => Err(at(
            &page,
            &format!(
                "the table is out of date: found\n{found}\nexpected\n{expected}\n{BLESS}=1 writes it anew"
            ),
        )),
    }
}

/// Writes a table that no two machines make alike, on request only.
pub(crate) fn bless(place: &Place, machine: &str, table: &str) -> Result<(), Failure> {
    match std::env::var_os(BLESS) {
        Some(_) => keep(place, machine, table),
        None => Ok(()),
    }
}

impl Place {
    /// Before the compiler's version, above the table.
    fn before(&self) -> String {
        format!("<!-- `cargo xtask {}` with ", self.command)
    }

    /// Below the table.
    fn end(&self) -> String {
        format!("<!-- end of `cargo xtask {}` -->", self.command)
    }
}

fn at(page: &Path, why: &str) -> Failure {
    Failure::failed(format!("{}: {why}", page.display()))
}

/// Whether two rows say the same, where numbers may differ by this share of the first.
fn agree(found: &str, expected: &str, margin: f64) -> bool {
    let same = |(found, expected): (&str, &str)| {
        let numbers = found.trim().parse::<f64>().ok().zip(expected.trim().parse::<f64>().ok());
        found == expected
            || numbers
                .is_some_and(|(found, expected)| (found - expected).abs() <= margin * found.abs())
    };
    let cells = |row: &str| row.split('|').count();
    cells(found) == cells(expected) && found.split('|').zip(expected.split('|')).all(same)
}

/// The table as the page has it.
struct Shown<'a> {
    compiler: &'a str,
    table: &'a str,
}

impl<'a> Shown<'a> {
    fn find(place: &Place, text: &'a str) -> Result<Self, String> {
        let (before, end) = (place.before(), place.end());
        let missing = |mark: &str| format!("no line `{}`", mark.trim_end());
        let (_, rest) = text.split_once(&before).ok_or_else(|| missing(&before))?;
        let (compiler, rest) = rest.split_once(BEHIND).ok_or_else(|| missing(BEHIND))?;
        let (table, _) = rest.split_once(&end).ok_or_else(|| missing(&end))?;
        Ok(Self { compiler, table })
    }

    fn first_difference(&self, table: &'a str, margin: f64) -> Option<(&'a str, &'a str)> {
        let (found, expected) = (self.table.trim(), table.trim());
        let mut lines = found.lines().zip(expected.lines());
        let differing = lines.find(|(found, expected)| !agree(found, expected, margin));
        let cut = (found.lines().count() != expected.lines().count()).then_some((found, expected));
        differing.or(cut)
    }

    fn replaced(&self, place: &Place, text: &str, compiler: &str, table: &str) -> String {
        let (before, end) = (place.before(), place.end());
        let section =
            |compiler: &str, table: &str| format!("{before}{compiler}{BEHIND}{table}{end}");
        let (new, old) = (format!("\n{table}\n"), section(self.compiler, self.table));
        text.replacen(&old, &section(compiler, &new), 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPEED: Place = Place { page: "page.md", command: "speed" };

    const TEXT: &str = "# Page\n<!-- `cargo xtask speed` with rustc 1 -->\n\n| a |\n| 1 |\n\n\
                        <!-- end of `cargo xtask speed` -->\nrest\n";

    #[test]
    fn a_changed_a_missing_and_a_further_row_are_differences() {
        let shown = Shown::find(&SPEED, TEXT).expect("has a table");
        assert_eq!(shown.compiler, "rustc 1");
        assert_eq!(shown.first_difference("| a |\n| 1 |\n", 0.0), None);
        assert_eq!(shown.first_difference("| a |\n| 2 |\n", 0.0), Some(("| 1 |", "| 2 |")));
        assert!(shown.first_difference("| a |\n", 0.0).is_some());
        assert!(shown.first_difference("| a |\n| 1 |\n| 2 |\n", 0.0).is_some());
    }

    #[test]
    fn numbers_within_the_margin_agree_and_nothing_else_does() {
        let agree = |found, expected| agree(found, expected, 0.02);
        assert!(agree("| avx2 | 500 | 1000 |", "| avx2 | 510 | 980 |"));
        assert!(!agree("| avx2 | 500 | 1000 |", "| avx2 | 511 | 1000 |"));
        assert!(!agree("| avx2 | 500 |", "| sse2 | 500 |"));
        assert!(!agree("| avx2 | 500 |", "| avx2 | 500 | 1 |"));
    }

    #[test]
    fn a_table_written_anew_is_found_again_and_the_rest_stays() {
        let text = Shown::find(&SPEED, TEXT)
            .expect("has a table")
            .replaced(&SPEED, TEXT, "rustc 2", "| b |\n");
        let shown = Shown::find(&SPEED, &text).expect("has a table");
        assert_eq!((shown.compiler, shown.first_difference("| b |", 0.0)), ("rustc 2", None));
        assert!(text.starts_with("# Page\n") && text.ends_with(" -->\nrest\n"), "{text}");
    }

    #[test]
    fn a_page_without_the_table_is_refused() {
        let why = Shown::find(&SPEED, "# Page\n").err().expect("no table");
        assert_eq!(why, "no line `<!-- `cargo xtask speed` with`");
    }
}

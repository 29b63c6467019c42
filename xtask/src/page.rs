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
    match shown.first_difference(table) {
        None => Ok(()),
        Some((found, expected)) => Err(at(
            &page,
            &format!(
                "the table is out of date: found\n{found}\nexpected\n{expected}\n{BLESS}=1 writes it anew"
            ),
        )),
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

    fn first_difference(&self, table: &'a str) -> Option<(&'a str, &'a str)> {
        let lines = self.table.trim().lines().zip(table.trim().lines());
        let differing = lines.clone().find(|(found, expected)| found != expected);
        let cut = (self.table.trim() != table.trim()).then_some((self.table, table));
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
        assert_eq!(shown.first_difference("| a |\n| 1 |\n"), None);
        assert_eq!(shown.first_difference("| a |\n| 2 |\n"), Some(("| 1 |", "| 2 |")));
        assert!(shown.first_difference("| a |\n").is_some());
        assert!(shown.first_difference("| a |\n| 1 |\n| 2 |\n").is_some());
    }

    #[test]
    fn a_table_written_anew_is_found_again_and_the_rest_stays() {
        let text = Shown::find(&SPEED, TEXT)
            .expect("has a table")
            .replaced(&SPEED, TEXT, "rustc 2", "| b |\n");
        let shown = Shown::find(&SPEED, &text).expect("has a table");
        assert_eq!((shown.compiler, shown.first_difference("| b |")), ("rustc 2", None));
        assert!(text.starts_with("# Page\n") && text.ends_with(" -->\nrest\n"), "{text}");
    }

    #[test]
    fn a_page_without_the_table_is_refused() {
        let why = Shown::find(&SPEED, "# Page\n").err().expect("no table");
        assert_eq!(why, "no line `<!-- `cargo xtask speed` with`");
    }
}

//! The pages explain every signal of the car's lamp, as the program shows it.

use super::pages;

const PAGE: &str = "docs/tutorial.md";
const BOARD: &str = "firmware-example/boards/pico2/README.md";
const PROGRAM: &str = "firmware-example/src/indicator.rs";

/// The blinking patterns in the program, lit and dark beats as `#` and `.`.
fn patterns() -> Vec<String> {
    let source = pages::read(PROGRAM);
    let (_, body) = source.split_once("fn pattern(").expect("the patterns");
    let body = body.split("\n    }\n").next().unwrap_or(body);
    let quoted = body.split('"').skip(1).step_by(2);
    let mut found: Vec<String> = quoted.map(str::to_owned).collect();
    found.sort();
    found
}

/// What follows a table's row head, for every row whose cells this table has.
fn meanings(rows: &[Vec<&str>], from: usize) -> Vec<String> {
    let mut found: Vec<String> = rows.iter().map(|row| row[from..].join("|")).collect();
    found.sort();
    found
}

#[test]
fn the_tutorial_explains_every_signal_of_the_lamp() {
    let page = pages::read(PAGE);
    let rows = pages::rows_of_code(&page);
    let mut explained: Vec<String> =
        rows.iter().map(|row| row[0].trim_matches('`').to_owned()).collect();
    explained.sort();
    let patterns = patterns();
    assert_eq!(patterns.len(), 6, "{PROGRAM}");
    assert_eq!(explained, patterns, "left: {PAGE}, right: {PROGRAM}");

    // The page beside the board says the same in the same words.
    let board = pages::read(BOARD);
    let (_, table) = board.split_once("| blinks | means |").expect("a table of the lamp");
    let lines = table.lines().skip(2).take_while(|line| line.starts_with("| "));
    let table: Vec<Vec<&str>> =
        lines.map(|row| row.trim_matches('|').split('|').map(str::trim).collect()).collect();
    assert_eq!(meanings(&rows, 1), meanings(&table, 0), "left: {PAGE}, right: {BOARD}");
}

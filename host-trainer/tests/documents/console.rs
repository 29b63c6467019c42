//! Blocks of commands and their output in a page.
//!
//! A block is fenced by ```` ```console ````. A line that begins with `$ ` is a command, the
//! lines after it are its output. One line `...` stands for any lines.

use std::ops::Range;

/// A command and what the page says it prints.
#[derive(Debug)]
pub(crate) struct Command<'a> {
    /// What is typed.
    pub(crate) line: &'a str,
    /// What comes out, line by line.
    pub(crate) output: Vec<&'a str>,
    /// Where the output stands: line numbers of the page, from 0.
    pub(crate) place: Range<usize>,
}

/// Every command of a page, in order.
pub(crate) fn commands(page: &str) -> Vec<Command<'_>> {
    let mut found: Vec<Command<'_>> = Vec::new();
    let mut inside = false;
    for (number, line) in page.lines().enumerate() {
        if line.starts_with("```") {
            inside = line == "```console";
        } else if inside && let Some(command) = line.strip_prefix("$ ") {
            let place = number + 1..number + 1;
            found.push(Command { line: command, output: Vec::new(), place });
        } else if inside {
            let command = found.last_mut().expect("a block begins with a command");
            command.output.push(line);
            command.place.end = number + 1;
        }
    }
    found
}

/// Whether a page's output is what was printed, but for speeds and numbers of threads.
pub(crate) fn agree(page: &[&str], printed: &[&str]) -> bool {
    let printed = cut_like(page, printed);
    page.len() == printed.len() && page.iter().zip(&printed).all(|(a, b)| plain(a) == plain(b))
}

/// The printed output as the page would have it: without the lines that the clock decides, with
/// the page's own speeds where nothing else differs, and cut where the page's was cut.
pub(crate) fn cut_like<'a>(page: &[&'a str], printed: &[&'a str]) -> Vec<&'a str> {
    let known = |line: &'a str| page.iter().find(|known| plain(known) == plain(line));
    let printed = printed.iter().filter(|line| !is_by_the_clock(line));
    let printed: Vec<&str> = printed.map(|line| *known(line).unwrap_or(line)).collect();
    let Some(head) = page.iter().position(|line| *line == "...") else { return printed };
    let tail = page.len() - head - 1;
    if head + tail >= printed.len() {
        return printed;
    }
    [&printed[..head], &["..."], &printed[printed.len() - tail..]].concat()
}

/// Whether this is a progress line that comes only every few seconds: not the first generation,
/// nor the last, nor a tenth part of the run.
fn is_by_the_clock(line: &str) -> bool {
    let parts = || {
        let (done, total) =
            line.strip_prefix("generation ")?.split_once("  ")?.0.split_once('/')?;
        Some((done.parse::<u32>().ok()?, total.parse::<u32>().ok()?))
    };
    parts().is_some_and(|(done, total)| {
        done != 1 && done != total && !done.is_multiple_of((total / 10).max(1))
    })
}

/// A line without what differs from machine to machine.
fn plain(line: &str) -> String {
    if let Some(rest) = line.strip_suffix(" steps/s") {
        return rest.rsplit_once("  ").map_or(rest, |(before, _)| before).to_owned();
    }
    let parts: Vec<&str> = line.split(", ").collect();
    let counts_threads = |part: &&str| part.ends_with(" threads") || part.ends_with(" thread");
    parts.into_iter().filter(|part| !counts_threads(part)).collect::<Vec<_>>().join(", ")
}

#[test]
fn a_block_is_cut_into_commands_and_their_output() {
    let page = "text\n```console\n$ one\na\nb\n$ two\n```\n```text\n$ three\n```\n";
    let found = commands(page);
    let [one, two] = found.as_slice() else { panic!("{found:?}") };
    assert_eq!((one.line, one.place.clone()), ("one", 3..5));
    assert_eq!(one.output, ["a", "b"]);
    assert_eq!((two.line, two.output.len()), ("two", 0));
}

#[test]
fn only_speed_threads_and_the_number_of_progress_lines_may_differ() {
    let page = ["x, seed 1, 2 threads, in y", "generation 1/20  best 3.0  70 k steps/s", "end"];
    let printed = [
        "x, seed 1, 8 threads, in y",
        "generation 1/20  best 3.0  1.9 M steps/s",
        "generation 3/20  best 2.0  2 M steps/s",
        "end",
    ];
    assert!(agree(&page, &printed));
    for (line, other) in [
        (0, "x, seed 2, 8 threads, in y"),
        (1, "generation 1/20  best 3.1  1 M steps/s"),
        (3, "End"),
    ] {
        let mut changed = printed;
        changed[line] = other;
        assert!(!agree(&page, &changed), "{other}");
    }
    assert!(agree(&["a", "...", "d"], &["a", "b", "c", "d"]));
    assert!(!agree(&["a", "...", "d"], &["a", "b", "c"]));
    assert!(!agree(&["a", "...", "d"], &["a"]));
    assert_eq!(cut_like(&["a", "...", "d"], &["1", "2", "3", "4"]), ["1", "...", "4"]);
}

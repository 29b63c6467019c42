//! Help that can be read in a terminal.

use super::bench::Bench;

const VERBS: [&str; 10] = [
    "train",
    "evaluate",
    "reproduce",
    "replay",
    "demo",
    "scenario",
    "export",
    "inspect",
    "verify",
    "bench",
];

#[test]
fn every_help_text_reads_as_its_snapshot() {
    let bench = Bench::new();
    let mut pages = vec![format!("$ evosteer --help\n{}", bench.say("--help").ends_in(0).stdout)];
    for verb in VERBS {
        let page = bench.run([verb, "--help"]).ends_in(0);
        assert_eq!(page.stderr, "");
        assert_eq!(page.stdout, bench.run(["help", verb]).ends_in(0).stdout);
        pages.push(format!("$ evosteer {verb} --help\n{}", page.stdout));
    }
    insta::assert_snapshot!(pages.join("\n"));
}

#[test]
fn no_help_text_is_wider_than_a_hundred_columns() {
    let bench = Bench::new();
    let listed = bench.say("--help").ends_in(0).stdout;
    let commands = listed.split("Commands:\n").nth(1).unwrap().lines();
    let verbs: Vec<&str> = commands
        .take_while(|line| !line.is_empty())
        .filter_map(|line| line.split_whitespace().next())
        .filter(|verb| *verb != "help")
        .collect();
    assert!(VERBS.iter().all(|verb| verbs.contains(verb)), "{verbs:?}");
    for verb in verbs {
        for option in ["-h", "--help"] {
            let text = bench.run([verb, option]).ends_in(0).stdout;
            for line in text.lines() {
                assert!(line.chars().count() <= 100, "{verb} {option}: {line}");
            }
        }
    }
}

#[test]
fn the_version_is_the_packages() {
    let version = Bench::new().say("--version").ends_in(0).stdout;
    assert_eq!(version, format!("evosteer {}\n", env!("CARGO_PKG_VERSION")));
}

#[test]
fn no_arguments_at_all_show_the_help_as_a_refusal() {
    let bench = Bench::new();
    let done = bench.say("").ends_in(2);
    assert_eq!(done.stdout, "");
    assert_eq!(done.stderr.trim_end(), bench.say("--help").stdout.trim_end());
}

//! What the program proposes works as it is printed.

use std::process::Command;

use super::bench::{Bench, Done, neutral};

/// Runs a printed command in the shell, as a user would who copies it.
#[cfg(unix)]
fn in_shell(bench: &Bench, command: &str) -> Done {
    let mut shell = Command::new("sh");
    shell.args(["-c", command]).current_dir(bench.path(""));
    neutral(&mut shell);
    Done::from(shell.output().unwrap())
}

fn proposed(done: &Done) -> String {
    let line = done.stdout.lines().find_map(|line| line.strip_prefix("next "));
    line.unwrap_or_else(|| panic!("{}", done.stdout)).trim().to_owned()
}

#[test]
#[cfg(unix)]
fn the_next_command_runs_for_every_kind_of_scenario_and_folder() {
    let bench = Bench::new();
    bench.file("rooms/my room.toml", "[world]\nmax_m = [6, 6]\n");
    let cases: [(&str, &str, &[&str]); 4] = [
        ("open", "plain", &[]),
        ("open", "it's mine", &["--set=vehicle.steer_limit_deg=30"]),
        ("rooms/my room.toml", "room", &[]),
        ("tb3_sandbox", "-x", &["--set=sensors.range_m=2"]),
    ];
    for (scenario, folder, options) in cases {
        let out = format!("--out={folder}");
        let mut words = vec!["train", scenario, &out];
        words.extend(super::bench::TINY);
        words.extend(options);
        let command = proposed(&bench.run(words).ends_in(0));
        let done = in_shell(&bench, &command).ends_in(0);
        assert!(done.stdout.contains("1000 unseen pairs"), "{command}\n{}", done.text());
        // The champion drives where it was trained: nothing about its car is news.
        assert_eq!(done.stderr, "", "{command}");
    }
}

#[test]
fn a_shipped_scenario_is_proposed_by_its_name() {
    let bench = Bench::new();
    let done = bench.say("train open --out run --population 12 --generations 2").ends_in(0);
    assert!(proposed(&done).ends_with(" evaluate run open"), "{}", done.stdout);
    let done = bench.train("open", "other", &["--set=world.boxes=[[4,4,5,5]]"]).ends_in(0);
    assert!(proposed(&done).ends_with(" evaluate other other"), "{}", done.stdout);
}

/// In a clone people type `cargo run`, and that is what they are told to type next.
#[test]
fn started_by_cargo_it_proposes_cargo() {
    let bench = Bench::new();
    let mut command = bench.program(["train", "open", "--out", "run"]);
    command.args(super::bench::TINY).env("CARGO_PKG_NAME", env!("CARGO_PKG_NAME"));
    let done = Done::from(command.output().unwrap()).ends_in(0);
    assert!(proposed(&done).starts_with("cargo run "), "{}", done.stdout);
}

#[test]
fn a_champion_drives_with_its_own_car_and_says_so() {
    let bench = Bench::new();
    bench.train("open", "run", &[]).ends_in(0);
    let done = bench.say("evaluate run tb3_sandbox --pairs 3").ends_in(0);
    insta::assert_snapshot!(done.stderr, @r"
    note: driving with the champion's beam range 10 m; the scenario's 3.5 m does not count
    note: driving with the champion's step 0.1 m; the scenario's 0.05 m does not count
    note: driving with the champion's period 0.1 s; the scenario's 0.05 s does not count
    ");
}

#[test]
fn a_replay_is_replaced_only_by_force() {
    let bench = Bench::new();
    bench.train("open", "run", &[]).ends_in(0);
    bench.say("replay run open --pairs 1").ends_in(0);
    let first = std::fs::read(bench.path("replay.html")).unwrap();
    let done = bench.say("replay run open --pairs 2").ends_in(2);
    assert_eq!(done.stdout, "", "it drove before it refused");
    assert_eq!(
        done.stderr,
        "error: --out replay.html: exists already and is not replaced without --force\n"
    );
    assert_eq!(std::fs::read(bench.path("replay.html")).unwrap(), first);
    bench.say("replay run open --pairs 2 --force").ends_in(0);
    assert_ne!(std::fs::read(bench.path("replay.html")).unwrap(), first);
}

#[test]
fn a_report_shows_the_first_pairs_and_says_so() {
    let bench = Bench::new();
    bench.train("open", "run", &["--set=pairs.count=50"]).ends_in(0);
    let report = std::fs::read_to_string(bench.path("run/report.html")).unwrap();
    assert!(report.contains("of 50 training pairs. The first 20 training pairs are shown."));
    let plots = std::fs::read_dir(bench.path("run/plots")).unwrap().count();
    assert_eq!(plots, 22);
}

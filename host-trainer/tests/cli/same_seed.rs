//! One seed gives the same bytes, whatever the machine does meanwhile.

use super::bench::{Bench, Done};
use host_trainer::vector::{Instructions, OVERRIDE};

#[test]
fn any_number_of_threads_leaves_the_same_files() {
    let bench = Bench::new();
    for threads in ["1", "2", "7"] {
        bench.train("obstacles", threads, &["--threads", threads, "--seed=7"]).ends_in(0);
    }
    let one = bench.results("1");
    for name in ["champion.blob", "metrics.csv", "manifest.toml", "report.html"] {
        assert!(one.contains_key(name), "{name} is missing");
    }
    let plots = one.keys().filter(|name| name.ends_with(".svg")).count();
    assert_eq!(plots, 4, "{:?}", one.keys());
    for threads in ["2", "7"] {
        assert!(one == bench.results(threads), "{threads} threads differ from one");
    }
    let checkpoint = "checkpoint-a.bin";
    assert_eq!(bench.all_files("1")[checkpoint], bench.all_files("7")[checkpoint]);
}

#[test]
fn any_vector_instructions_leave_the_same_files() {
    let bench = Bench::new();
    let sets: Vec<String> = Instructions::available().map(|set| set.to_string()).collect();
    for set in &sets {
        let mut command = bench.program(["train", "small-car", "--out", set, "--threads=2"]);
        command.args(super::bench::TINY).env(OVERRIDE, set);
        Done::from(command.output().unwrap()).ends_in(0);
        assert!(bench.results(&sets[0]) == bench.results(set), "{set} differs from {}", sets[0]);
    }
    // No failure, even where nothing may be left out: nobody chooses the CPU of a test machine.
    if sets.len() < Instructions::ALL.len() {
        eprintln!("NOT RUN: the rest of {:?}; this CPU has {}", Instructions::ALL, sets.join(", "));
    }
}

#[test]
fn another_seed_leaves_another_champion() {
    let bench = Bench::new();
    bench.train("open", "a", &["--seed=1"]).ends_in(0);
    bench.train("open", "b", &["--seed=18446744073709551615"]).ends_in(0);
    assert_ne!(bench.results("a")["champion.blob"], bench.results("b")["champion.blob"]);
}

/// Language, time zone and the working directory are not part of a run.
#[test]
fn another_environment_leaves_the_same_files() {
    let bench = Bench::new();
    bench.train("open", "a", &[]).ends_in(0);
    std::fs::create_dir(bench.path("elsewhere")).unwrap();
    let mut command = bench.program(["train", "open", "--out", "../b"]);
    command.args(super::bench::TINY).current_dir(bench.path("elsewhere"));
    command.envs([("LC_ALL", "de_DE.UTF-8"), ("LANG", "tr_TR.UTF-8"), ("TZ", "Asia/Kathmandu")]);
    Done::from(command.output().unwrap()).ends_in(0);
    assert!(bench.results("a") == bench.results("b"));
}

#[test]
fn a_run_that_is_resumed_to_more_generations_ends_as_the_longer_run_does() {
    let bench = Bench::new();
    let options = |folder: &str, generations: &str| {
        format!(
            "train open --out {folder} --population 12 --set pairs.count=2 \
             --set episode.step_limit=60 --generations {generations}"
        )
    };
    bench.say(&options("whole", "8")).ends_in(0);
    bench.say(&options("parts", "2")).ends_in(0);
    bench.say("train --resume parts --generations 5").ends_in(0);
    bench.say("train --resume parts --generations 8 --threads 1").ends_in(0);
    assert!(bench.results("whole") == bench.results("parts"));
}

#[test]
fn a_run_that_changes_on_its_way_is_not_resumed_to_another_number_of_generations() {
    let several = ["--preset=robust", "--set=training.validation_pairs=5"];
    let islands = ["--set=training.islands=2"];
    for (folder, settings) in [("a", &several[..]), ("b", &islands)] {
        let bench = Bench::new();
        bench.train("open", folder, settings).ends_in(0);
        let before = bench.all_files(folder);
        let done = bench.say(&format!("train --resume {folder} --generations 5")).ends_in(2);
        let expected = "from its first generation to its last, generation 3; expected that number";
        assert!(done.stderr.contains(expected), "{}", done.stderr);
        assert!(before == bench.all_files(folder));
        bench.say(&format!("train --resume {folder} --generations 3")).ends_in(0);
    }
}

#[test]
fn a_search_by_novelty_that_is_resumed_ends_as_the_run_that_was_never_interrupted() {
    let bench = Bench::new();
    let options = |folder: &str, generations: &str| {
        format!(
            "train medium_maze --preset novelty --set episode.on_collision=stop --population 20 \
             --out {folder} --generations {generations}"
        )
    };
    bench.say(&options("whole", "7")).ends_in(0);
    bench.say(&options("parts", "3")).ends_in(0);
    bench.say("train --resume parts --generations 7 --threads 1").ends_in(0);
    assert!(bench.results("whole") == bench.results("parts"));
}

#[test]
fn a_run_until_the_goal_is_reached_ends_with_that_and_stays_so() {
    let bench = Bench::new();
    let line = "train medium_maze --preset novelty --generations 300 --out a --json";
    let done: serde_json::Value = serde_json::from_str(&bench.say(line).ends_in(0).stdout).unwrap();
    assert_eq!(done["training"]["reached"], 1);
    assert!(done["generations"].as_u64().unwrap() < 300, "{done}");
    let before = bench.all_files("a");
    bench.say("train --resume a").ends_in(0);
    assert!(before == bench.all_files("a"));
}

#[test]
fn a_finished_run_that_is_resumed_stays_as_it_is() {
    let bench = Bench::new();
    bench.train("open", "a", &[]).ends_in(0);
    let before = bench.all_files("a");
    bench.say("train --resume a").ends_in(0);
    assert!(before == bench.all_files("a"));
}

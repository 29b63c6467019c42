//! The paper's experiments from the command line: small, interrupted, resumed, refused.

use super::bench::{Bench, unfinished};

/// Options of a reproduction that takes a second.
const SMALL: &str = "--seeds 2 --generations 3 --population 12 --pairs 20";

#[test]
fn a_reproduction_leaves_a_report_plots_a_line_per_seed_and_all_numbers() {
    let bench = Bench::new();
    let done = bench.say(&format!("reproduce open --methods self {SMALL}")).ends_in(0);
    assert!(done.stdout.contains("runs/reproduce-open/report.html"), "{}", done.stdout);
    assert!(done.stdout.contains("paper, 3× generations  training "), "{}", done.stdout);
    assert!(done.stderr.contains("trial 4/4  "), "{}", done.stderr);
    let files = bench.results("runs/reproduce-open");
    for name in ["report.html", "results.csv", "results.json", "reproduction.toml"] {
        assert!(files.contains_key(name), "{name}");
    }
    for plot in ["fitness", "criteria", "unseen", "best-5", "median-1"] {
        assert!(files.contains_key(&format!("plots/open-{plot}.svg")), "{plot}");
    }
    let csv = String::from_utf8(files["results.csv"].clone()).unwrap();
    // Three lengths of the paper's method and one other, two seeds each.
    assert_eq!(csv.lines().count(), 1 + 4 * 2, "{csv}");
    assert_eq!(unfinished(&files), [""; 0]);
}

#[test]
fn the_json_object_is_the_file_and_where_it_lies() {
    let bench = Bench::new();
    let line = format!("reproduce complex --methods paper --json --out r {SMALL}");
    let done = bench.say(&line).ends_in(0);
    let mut printed: serde_json::Value = serde_json::from_str(&done.stdout).unwrap();
    let object = printed.as_object_mut().unwrap();
    assert_eq!(object.remove("folder").unwrap(), "r");
    assert!(object.remove("report").unwrap().as_str().unwrap().ends_with("report.html"));
    let kept = std::fs::read(bench.path("r/results.json")).unwrap();
    assert_eq!(printed, serde_json::from_slice::<serde_json::Value>(&kept).unwrap());
    assert_eq!(printed["scenes"][0]["papers_success_rate"], 0.75);
}

#[test]
fn a_maze_is_searched_by_novelty_by_distance_and_by_chance() {
    let bench = Bench::new();
    let line = "reproduce medium-maze --seeds 2 --generations 4 --population 40 --out r --json";
    let done = bench.say(line).ends_in(0);
    let mut printed: serde_json::Value = serde_json::from_str(&done.stdout).unwrap();
    let object = printed.as_object_mut().unwrap();
    assert_eq!(object.remove("folder").unwrap(), "r");
    assert!(object.remove("report").unwrap().as_str().unwrap().ends_with("report.html"));
    let files = bench.results("r");
    assert_eq!(
        printed,
        serde_json::from_slice::<serde_json::Value>(&files["results.json"]).unwrap()
    );
    let course = &printed["courses"][0];
    assert_eq!(course["course"], "medium-maze");
    assert_eq!(course["published"][0]["mean"], 18274.0);
    let methods: Vec<_> = course["rows"].as_array().unwrap().iter().map(|r| &r["method"]).collect();
    assert_eq!(methods, ["novelty", "distance", "chance"]);
    for row in course["rows"].as_array().unwrap() {
        assert_eq!((&row["budget"], &row["solved"]["of"]), (&160.into(), &2.into()));
    }
    let csv = String::from_utf8(files["results.csv"].clone()).unwrap();
    assert_eq!(csv.lines().count(), 1 + 2 * 3 * 2, "{csv}");
    for name in
        ["report.html", "plots/medium-maze-novelty.svg", "plots/medium-maze-clean-chance.svg"]
    {
        assert!(files.contains_key(name), "{name}");
    }
    assert_eq!(unfinished(&files), [""; 0]);
}

#[test]
fn a_maze_gone_on_with_has_the_bytes_of_one_done_at_once_on_any_number_of_threads() {
    let bench = Bench::new();
    let line = "reproduce switchback-maze --generations 3 --population 20 --methods novelty";
    bench.say(&format!("{line} --seeds 3 --threads 5 --out whole")).ends_in(0);
    bench.say(&format!("{line} --seeds 1 --threads 1 --out parts")).ends_in(0);
    let more = bench.say("reproduce --resume parts --seeds 3 --threads 2").ends_in(0);
    assert!(more.stderr.contains("6 trials (2 done)"), "{}", more.stderr);
    assert!(bench.results("whole") == bench.results("parts"));
    let fewer = bench.say("reproduce --resume parts --seeds 2").ends_in(2);
    assert!(fewer.stderr.contains("has 3 seeds; expected as many or more"), "{}", fewer.stderr);
}

#[test]
fn a_run_in_a_maze_is_the_run_that_train_does_with_the_same_seed() {
    let bench = Bench::new();
    let line = "reproduce medium-maze --methods novelty --seed 7 --seeds 1 --generations 20 --json";
    let mazes: serde_json::Value =
        serde_json::from_str(&bench.say(line).ends_in(0).stdout).unwrap();
    let same = "train medium_maze --preset novelty --seed 7 --generations 20 --out t --json";
    let run: serde_json::Value = serde_json::from_str(&bench.say(same).ends_in(0).stdout).unwrap();
    let found = &mazes["courses"][0]["rows"][0]["runs"][0];
    assert_eq!(found["solved"], true);
    let generations = run["generations"].as_u64().unwrap();
    assert_eq!(found["evaluations"].as_u64().unwrap(), 250 * generations);
}

#[test]
fn options_of_scenes_and_of_mazes_are_told_apart_by_name() {
    let bench = Bench::new();
    for (line, parts) in [
        ("reproduce medium-maze --pairs 5", ["--pairs: found", "expected none"]),
        ("reproduce medium-maze --methods elman", ["`elman`", "novelty, distance, chance"]),
        ("reproduce open --methods distance", ["`distance`", "expected some of: paper"]),
    ] {
        let done = bench.say(line).ends_in(2);
        assert!(parts.iter().all(|part| done.stderr.contains(part)), "{line}: {}", done.stderr);
        assert!(!bench.path("runs").exists(), "{line}");
    }
}

#[test]
fn equal_reproductions_have_equal_bytes_on_any_number_of_threads() {
    let bench = Bench::new();
    for threads in ["1", "2", "5"] {
        let line = format!("reproduce open --methods elman --threads {threads} --out {threads}");
        bench.say(&format!("{line} {SMALL}")).ends_in(0);
    }
    assert!(bench.results("1") == bench.results("2"), "1 and 2");
    assert!(bench.results("1") == bench.results("5"), "1 and 5");
}

#[test]
fn a_trial_is_the_run_that_train_does_with_the_same_seed() {
    let bench = Bench::new();
    let line = "reproduce open --methods paper --seed 7 --seeds 1 --pairs 1000 --out r";
    bench.say(&format!("{line} --generations 3 --population 12")).ends_in(0);
    let same = "train open --preset paper --seed 7 --generations 3 --population 12 --out t --json";
    let run: serde_json::Value = serde_json::from_str(&bench.say(same).ends_in(0).stdout).unwrap();
    let kept = std::fs::read(bench.path("r/results.json")).unwrap();
    let kept: serde_json::Value = serde_json::from_slice(&kept).unwrap();
    let row = &kept["scenes"][0]["rows"][0];
    assert_eq!(row["seeds"][0]["best"], run["best"]);
    assert_eq!(row["seeds"][0]["training_reached"], run["training"]["reached"]);
    assert_eq!(row["unseen_reached"]["median"], run["unseen"]["reached"]);
    assert_eq!(row["unseen_clean"]["median"], run["unseen"]["clean"]);
}

#[test]
fn what_is_done_is_not_done_again_and_more_seeds_end_as_if_asked_for_at_once() {
    let bench = Bench::new();
    let two = format!("--methods paper {SMALL}");
    bench.say(&format!("reproduce open --out parts {two}")).ends_in(0);
    let first = std::fs::read(bench.path("parts/trials/open-paper-1.bin")).unwrap();
    let again = bench.say("reproduce --resume parts").ends_in(0);
    assert!(again.stderr.contains("2 trials (2 done)"), "{}", again.stderr);
    let more = bench.say("reproduce --resume parts --seeds 3 --threads 1").ends_in(0);
    assert!(more.stderr.contains("3 trials (2 done)"), "{}", more.stderr);
    assert_eq!(first, std::fs::read(bench.path("parts/trials/open-paper-1.bin")).unwrap());
    let three = two.replace("--seeds 2", "--seeds 3");
    bench.say(&format!("reproduce open --out whole {three}")).ends_in(0);
    assert!(bench.results("whole") == bench.results("parts"));
}

#[test]
fn a_damaged_trial_is_done_again() {
    let bench = Bench::new();
    bench.say(&format!("reproduce open --methods paper --out r {SMALL}")).ends_in(0);
    let whole = bench.results("r");
    bench.file("r/trials/open-paper-2.bin", "half a tri");
    let again = bench.say("reproduce --resume r").ends_in(0);
    assert!(again.stderr.contains("2 trials (1 done)"), "{}", again.stderr);
    assert!(whole == bench.results("r"));
}

#[test]
fn what_makes_no_sense_is_refused_by_the_options_name_and_leaves_nothing() {
    let bench = Bench::new();
    bench.train("open", "run", &[]).ends_in(0);
    bench.say(&format!("reproduce open --methods paper --out done {SMALL}")).ends_in(0);
    for (line, named) in [
        ("reproduce opne", "[SCENE]"),
        ("reproduce open --seeds 0", "--seeds"),
        ("reproduce open --seed -1", "--seed"),
        ("reproduce open --seed 18446744073709551610", "--seed"),
        ("reproduce open --pairs 0", "--pairs"),
        ("reproduce open --threads 0", "--threads"),
        ("reproduce open --generations 0", "--generations"),
        ("reproduce open --population 1", "--population"),
        ("reproduce open --population 1000000", "--population"),
        ("reproduce open --methods papr", "--methods"),
        ("reproduce open --out done", "--resume done"),
        ("reproduce open --out run", "--out"),
        ("reproduce --resume nowhere", "--resume"),
        ("reproduce --resume run", "has no reproduction.toml"),
        ("reproduce --resume done --pairs 5", "--pairs"),
        ("reproduce complex --resume done", "--resume"),
        ("reproduce --resume done --seeds 1", "--seeds"),
        ("train --resume done", "has no manifest.toml"),
    ] {
        let done = bench.say(line).ends_in(2);
        assert!(done.stdout.is_empty() && done.stderr.contains(named), "{line}: {}", done.stderr);
    }
    assert!(!bench.path("runs").exists());
}

#[cfg(unix)]
mod interrupted {
    use crate::bench::{Bench, Done};
    use std::process::{Command, Stdio};
    use std::time::{Duration, Instant};

    /// Seconds of work, in many trials.
    const LONG: &str = "--seeds 12 --generations 10 --population 40 --pairs 20 --methods paper";

    #[test]
    fn ctrl_c_and_sigterm_keep_what_is_done_and_say_how_to_go_on() {
        let bench = Bench::new();
        for (signal, code) in [("INT", 130), ("TERM", 143)] {
            let line = format!("reproduce open --threads 1 --out {signal} {LONG}");
            let mut program = bench.program(line.split_whitespace());
            let mut child = program.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
            let end = Instant::now() + Duration::from_secs(60);
            while !bench.path(format!("{signal}/trials/open-paper-2.bin")).exists()
                && child.try_wait().unwrap().is_none()
            {
                assert!(Instant::now() < end, "no trial");
                std::thread::sleep(Duration::from_millis(1));
            }
            let arguments = [format!("-{signal}"), child.id().to_string()];
            assert!(Command::new("kill").args(arguments).status().unwrap().success());
            let done = Done::from(child.wait_with_output().unwrap()).ends_in(code);
            assert!(
                done.stderr.contains(" of 12 trials, each kept\ngo on with: "),
                "{}",
                done.stderr
            );
            assert!(done.stderr.contains(&format!("reproduce --resume {signal}\n")));
            assert!(!bench.path(format!("{signal}/report.html")).exists());
            let resumed = bench.say(&format!("reproduce --resume {signal}")).ends_in(0);
            assert!(!resumed.stderr.contains("(0 done)"), "{}", resumed.stderr);
        }
        assert!(bench.results("INT") == bench.results("TERM"));
    }
}

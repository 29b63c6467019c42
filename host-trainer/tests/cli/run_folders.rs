//! A run folder belongs to one run, and to one process at a time.

use std::fs;
use std::process::Stdio;
use std::thread::sleep;
use std::time::{Duration, Instant};

use super::bench::{Bench, TINY};

#[test]
fn a_folder_in_use_is_busy_at_once_for_everybody_else() {
    let bench = Bench::new();
    let mut holder = bench
        .program("train open --out run --generations 1000000".split(' '))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    while !bench.path("run/metrics.csv").exists() {
        sleep(Duration::from_millis(2));
    }
    for command in ["train --resume run", "train open --out run"] {
        let begun = Instant::now();
        let done = bench.say(command).ends_in(4);
        assert!(begun.elapsed() < Duration::from_secs(2), "{command}: {:?}", begun.elapsed());
        assert_eq!(done.stderr, "error: another evosteer is using the run folder run\n");
    }
    // Reading is everybody's right.
    let done = bench.say("evaluate run open").ends_in(2);
    assert!(done.stderr.contains("this run has not finished"), "{}", done.stderr);
    holder.kill().unwrap();
    holder.wait().unwrap();
}

#[test]
fn a_used_folder_is_never_overwritten() {
    let bench = Bench::new();
    bench.train("open", "run", &[]).ends_in(0);
    bench.file("mine/thesis.tex", "years of work");
    let before = [bench.all_files("run"), bench.all_files("mine")];
    for folder in ["run", "mine"] {
        bench.train("obstacles", folder, &["--seed=2"]).ends_in(2);
    }
    assert!(before == [bench.all_files("run"), bench.all_files("mine")]);
}

#[test]
fn a_run_with_ever_new_worlds_leaves_the_first_and_the_champions_in_its_folder() {
    let bench = Bench::new();
    let worlds = [
        "training.worlds.rooms=2",
        "training.worlds.renew_every=1",
        "pairs.count=6",
        "training.generations=2",
    ];
    let settings = worlds.map(|setting| format!("--set={setting}"));
    bench.train("open", "run", &settings.each_ref().map(String::as_str)).ends_in(0);
    let files = bench.all_files("run");
    let made = |ending| {
        files.keys().filter(|name| name.starts_with("worlds/") && name.ends_with(ending)).count()
    };
    // Two of the first generation, and the two that are there in the third.
    assert_eq!([made(".toml"), made(".svg")], [4, 4]);
}

/// Its worlds are scenarios like any other, and the report says where it was trained.
#[test]
fn a_run_in_random_worlds_leaves_them_in_its_folder() {
    let bench = Bench::new();
    let worlds = ["training.worlds.boxes=2", "training.worlds.rooms=1", "pairs.count=6"];
    let settings = worlds.map(|setting| format!("--set={setting}"));
    bench.train("open", "run", &settings.each_ref().map(String::as_str)).ends_in(0);
    let files = bench.all_files("run");
    let mut names: Vec<&str> =
        files.keys().filter_map(|name| name.strip_prefix("worlds/")).collect();
    names.retain(|name| name.ends_with(".toml"));
    assert_eq!(names.len(), 3, "{:?}", files.keys());
    for name in names {
        assert!(files.contains_key(&format!("worlds/{}", name.replace(".toml", ".svg"))));
        bench.say(&format!("evaluate run run/worlds/{name} --pairs 5")).ends_in(0);
    }
    let report = String::from_utf8_lossy(&files["report.html"]).into_owned();
    assert!(report.contains("It was trained in random worlds"), "{report:.600}");
    bench.say("evaluate run run --pairs 5").ends_in(0);
}

#[test]
fn runs_without_out_get_a_folder_of_their_own() {
    let bench = Bench::new();
    for _ in 0..3 {
        bench.run(["train", "open", "--seed=5"].iter().chain(TINY)).ends_in(0);
    }
    let mut names: Vec<_> = fs::read_dir(bench.path("runs"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(names, ["open-5", "open-5-2", "open-5-3"]);
}

/// Everything fits but the scenario: only its identity tells them apart.
#[test]
fn a_checkpoint_of_another_run_is_refused() {
    let bench = Bench::new();
    bench.train("open", "run", &[]).ends_in(0);
    let others: [(&str, &[&str]); 3] = [
        ("other-seed", &["--seed=2"]),
        ("other-scene", &["--set=fitness.bonus=1"]),
        ("other-size", &["--set=network.hidden=16"]),
    ];
    for (other, options) in others {
        bench.train("open", other, options).ends_in(0);
        let checkpoint = fs::read(bench.path(other).join("checkpoint-a.bin")).unwrap();
        bench.train("open", &format!("{other}-copy"), &[]).ends_in(0);
        bench.file(&format!("{other}-copy/checkpoint-a.bin"), checkpoint);
        let done = bench.say(&format!("train --resume {other}-copy --generations 9")).ends_in(2);
        let why = format!(
            "error: the checkpoint in {other}-copy does not belong to this run: it was saved \
             under another scenario, seed or beginning\n"
        );
        assert_eq!(done.stderr, why);
    }
}

#[test]
fn a_run_does_not_resume_to_fewer_generations_than_it_has() {
    let bench = Bench::new();
    bench.train("open", "run", &[]).ends_in(0);
    let before = bench.all_files("run");
    let done = bench.say("train --resume run --generations 2").ends_in(2);
    assert_eq!(
        done.stderr,
        "error: --generations: 3 generations of the run in run are done already; expected as many \
         or more\n"
    );
    assert!(before == bench.all_files("run"));
}

#[test]
fn a_damaged_checkpoint_is_passed_over_and_the_end_is_the_same() {
    let bench = Bench::new();
    bench.train("open", "whole", &[]).ends_in(0);
    bench.train("open", "run", &["--checkpoint-every=0"]).ends_in(0);
    // Generation 3 of 3 is in a: the older one is what remains.
    let newest = bench.path("run/checkpoint-a.bin");
    let mut bytes = fs::read(&newest).unwrap();
    bytes[200] ^= 1;
    fs::write(&newest, bytes).unwrap();
    let done = bench.say("train --resume run").ends_in(0);
    assert!(done.stderr.starts_with("warning: run/checkpoint-a.bin: damaged"), "{}", done.stderr);
    assert!(done.stderr.contains("going on from generation 2\n"), "{}", done.stderr);
    assert!(bench.results("whole") == bench.results("run"));

    for name in ["checkpoint-a.bin", "checkpoint-b.bin"] {
        bench.file(&format!("run/{name}"), "scribble");
    }
    bench.say("train --resume run").ends_in(2);
    for name in ["checkpoint-a.bin", "checkpoint-b.bin"] {
        fs::remove_file(bench.path("run").join(name)).unwrap();
    }
    bench.say("train --resume run").ends_in(0);
    assert!(bench.results("whole") == bench.results("run"));
}

#[test]
fn a_run_folder_may_be_moved() {
    let bench = Bench::new();
    bench.train("tb3_sandbox", "run", &[]).ends_in(0);
    fs::rename(bench.path("run"), bench.path("moved here")).unwrap();
    bench.run(["train", "--resume", "moved here", "--generations", "4"]).ends_in(0);
    bench.run(["evaluate", "moved here", "tb3_sandbox", "--pairs", "5"]).ends_in(0);
}

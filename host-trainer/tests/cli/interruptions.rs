//! Killed, stopped and gone on with: the end is the same.
#![cfg(unix)]

use std::os::unix::process::ExitStatusExt;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use super::bench::{Bench, Done, unfinished};

/// About half a second of training, with a checkpoint after every generation.
const RUN: &[&str] = &[
    "train",
    "obstacles",
    "--seed=3",
    "--population=30",
    "--generations=60",
    "--checkpoint-every=0",
    "--set=pairs.count=2",
    "--set=episode.step_limit=60",
    "--set=training.ga.mutation={gaussian_sigma=0.2}",
];

/// The same with an archive in the checkpoint, in a room whose goal nobody reaches in so few steps.
const NOVEL_RUN: &[&str] = &[
    "train",
    "medium_maze",
    "--preset=novelty",
    "--seed=3",
    "--population=60",
    "--generations=60",
    "--checkpoint-every=0",
    "--set=episode.step_limit=60",
];

fn start(bench: &Bench, folder: &str) -> Child {
    start_as(RUN, bench, folder)
}

fn start_as(run: &[&str], bench: &Bench, folder: &str) -> Child {
    // Killed before it could say what it is, a run has to be begun again.
    let mut command = if bench.path(folder).join("manifest.toml").exists() {
        bench.program(["train", "--checkpoint-every=0", "--resume", folder])
    } else {
        bench.program(run.iter().chain(&["--out", folder]))
    };
    command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

fn uninterrupted(bench: &Bench) -> Duration {
    uninterrupted_as(RUN, bench)
}

fn uninterrupted_as(run: &[&str], bench: &Bench) -> Duration {
    let begun = Instant::now();
    bench.run(run.iter().chain(&["--out", "whole"])).ends_in(0);
    begun.elapsed()
}

fn finish(bench: &Bench, folder: &str) {
    let child = start(bench, folder);
    Done::from(child.wait_with_output().unwrap()).ends_in(0);
}

fn send(signal: &str, child: &Child) {
    let sent = Command::new("kill").args([signal, &child.id().to_string()]).status();
    assert!(sent.unwrap().success());
}

/// Waits until the run has written a file, or ended without.
fn wait_for(bench: &Bench, file: &str, child: &mut Child) {
    let end = Instant::now() + Duration::from_secs(30);
    while !bench.path(file).exists() && child.try_wait().unwrap().is_none() {
        assert!(Instant::now() < end, "no {file}");
        sleep(Duration::from_millis(1));
    }
}

#[test]
fn a_run_killed_at_ten_random_moments_ends_as_if_nothing_had_happened() {
    killed_at_ten_random_moments(RUN);
}

#[test]
fn a_search_by_novelty_killed_at_ten_random_moments_ends_as_if_nothing_had_happened() {
    killed_at_ten_random_moments(NOVEL_RUN);
}

fn killed_at_ten_random_moments(run: &[&str]) {
    let bench = Bench::new();
    let whole = uninterrupted_as(run, &bench);
    let mut random = 0x5eed_u64;
    println!("seed of the moments {random:#x}, the whole run takes {whole:?}");
    let mut killed = 0;
    for _ in 0..10 {
        // Knuth's MMIX generator; its high bits are good enough for moments.
        random =
            random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let moment = whole.mul_f64(0.4 * (random >> 32) as f64 / f64::from(u32::MAX));
        let mut child = start_as(run, &bench, "parts");
        sleep(moment);
        child.kill().unwrap();
        let status = child.wait().unwrap();
        let done = std::fs::read_to_string(bench.path("parts/metrics.csv")).unwrap_or_default();
        println!("after {moment:?}: {status}, {} lines of metrics", done.lines().count());
        killed += usize::from(status.signal() == Some(9));
    }
    assert!(killed >= 3, "only {killed} of 10 runs were still going when they were killed");
    finish(&bench, "parts");
    assert!(bench.results("whole") == bench.results("parts"));
    assert_eq!(unfinished(&bench.all_files("parts")), [""; 0]);
}

#[test]
fn a_run_killed_while_it_writes_its_results_writes_them_again() {
    let bench = Bench::new();
    uninterrupted(&bench);
    for file in ["champion.blob", "plots/fitness.svg", "plots/trajectory-2.svg"] {
        let folder = file.replace(['/', '.'], "-");
        let mut child = start(&bench, &folder);
        wait_for(&bench, &format!("{folder}/{file}"), &mut child);
        child.kill().unwrap();
        child.wait().unwrap();
        finish(&bench, &folder);
        assert!(bench.results("whole") == bench.results(&folder), "{file}");
    }
}

#[test]
fn ctrl_c_and_sigterm_write_a_checkpoint_and_say_how_to_go_on() {
    let bench = Bench::new();
    uninterrupted(&bench);
    for (signal, code) in [("INT", 130), ("TERM", 143)] {
        let mut child = start(&bench, signal);
        wait_for(&bench, &format!("{signal}/checkpoint-a.bin"), &mut child);
        let sent = Instant::now();
        send(&format!("-{signal}"), &child);
        let done = Done::from(child.wait_with_output().unwrap());
        assert!(sent.elapsed() < Duration::from_secs(5), "{:?}", sent.elapsed());
        let done = done.ends_in(code);
        assert!(
            done.stderr.contains(" of 60, checkpoint written\ngo on with: "),
            "{}",
            done.stderr
        );
        let folder = format!("train --resume {signal}\n");
        assert!(done.stderr.contains(&folder), "{}", done.stderr);
        let resumed = bench.run(["train", &format!("--resume={signal}")]).ends_in(0);
        assert!(resumed.stdout.contains("trained 60 generations"), "{}", resumed.stdout);
        assert!(bench.results("whole") == bench.results(signal), "{signal}");
    }
}

#[test]
fn a_second_ctrl_c_ends_a_run_that_is_already_stopping() {
    let bench = Bench::new();
    let mut child = start(&bench, "run");
    wait_for(&bench, "run/checkpoint-a.bin", &mut child);
    for _ in 0..2 {
        // The first one may have ended it.
        let _ = Command::new("kill")
            .args(["-INT", &child.id().to_string()])
            .stderr(Stdio::null())
            .status();
    }
    Done::from(child.wait_with_output().unwrap()).ends_in(130);
}

/// A generation of this run takes minutes; nobody waits for it.
#[test]
fn ctrl_c_does_not_wait_for_a_long_generation() {
    let bench = Bench::new();
    let options = "train complex --out run --population 20000 --set pairs.count=400";
    let mut child = bench
        .program(options.split(' '))
        .stderr(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    wait_for(&bench, "run/timing.csv", &mut child);
    let sent = Instant::now();
    send("-INT", &child);
    let done = Done::from(child.wait_with_output().unwrap()).ends_in(130);
    assert!(sent.elapsed() < Duration::from_secs(5), "{:?}", sent.elapsed());
    assert!(done.stderr.contains("stopped after generation 0 of"), "{}", done.stderr);
}

/// There is nothing to save: the system's own way to end is the right one. SIGTERM stands in
/// for Ctrl-C, which a test run in the background inherits as ignored.
#[test]
fn a_signal_ends_an_evaluation_at_once() {
    let bench = Bench::new();
    bench.train("open", "run", &[]).ends_in(0);
    let mut child = bench
        .program("evaluate run open --pairs 5000000".split(' '))
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    sleep(Duration::from_millis(300));
    assert!(child.try_wait().unwrap().is_none(), "it ended by itself");
    let sent = Instant::now();
    send("-TERM", &child);
    assert_eq!(child.wait().unwrap().signal(), Some(15));
    assert!(sent.elapsed() < Duration::from_secs(10));
}

#[test]
fn a_run_that_is_held_and_let_go_ends_the_same() {
    let bench = Bench::new();
    uninterrupted(&bench);
    let mut child = start(&bench, "held");
    wait_for(&bench, "held/checkpoint-b.bin", &mut child);
    send("-STOP", &child);
    sleep(Duration::from_millis(200));
    send("-CONT", &child);
    Done::from(child.wait_with_output().unwrap()).ends_in(0);
    assert!(bench.results("whole") == bench.results("held"));
}

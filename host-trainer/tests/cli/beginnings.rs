//! A run can begin with a champion instead of with random networks.

use super::bench::{Bench, Done, TINY};
use std::fs;

/// Trains for so many generations in a moment, into `folder`.
fn train(bench: &Bench, folder: &str, generations: u32, more: &[&str]) -> Done {
    let generations = format!("--generations={generations}");
    let tiny = TINY.iter().filter(|option| !option.starts_with("--generations"));
    let place = ["train", "open", "--out", folder, &generations];
    bench.run(place.iter().chain(tiny).chain(more))
}

/// What each generation's best cost.
fn costs(bench: &Bench, run: &str) -> Vec<f64> {
    let metrics = fs::read_to_string(bench.path(run).join("metrics.csv")).unwrap();
    metrics.lines().skip(1).map(|row| row.split(',').nth(1).unwrap().parse().unwrap()).collect()
}

#[test]
fn a_run_goes_on_from_where_a_champion_of_the_same_pairs_stood() {
    let bench = Bench::new();
    train(&bench, "first", 12, &[]).ends_in(0);
    train(&bench, "second", 3, &["--from=first"]).ends_in(0);
    let (first, second) = (costs(&bench, "first"), costs(&bench, "second"));
    assert!(first[11] < first[0], "{first:?}: the first run learnt something");
    assert!(second[0] <= first[11], "{second:?} after {first:?}");
    let copy = fs::read(bench.path("second/from.blob")).unwrap();
    assert!(copy == fs::read(bench.path("first/champion.blob")).unwrap());
    // A file and the folder it lies in are the same beginning; manifest and report say which it was.
    train(&bench, "third", 3, &["--from=first/champion.blob"]).ends_in(0);
    let results = |run| {
        let mut files = bench.results(run);
        assert!(files.remove("report.html").is_some());
        let manifest = files.remove("manifest.toml").unwrap();
        (files, String::from_utf8(manifest).unwrap())
    };
    let ((second, said), (third, says)) = (results("second"), results("third"));
    assert!(second == third);
    assert!(said.contains("path = \"first\"") && says.contains("path = \"first/champion.blob\""));
}

#[test]
fn a_run_that_began_with_a_champion_resumes_like_any_other() {
    let bench = Bench::new();
    train(&bench, "first", 3, &[]).ends_in(0);
    train(&bench, "whole", 5, &["--from=first"]).ends_in(0);
    train(&bench, "parts", 2, &["--from=first"]).ends_in(0);
    fs::rename(bench.path("first"), bench.path("away")).unwrap();
    bench.say("train --resume parts --generations 5").ends_in(0);
    assert!(bench.results("parts") == bench.results("whole"));
    fs::rename(bench.path("away"), bench.path("first")).unwrap();

    // Killed when it had written its manifest and nothing else.
    train(&bench, "killed", 5, &["--from=first"]).ends_in(0);
    for (name, _) in bench.all_files("killed") {
        if name != "manifest.toml" {
            fs::remove_file(bench.path("killed").join(name)).unwrap();
        }
    }
    bench.file("killed/lock", "");
    bench.say("train --resume killed").ends_in(0);
    assert!(bench.results("killed") == bench.results("whole"));
}

#[test]
fn a_run_goes_on_only_with_the_champion_that_it_began_with() {
    let bench = Bench::new();
    train(&bench, "first", 3, &[]).ends_in(0);
    train(&bench, "run", 2, &["--from=first"]).ends_in(0);
    let resume = || bench.say("train --resume run --generations 4").ends_in(2).stderr;

    // Of the same scenario and seed, and yet of another run.
    train(&bench, "other", 2, &[]).ends_in(0);
    for name in ["checkpoint-a.bin", "checkpoint-b.bin"] {
        let _ = fs::remove_file(bench.path("run").join(name));
        let _ = fs::copy(bench.path("other").join(name), bench.path("run").join(name));
    }
    let said = resume();
    assert!(said.contains("saved under another scenario, seed or beginning"), "{said}");

    let before = bench.results("run")["manifest.toml"].clone();
    let copy = bench.path("run/from.blob");
    fs::copy(bench.path("other/champion.blob"), &copy).unwrap();
    let said = resume();
    assert!(said.contains("run/from.blob has changed since the run in run began"), "{said}");
    fs::write(&copy, "something else").unwrap();
    let said = resume();
    assert!(said.contains("run/from.blob is refused"), "{said}");
    fs::remove_file(copy).unwrap();
    fs::remove_dir_all(bench.path("first")).unwrap();
    let said = resume();
    assert!(said.contains("has lost from.blob") && said.contains("first: no such file"), "{said}");
    assert!(bench.results("run")["manifest.toml"] == before);
}

#[test]
fn a_refinement_has_to_begin_with_a_champion() {
    let bench = Bench::new();
    let done = train(&bench, "run", 2, &["--preset=refine"]).ends_in(2);
    assert!(
        done.stderr.starts_with("error: --preset refine goes on from a champion; expected --from ")
    );
    assert!(!bench.path("run").exists());
    train(&bench, "run", 2, &["--preset=refine", "--from=complex"]).ends_in(0);
}

/// A file of that name has to be called `./depot`.
#[test]
fn a_shipped_champion_is_named_by_its_scene_and_its_other_car_is_told() {
    let bench = Bench::new();
    bench.file("depot", "no blob");
    let car = "--set=vehicle.wheelbase_m=0.25";
    let done = train(&bench, "run", 2, &["--from=depot", "--preset=robust", car]).ends_in(0);
    for said in [
        "begins with champions/depot.blob, trained in depot, seed ",
        "note: its wheelbase was 0.3 m; the scenario's, 0.25 m, counts\n",
    ] {
        assert!(done.stderr.contains(said), "{}", done.stderr);
    }
    let report = fs::read_to_string(bench.path("run/report.html")).unwrap();
    assert!(report.contains("began with"));
    let done = train(&bench, "other", 2, &["--from=./depot"]).ends_in(2);
    assert!(done.stderr.starts_with("error: ./depot is refused: "), "{}", done.stderr);
}

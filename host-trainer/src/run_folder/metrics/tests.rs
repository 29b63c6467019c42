use tempfile::{TempDir, tempdir};

use super::*;

fn run() -> (TempDir, RunFolder) {
    let base = tempdir().unwrap();
    let folder = RunFolder::create(&base.path().join("run")).unwrap();
    (base, folder)
}

fn row(generation: u32) -> MetricsRow {
    MetricsRow {
        generation,
        best: -0.1 - f64::from(generation),
        mean: 1e10 / 3.0,
        worst: f64::INFINITY,
        collisions: 3,
        distance_to_target: 12.5,
        bonus: 2,
        path_length: 100.0,
        reached: 0.4,
        clean: 0.2,
        population_reached: 1.0 / 3.0,
        live_steps: 70_000,
    }
}

fn text(folder: &RunFolder, name: &str) -> String {
    fs::read_to_string(folder.join(name)).unwrap()
}

#[test]
fn every_generation_is_a_line_under_its_column_names() {
    let (_base, folder) = run();
    let mut metrics = Metrics::start(&folder, &[]).unwrap();
    metrics.append(&row(0), 1_234_567.8).unwrap();
    metrics.append(&row(1), 2e6).unwrap();
    metrics.sync().unwrap();
    assert_eq!(
        text(&folder, "metrics.csv"),
        "generation,best,mean,worst,collisions,distance_to_target,bonus,path_length,reached,\
         clean,population_reached,live_steps\n\
         0,-0.1,3333333333.3333335,inf,3,12.5,2,100,0.4,0.2,0.3333333333333333,70000\n\
         1,-1.1,3333333333.3333335,inf,3,12.5,2,100,0.4,0.2,0.3333333333333333,70000\n"
    );
    assert_eq!(text(&folder, "timing.csv"), "generation,steps_per_second\n0,1234568\n1,2000000\n");
}

#[test]
fn a_killed_and_resumed_run_has_the_metrics_of_one_that_was_not() {
    let (_base, whole) = run();
    let mut metrics = Metrics::start(&whole, &[]).unwrap();
    (0..6).for_each(|generation| metrics.append(&row(generation), 1e6).unwrap());

    let (_base, killed) = run();
    let mut metrics = Metrics::start(&killed, &[]).unwrap();
    (0..5).for_each(|generation| metrics.append(&row(generation), 1e6).unwrap());
    drop(metrics);
    // Killed in the middle of both writes, with the last checkpoint after generation 2.
    for name in [RunFolder::METRICS, RunFolder::TIMING] {
        let mut bytes = fs::read(killed.join(name)).unwrap();
        bytes.extend(b"5,9");
        fs::write(killed.join(name), bytes).unwrap();
    }
    let history: Vec<MetricsRow> = (0..3).map(row).collect();
    let mut metrics = Metrics::start(&killed, &history).unwrap();
    (3..6).for_each(|generation| metrics.append(&row(generation), 2e6).unwrap());

    assert_eq!(text(&killed, "metrics.csv"), text(&whole, "metrics.csv"));
    assert_eq!(
        text(&killed, "timing.csv"),
        "generation,steps_per_second\n\
         0,1000000\n1,1000000\n2,1000000\n3,2000000\n4,2000000\n5,2000000\n"
    );
}

#[test]
fn a_resumed_run_does_without_its_timing() {
    let (_base, folder) = run();
    drop(Metrics::start(&folder, &[]).unwrap());
    fs::remove_file(folder.join("timing.csv")).unwrap();
    Metrics::start(&folder, &[row(0)]).unwrap();
    fs::write(folder.join("timing.csv"), b"0,1\n\xff\n0,fast\n0,2").unwrap();
    Metrics::start(&folder, &[row(0)]).unwrap();
    assert_eq!(text(&folder, "timing.csv"), "generation,steps_per_second\n0,1\n");
}

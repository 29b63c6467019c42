//! The SVG files.

use host_trainer::report::data::{Drive, Generation, Scene};
use host_trainer::report::{plots, scene_svg};

use crate::fixture;

/// A room with one box, and a car that bumped into it.
fn bump() -> (Scene, Drive) {
    let scene = Scene {
        name: "bump".to_owned(),
        bounds: [[0.0, 0.0], [2.0, 1.0]],
        outer_wall: true,
        target_radius: 0.2,
        polygons: vec![vec![[1.0, 0.0], [1.2, 0.0], [1.2, 0.5], [1.0, 0.5]]],
        circles: Vec::new(),
        segments: vec![[0.0, 0.8, 0.4, 0.8], [0.4, 0.8, 0.4, 1.0]],
        outlines: Vec::new(),
    };
    let mut drive = fixture::clean();
    drive.moments.truncate(4);
    let places = [[0.7, 0.3], [0.8, 0.3], [0.9, 0.3], [0.9, 0.3]];
    for (moment, [x, y]) in drive.moments.iter_mut().zip(places) {
        (moment.x, moment.y, moment.heading) = (x, y, 0.0);
    }
    drive.moments[3].collided = true;
    (drive.start, drive.goal) = ([0.7, 0.3, 0.0], [1.7, 0.3]);
    drive.outcome.reached = false;
    drive.outcome.collisions = 1;
    (scene, drive)
}

#[test]
fn a_drive_is_drawn_from_diamond_to_square_with_its_collision() {
    let (scene, drive) = bump();
    insta::assert_snapshot!(plots::trajectory_svg(&scene, &fixture::BODY, &drive, "Drive 1"));
}

#[test]
fn the_world_alone_has_no_drive_in_it() {
    let (scene, drive) = bump();
    let world = scene_svg(&scene);
    let with_drive = plots::trajectory_svg(&scene, &fixture::BODY, &drive, "Drive 1");
    assert!(world.contains("<title>bump</title>") && !world.contains("polyline"));
    // Where both show something it is the same thing in the same place.
    let obstacles =
        |svg: &str| svg.lines().find(|l| l.starts_with("<g transform")).map(str::to_owned);
    assert!(obstacles(&world).is_some());
    assert_eq!(obstacles(&world), obstacles(&with_drive));
}

#[test]
fn the_same_history_gives_the_same_bytes() {
    let report = fixture::report();
    let draw = || plots::fitness_svg(&report.history) + &plots::criteria_svg(&report.history);
    assert_eq!(draw(), draw());
}

#[test]
fn histories_without_a_point_or_with_strange_points_are_drawn() {
    let usual = fixture::report().history;
    let strange = |value: f64| {
        let row = Generation { best: value, mean: value, worst: value, ..usual[3] };
        vec![usual[0], row, usual[5], usual[6]]
    };
    let histories = [
        Vec::new(),
        usual[..1].to_vec(),
        vec![Generation::default(); 3],
        strange(f64::NAN),
        strange(f64::INFINITY),
        strange(1e300),
    ];
    for history in histories {
        let svg = plots::fitness_svg(&history) + &plots::criteria_svg(&history);
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{history:?}");
    }
}

/// What is written at the ticks, axis by axis.
fn tick_texts(svg: &str) -> Vec<Vec<&str>> {
    let texts = svg.lines().filter(|line| line.contains("font-size=\"11\""));
    let texts: Vec<(bool, &str)> = texts
        .map(|line| {
            let (_, text) = line.split_once('>').unwrap();
            (line.contains("text-anchor=\"end\""), text.split_once('<').unwrap().0)
        })
        .collect();
    let axes = texts.chunk_by(|a, b| a.0 == b.0);
    axes.map(|axis| axis.iter().map(|&(_, text)| text).collect()).collect()
}

#[test]
fn ticks_are_plain_numbers_that_differ_however_short_or_flat_the_run() {
    let values: [fn(f64) -> f64; 7] = [
        |_| 0.0,
        |_| 12_016.5,
        |_| -20_764.3,
        |_| 0.004,
        |n| 12_016.5 - 0.001 * n,
        |n| 0.03 / (n + 1.0),
        |n| 73_249.7 - 1_234.5 * n,
    ];
    for count in [1, 2, 3, 10, 200] {
        for (number, value) in values.iter().enumerate() {
            let row = |number| {
                let value = value(f64::from(number));
                Generation {
                    number,
                    best: value,
                    mean: value,
                    worst: value,
                    collisions: value.abs(),
                    distance: value.abs(),
                    reached: 1,
                    pairs: 4,
                    length: value.abs(),
                }
            };
            let history: Vec<Generation> = (0..count).map(row).collect();
            for (svg, panels) in
                [(plots::fitness_svg(&history), 2), (plots::criteria_svg(&history), 4)]
            {
                let axes = tick_texts(&svg);
                assert_eq!(axes.len(), 2 * panels, "{count} generations of values {number}");
                for axis in axes {
                    let at = format!("{count} generations of values {number}: {axis:?}");
                    assert!((2..=12).contains(&axis.len()), "{at}");
                    assert!(!axis.iter().any(|text| text.contains('e')), "{at}");
                    let mut once = axis.clone();
                    once.sort_unstable();
                    once.dedup();
                    assert_eq!(once.len(), axis.len(), "{at}");
                }
            }
        }
    }
}

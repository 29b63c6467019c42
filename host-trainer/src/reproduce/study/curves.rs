//! Curves over generations (Figs. 5 and 6), and how champions do on unseen pairs.

use super::super::results::SceneResults;
use super::super::setup::Setup;
use super::super::spread::Spread;
use super::super::trial::Trial;
use super::Method;
use crate::report::plots::{Band, Line, SeedPanel, Strip, seeds_svg, strips_svg};
use crate::run_folder::MetricsRow;

/// Runs that are drawn by themselves, as in the paper: "two independent GA runs".
const INDEPENDENT: usize = 2;

/// What a curve shows of a generation.
type Value = fn(&MetricsRow) -> f64;

/// Fitness of the best over generations, and the training pairs that every method reaches.
pub(super) fn fitness(methods: &[Method<'_>]) -> (String, String) {
    let (setup, trials) = methods[0];
    let fitness = SeedPanel {
        title: "Fitness of the best individual".to_owned(),
        unit: "fitness (lower is better)",
        ..over_seeds(setup, trials, |row| row.best, true)
    };
    let line = |(setup, trials): &Method<'_>| {
        let values = by_generation(trials, setup.all_generations(), |row| 100.0 * row.reached);
        Line {
            name: Some(setup.method.name.to_owned()),
            values: values.map(|v| mean(&v)).collect(),
        }
    };
    let reached = SeedPanel {
        title: "Training pairs reached (mean)".to_owned(),
        unit: "%",
        shown: vec![0.0, 100.0],
        lines: methods.iter().map(line).collect(),
        ..SeedPanel::default()
    };
    let name = setup.scene.name();
    let svg = seeds_svg(
        &format!("{name}-fitness"),
        &format!("{name}: fitness over generations"),
        1,
        &[fitness, reached],
    );
    let caption = format!(
        "Left: Fig. 5 over {} seeds: the median, the middle half (dark) and all runs (light), and \
         two independent runs. Right: every method as far as it ran.",
        trials.len()
    );
    (svg, caption)
}

/// The four partial criteria of the best.
pub(super) fn criteria(setup: &Setup, trials: &[Trial]) -> (String, String) {
    let pairs = trials.iter().map(|trial| trial.stages[0].training.len()).max().unwrap_or(0);
    let criterion = |title: &str, unit, most: Option<f64>, value: Value| SeedPanel {
        title: title.to_owned(),
        unit,
        shown: most.into_iter().chain([0.0]).collect(),
        ..over_seeds(setup, trials, value, false)
    };
    let panels = [
        criterion("Collisions", "moves in contact", None, |row| row.collisions as f64),
        criterion("Distance to target at the end", "metres", None, |row| row.distance_to_target),
        criterion("Targets reached", "pairs", Some(pairs as f64), |row| f64::from(row.bonus)),
        criterion("Path length", "metres", None, |row| row.path_length),
    ];
    let name = setup.scene.name();
    let title = format!("{name}: partial criteria over generations");
    let svg = seeds_svg(&format!("{name}-criteria"), &title, 2, &panels);
    let caption = "Fig. 6: of the best individual of each generation, summed over its training \
                   pairs; the lines and areas are those of the fitness above."
        .to_owned();
    (svg, caption)
}

/// One dot per champion.
pub(super) fn unseen(name: &str, results: &SceneResults) -> (String, String) {
    let strip = |title: &str, share: fn(&super::super::results::SeedRow) -> u32| {
        let groups = results.rows.iter().map(|row| {
            let of = |seed| 100.0 * f64::from(share(seed)) / f64::from(seed.unseen_pairs);
            (row.variant.clone(), row.seeds.iter().map(of).collect())
        });
        Strip { title: title.to_owned(), unit: "% of unseen pairs", groups: groups.collect() }
    };
    let strips = [
        strip("Unseen pairs reached", |seed| seed.unseen_reached),
        strip("Unseen pairs reached clean", |seed| seed.unseen_clean),
    ];
    let svg = strips_svg(&format!("{name}-unseen"), &format!("{name}: unseen pairs"), &strips);
    (svg, "A dot per seed; the large one is the median.".to_owned())
}

/// Median, quartiles and ends over the seeds within the paper's generations, and the first runs.
fn over_seeds(setup: &Setup, trials: &[Trial], value: Value, named: bool) -> SeedPanel {
    let generations = setup.generations(1);
    let spreads: Vec<Spread> =
        by_generation(trials, generations, value).filter_map(Spread::of).collect();
    let name = |text: &str| named.then(|| text.to_owned());
    let edge = |of: fn(&Spread) -> f64| spreads.iter().map(of).collect::<Vec<f64>>();
    let single = trials.iter().take(INDEPENDENT).map(|trial| Line {
        name: name(&format!("seed {}", trial.seed)),
        values: trial.history.iter().take(generations as usize).map(value).collect(),
    });
    let median = Line { name: name("median"), values: edge(|spread| spread.median) };
    SeedPanel {
        bands: vec![
            Band { low: edge(|spread| spread.least), high: edge(|spread| spread.most) },
            Band {
                low: edge(|spread| spread.lower_quartile),
                high: edge(|spread| spread.upper_quartile),
            },
        ],
        lines: std::iter::once(median).chain(single).collect(),
        ..SeedPanel::default()
    }
}

/// The values of all trials, generation by generation.
fn by_generation(
    trials: &[Trial],
    generations: u32,
    value: Value,
) -> impl Iterator<Item = Vec<f64>> + '_ {
    (0..generations as usize).map(move |generation| {
        trials.iter().map(|trial| value(&trial.history[generation])).collect()
    })
}

fn mean(values: &[f64]) -> f64 {
    let mut sum = 0.0;
    for value in values {
        sum += value;
    }
    sum / values.len() as f64
}

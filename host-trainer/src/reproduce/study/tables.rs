//! The tables of a scene.

use super::super::results::{Row, SceneResults, SeedRow, range};
use crate::report::study::Table;

/// What the paper shows or says, and what was found.
pub(super) fn claims(results: &SceneResults) -> Table {
    let rows = results.claims.iter().map(|claim| {
        let place = claim.place.replace(' ', "\u{a0}");
        vec![place, format!("“{}”", claim.paper), claim.here.clone()]
    });
    Table {
        columns: vec![("", false), ("The paper", false), ("Here", false)],
        rows: rows.collect(),
    }
}

/// A row per variant.
pub(super) fn variants(results: &SceneResults) -> Table {
    let columns = vec![
        ("Variant", false),
        ("Size", false),
        ("Training pairs reached", false),
        ("All of them", false),
        ("Unseen reached", false),
        ("Unseen clean", false),
        ("Training, by seed", false),
        ("Unseen, by seed", false),
    ];
    let paper = results.papers_success_rate.map(|rate| {
        let mut row = vec![String::new(); columns.len()];
        row[0] = "the paper says".to_owned();
        row[2] = format!("{:.0} %", 100.0 * rate);
        row
    });
    let rows = paper.into_iter().chain(results.rows.iter().map(variant)).collect();
    Table { columns, rows }
}

fn variant(row: &Row) -> Vec<String> {
    let against = |split: &Option<super::super::spread::SeedBySeed>| {
        split.as_ref().map_or("–".to_owned(), ToString::to_string)
    };
    vec![
        row.variant.clone(),
        size(row),
        row.training.to_string(),
        format!("{} of {}", row.all_reached.count, row.all_reached.of),
        range(&row.unseen_reached),
        range(&row.unseen_clean),
        against(&row.training_against_paper),
        against(&row.unseen_against_paper),
    ]
}

fn size(row: &Row) -> String {
    let Row { islands, population, generations, .. } = row;
    match islands {
        1 => format!("{population} × {generations}"),
        _ => format!("{islands} × {population} × {generations}"),
    }
}

/// How to read the table of variants.
pub(super) fn explained(results: &SceneResults) -> String {
    let medians = match results.papers().unseen_reached.median_interval {
        Some([low, high]) => format!(
            " The 95 % interval of the paper's median of unseen pairs reached is {:.1} to {:.1} %.",
            100.0 * low,
            100.0 * high
        ),
        None => String::new(),
    };
    let mut whats: Vec<String> = Vec::new();
    for row in &results.rows {
        let what = format!("{}: {}", row.method, row.what);
        if !whats.contains(&what) {
            whats.push(what);
        }
    }
    let whats = whats.join("; ");
    format!(
        "{whats}. Size: individuals × generations, before them the islands if there are several. Training pairs are those of all seeds together, \
         with Wilson's 95 % interval; all of them: runs that reached all of their pairs. Unseen \
         pairs: the median over the seeds, with the least and the most; clean is reached without \
         one collision.{medians} The last columns count the seeds on which a variant did better or \
         worse than the paper's own method (two-sided sign test)."
    )
}

/// A row per variant and seed.
pub(super) fn seeds(results: &SceneResults) -> Table {
    let columns = vec![
        ("Variant", false),
        ("Seed", true),
        ("Fitness", true),
        ("Training reached", true),
        ("clean", true),
        ("All reached after", true),
        ("Unseen reached", true),
        ("clean", true),
        ("Loops", true),
        ("Stuck", true),
    ];
    let lines = results.rows.iter().flat_map(|row| row.seeds.iter().map(|seed| line(row, seed)));
    Table { columns, rows: lines.collect() }
}

fn line(row: &Row, seed: &SeedRow) -> Vec<String> {
    let share =
        |count: u32| format!("{:.1} %", 100.0 * f64::from(count) / f64::from(seed.unseen_pairs));
    vec![
        row.variant.clone(),
        seed.seed.to_string(),
        format!("{:.1}", seed.best),
        format!("{} of {}", seed.training_reached, seed.training_pairs),
        seed.training_clean.to_string(),
        seed.learned_after.map_or("–".to_owned(), |after| after.to_string()),
        share(seed.unseen_reached),
        share(seed.unseen_clean),
        seed.unreached.in_loops.to_string(),
        seed.unreached.stuck.to_string(),
    ]
}

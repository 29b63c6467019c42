//! `results.csv`: a line per scene, variant and seed.

use super::results::{Results, Row, SeedRow};
use std::fmt::Write;

/// The first line.
pub const HEADER: &str = "scene,variant,network,population,generations,seed,best,found_in,\
     training_pairs,training_reached,training_clean,learned_after,unseen_pairs,unseen_reached,\
     unseen_clean,unreached,in_loops,stuck";

/// The whole table. Where no generation reached all pairs, `learned_after` is empty. A variant's
/// name may hold a comma, so it is quoted.
pub fn csv(results: &Results) -> String {
    let mut text = format!("{HEADER}\n");
    for scene in &results.scenes {
        for row in &scene.rows {
            for seed in &row.seeds {
                line(&mut text, scene.scene.name(), row, seed);
            }
        }
    }
    text
}

fn line(text: &mut String, scene: &str, row: &Row, seed: &SeedRow) {
    let Row { variant, network, population, generations, .. } = row;
    let SeedRow {
        seed,
        best,
        found_in,
        training_pairs,
        training_reached,
        training_clean,
        learned_after,
        unseen_pairs,
        unseen_reached,
        unseen_clean,
        unreached,
    } = seed;
    let learned_after = learned_after.map(|after| after.to_string()).unwrap_or_default();
    let _ = writeln!(
        text,
        "{scene},\"{variant}\",\"{network}\",{population},{generations},{seed},{best},{found_in},\
         {training_pairs},{training_reached},{training_clean},{learned_after},{unseen_pairs},\
         {unseen_reached},{unseen_clean},{},{},{}",
        unreached.drives, unreached.in_loops, unreached.stuck
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::sample;

    #[test]
    fn every_seed_of_every_variant_has_a_line_with_a_value_for_every_column() {
        let plan = sample::plan();
        let text = csv(&sample::results(&plan));
        // Three lengths of the paper's method and one other, two seeds each.
        assert_eq!(text.lines().count(), 1 + 4 * 2, "{text}");
        for line in text.lines().skip(1) {
            // What stands between quotes counts as one.
            let outside: String = line.split('"').step_by(2).collect();
            assert_eq!(outside.split(',').count(), HEADER.split(',').count(), "{line}");
        }
    }
}

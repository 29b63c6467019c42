use super::*;
use crate::reproduce::sample;

#[test]
fn a_row_counts_what_its_seeds_show() {
    let results = sample::results(&sample::plan());
    let [scene] = &results.scenes[..] else { panic!("one scene") };
    let names: Vec<&str> = scene.rows.iter().map(|row| &*row.variant).collect();
    assert_eq!(names, ["paper", "paper, 2× generations", "paper, 3× generations", "self"]);
    for row in &scene.rows {
        let reached: u32 = row.seeds.iter().map(|seed| seed.training_reached).sum();
        let lost: u32 = row.seeds.iter().map(|seed| seed.unreached.drives).sum();
        assert_eq!((row.training.count, row.training.of), (reached, 10));
        assert_eq!((reached + lost, row.unreached.drives), (10, lost));
        assert_eq!(row.seeds.iter().map(|seed| seed.seed).collect::<Vec<_>>(), [1, 2]);
    }
}

#[test]
fn every_variant_but_the_papers_is_compared_with_it_seed_by_seed() {
    let results = sample::results(&sample::plan());
    let rows = &results.scenes[0].rows;
    assert_eq!(rows[0].training_against_paper, None);
    for row in &rows[1..] {
        let pairs = row.seeds.iter().zip(&rows[0].seeds);
        let better = pairs.filter(|(a, b)| a.unseen_reached > b.unseen_reached).count() as u32;
        assert_eq!(row.unseen_against_paper.unwrap().better, better, "{}", row.variant);
    }
}

#[test]
fn runs_learn_in_the_first_generation_whose_best_reaches_every_pair() {
    let plan = sample::plan();
    let (setups, mut trials) = sample::trials(&plan);
    for (generation, row) in trials[0][0].history.iter_mut().enumerate() {
        row.reached = if generation == 3 { 1.0 } else { 0.8 };
    }
    for row in &mut trials[0][1].history {
        row.reached = 0.0;
    }
    let rows = &Results::of(&plan, &setups, &trials).scenes[0].rows;
    let learned = |row: &Row| row.seeds.iter().map(|s| s.learned_after).collect::<Vec<_>>();
    // Lengths of 2, 4 and 6 generations.
    assert_eq!(learned(&rows[0]), [None, None]);
    assert_eq!(learned(&rows[1]), [Some(4), None]);
    assert_eq!(rows[2].learned_after.unwrap().median, 4.0);
}

#[test]
fn the_numbers_are_json_without_anything_missing() {
    let json = serde_json::to_value(sample::results(&sample::plan())).unwrap();
    let row = &json["scenes"][0]["rows"][0];
    assert_eq!(json["scenes"][0]["scene"], "open");
    for key in ["training", "unseen_reached", "unseen_clean", "unreached", "seeds", "all_reached"] {
        assert!(!row[key].is_null(), "{key}: {row}");
    }
    assert!(row["unseen_clean"]["median"].is_number());
}

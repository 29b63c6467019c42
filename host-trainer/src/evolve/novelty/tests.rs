use super::*;
use proptest::collection::vec;
use proptest::prelude::*;

fn behaviours(points: &[[f32; 2]]) -> Behaviours {
    let mut behaviours = Behaviours::none(2);
    for point in points {
        behaviours.extend(point);
    }
    behaviours
}

fn novelty(neighbours: u32, archive_growth: u32) -> Novelty {
    Novelty::new(NoveltySpec { neighbours, archive_growth }, 2, RunSeed(7))
}

fn judged(novelty: &mut Novelty, generation: u32, points: &[[f32; 2]]) -> Vec<f64> {
    novelty.judge(generation, &behaviours(points)).into_iter().map(|cost| -cost.value()).collect()
}

/// Oracle: all distances sorted, in the order of the definition.
fn by_definition(k: usize, own: usize, population: &[[f32; 2]], archive: &[[f32; 2]]) -> f64 {
    let [x, y] = population[own].map(f64::from);
    let others = population.iter().enumerate().filter(|(place, _)| *place != own);
    let mut distances: Vec<f64> = others
        .map(|(_, other)| other)
        .chain(archive)
        .map(|other| libm::hypot(f64::from(other[0]) - x, f64::from(other[1]) - y))
        .collect();
    distances.sort_by(f64::total_cmp);
    distances.truncate(k);
    if distances.is_empty() { 0.0 } else { distances.iter().sum::<f64>() / distances.len() as f64 }
}

/// Many points coincide, so that equals are met.
fn points(count: std::ops::Range<usize>) -> impl Strategy<Value = Vec<[f32; 2]>> {
    let coordinate = prop_oneof![(-3_i8..3).prop_map(f32::from), -3_f32..3.0];
    vec([coordinate.clone(), coordinate], count)
}

proptest! {
    #[test]
    fn novelty_is_the_mean_distance_to_the_nearest_of_population_and_archive(
        population in points(1..40),
        archive in points(0..40),
        k in 1_u32..20,
    ) {
        let mut judge = novelty(k, 0);
        judge.archive = behaviours(&archive);
        let found = judged(&mut judge, 0, &population);
        for (own, found) in found.into_iter().enumerate() {
            let expected = by_definition(k as usize, own, &population, &archive);
            prop_assert!((found - expected).abs() <= 1e-12 * expected.max(1.0), "{own}: {found}");
        }
    }

    #[test]
    fn novelty_has_the_same_bits_in_whatever_order_the_others_stand(
        mut population in points(2..30),
        turn in 1_usize..29,
    ) {
        let first = population[0];
        let one = judged(&mut novelty(15, 0), 0, &population)[0];
        let turn = turn % (population.len() - 1);
        population[1..].rotate_left(turn);
        prop_assert_eq!(population[0], first);
        let other = judged(&mut novelty(15, 0), 0, &population)[0];
        prop_assert_eq!(one.to_bits(), other.to_bits());
    }
}

#[test]
fn who_ends_alone_is_the_most_novel_and_costs_least() {
    let costs =
        novelty(2, 0).judge(0, &behaviours(&[[0.0, 0.0], [1.0, 0.0], [9.0, 0.0], [0.0, 1.0]]));
    assert_eq!(super::super::best_index(&costs), Some(2));
    assert_eq!(costs[0].value(), -1.0);
}

#[test]
fn what_the_archive_holds_is_not_novel_any_more() {
    let mut judge = novelty(1, 0);
    let alone = judged(&mut judge, 0, &[[0.0, 0.0], [5.0, 0.0]])[1];
    judge.archive = behaviours(&[[5.0, 0.5]]);
    let again = judged(&mut judge, 1, &[[0.0, 0.0], [5.0, 0.0]])[1];
    assert_eq!((alone, again), (5.0, 0.5));
}

#[test]
fn a_generation_is_judged_before_any_of_it_joins_the_archive() {
    let points = [[0.0, 0.0], [3.0, 4.0]];
    let mut judge = novelty(1, 2);
    assert_eq!(judged(&mut judge, 0, &points), [5.0, 5.0]);
    assert_eq!(judge.archive().len(), 2);
    assert_eq!(judged(&mut judge, 1, &points), [0.0, 0.0]);
}

#[test]
fn as_many_as_are_asked_for_join_each_at_most_once_and_by_chance() {
    let population: Vec<[f32; 2]> = (0..50).map(|place| [place as f32, 0.0]).collect();
    let mut judge = novelty(15, 6);
    let mut times = [0_u32; 50];
    for generation in 0..500 {
        judge.archive = Archive::none(2);
        judge.remember(generation, &behaviours(&population));
        let mut joined: Vec<usize> =
            judge.archive().points().map(|point| point[0] as usize).collect();
        joined.iter().for_each(|place| times[*place] += 1);
        joined.sort_unstable();
        joined.dedup();
        assert_eq!(joined.len(), 6, "generation {generation}");
    }
    // 60 on average; a spread of 7.3.
    assert!(times.iter().all(|times| (25..95).contains(times)), "{times:?}");
}

/// The streams behind it are pinned by their own tests; this pins what is drawn from them.
#[test]
fn the_same_individuals_join_in_every_release() {
    let population: Vec<[f32; 2]> = (0..250).map(|place| [place as f32, 0.0]).collect();
    let mut judge = novelty(15, 6);
    judged(&mut judge, 3, &population);
    let joined: Vec<f32> = judge.archive().points().map(|point| point[0]).collect();
    assert_eq!(joined, [60.0, 85.0, 63.0, 161.0, 210.0, 143.0]);
}

#[test]
fn an_archive_of_another_length_is_refused() {
    let saved = |generations: u32| {
        let mut judge = novelty(1, 2);
        for generation in 0..generations {
            judged(&mut judge, generation, &[[0.0, 0.0], [3.0, 4.0], [1.0, 1.0]]);
        }
        judge.archive
    };
    let mut judge = novelty(1, 2);
    let refusal = judge.restore(saved(3), 4, 3).unwrap_err();
    assert_eq!(refusal.to_string(), "the saved archive has 12 coordinates, expected 16");
    assert!(judge.archive().is_empty(), "nothing has changed");
    assert!(judge.restore(Archive::none(4), 0, 3).is_err(), "points of four coordinates");
    judge.restore(saved(4), 4, 3).unwrap();
    assert_eq!(judge.archive(), &saved(4));
}

#[test]
fn senseless_settings_are_refused_by_name() {
    let spec = NoveltySpec { neighbours: 0, ..NoveltySpec::USUAL };
    let refusal = spec.check(250).unwrap_err();
    assert_eq!(refusal.to_string(), "neighbours is 0, expected at least 1");
    let spec = NoveltySpec { archive_growth: 300, ..NoveltySpec::USUAL };
    let refusal = spec.check(250).unwrap_err();
    assert_eq!(refusal.to_string(), "archive_growth is 300, expected at most the population");
}

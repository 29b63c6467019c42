//! What the metrics say of a generation.

use crate::episode::Outcome;
use crate::evolve::Cost;
use crate::run_folder::MetricsRow;

/// One row: `drives` are all of the first individual's `pairs`, then of the second.
pub(super) fn row(
    generation: u32,
    costs: &[Cost],
    drives: &[Outcome],
    pairs: usize,
    best: usize,
) -> MetricsRow {
    let (mut mean, mut worst) = (0.0, Cost::new(f64::MIN));
    for cost in costs {
        mean += cost.value() / costs.len() as f64;
        worst = worst.max(*cost);
    }
    let champion = &drives[best * pairs..][..pairs];
    let count = |drives: &[Outcome], counts: fn(&Outcome) -> bool| {
        drives.iter().filter(|drive| counts(drive)).count()
    };
    let share = |n: usize, of: usize| n as f64 / of as f64;
    let reached_by_all = count(drives, |drive| drive.reached);
    let reached = count(champion, |drive| drive.reached);
    let (mut distance_to_target, mut path_length) = (0.0, 0.0);
    for drive in champion {
        distance_to_target += f64::from(drive.distance_to_target);
        path_length += f64::from(drive.path_length);
    }
    let live_steps = drives.iter().map(|drive| u64::from(drive.steps)).sum();
    MetricsRow {
        generation,
        best: costs[best].value(),
        mean,
        worst: worst.value(),
        collisions: champion.iter().map(|drive| u64::from(drive.collisions)).sum(),
        distance_to_target,
        bonus: reached as u32,
        path_length,
        reached: share(reached, champion.len()),
        clean: share(count(champion, Outcome::clean), champion.len()),
        population_reached: share(reached_by_all, drives.len()),
        live_steps,
    }
}

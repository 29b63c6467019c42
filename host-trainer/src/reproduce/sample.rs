//! A reproduction small enough for a test.

use super::claim::PaperScene;
use super::plan::Plan;
use super::results::Results;
use super::setup::Setup;
use super::trial::Trial;
use crate::signals::StopFlag;

/// Two seeds of two methods in the empty room, a few generations of a few individuals.
pub(super) fn plan() -> Plan {
    Plan {
        evosteer: "0.0.0".to_owned(),
        scenes: vec![PaperScene::Open],
        methods: vec!["paper".to_owned(), "self".to_owned()],
        seed: 1,
        seeds: 2,
        pairs: 12,
        generations: Some(2),
        population: Some(12),
    }
}

/// Its trials: one list per setup, by seed.
pub(super) fn trials(plan: &Plan) -> (Vec<Setup>, Vec<Vec<Trial>>) {
    let setups = plan.setups().unwrap();
    let never = StopFlag::default();
    let trial = |setup, seed| Trial::run(setup, seed, &never, || true).unwrap().unwrap();
    let of = |setup| plan.seeds().map(|seed| trial(setup, seed)).collect();
    let trials = setups.iter().map(of).collect();
    (setups, trials)
}

/// Its results.
pub(super) fn results(plan: &Plan) -> Results {
    let (setups, trials) = trials(plan);
    Results::of(plan, &setups, &trials)
}

//! What a population's individuals are judged by: their drives, a share of them with a worse car.

use crate::disturbances::Disturbances;
use crate::episode::Outcome;
use crate::problem::Problem;
use crate::scenario::Pair;
use crate::seed::Stream;
use crate::signals::StopFlag;
use crate::stress;
use crate::vector::Instructions;
use crate::wide::Fleet;

/// The scenario's car, and the same under stress for a share of the pairs.
#[derive(Debug)]
pub(super) struct TestDrives<'a> {
    as_described: &'a Problem,
    stressed: Option<Problem>,
}

impl<'a> TestDrives<'a> {
    pub(super) fn new(problem: &'a Problem) -> Self {
        let scenario = &problem.scenario;
        let stressed = (scenario.training.stressed_share > 0.0).then(|| {
            let car = Disturbances::of(scenario).without_chance();
            problem.disturbed(stress::in_full(car, scenario.episode.period))
        });
        Self { as_described: problem, stressed }
    }

    /// Every individual's drives, all of the first individual, then of the second; none once
    /// `stop` is raised. Drive `i` gets the random numbers of `random(i)`. This `share` of them is
    /// under stress, if the scenario has such drives at all.
    pub(super) fn of(
        &self,
        genomes: &[f32],
        share: f64,
        pairs: &[Pair],
        random: &(dyn Fn(u32) -> Stream + Sync),
        stop: &StopFlag,
    ) -> Option<Vec<Outcome>> {
        let Some(stressed) = &self.stressed else {
            return drives(self.as_described, genomes, pairs, random, stop);
        };
        let individuals = genomes.len() / self.as_described.topology().weights();
        let mut all = vec![Outcome::default(); individuals * pairs.len()];
        for (problem, of_stressed) in [(self.as_described, false), (stressed, true)] {
            let places: Vec<usize> = (0..pairs.len())
                .filter(|place| is_stressed(*place, share) == of_stressed)
                .collect();
            let chosen: Vec<Pair> = places.iter().map(|place| pairs[*place]).collect();
            let random = |index: u32| random(places[index as usize] as u32);
            let outcomes = drives(problem, genomes, &chosen, &random, stop)?;
            for (index, outcome) in outcomes.into_iter().enumerate() {
                let (individual, place) = (index / chosen.len(), places[index % chosen.len()]);
                all[individual * pairs.len() + place] = outcome;
            }
        }
        Some(all)
    }
}

fn drives(
    problem: &Problem,
    genomes: &[f32],
    pairs: &[Pair],
    random: &(dyn Fn(u32) -> Stream + Sync),
    stop: &StopFlag,
) -> Option<Vec<Outcome>> {
    let fleet = Fleet { problem, genomes, pairs, random, again: false };
    fleet.drive(Instructions::in_use(), stop).map(|drives| drives.outcomes)
}

/// Whether the pair at this place is driven under stress: of the first `n` places
/// `share * n` are, rounded down.
fn is_stressed(place: usize, share: f64) -> bool {
    let before = |places: usize| (places as f64 * share) as u64;
    before(place + 1) > before(place)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::training_drive;
    use crate::scenario::{PairSource, Preset};
    use crate::seed::RunSeed;

    #[test]
    fn stressed_pairs_are_spread_evenly() {
        let places = |share| -> String {
            (0..8).map(|place| if is_stressed(place, share) { '!' } else { '.' }).collect()
        };
        assert_eq!(places(0.0), "........");
        assert_eq!(places(0.25), "...!...!");
        assert_eq!(places(0.5), ".!.!.!.!");
        assert_eq!(places(1.0), "!!!!!!!!");
    }

    #[test]
    fn a_stressed_drive_is_that_of_a_stressed_car_and_the_others_are_as_without_stress() {
        let mut scenario = Preset::Paper.scenario();
        scenario.pairs.source = PairSource::Drawn { count: 7, resample: false };
        let calm = Problem::new(scenario.clone()).unwrap();
        scenario.training.stressed_share = 0.5;
        let half = Problem::new(scenario.clone()).unwrap();
        scenario.training.stressed_share = 1.0;
        let always = Problem::new(scenario).unwrap();
        let car = stress::in_full(Disturbances::of(&calm.scenario), calm.scenario.episode.period);
        let worse = calm.disturbed(car);
        let pairs = calm.sampler().unseen(RunSeed(3), 7).unwrap();
        let weights = 2 * calm.topology().weights();
        let genomes: Vec<f32> = (0..weights).map(|i| libm::sinf(i as f32)).collect();
        let random = |pair| training_drive(RunSeed(1), 4, pair);
        let stop = StopFlag::default();
        let of = |problem: &Problem| {
            let share = problem.scenario.training.stressed_share.into();
            TestDrives::new(problem).of(&genomes, share, &pairs, &random, &stop).unwrap()
        };
        let (half, always, calm, worse) = (of(&half), of(&always), of(&calm), of(&worse));
        assert_ne!(calm, worse);
        assert_eq!(always, worse);
        for (index, outcome) in half.iter().enumerate() {
            let expected = if index % 7 % 2 == 1 { worse[index] } else { calm[index] };
            assert_eq!(*outcome, expected, "drive {index}");
        }
    }
}

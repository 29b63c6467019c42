//! What a population's individuals are judged by: their drives, a share of them with a worse car.

use super::grounds::{Ground, grounds};
use crate::episode::Outcome;
use crate::failure::Failure;
use crate::pairs::PairSampler;
use crate::problem::Problem;
use crate::scenario::Pair;
use crate::seed::{RunSeed, Stream};
use crate::signals::StopFlag;
use crate::vector::Instructions;
use crate::wide::Fleet;
use rayon::prelude::*;

/// Drives in each world with the scenario's car, and with the same under stress for a share of
/// the pairs. Pair `i` lies in world `i` modulo their number.
#[derive(Debug)]
pub(super) struct TestDrives {
    grounds: Vec<Ground>,
}

/// The drives of one car in one world: who, and the places of its pairs.
struct Part<'a> {
    problem: &'a Problem,
    places: Vec<usize>,
}

impl TestDrives {
    pub(super) fn new(problem: &Problem, seed: RunSeed) -> Result<Self, Failure> {
        Ok(Self { grounds: grounds(problem, seed)? })
    }

    /// What draws pairs, world by world.
    pub(super) fn samplers(&self) -> Vec<PairSampler<'_>> {
        self.grounds.iter().map(Ground::sampler).collect()
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
        let parts = self.parts(pairs.len(), share);
        let drive = |part: &Part<'_>, threads| {
            let chosen: Vec<Pair> = part.places.iter().map(|place| pairs[*place]).collect();
            let random = |index: u32| random(part.places[index as usize] as u32);
            let fleet = Fleet {
                problem: part.problem,
                genomes,
                pairs: &chosen,
                random: &random,
                again: false,
            };
            let instructions = Instructions::in_use();
            let drives = if threads == 1 {
                fleet.drive_here(instructions, stop)
            } else {
                fleet.drive(instructions, stop)
            };
            Some(drives?.outcomes)
        };
        let threads = rayon::current_num_threads();
        // Every fleet ends with cars that wait for its longest drive: many small ones wait side
        // by side.
        let driven: Vec<Option<Vec<Outcome>>> = if parts.len() >= 4 * threads {
            parts.par_iter().map(|part| drive(part, 1)).collect()
        } else {
            parts.iter().map(|part| drive(part, threads)).collect()
        };
        let individuals = genomes.len() / self.grounds[0].as_described.topology().weights();
        let mut all = vec![Outcome::default(); individuals * pairs.len()];
        for (part, outcomes) in parts.iter().zip(driven) {
            for (index, outcome) in outcomes?.into_iter().enumerate() {
                let (individual, place) = (index / part.places.len(), index % part.places.len());
                all[individual * pairs.len() + part.places[place]] = outcome;
            }
        }
        Some(all)
    }

    /// Who drives which pairs.
    fn parts(&self, pairs: usize, share: f64) -> Vec<Part<'_>> {
        let worlds = self.grounds.len();
        let mut parts = Vec::new();
        for (world, Ground { as_described, stressed }) in self.grounds.iter().enumerate() {
            let places = (world..pairs).step_by(worlds);
            let (worse, same): (Vec<usize>, Vec<usize>) =
                places.partition(|place| stressed.is_some() && is_stressed(place / worlds, share));
            parts.push(Part { problem: as_described, places: same });
            parts.extend(stressed.iter().map(|problem| Part { problem, places: worse.clone() }));
        }
        parts.retain(|part| !part.places.is_empty());
        parts
    }
}

/// Whether the pair at this place of its world is driven under stress: of the first `n` places
/// `share * n` are, rounded down.
fn is_stressed(place: usize, share: f64) -> bool {
    let before = |places: usize| (places as f64 * share) as u64;
    before(place + 1) > before(place)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::disturbances::Disturbances;
    use crate::problem::training_drive;
    use crate::scenario::{PairSource, Preset};
    use crate::stress;

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
            TestDrives::new(problem, RunSeed(1))
                .unwrap()
                .of(&genomes, share, &pairs, &random, &stop)
                .unwrap()
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

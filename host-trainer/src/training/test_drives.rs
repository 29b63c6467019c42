//! What a population's individuals are judged by: their drives, a share of them with a worse car.

use super::grounds::{Ground, Plan};
use crate::episode::Outcome;
use crate::failure::Failure;
use crate::pairs::PairSampler;
use crate::problem::Problem;
use crate::scenario::generate::Recipe;
use crate::scenario::{Pair, Scenario};
use crate::seed::{RunSeed, Stream};
use crate::signals::StopFlag;
use crate::vector::Instructions;
use crate::wide::{Drives, Fleet};
use rayon::prelude::*;

/// Drives in each world with the scenario's car, and with worse ones for some of the pairs. Pair `i`
/// lies in world `i` modulo their number.
#[derive(Debug)]
pub(super) struct TestDrives {
    grounds: Vec<Ground>,
    /// What each of them is, where the run makes them for itself.
    made: Vec<(Plan, Recipe)>,
}

/// What cars the drives are made with.
#[derive(Clone, Copy, Debug)]
pub(super) enum Cars {
    /// The scenario's.
    AsDescribed,
    /// Those of training, this share of them under stress if the scenario has such drives at all; of
    /// the cars under stress, whose turn it is first.
    OfTraining { stressed: f64, first_turn: u64 },
}

/// The drives of one car in one world: who, and the places of its pairs.
struct Part<'a> {
    problem: &'a Problem,
    places: Vec<usize>,
}

impl TestDrives {
    /// In the scenario's own world, or in those that its run makes for itself, as they are in this
    /// generation.
    ///
    /// # Errors
    ///
    /// No way through any of many random fields.
    pub(super) fn new(problem: &Problem, seed: RunSeed, generation: u32) -> Result<Self, Failure> {
        let Some(worlds) = problem.scenario.training.worlds else {
            return Ok(Self { grounds: vec![Ground::new(problem.clone())], made: Vec::new() });
        };
        Self::planned(problem, seed, Plan::of_generation(worlds, generation))
    }

    /// In the worlds that nobody is trained in; none if there are none.
    ///
    /// # Errors
    ///
    /// No way through any of many random fields.
    pub(super) fn held_out(problem: &Problem, seed: RunSeed) -> Result<Option<Self>, Failure> {
        let worlds = problem.scenario.training.worlds.filter(|worlds| worlds.held_out > 0);
        worlds.map(|worlds| Self::planned(problem, seed, Plan::held_out(worlds))).transpose()
    }

    fn planned(problem: &Problem, seed: RunSeed, plans: Vec<Plan>) -> Result<Self, Failure> {
        let (mut grounds, mut made) = (Vec::new(), Vec::new());
        for plan in plans {
            let (recipe, ground) = plan.made(problem, seed)?;
            grounds.push(ground);
            made.push((plan, recipe));
        }
        Ok(Self { grounds, made })
    }

    /// The worlds that the run made for itself.
    pub(super) fn recipes(&self) -> impl Iterator<Item = Recipe> {
        self.made.iter().map(|(_, recipe)| *recipe)
    }

    /// Makes the worlds that are new in this generation, in the places of others.
    ///
    /// # Errors
    ///
    /// No way through any of many random fields.
    pub(super) fn renew(
        &mut self,
        problem: &Problem,
        seed: RunSeed,
        generation: u32,
    ) -> Result<(), Failure> {
        let Some(worlds) = problem.scenario.training.worlds else { return Ok(()) };
        let plans = Plan::of_generation(worlds, generation);
        for ((place, made), plan) in self.grounds.iter_mut().zip(&mut self.made).zip(plans) {
            if made.0 != plan {
                let (recipe, ground) = plan.made(problem, seed)?;
                (*place, *made) = (ground, (plan, recipe));
            }
        }
        Ok(())
    }

    /// Whether these are the worlds of that generation.
    pub(super) fn are_of(&self, problem: &Problem, generation: u32) -> bool {
        let worlds = problem.scenario.training.worlds;
        let plans = worlds.map_or(Vec::new(), |worlds| Plan::of_generation(worlds, generation));
        self.made.iter().map(|(plan, _)| plan).eq(&plans)
    }

    /// The scenarios of the worlds that the run made for itself.
    pub(super) fn scenarios(&self) -> impl Iterator<Item = &Scenario> {
        let scenarios = self.grounds.iter().map(|ground| &ground.as_described().scenario);
        scenarios.filter(|scenario| scenario.training.worlds.is_some())
    }

    /// What draws pairs, world by world.
    pub(super) fn samplers(&self) -> Vec<PairSampler<'_>> {
        self.grounds.iter().map(Ground::sampler).collect()
    }

    /// Every individual's drives, all of the first individual, then of the second; none once
    /// `stop` is raised. Drive `i` gets the random numbers of `random(i)`.
    pub(super) fn of(
        &self,
        genomes: &[f32],
        cars: Cars,
        pairs: &[Pair],
        random: &(dyn Fn(u32) -> Stream + Sync),
        stop: &StopFlag,
    ) -> Option<Vec<Outcome>> {
        let parts = self.parts(pairs.len(), cars);
        let length = self.grounds[0].as_described().topology().weights();
        let individuals = genomes.len() / length;
        let mut all = vec![Outcome::default(); individuals * pairs.len()];
        let instructions = Instructions::in_use();
        let mut keep = |part: &Part<'_>, first: usize, outcomes: Vec<Outcome>| {
            for (index, outcome) in outcomes.into_iter().enumerate() {
                let (individual, place) = (index / part.places.len(), index % part.places.len());
                all[(first + individual) * pairs.len() + part.places[place]] = outcome;
            }
        };
        if let [_] = self.grounds[..] {
            for part in &parts {
                let drive = |fleet: Fleet<'_>| fleet.drive(instructions, stop);
                keep(part, 0, part.drives(genomes, pairs, random, drive)?);
            }
        } else {
            // At the end of a fleet cars wait for its longest drive. Fleets of many worlds are small
            // and do so side by side, each on one thread.
            let pieces = (4 * rayon::current_num_threads()).div_ceil(parts.len());
            let some = individuals.div_ceil(pieces);
            let pieces: Vec<(&Part<'_>, usize)> = parts
                .iter()
                .flat_map(|part| (0..individuals).step_by(some).map(move |first| (part, first)))
                .collect();
            let driven: Vec<Option<Vec<Outcome>>> = pieces
                .par_iter()
                .map(|&(part, first)| {
                    let genomes = &genomes[first * length..];
                    let genomes = &genomes[..genomes.len().min(some * length)];
                    part.drives(genomes, pairs, random, |fleet| {
                        fleet.drive_here(instructions, stop)
                    })
                })
                .collect();
            for ((part, first), outcomes) in pieces.into_iter().zip(driven) {
                keep(part, first, outcomes?);
            }
        }
        Some(all)
    }

    /// Who drives which pairs.
    fn parts(&self, pairs: usize, cars: Cars) -> Vec<Part<'_>> {
        let worlds = self.grounds.len();
        let mut parts: Vec<Part<'_>> = Vec::new();
        // Counted through all worlds, so that they have their share together.
        let mut count = 0;
        for (world, ground) in self.grounds.iter().enumerate() {
            let first = parts.len();
            for place in (world..pairs).step_by(worlds) {
                let problem = match cars {
                    Cars::AsDescribed => ground.as_described(),
                    Cars::OfTraining { stressed, first_turn } => {
                        ground.for_drive(count, stressed, first_turn)
                    }
                };
                count += 1;
                match parts[first..].iter_mut().find(|part| std::ptr::eq(part.problem, problem)) {
                    Some(part) => part.places.push(place),
                    None => parts.push(Part { problem, places: vec![place] }),
                }
            }
        }
        parts
    }
}

impl Part<'_> {
    /// Its drives by all of these individuals, as `drive` makes them.
    fn drives(
        &self,
        genomes: &[f32],
        pairs: &[Pair],
        random: &(dyn Fn(u32) -> Stream + Sync),
        drive: impl FnOnce(Fleet<'_>) -> Option<Drives>,
    ) -> Option<Vec<Outcome>> {
        let chosen: Vec<Pair> = self.places.iter().map(|place| pairs[*place]).collect();
        let random = |index: u32| random(self.places[index as usize] as u32);
        let problem = self.problem;
        let fleet = Fleet { problem, genomes, pairs: &chosen, random: &random, again: false };
        drive(fleet).map(|drives| drives.outcomes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::disturbances::Disturbances;
    use crate::problem::training_drive;
    use crate::scenario::{self, PairSource, Preset};
    use crate::stress;

    #[test]
    fn all_worlds_together_have_the_share_of_stressed_drives() {
        for worlds in ["", "[training.worlds]\nboxes = 7"] {
            let text = format!("[pairs]\ncount = 9\n[training]\nstressed_share = 0.5\n{worlds}");
            let source = scenario::Source::new("a.toml", text, std::path::Path::new(""));
            let problem = Problem::new(scenario::load(&source, None, &[]).unwrap()).unwrap();
            let drives = TestDrives::new(&problem, RunSeed(1), 0).unwrap();
            let parts = drives.parts(9, Cars::OfTraining { stressed: 0.5, first_turn: 0 });
            let stressed = parts.iter().filter(|part| is_stressed(part));
            let stressed: usize = stressed.map(|part| part.places.len()).sum();
            let all: usize = parts.iter().map(|part| part.places.len()).sum();
            assert_eq!((stressed, all), (4, 9), "{worlds}");
        }
    }

    #[test]
    fn drives_under_stress_take_turns_and_the_others_are_as_without_stress() {
        let mut scenario = of_seven_pairs();
        let calm = Problem::new(scenario.clone()).unwrap();
        scenario.training.stressed_share = 1.0;
        let alike = Problem::new(scenario.clone()).unwrap();
        scenario.training.stress_in_turns = true;
        let always = Problem::new(scenario.clone()).unwrap();
        scenario.training.stressed_share = 0.5;
        let half = Problem::new(scenario).unwrap();
        let (car, period) = (Disturbances::of(&calm.scenario), calm.scenario.episode.period);
        let in_full = calm.disturbed(stress::in_full(car, period));
        let mut but_dead_time = in_full.clone();
        but_dead_time
            .disturb(Disturbances { delay_periods: 0, ..Disturbances::of(&in_full.scenario) });
        let mut but_servo_time = in_full.clone();
        but_servo_time
            .disturb(Disturbances { servo_rate: None, ..Disturbances::of(&in_full.scenario) });
        let pairs = calm.sampler().unseen(RunSeed(3), 7).unwrap();
        let [half, always, alike, calm, in_full, but_dead_time, but_servo_time] =
            [&half, &always, &alike, &calm, &in_full, &but_dead_time, &but_servo_time]
                .map(|problem| driven(problem, &pairs));
        assert_eq!(alike, in_full);
        let turns = [&in_full, &but_dead_time, &in_full, &but_servo_time];
        for (index, (half, always)) in half.iter().zip(&always).enumerate() {
            let cars = [&calm, &in_full, &but_dead_time, &but_servo_time];
            for (n, car) in cars.iter().enumerate() {
                let others = &cars[n + 1..];
                assert!(others.iter().all(|other| other[index] != car[index]), "drive {index}");
            }
            let pair = index % 7;
            assert_eq!(*always, turns[pair % 4][index], "drive {index}");
            let car = if pair % 2 == 1 { turns[pair / 2] } else { &calm };
            assert_eq!(*half, car[index], "drive {index}");
        }
    }

    #[test]
    fn of_the_cars_under_stress_another_has_its_turn_first_in_the_next_generation() {
        let mut scenario = of_seven_pairs();
        scenario.training.stressed_share = 1.0;
        scenario.training.stress_in_turns = true;
        let problem = Problem::new(scenario).unwrap();
        let pairs = problem.sampler().unseen(RunSeed(3), 7).unwrap();
        let from = |first_turn| {
            let cars = Cars::OfTraining { stressed: 1.0, first_turn };
            let drives = TestDrives::new(&problem, RunSeed(1), 0).unwrap();
            let vehicle = |part: &Part<'_>| {
                let vehicle = &part.problem.scenario.vehicle;
                (part.places.clone(), vehicle.delay_periods, vehicle.servo_rate.is_some())
            };
            drives.parts(pairs.len(), cars).iter().map(vehicle).collect::<Vec<_>>()
        };
        let [in_full, but_dead_time, but_servo_time] = [(1, true), (0, true), (1, false)];
        let expected = |parts: [(&[usize], (u8, bool)); 3]| {
            parts.map(|(places, (delay, servo))| (places.to_vec(), delay, servo)).to_vec()
        };
        assert_eq!(
            from(0),
            expected([(&[0, 2, 4, 6], in_full), (&[1, 5], but_dead_time), (&[3], but_servo_time)])
        );
        assert_eq!(
            from(3),
            expected([(&[0, 4], but_servo_time), (&[1, 3, 5], in_full), (&[2, 6], but_dead_time)])
        );
    }

    #[test]
    fn every_other_drive_is_that_of_a_car_with_a_larger_body() {
        let [some, lean, stout] = padded();
        let pairs = lean.sampler().unseen(RunSeed(3), 7).unwrap();
        let [some, lean, stout] = [&some, &lean, &stout].map(|problem| driven(problem, &pairs));
        assert_take_turns(&some, &lean, &stout);
    }

    #[test]
    fn drives_as_described_are_those_of_the_cars_own_body() {
        let [some, lean, _] = padded();
        let pairs = lean.sampler().unseen(RunSeed(3), 7).unwrap();
        assert_eq!(drives(&some, Cars::AsDescribed, &pairs), driven(&lean, &pairs));
    }

    /// A training with some larger cars, one with none, and one with large cars only.
    fn padded() -> [Problem; 3] {
        let mut scenario = of_seven_pairs();
        let lean = scenario.clone();
        scenario.training.footprint_padding = 0.3;
        let some = scenario.clone();
        scenario.training.footprint_padding = 0.0;
        let vehicle = &mut scenario.vehicle;
        (vehicle.length, vehicle.width, vehicle.front_overhang) = (1.0, 0.8, 0.35);
        [some, lean, scenario].map(|scenario| Problem::new(scenario).unwrap())
    }

    #[test]
    fn as_many_padded_cars_are_under_stress_as_others() {
        let mut scenario = Preset::Paper.scenario();
        scenario.training.footprint_padding = 0.1;
        scenario.training.stressed_share = 0.5;
        let problem = Problem::new(scenario).unwrap();
        let drives = TestDrives::new(&problem, RunSeed(1), 0).unwrap();
        let cars = drives.parts(8, Cars::OfTraining { stressed: 0.5, first_turn: 0 });
        let of = |part: &Part<'_>| {
            let is_padded = part.problem.scenario.vehicle.width > 0.3;
            (is_padded, is_stressed(part), part.places.clone())
        };
        assert_eq!(
            cars.iter().map(of).collect::<Vec<_>>(),
            [
                (false, false, vec![0, 4]),
                (true, false, vec![1, 5]),
                (false, true, vec![2, 6]),
                (true, true, vec![3, 7]),
            ]
        );
    }

    /// Whether these are drives of a car under stress, whichever.
    fn is_stressed(part: &Part<'_>) -> bool {
        part.problem.scenario.sensors.dropout > 0.0
    }

    fn of_seven_pairs() -> Scenario {
        let mut scenario = Preset::Paper.scenario();
        scenario.pairs.source = PairSource::Drawn { count: 7, resample: false };
        scenario
    }

    /// Of seven pairs, the first car drives one and the second the next.
    fn assert_take_turns(found: &[Outcome], first: &[Outcome], second: &[Outcome]) {
        assert_ne!(first, second);
        for (index, outcome) in found.iter().enumerate() {
            let expected = if index % 7 % 2 == 1 { second[index] } else { first[index] };
            assert_eq!(*outcome, expected, "drive {index}");
        }
    }

    /// The drives of two individuals, as in the scenario's training.
    fn driven(problem: &Problem, pairs: &[Pair]) -> Vec<Outcome> {
        let stressed = problem.scenario.training.stressed_share.into();
        drives(problem, Cars::OfTraining { stressed, first_turn: 0 }, pairs)
    }

    fn drives(problem: &Problem, cars: Cars, pairs: &[Pair]) -> Vec<Outcome> {
        let weights = 2 * problem.topology().weights();
        let genomes: Vec<f32> = (0..weights).map(|i| libm::sinf(i as f32)).collect();
        let random = |pair| training_drive(RunSeed(1), 4, pair);
        let drives = TestDrives::new(problem, RunSeed(1), 0).unwrap();
        drives.of(&genomes, cars, pairs, &random, &StopFlag::default()).unwrap()
    }
}

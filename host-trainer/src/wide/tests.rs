//! Every car of a fleet against the same drive alone, as bits.

use super::block::Block;
use super::queue::Queue;
use super::starts::Starts;
use super::tape::Tapes;
use super::{Fleet, SLOTS, Tally, Work};
use crate::disturbances::Disturbances;
use crate::episode::{Outcome, Trace};
use crate::pairs::PairSampler;
use crate::problem::{Problem, evaluation_drive};
use crate::scenario::{
    self, NetworkSpec, OnCollision, Pair, RandomiseSpec, ReachedBy, Scenario, StepLength,
};
use crate::seed::{Purpose, RunSeed};
use crate::signals::StopFlag;
use crate::vector::{Instructions, Kernel, MOST_LANES, Vector};
use controller_core::activation::ActivationKind;
use controller_core::network::RecurrenceKind;
use controller_core::observation::{DistanceLaw, TypeCode};
use proptest::prelude::*;
use proptest::sample::select;
use proptest::test_runner::{Config, TestCaseError, TestRunner};

/// All that a scenario can ask of a drive.
fn scenarios() -> impl Strategy<Value = Scenario> {
    let places = (
        select(vec!["open", "obstacles", "complex", "barn_000", "tb3_sandbox"]),
        select(vec![OnCollision::Hold, OnCollision::Stop]),
        select(vec![ReachedBy::Body, ReachedBy::ReferencePoint]),
        select(vec![0.0_f32, 0.3]),
        select(vec![0.0_f32, 0.5]),
        select(vec![
            RandomiseSpec::default(),
            RandomiseSpec { wheelbase: 0.2, step: 0.1, steer_offset: 0.05 },
        ]),
        5..120_u32,
    );
    let networks = (
        select(NetworkSpec::HIDDEN.to_vec()),
        select(vec![RecurrenceKind::Feedforward, RecurrenceKind::SelfLoop, RecurrenceKind::Elman]),
        any::<bool>(),
        select(vec![ActivationKind::Rational, ActivationKind::Libm, ActivationKind::Micromath]),
    );
    let sensors = (
        select(vec![10.0_f32, 2.5]),
        select(vec![DistanceLaw::Linear, DistanceLaw::Saturating { half: 1.0 }]),
        select(vec![
            TypeCode::Any,
            TypeCode::Nearest,
            TypeCode::Share,
            TypeCode::NearestWallAnyTarget,
            TypeCode::Bearing,
        ]),
        select(vec![0.0_f32, 0.05]),
        select(vec![0.0_f32, 0.1]),
        any::<bool>(),
    );
    let vehicles = (
        select(vec![
            StepLength::Constant(0.1),
            StepLength::Variable { lower: -0.02, upper: 0.15 },
            StepLength::Variable { lower: 0.05, upper: 0.12 },
        ]),
        select(vec![1.5_f32, 0.5]),
        select(vec![None, Some(3.0_f32)]),
        select(vec![0_u8, 1, 3, 8]),
    );
    (places, networks, sensors, vehicles).prop_map(|(places, networks, sensors, vehicles)| {
        let found = scenario::find(places.0).unwrap();
        let mut scenario = scenario::load(&found, None, &[]).unwrap();
        let Scenario { episode, network, sensors: beams, vehicle, .. } = &mut scenario;
        (episode.on_collision, episode.reached_by) = (places.1, places.2);
        (episode.start_offset, episode.start_turn) = (places.3, places.4);
        (episode.randomise, episode.step_limit) = (places.5, places.6);
        (network.hidden, network.recurrence) = (networks.0, networks.1);
        (network.biases, network.activation) = (networks.2, networks.3);
        beams.range = sensors.0;
        (beams.encoding.distance, beams.encoding.types) = (sensors.1, sensors.2);
        (beams.noise, beams.dropout) = (sensors.3, sensors.4);
        if sensors.5 {
            for (beam, side) in beams.beams.iter_mut().zip([-2.0, -1.0, 0.0, 1.0, 2.0]) {
                (beam.x, beam.y) = (0.03, 0.02 * side);
            }
        }
        (vehicle.step, vehicle.steer_limit) = (vehicles.0, vehicles.1);
        (vehicle.servo_rate, vehicle.delay_periods) = (vehicles.2, vehicles.3);
        scenario
    })
}

/// Genomes between meek and wild, so that some neurons saturate, and one that is not sound.
fn genomes(problem: &Problem, individuals: usize, seed: u64) -> Vec<f32> {
    let length = problem.topology().weights();
    let mut random = RunSeed(seed).stream(Purpose::InitialPopulation, 0, 0);
    let mut genomes = Vec::new();
    for individual in 0..individuals {
        let bound = [0.3, 1.0, 3.0, 30.0][individual % 4];
        genomes.extend((0..length).map(|_| random.within(-bound, bound)));
    }
    if individuals > 6 {
        genomes[6 * length..7 * length].fill(f32::MAX);
    }
    genomes
}

fn pairs(problem: &Problem, count: u32, seed: u64) -> Vec<Pair> {
    let sampler = PairSampler::new(&problem.world, &problem.scenario);
    sampler.unseen(RunSeed(seed), count).unwrap()
}

/// Each drive alone.
fn alone(problem: &Problem, genomes: &[f32], pairs: &[Pair], seed: u64) -> Vec<Outcome> {
    let mut outcomes = Vec::new();
    for genome in genomes.chunks(problem.topology().weights()) {
        let mut brain = problem.brain(genome).unwrap();
        let random = |pair| evaluation_drive(RunSeed(seed), pair);
        outcomes.extend(problem.drive_all(brain.as_mut(), pairs, random));
    }
    outcomes
}

fn bits(outcome: &Outcome) -> (bool, u32, u32, [u32; 4]) {
    let Outcome { reached, collisions, steps, path_length, distance_to_target, end } = outcome;
    let floats = [*path_length, *distance_to_target, end[0], end[1]];
    (*reached, *collisions, *steps, floats.map(f32::to_bits))
}

/// Drives a fleet at every width, and each drive alone. Returns the steps of one of them.
fn compare(
    scenario: Scenario,
    individuals: usize,
    count: u32,
    seed: u64,
) -> Result<u64, TestCaseError> {
    let problem = Problem::new(scenario).unwrap();
    let pairs = pairs(&problem, count, seed);
    let genomes = genomes(&problem, individuals, seed);
    let expected = alone(&problem, &genomes, &pairs, seed);
    let steps = expected.iter().map(|outcome| u64::from(outcome.steps)).sum();
    let random = |pair| evaluation_drive(RunSeed(seed), pair);
    let fleet = Fleet {
        problem: &problem,
        genomes: &genomes,
        pairs: &pairs,
        random: &random,
        again: false,
    };
    for instructions in Instructions::available() {
        let drives = fleet.drive(instructions, &StopFlag::default()).unwrap();
        prop_assert_eq!(drives.tally.steps, steps);
        for (index, (found, expected)) in drives.outcomes.iter().zip(&expected).enumerate() {
            let (individual, pair) = (index / pairs.len(), index % pairs.len());
            prop_assert_eq!(
                bits(found),
                bits(expected),
                "{}, individual {}, pair {}: {:?}, alone {:?}",
                instructions,
                individual,
                pair,
                found,
                expected
            );
        }
    }
    Ok(steps)
}

fn drives_enough(cases: u32, individuals: usize, pairs: u32, enough: u64) {
    let mut runner = TestRunner::new(Config {
        cases,
        source_file: Some(file!()),
        max_shrink_iters: 60,
        ..Config::default()
    });
    let steps = std::cell::Cell::new(0);
    let fleets = (scenarios(), 1..=individuals, 1..=pairs, any::<u64>());
    let result = runner.run(&fleets, |(scenario, individuals, pairs, seed)| {
        steps.set(steps.get() + compare(scenario, individuals, pairs, seed)?);
        Ok(())
    });
    if let Err(error) = result {
        panic!("{error}");
    }
    assert!(steps.get() >= enough, "{} steps are too few to tell", steps.get());
}

#[test]
fn every_drive_of_a_fleet_ends_as_it_does_alone() {
    drives_enough(48, 40, 13, 100_000);
}

#[test]
#[ignore = "ten million steps, a minute or two; cargo xtask test runs it"]
fn ten_million_steps_of_a_fleet_are_those_of_drives_alone() {
    drives_enough(700, 70, 21, 10_000_000);
}

/// Steps a block by hand and looks at every car before each step.
struct Watch<'a> {
    work: Work<'a>,
    traces: &'a [Trace],
    /// Steps before each car is given weights of its own.
    together: usize,
}

impl Kernel for Watch<'_> {
    type Output = usize;

    #[inline(always)]
    fn run<V: Vector>(self) -> usize {
        let mut block = Block::<V>::new(self.work);
        let (mut seen, mut steps) = (0, 0);
        while block.fill() {
            if steps == self.together {
                block.separate();
            }
            steps += 1;
            for (index, step, pose, hidden) in block.look() {
                let trace = &self.traces[index].steps;
                let expected = &trace[step].pose;
                let bits = |pose: &controller_core::motion::Pose<f32>| {
                    [pose.x, pose.y, pose.heading, pose.cos, pose.sin].map(f32::to_bits)
                };
                assert_eq!(bits(&pose), bits(expected), "drive {index}, step {step}");
                let before = step.checked_sub(1).map(|before| &trace[before].hidden);
                let none = vec![0.0; hidden.len()];
                let expected = before.unwrap_or(&none).iter().map(|output| output.to_bits());
                let found = hidden.iter().map(|output| output.to_bits());
                assert!(found.eq(expected), "drive {index}, step {step}: hidden outputs");
                seen += 1;
            }
            block.step();
        }
        seen
    }
}

/// Looks at every step of so many individuals' drives, whose cars are separated after so many steps.
fn watch(individuals: usize, count: u32, together: usize) {
    let mut scenario = scenario::load(&scenario::find("complex").unwrap(), None, &[]).unwrap();
    scenario.network.recurrence = RecurrenceKind::Elman;
    scenario.sensors.noise = 0.02;
    scenario.vehicle.delay_periods = 2;
    scenario.vehicle.servo_rate = Some(5.0);
    scenario.episode.step_limit = 80;
    scenario.episode.on_collision = OnCollision::Stop;
    let problem = Problem::new(scenario).unwrap();
    let pairs = pairs(&problem, count, 3);
    let genomes = genomes(&problem, individuals, 3);
    let random = |pair| evaluation_drive(RunSeed(3), pair);
    let mut traces = Vec::new();
    for (individual, genome) in genomes.chunks(problem.topology().weights()).enumerate() {
        let mut brain = problem.brain(genome).unwrap();
        for (index, pair) in (0..).zip(&pairs) {
            let (_, trace) = problem.drive_traced(brain.as_mut(), pair, random(index));
            assert_eq!(traces.len(), individual * pairs.len() + index as usize);
            traces.push(trace);
        }
    }
    let steps: usize = traces.iter().map(|trace| trace.steps.len()).sum();
    let fleet = Fleet {
        problem: &problem,
        genomes: &genomes,
        pairs: &pairs,
        random: &random,
        again: false,
    };
    for set in Instructions::available() {
        let stop = StopFlag::default();
        let queue = Queue::new(individuals, pairs.len(), &stop);
        let (starts, tapes) = (Starts::of(&fleet), Tapes::of(&fleet));
        let work = Work { fleet: &fleet, queue: &queue, starts: &starts, tapes: &tapes };
        let watch = Watch { work, traces: &traces, together };
        let seen = set.run(watch);
        assert_eq!(seen, steps, "{set}");
    }
}

#[test]
fn every_pose_and_every_hidden_output_is_that_of_the_drive_alone() {
    watch(23, 7, usize::MAX);
}

#[test]
fn every_pose_and_hidden_output_stays_that_of_the_drive_alone_once_cars_are_separate() {
    for together in [0, 1, 17, 100] {
        // More individuals than there are lanes or cars, and fewer drives than cars.
        watch(SLOTS * MOST_LANES + 3, 3, together);
        watch(3, 2, together);
    }
}

/// Drives a fleet: whether its cars were separated, and which share of their control periods they drove.
struct Waiting<'a>(&'a Fleet<'a>);

/// How cars waited for each other.
struct Waited {
    /// Whether they were separated while there was anything left to begin.
    separate: bool,
    /// The share of all cars' control periods that they drove.
    busy: f64,
    /// Control periods in which nothing was left to begin, and in how many of them cars took more
    /// slots than there have to be.
    ending: usize,
    spread: usize,
}

impl Kernel for Waiting<'_> {
    type Output = Waited;

    #[inline(always)]
    fn run<V: Vector>(self) -> Waited {
        let stop = StopFlag::default();
        let queue = Queue::new(self.0.individuals(), self.0.pairs.len(), &stop);
        let (starts, tapes) = (Starts::of(self.0), Tapes::of(self.0));
        let work = Work { fleet: self.0, queue: &queue, starts: &starts, tapes: &tapes };
        let mut block = Block::<V>::new(work);
        let mut waited = Waited { separate: false, busy: 0.0, ending: 0, spread: 0 };
        let mut periods = 0;
        while block.fill() {
            let [cars, slots] = block.cars_and_slots();
            if queue.has_drives() {
                waited.separate |= block.are_separate();
            } else {
                waited.ending += 1;
                waited.spread += usize::from(slots > cars.div_ceil(V::WIDTH));
            }
            block.step();
            periods += SLOTS * V::WIDTH;
        }
        Waited { busy: block.done().1.steps as f64 / periods as f64, ..waited }
    }
}

/// What [`Waiting`] says, with the widest vectors, of drives that a collision ends.
fn waiting(individuals: usize, count: u32, hidden: u8, again: bool) -> Waited {
    let mut scenario = scenario::load(&scenario::find("complex").unwrap(), None, &[]).unwrap();
    scenario.episode.on_collision = OnCollision::Stop;
    scenario.episode.step_limit = 150;
    (scenario.network.hidden, scenario.network.recurrence) = (hidden, RecurrenceKind::Elman);
    let problem = Problem::new(scenario).unwrap();
    let (pairs, genomes) = (pairs(&problem, count, 4), genomes(&problem, individuals, 4));
    let random = |pair| evaluation_drive(RunSeed(4), pair);
    let fleet =
        Fleet { problem: &problem, genomes: &genomes, pairs: &pairs, random: &random, again };
    Instructions::of_this_cpu().run(Waiting(&fleet))
}

#[test]
fn cars_are_separated_where_they_would_wait_for_the_longest_drive_of_few_pairs() {
    let Waited { separate, busy, .. } = waiting(300, 5, 12, false);
    assert!(separate);
    assert!(busy > 0.8, "{busy}");
}

#[test]
fn cars_stay_together_where_hardly_any_would_wait() {
    assert!(!waiting(20, 200, 12, false).separate, "many pairs");
    assert!(!waiting(100, 5, 12, true).separate, "every drive as long as the others");
    assert!(!waiting(1, 200, 12, false).separate, "one individual");
    let width = Instructions::of_this_cpu().width();
    assert!(!waiting(width, 5, 12, false).separate, "nobody is left");
}

#[test]
fn at_the_end_of_a_fleet_cars_take_no_more_slots_than_they_have_to() {
    for (individuals, count) in [(300, 5), (20, 200), (1, 200), (3, 5), (1, 5)] {
        let Waited { ending, spread, .. } = waiting(individuals, count, 12, false);
        assert!(ending > 20 && spread == 0, "{individuals}, {count}: {spread} of {ending}");
    }
    let Waited { spread, .. } = waiting(20, 200, 32, false);
    let fits = Instructions::of_this_cpu().width() < MOST_LANES;
    assert_eq!(spread == 0, fits, "weights for each car do not fit the second cache");
}

#[test]
fn cars_stay_together_where_weights_for_each_would_not_fit_the_second_cache() {
    let separate = waiting(300, 5, 32, false).separate;
    assert_eq!(separate, Instructions::of_this_cpu().width() < MOST_LANES);
}

#[test]
fn the_outcomes_are_the_same_on_any_number_of_threads() {
    let mut scenario = scenario::load(&scenario::find("obstacles").unwrap(), None, &[]).unwrap();
    scenario.episode.on_collision = OnCollision::Stop;
    let problem = Problem::new(scenario).unwrap();
    let pairs = pairs(&problem, 6, 8);
    let genomes = genomes(&problem, 150, 8);
    let random = |pair| evaluation_drive(RunSeed(8), pair);
    let fleet = Fleet {
        problem: &problem,
        genomes: &genomes,
        pairs: &pairs,
        random: &random,
        again: false,
    };
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| fleet.drive(Instructions::of_this_cpu(), &StopFlag::default())).unwrap()
    };
    let one = on(1);
    assert_eq!(one.outcomes.len(), 900);
    assert_eq!([on(2), on(5)], [one.clone(), one]);
}

#[test]
fn a_fleet_that_drives_again_makes_every_step_and_keeps_its_first_outcomes() {
    let mut scenario = scenario::load(&scenario::find("complex").unwrap(), None, &[]).unwrap();
    scenario.episode.on_collision = OnCollision::Stop;
    scenario.episode.step_limit = 150;
    let problem = Problem::new(scenario).unwrap();
    let pairs = pairs(&problem, 5, 4);
    let genomes = genomes(&problem, 20, 4);
    let random = |pair| evaluation_drive(RunSeed(4), pair);
    let mut fleet = Fleet {
        problem: &problem,
        genomes: &genomes,
        pairs: &pairs,
        random: &random,
        again: false,
    };
    let once = fleet.drive(Instructions::of_this_cpu(), &StopFlag::default()).unwrap();
    fleet.again = true;
    let again = fleet.drive(Instructions::of_this_cpu(), &StopFlag::default()).unwrap();
    assert_eq!(again.outcomes, once.outcomes);
    assert_eq!(again.tally.steps, 20 * 5 * 150);
    assert!(again.tally.stopped > once.tally.stopped && once.tally.stopped > 20);
    let crashes = once.outcomes.iter().filter(|outcome| outcome.collisions > 0).count();
    assert_eq!(once.tally.stopped, crashes as u64);
}

/// A scenario in which everything about a drive is left to chance.
fn by_chance(step_limit: u32) -> Problem {
    let mut scenario = scenario::load(&scenario::find("complex").unwrap(), None, &[]).unwrap();
    (scenario.sensors.noise, scenario.sensors.dropout) = (0.05, 0.1);
    (scenario.episode.start_offset, scenario.episode.start_turn) = (0.3, 0.5);
    scenario.episode.randomise = RandomiseSpec { wheelbase: 0.2, step: 0.1, steer_offset: 0.05 };
    scenario.episode.step_limit = step_limit;
    Problem::new(scenario).unwrap()
}

/// Drives so many individuals on one and on three threads, and each drive alone.
fn misread_as_alone(individuals: usize, taped: bool) {
    let problem = by_chance(150);
    let pairs = pairs(&problem, MOST_LANES as u32 + 5, 6);
    let genomes = genomes(&problem, individuals, 6);
    let expected = alone(&problem, &genomes, &pairs, 6);
    assert!(expected.iter().filter(|outcome| outcome.steps > 128).count() > 20);
    let random = |pair| evaluation_drive(RunSeed(6), pair);
    let fleet = Fleet {
        problem: &problem,
        genomes: &genomes,
        pairs: &pairs,
        random: &random,
        again: false,
    };
    assert_eq!(Tapes::of(&fleet).are_used(), taped);
    for threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        for set in Instructions::available() {
            let drives = pool.install(|| fleet.drive(set, &StopFlag::default())).unwrap();
            for (index, (found, expected)) in drives.outcomes.iter().zip(&expected).enumerate() {
                assert_eq!(bits(found), bits(expected), "{set}, {threads} threads, drive {index}");
            }
        }
    }
}

#[test]
fn individuals_that_read_misreadings_from_tapes_drive_as_they_do_alone() {
    misread_as_alone(20, true);
}

#[test]
fn individuals_that_draw_their_own_misreadings_drive_as_they_do_alone() {
    misread_as_alone(3, false);
}

#[test]
fn a_tape_is_read_from_its_beginning_when_a_drive_begins_again() {
    let mut problem = by_chance(150);
    problem.scenario.episode.on_collision = OnCollision::Stop;
    let problem = Problem::new(problem.scenario).unwrap();
    let pairs = pairs(&problem, 5, 4);
    let genomes = genomes(&problem, 12, 4);
    let random = |pair| evaluation_drive(RunSeed(4), pair);
    let tally = |genomes: &[f32], taped: bool| {
        let fleet =
            Fleet { problem: &problem, genomes, pairs: &pairs, random: &random, again: true };
        assert_eq!(Tapes::of(&fleet).are_used(), taped);
        fleet.drive(Instructions::of_this_cpu(), &StopFlag::default()).unwrap().tally
    };
    let together = tally(&genomes, true);
    let mut one_by_one = Tally::default();
    for genome in genomes.chunks(problem.topology().weights()) {
        let one = tally(genome, false);
        one_by_one.steps += one.steps;
        one_by_one.stopped += one.stopped;
        one_by_one.reached += one.reached;
    }
    assert_eq!(together, one_by_one);
    assert!(together.stopped > 3 * 12 * 5);
}

#[test]
fn there_are_tapes_only_where_something_is_misread_and_they_fit_into_256_mib() {
    let used = |problem: &Problem, pairs: usize| {
        let pairs = vec![Pair { start: [1.0, 1.0, 0.0], goal: [2.0, 2.0] }; pairs];
        let genomes = genomes(problem, 4, 1);
        let random = |pair| evaluation_drive(RunSeed(1), pair);
        let fleet =
            Fleet { problem, genomes: &genomes, pairs: &pairs, random: &random, again: false };
        Tapes::of(&fleet).are_used()
    };
    let long = by_chance(100_000);
    assert!(used(&long, 130) && !used(&long, 140));
    let mut exact = by_chance(100);
    assert!(used(&exact, 1));
    exact.disturb(Disturbances::of(&exact.scenario).without_chance());
    assert!(!used(&exact, 1));
}

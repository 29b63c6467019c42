//! Training is the same, bit for bit, on any number of threads and after any interruption.

use crate::worlds::from_toml;
use host_trainer::fitness;
use host_trainer::pairs::PairSampler;
use host_trainer::problem::{Problem, training_drive, validation_drive};
use host_trainer::scenario::WorldSpec;
use host_trainer::seed::RunSeed;
use host_trainer::signals::StopFlag;
use host_trainer::training::{ResumeError, Snapshot, Training};
use rayon::ThreadPoolBuilder;

/// A small run with everything random that there is.
const NOISY: &str = "
    [world]
    boxes = [[4, 4, 6, 6]]
    circles = [[2, 8, 0.5]]
    [sensors]
    noise_m = 0.02
    dropout = 0.02
    [network]
    recurrence = 'elman'
    [episode]
    step_limit = 120
    start_offset_m = 0.1
    start_turn_deg = 10
    randomise = { wheelbase = 0.1, step = 0.1, steer_offset_deg = 2 }
    [pairs]
    count = 3
    resample = true
    [training]
    population = 21
";

const EXACT: &str = "
    [world]
    boxes = [[4, 4, 6, 6]]
    [episode]
    step_limit = 120
    [training]
    population = 21
";

/// Everything that may change from generation to generation.
const CHANGING: &str = "
    [world]
    boxes = [[4, 4, 6, 6]]
    [episode]
    step_limit = 120
    on_collision = 'stop'
    [fitness]
    kind = 'reached-first'
    [pairs]
    count = 4
    count_end = 16
    resample = true
    mine = 0.5
    [training]
    population = 40
    generations = 12
    weight_bound = 10
    validation_pairs = 30
    [training.ga]
    crossover_share = 0
    mutation_share = 0.95
    ranking_share = 0.05
    random_share = 0
    selection = { truncation_share = 0.2 }
    mutation = { every_gene_sigma = 0.2 }
    sigma_end = 0.02
    initial = { gaussian_sigma = 1 }
    fan_in = true
";

/// The same, short, with ever more drives under stress and some larger cars.
fn stressed() -> String {
    let settings = "generations = 4\n    footprint_padding_m = 0.05\n    stressed_share = 1";
    CHANGING.replace("generations = 12", settings)
}

/// The same on three islands, of which two are left after eight of twelve generations, and one after ten.
fn apart() -> String {
    CHANGING.replace("population = 40", "population = 20\n    islands = 3")
}

/// The same in random worlds instead of the scenario's own.
fn elsewhere() -> String {
    let worlds = "[training.worlds]\nboxes = 2\nbarn_like = 1\nside_m = [6, 9]\n[training.ga]";
    stressed().replace("mine = 0.5", "").replace("[training.ga]", worlds)
}

/// The same in random worlds that make way for new ones, with others to choose the champion in.
fn ever_elsewhere() -> String {
    elsewhere().replace("side_m", "renew_every = 2\nheld_out = 2\nside_m")
}

/// A search by novelty, which keeps an archive.
const NOVEL: &str = "
    [world]
    boxes = [[4, 4, 6, 6]]
    [episode]
    step_limit = 120
    [training]
    population = 40
    until_reached = true
    [training.novelty]
    neighbours = 5
    archive_growth = 4
";

fn bytes(training: &Training<'_>) -> Vec<u8> {
    postcard::to_allocvec(&training.snapshot()).unwrap()
}

fn trained(problem: &Problem, threads: usize, generations: u32) -> Vec<u8> {
    let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        let mut training = Training::new(problem, RunSeed(5)).unwrap();
        for _ in 0..generations {
            training.step().unwrap();
        }
        bytes(&training)
    })
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let (stressed, elsewhere, ever_elsewhere) = (&stressed(), &elsewhere(), &ever_elsewhere());
    let runs = [EXACT, NOISY, CHANGING, stressed, &apart(), elsewhere, ever_elsewhere, NOVEL];
    for settings in runs {
        // Until islands have left.
        let generations = if settings.contains("islands") { 11 } else { 3 };
        let problem = Problem::new(from_toml(settings)).unwrap();
        let alone = trained(&problem, 1, generations);
        for threads in [2, 7] {
            let together = trained(&problem, threads, generations);
            assert!(together == alone, "{threads} threads: {settings}");
        }
    }
}

#[test]
fn a_run_goes_on_from_its_snapshot_as_if_nothing_had_happened() {
    let (stressed, elsewhere, ever_elsewhere) = (&stressed(), &elsewhere(), &ever_elsewhere());
    for (settings, before) in [
        (EXACT, 2),
        (NOISY, 2),
        (CHANGING, 9),
        (stressed, 2),
        (&apart(), 7),
        (&apart(), 9),
        (elsewhere, 2),
        (ever_elsewhere, 9),
        (NOVEL, 4),
    ] {
        let problem = Problem::new(from_toml(settings)).unwrap();
        let mut first = Training::new(&problem, RunSeed(5)).unwrap();
        for _ in 0..before {
            first.step().unwrap();
        }
        let saved: Snapshot = postcard::from_bytes(&bytes(&first)).unwrap();
        let mut resumed = Training::new(&problem, RunSeed(5)).unwrap();
        resumed.restore(saved).unwrap();
        assert_eq!(resumed.generation(), before);
        for _ in 0..2 {
            resumed.step().unwrap();
        }
        assert!(bytes(&resumed) == trained(&problem, 1, before + 2), "{settings}");
    }
}

#[test]
fn islands_that_were_given_up_are_driven_no_more() {
    let problem = Problem::new(from_toml(&apart())).unwrap();
    let mut training = Training::new(&problem, RunSeed(5)).unwrap();
    let mut individuals = Vec::new();
    while !training.is_over() {
        training.step().unwrap();
        individuals.push(training.ends().len());
    }
    assert_eq!(individuals, [[60; 8].as_slice(), &[40; 2], &[20; 2]].concat());
}

#[test]
fn a_checkpoint_of_a_search_by_novelty_holds_its_archive() {
    let problem = Problem::new(from_toml(NOVEL)).unwrap();
    let mut training = Training::new(&problem, RunSeed(5)).unwrap();
    for generation in 1..=3 {
        training.step().unwrap();
        // Five pairs, so points of ten coordinates.
        let archive = training.archive().unwrap();
        assert_eq!(archive.len(), 4 * generation);
        assert!(archive.points().all(|point| point.len() == 10));
    }
    let saved: Snapshot = postcard::from_bytes(&bytes(&training)).unwrap();
    let mut resumed = Training::new(&problem, RunSeed(5)).unwrap();
    resumed.restore(saved).unwrap();
    assert_eq!(resumed.archive(), training.archive());
}

#[test]
fn where_drives_end_is_where_the_same_drives_alone_end() {
    let problem = Problem::new(from_toml(NOVEL)).unwrap();
    let mut training = Training::new(&problem, RunSeed(5)).unwrap();
    training.step().unwrap();
    let best = training.best().unwrap();
    let pairs = training.pairs_of(best).unwrap();
    let mut brain = problem.brain(&best.genome).unwrap();
    let drives = problem.drive_all(&mut *brain, &pairs, |pair| training_drive(RunSeed(5), 0, pair));
    let alone: Vec<f32> = drives.iter().flat_map(|drive| drive.end).collect();
    assert!(training.ends().points().any(|point| point == alone), "{alone:?}");
}

/// A room with a wall between start and goal that ends short of the far side.
const SMALL_MAZE: &str = "
    [world]
    max_m = [6, 5]
    walls = [{ points = [[0, 2.5], [4.2, 2.5]] }]
    [episode]
    step_limit = 200
    [fitness]
    length = 0
    [pairs]
    list = [{ start = [1, 1, 0], goal = [1, 4] }]
    [training]
    population = 60
    until_reached = true
    [training.novelty]
    neighbours = 10
    archive_growth = 3
    [training.ga]
    crossover_share = 0
    mutation_share = 0.98
    ranking_share = 0.02
    random_share = 0
    selection = { truncation_share = 0.2 }
    mutation = { every_gene_sigma = 0.1 }
    initial = { gaussian_sigma = 1 }
    fan_in = true
";

#[test]
fn a_small_maze_is_solved_by_a_search_that_ignores_its_goal() {
    let problem = Problem::new(from_toml(SMALL_MAZE)).unwrap();
    for seed in 1..=5 {
        let mut training = Training::new(&problem, RunSeed(seed)).unwrap();
        while !training.is_solved() && training.generation() < 60 {
            training.step().unwrap();
        }
        assert!(training.is_solved() && training.is_over(), "seed {seed}");
        let best = training.best().unwrap();
        assert_eq!(best.generation + 1, training.generation(), "seed {seed}: who reached it");
        let mut brain = problem.brain(&best.genome).unwrap();
        let pairs = training.pairs_of(best).unwrap();
        let place = |pair| training_drive(RunSeed(seed), best.generation, pair);
        assert!(problem.drive_all(&mut *brain, &pairs, place)[0].reached, "seed {seed}");
    }
}

/// The goal pulls nobody: with all costs equal, the same genomes are bred.
#[test]
fn a_search_by_novelty_does_not_look_at_the_cost() {
    let bred = |distance: &str| {
        let costs = format!("[fitness]\ndistance = {distance}\ncollision = {distance}");
        let problem = Problem::new(from_toml(&format!("{NOVEL}\n{costs}"))).unwrap();
        let mut training = Training::new(&problem, RunSeed(5)).unwrap();
        for _ in 0..4 {
            training.step().unwrap();
        }
        training.ends().clone()
    };
    assert_eq!(bred("0"), bred("700"));
}

/// Seeds, pairs and genomes of the first generation are the same; what a drive under stress costs is
/// not.
#[test]
fn drives_are_under_stress_from_the_second_generation_on_or_as_soon_as_asked() {
    let begun = |share: &str| {
        let settings = stressed().replace("stressed_share = 1", share);
        let settings = settings.replace("resample = true", "resample = false");
        let mut settings = settings.replace("mine = 0.5", "");
        for line in ["count_end = 16", "footprint_padding_m = 0.05"] {
            settings = settings.replace(line, "");
        }
        let problem = Problem::new(from_toml(&settings)).unwrap();
        let mut training = Training::new(&problem, RunSeed(5)).unwrap();
        let first = *training.step().unwrap();
        let validated = training.best().unwrap().cost;
        (first, *training.step().unwrap(), validated)
    };
    let [calm, stressed] = ["", "stressed_share = 1"].map(begun);
    assert_eq!(calm.0, stressed.0);
    assert_ne!(calm.1, stressed.1);
    let always = begun("stressed_share_start = 1\nstressed_share = 1");
    let fading = begun("stressed_share_start = 1");
    assert_ne!(always.0, calm.0);
    assert_eq!(always.0, fading.0);
    assert_ne!(always.1, fading.1);
    // The same individual drives the pairs that choose the champion, under stress as in the end.
    assert_ne!(always.2, fading.2);
}

/// The oracle drives each pair alone, in a world made by hand as the run says it made it.
#[test]
fn every_pair_is_driven_in_the_random_world_whose_turn_it_is() {
    assert_driven_in_its_world(&elsewhere(), 1);
    // The best of the fifth generation, after its worlds have gone.
    assert_driven_in_its_world(&ever_elsewhere(), 5);
}

fn assert_driven_in_its_world(settings: &str, generations: u32) {
    let problem = Problem::new(from_toml(settings)).unwrap();
    let mut training = Training::new(&problem, RunSeed(5)).unwrap();
    for _ in 0..generations {
        training.step().unwrap();
    }
    let best = &training.best().unwrap().clone();
    for _ in 0..4 {
        training.step().unwrap();
    }
    let (pairs, drives) =
        (training.pairs_of(best).unwrap(), training.drives_of(best, &StopFlag::default()));
    let drives = drives.unwrap().unwrap();
    let worlds = training.worlds_in(best.generation).unwrap();
    assert_eq!(worlds.len(), 3);
    for (index, pair) in pairs.iter().enumerate() {
        let mut scenario = problem.scenario.clone();
        let made = worlds[index % worlds.len()].scenario().unwrap().world;
        scenario.world = WorldSpec { target_radius: scenario.world.target_radius, ..made };
        let there = Problem::new(scenario).unwrap();
        assert!(!there.world.blocks_disc(pair.goal, there.world.target_radius), "pair {index}");
        let random = |_| training_drive(RunSeed(5), best.generation, index as u32);
        let mut brain = there.brain(&best.genome).unwrap();
        assert_eq!(there.drive_all(&mut *brain, &[*pair], random), [drives[index]], "pair {index}");
    }
}

#[test]
fn random_worlds_are_those_of_the_seed_whatever_the_own_world_is() {
    let best = |seed, own: &str| {
        let settings = elsewhere().replace("[4, 4, 6, 6]", own);
        let problem = Problem::new(from_toml(&settings)).unwrap();
        let mut training = Training::new(&problem, RunSeed(seed)).unwrap();
        training.step().unwrap();
        (training.worlds_in(0).unwrap(), training.best().cloned())
    };
    assert_eq!(best(5, "[4, 4, 6, 6]"), best(5, "[1, 2, 9, 3]"));
    assert_ne!(best(5, "[4, 4, 6, 6]").0, best(6, "[4, 4, 6, 6]").0);
}

#[test]
fn a_snapshot_of_a_search_by_cost_is_another_run_than_one_by_novelty() {
    let by_cost = NOVEL.split("[training.novelty]").next().unwrap();
    let [novel, plain] = [NOVEL, by_cost].map(|text| Problem::new(from_toml(text)).unwrap());
    let snapshot = Training::new(&plain, RunSeed(5)).unwrap().snapshot();
    let mut training = Training::new(&novel, RunSeed(5)).unwrap();
    assert_eq!(training.restore(snapshot), Err(ResumeError::OtherRun));
    assert_eq!(training.archive().map(|archive| archive.len()), Some(0));
}

#[test]
fn another_seed_gives_another_run() {
    let problem = Problem::new(from_toml(EXACT)).unwrap();
    let mut costs = Vec::new();
    for seed in [5, 6] {
        let mut training = Training::new(&problem, RunSeed(seed)).unwrap();
        costs.push(training.step().unwrap().best);
    }
    assert_ne!(costs[0], costs[1]);
}

#[test]
fn a_snapshot_of_another_network_is_refused() {
    let problem = Problem::new(from_toml(EXACT)).unwrap();
    let wider = Problem::new(from_toml(&format!("{EXACT}\n[network]\nhidden = 16"))).unwrap();
    let snapshot = Training::new(&problem, RunSeed(5)).unwrap().snapshot();
    let mut other = Training::new(&wider, RunSeed(5)).unwrap();
    assert!(other.restore(snapshot).is_err());
}

/// A run that has come far enough to keep hard pairs.
fn changed(problem: &Problem) -> Training<'_> {
    let mut training = Training::new(problem, RunSeed(5)).unwrap();
    let mut costs = Vec::new();
    for _ in 0..12 {
        training.step().unwrap();
        costs.push(training.best().unwrap().cost);
    }
    assert!(costs.is_sorted_by(|before, after| before >= after), "{costs:?}");
    assert!(costs[11] < costs[0]);
    training
}

#[test]
fn the_champion_is_the_one_that_did_best_on_pairs_of_its_own() {
    let problem = Problem::new(from_toml(CHANGING)).unwrap();
    let training = changed(&problem);
    let best = training.best().unwrap();
    let sampler = PairSampler::new(&problem.world, &problem.scenario);
    let pairs = sampler.validation(RunSeed(5), 30).unwrap();
    let mut brain = problem.brain(&best.genome).unwrap();
    let drives = problem.drive_all(&mut *brain, &pairs, |pair| validation_drive(RunSeed(5), pair));
    assert_eq!(fitness::total(&problem.scenario, &pairs, &drives), best.cost);
}

#[test]
fn a_champions_pairs_are_those_that_its_generation_drove() {
    let problem = Problem::new(from_toml(CHANGING)).unwrap();
    let training = changed(&problem);
    let best = training.best().unwrap();
    let pairs = training.pairs_of(best).unwrap();
    assert!(!best.kept.is_empty() && pairs.ends_with(&best.kept), "{best:?}");
    let mut brain = problem.brain(&best.genome).unwrap();
    let place = |pair| training_drive(RunSeed(5), best.generation, pair);
    let drives = problem.drive_all(&mut *brain, &pairs, place);
    let found = fitness::total(&problem.scenario, &pairs, &drives).value();
    assert_eq!(found, training.history()[best.generation as usize].best);
}

#[test]
fn pairs_grow_in_number_to_the_last_generation() {
    let problem = Problem::new(from_toml(CHANGING)).unwrap();
    let sampler = PairSampler::new(&problem.world, &problem.scenario);
    let count =
        |generation| sampler.training(&problem.scenario, RunSeed(5), generation).unwrap().len();
    assert_eq!([0, 1, 5, 6, 11].map(count), [4, 5, 8, 9, 16]); // 4 · 4^(generation/11)
}

#[test]
fn the_number_of_generations_is_part_of_a_run_that_changes_on_its_way() {
    let cases = [
        (NOISY, [0.0, 0.0], false),
        (CHANGING, [0.0, 0.0], true),
        (NOISY, [0.0, 0.5], true),
        (NOISY, [0.5, 0.0], true),
        (NOISY, [0.5, 0.5], false),
    ];
    for (settings, [start, end], is_part) in cases {
        let run = |generations| {
            let mut scenario = from_toml(settings);
            scenario.training.generations = generations;
            scenario.training.stressed_share_start = start;
            scenario.training.stressed_share = end;
            Problem::new(scenario).unwrap()
        };
        let (short, long) = (run(7), run(9));
        let mut first = Training::new(&short, RunSeed(5)).unwrap();
        first.step().unwrap();
        let mut other = Training::new(&long, RunSeed(5)).unwrap();
        let is_other = other.restore(first.snapshot()).is_err();
        assert_eq!(is_other, is_part, "stress from {start} to {end}");
    }
}

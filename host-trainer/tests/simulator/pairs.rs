//! Start/goal pairs: drawn ones are possible and unseen, listed ones are checked.

use crate::worlds::{PAPER, from_toml, shipped, world_of};
use host_trainer::car::CarModel;
use host_trainer::failure::{Failure, FailureKind};
use host_trainer::map;
use host_trainer::pairs::PairSampler;
use host_trainer::scenario::{Pair, PairSource, Scenario};
use host_trainer::seed::RunSeed;
use host_trainer::world::free_space::FreeSpace;
use host_trainer::world::{World, WorldError, distance};
use std::collections::HashSet;
use std::path::Path;

fn unseen(scenario: &Scenario, seed: u64, count: u32) -> (World, Vec<Pair>) {
    let world = world_of(scenario);
    let pairs = PairSampler::new(&world, scenario).unseen(RunSeed(seed), count).unwrap();
    (world, pairs)
}

#[test]
fn drawn_pairs_are_clear_of_obstacles_and_far_enough_apart() {
    for name in PAPER.into_iter().chain(["depot", "tb3_sandbox"]) {
        let scenario = shipped(name);
        let (world, pairs) = unseen(&scenario, 1, 500);
        let body = *CarModel::new(&scenario).body();
        for Pair { start: [x, y, heading], goal } in &pairs {
            let pose = controller_core::motion::Pose::new(*x, *y, *heading);
            assert!(!world.blocks(&body, &pose), "{name}: {x} {y} {heading}");
            assert!(!world.blocks_disc(*goal, world.target_radius), "{name}: {goal:?}");
            assert!(distance([*x, *y], *goal) >= scenario.pairs.min_distance);
            assert!(world.bounds.contains([*x, *y]) && world.bounds.contains(*goal));
        }
        // All directions, and not one pair twice.
        let quarter = |pair: &&Pair| pair.start[2] > 2.0;
        assert!((50..150).contains(&pairs.iter().filter(quarter).count()));
        let different: HashSet<[u32; 2]> =
            pairs.iter().map(|pair| pair.goal.map(f32::to_bits)).collect();
        assert_eq!(different.len(), 500);
    }
}

#[test]
fn unseen_pairs_are_never_training_or_validation_pairs_even_with_the_same_seed() {
    let mut scenario = shipped("obstacles");
    scenario.pairs.source = PairSource::Drawn { count: 100, resample: true };
    let world = world_of(&scenario);
    let sampler = PairSampler::new(&world, &scenario);
    let bits = |pair: &Pair| pair.start.map(f32::to_bits);
    let mut trained = HashSet::new();
    for generation in 0..20 {
        trained
            .extend(sampler.training(&scenario, RunSeed(7), generation).unwrap().iter().map(bits));
    }
    assert_eq!(trained.len(), 2_000);
    trained.extend(sampler.validation(RunSeed(7), 2_000).unwrap().iter().map(bits));
    assert_eq!(trained.len(), 4_000);
    let unseen = sampler.unseen(RunSeed(7), 2_000).unwrap();
    assert!(unseen.iter().all(|pair| !trained.contains(&bits(pair))));
}

#[test]
fn training_drives_the_same_pairs_in_every_generation_unless_told_otherwise() {
    let mut scenario = shipped("open");
    let world = world_of(&scenario);
    let pairs = |scenario: &Scenario, generation| {
        let sampler = PairSampler::new(&world, scenario);
        sampler.training(scenario, RunSeed(3), generation).unwrap()
    };
    assert_eq!(pairs(&scenario, 0), pairs(&scenario, 9));
    assert_eq!(pairs(&scenario, 0).len(), 5);
    scenario.pairs.source = PairSource::Drawn { count: 5, resample: true };
    assert_ne!(pairs(&scenario, 0), pairs(&scenario, 9));
}

/// Two rooms behind one outer wall; the right one is larger.
const TWO_ROOMS: &str = "
    world.walls = [{ points = [[4, 0], [4, 10]], thickness_m = 0.1 }]
    pairs.min_distance_m = 1
";

#[test]
fn start_and_goal_lie_in_the_largest_room() {
    let (_, pairs) = unseen(&from_toml(TWO_ROOMS), 2, 500);
    assert!(pairs.iter().all(|pair| pair.start[0] > 4.0 && pair.goal[0] > 4.0));
}

#[test]
fn the_inside_of_a_solid_thing_is_not_a_room_however_large() {
    let text = "world.boxes = [[0.5, 0.5, 9.5, 9.5]]\npairs.min_distance_m = 1";
    let mut scenario = from_toml(text);
    scenario.world.target_radius = 0.2;
    let (_, pairs) = unseen(&scenario, 2, 200);
    let in_the_gap = |x: f32, y: f32| !(0.5..9.5).contains(&x) || !(0.5..9.5).contains(&y);
    assert!(pairs.iter().all(|pair| in_the_gap(pair.start[0], pair.start[1])));
}

/// The depot's map has free cells outside of the building, around it and in hollow pillars.
#[test]
fn pairs_on_the_depots_map_lie_in_the_building() {
    let scenario = shipped("depot");
    let (world, pairs) = unseen(&scenario, 3, 1_000);
    let car = CarModel::new(&scenario);
    let space = FreeSpace::new(&world, car.body().half_width);
    // A place in the hall, seen on the map.
    let hall = HALL;
    for pair in &pairs {
        assert!(space.connects(hall, pair.goal, 0.3), "{:?}", pair.goal);
        let [x, y, _] = pair.start;
        assert!(space.connects(hall, [x, y], 0.3), "{:?}", pair.start);
    }
}

/// The middle of the depot's hall, metres.
const HALL: [f32; 2] = [15.0, 7.0];

#[test]
fn a_full_world_has_no_pair_and_says_so() {
    for full in [
        "world.boxes = [[-1, -1, 11, 11]]",
        "pairs.min_distance_m = 9\nworld.boxes = [[0, 2, 10, 10]]\nworld.max_m = [10, 10]\nworld.target_radius_m = 0.9",
        "world.walls = [{ points = [[0, 3.3], [10, 3.3]] }, { points = [[0, 6.6], [10, 6.6]] },
            { points = [[3.3, 0], [3.3, 10]] }, { points = [[6.6, 0], [6.6, 10]] }]
         pairs.min_distance_m = 5",
    ] {
        let scenario = from_toml(full);
        let world = world_of(&scenario);
        let refused = PairSampler::new(&world, &scenario).unseen(RunSeed(1), 1).unwrap_err();
        let message = refused.to_string();
        assert!(message.contains("clear of obstacles"), "{message}");
        assert_eq!(refused.min_distance, scenario.pairs.min_distance);
    }
}

/// The keys and problems of one listed pair in a world with a solid box, a thin wall and a
/// chamber sealed on all sides.
fn found(start: [f32; 3], goal: [f32; 2]) -> Vec<String> {
    let mut scenario = from_toml(
        "
        [world]
        boxes = [[4, 4, 6, 6]]
        walls = [
            { points = [[7, 7], [9, 7], [9, 9], [7, 9], [7, 7]] },
            { points = [[1, 8], [3, 8]], thickness_m = 0.1 },
        ]
        [pairs]
        list = [{ start = [2, 2, 0], goal = [8, 2] }]
        ",
    );
    let PairSource::Listed(list) = &mut scenario.pairs.source else { unreachable!() };
    list.push(Pair { start, goal });
    let found = world_of(&scenario).impossibilities(&scenario);
    found.iter().map(ToString::to_string).collect()
}

#[test]
fn a_possible_pair_has_nothing_wrong() {
    for (start, goal) in [
        ([2.0, 2.0, 0.5], [8.0, 8.0 - 2.0]),
        ([3.89, 5.0, 1.570_796_4], [6.5, 5.0]),
        // Nose to the wall; the reference point is nearer to it than half a width.
        ([3.94, 5.0, 0.0], [2.0, 2.0]),
        ([8.0, 8.0, 0.0], [7.5, 8.5]),
    ] {
        let none: [String; 0] = [];
        assert_eq!(found(start, goal), none, "{start:?} {goal:?}");
    }
}

#[test]
fn an_impossible_pair_is_named_with_the_end_that_is_wrong() {
    let fine = ([2.0, 2.0, 0.0], [8.0, 2.0]);
    let cases = [
        ([11.0, 5.0, 0.0], fine.1, "pairs.list[1].start: (11, 5) lies outside the room"),
        (fine.0, [5.0, -0.1], "pairs.list[1].goal: (5, -0.1) lies outside the room"),
        ([5.0, 5.0, 0.0], fine.1, "pairs.list[1].start: the car's body at (5, 5) overlaps"),
        ([3.96, 5.0, 0.0], fine.1, "pairs.list[1].start: the car's body at (3.96, 5) overlaps"),
        ([6.3, 5.0, 0.0], fine.1, "pairs.list[1].start: the car's body at (6.3, 5) overlaps"),
        ([2.0, 8.0, 0.0], fine.1, "pairs.list[1].start: the car's body at (2, 8) overlaps"),
        (fine.0, [5.0, 5.0], "pairs.list[1].goal: (5, 5) lies inside an obstacle"),
        (fine.0, [2.0, 8.0], "pairs.list[1].goal: (2, 8) lies inside an obstacle"),
        (fine.0, [8.0, 8.0], "pairs.list[1].goal: (8, 8) cannot be reached from (2, 2)"),
        ([8.0, 8.0, 0.0], fine.1, "pairs.list[1].goal: (8, 2) cannot be reached from (8, 8)"),
    ];
    for (start, goal, expected) in cases {
        let found = found(start, goal);
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(found[0].starts_with(expected), "{found:?} is not {expected}");
    }
}

#[test]
fn a_way_exactly_as_wide_as_the_car_is_a_way() {
    for width in [0.2, 0.21, 0.25] {
        for (dx, dy) in [(1.0_f32, 0.0_f32), (0.6, 0.8), (0.8, -0.6), (0.0, 1.0)] {
            // A corridor of this width across the room, 4 m long, from the middle of one wall.
            let side = |offset: f32| {
                [-2.0, 2.0].map(|t: f32| [5.0 + dx * t - dy * offset, 5.0 + dy * t + dx * offset])
            };
            let [a, b] = [side(width / 2.0), side(-width / 2.0)];
            let mut scenario = from_toml("");
            let wall =
                |points: Vec<[f32; 2]>| host_trainer::scenario::Wall { points, thickness: 0.0 };
            // Only the corridor joins the two sides: a wall across the room, left and right of it.
            let across = |from: [f32; 2], sign: f32| {
                wall(vec![from, [from[0] - dy * 12.0 * sign, from[1] + dx * 12.0 * sign]])
            };
            scenario.world.walls =
                vec![wall(a.to_vec()), wall(b.to_vec()), across(a[0], 1.0), across(b[0], -1.0)];
            let at = |t: f32| [5.0 + dx * t, 5.0 + dy * t];
            let ([x, y], goal) = (at(-2.7), at(3.2));
            let heading = libm::atan2f(dy, dx);
            let pair = Pair { start: [x, y, heading], goal };
            scenario.pairs.source = PairSource::Listed(vec![pair]);
            assert_eq!(world_of(&scenario).impossibilities(&scenario), [], "{width} {dx} {dy}");
            // Without the corridor's opening there is no way.
            let closed = [side(0.2)[1], side(-0.2)[1]];
            scenario.world.walls.push(wall(closed.to_vec()));
            let found = world_of(&scenario).impossibilities(&scenario);
            assert_eq!(found.len(), 1, "{width} {dx} {dy}");
        }
    }
}

#[test]
fn a_world_too_large_to_map_still_gives_pairs_and_makes_no_false_claims() {
    let mut scenario = from_toml("world.min_m = [-5000, -5000]\nworld.max_m = [5000, 5000]");
    let (_, pairs) = unseen(&scenario, 1, 50);
    assert_eq!(pairs.len(), 50);
    scenario.pairs.source = PairSource::Listed(pairs);
    assert_eq!(world_of(&scenario).impossibilities(&scenario), []);
}

/// Every second cell of a chess board is an obstacle: four walls each.
fn noise_map(folder: &Path, side: usize) -> Scenario {
    let mut image = format!("P5 {side} {side} 255\n").into_bytes();
    image.extend((0..side * side).map(|i| if (i + i / side).is_multiple_of(2) { 0 } else { 254 }));
    std::fs::write(folder.join("noise.pgm"), image).unwrap();
    let yaml = folder.join("noise.yaml");
    let text = "image: noise.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\n\
        occupied_thresh: 0.65\nfree_thresh: 0.25\n";
    std::fs::write(&yaml, text).unwrap();
    from_toml(&format!("world.map.yaml = {yaml:?}\nworld.target_radius_m = 0.001"))
}

#[test]
fn a_map_of_noise_is_refused_by_name_instead_of_eating_all_memory() {
    let folder = tempfile::tempdir().unwrap();
    let scenario = noise_map(folder.path(), 1026);
    let map = map::load(&scenario.world.map.as_ref().unwrap().yaml).unwrap();
    assert!(map::trace(&map, true, 100).len() > host_trainer::world::MAX_OUTLINE);
    let error = World::new(&scenario).unwrap_err();
    assert!(matches!(error, WorldError::TooRough { .. }), "{error}");
    let failure = Failure::from(error);
    assert_eq!(failure.kind(), FailureKind::BadInput);
    let message = failure.to_string();
    assert!(message.contains("noise.yaml: ") && message.contains("1048576"), "{message}");
}

#[test]
fn a_map_just_below_the_limit_is_built() {
    let folder = tempfile::tempdir().unwrap();
    let scenario = noise_map(folder.path(), 700);
    let world = World::new(&scenario).unwrap();
    assert!(world.segments().len() > 900_000, "{}", world.segments().len());
}

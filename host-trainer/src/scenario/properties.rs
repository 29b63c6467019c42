//! Properties over many scenarios and many texts that are none.

use std::path::Path;

use controller_core::observation::{DistanceLaw, TypeCode};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;

use super::shipped::ENTRIES;
use super::*;

fn load_text(text: &str) -> Result<Scenario, crate::failure::Failure> {
    load(&Source::new("room.toml", text, Path::new("/nowhere")), None, &[])
}

fn any_world() -> impl Strategy<Value = WorldSpec> {
    let coordinate = || -20_f32..20.0;
    let low_high = || (coordinate(), 0.01_f32..5.0).prop_map(|(low, size)| (low, low + size));
    let a_box = (low_high(), low_high()).prop_map(|((x0, x1), (y0, y1))| [x0, y0, x1, y1]);
    let circle = (coordinate(), coordinate(), 0.01_f32..3.0)
        .prop_map(|(x, y, radius)| Circle { centre: [x, y], radius });
    let triangle = (coordinate(), coordinate(), 0.1_f32..3.0, 0.1_f32..3.0)
        .prop_map(|(x, y, w, h)| vec![[x, y], [x + w, y], [x, y + h]]);
    let wall = (coordinate(), coordinate(), 0.1_f32..3.0, 0_f32..0.5).prop_map(
        |(x, y, size, thickness)| Wall { points: vec![[x, y], [x + size, y - size]], thickness },
    );
    let lists = (vec(a_box, 0..4), vec(triangle, 0..3), vec(circle, 0..4), vec(wall, 0..3));
    (20_f32..90.0, 0.1_f32..1.0, any::<bool>(), lists).prop_map(
        |(size, target_radius, outer_wall, (boxes, polygons, circles, walls))| WorldSpec {
            bounds: Bounds { min: [-size, -size - 1.0], max: [size + 0.5, size] },
            outer_wall,
            target_radius,
            boxes,
            polygons,
            circles,
            walls,
            map: None,
        },
    )
}

fn any_vehicle() -> impl Strategy<Value = VehicleSpec> {
    let step = prop_oneof![
        (0.001_f32..0.1).prop_map(StepLength::Constant),
        (0_f32..0.05, 0.05_f32..0.1)
            .prop_map(|(lower, upper)| StepLength::Variable { lower, upper }),
    ];
    // The length is what lies behind the rear axle, until the others are added.
    let sizes = (0_f32..2.0, 0.2_f32..1.0, 0_f32..0.25, 0.7_f32..2.0);
    (sizes, step, 0.001_f32..1.57, proptest::option::of(0.01_f32..50.0), 0_u8..=8).prop_map(
        |(
            (behind, width, front_overhang, wheelbase),
            step,
            steer_limit,
            servo_rate,
            delay_periods,
        )| {
            VehicleSpec {
                length: front_overhang + wheelbase + behind,
                width,
                front_overhang,
                wheelbase,
                step,
                steer_limit,
                servo_rate,
                delay_periods,
            }
        },
    )
}

fn any_sensors() -> impl Strategy<Value = SensorSpec> {
    let mount =
        |low: f32| {
            (low..low + 0.2, prop_oneof![Just(0.0_f32), -1_f32..1.0])
                .prop_map(|(angle, y)| BeamMount { x: y * 0.5, y, angle })
        };
    let law = prop_oneof![
        Just(DistanceLaw::Linear),
        (0.01_f32..9.0).prop_map(|half| DistanceLaw::Saturating { half }),
    ];
    let codes = select(vec![
        TypeCode::Any,
        TypeCode::Nearest,
        TypeCode::Share,
        TypeCode::NearestWallAnyTarget,
        TypeCode::Bearing,
    ]);
    let beams = [mount(-1.0), mount(-0.6), mount(-0.1), mount(0.3), mount(0.8)];
    (beams, 1_f32..30.0, law, codes, 0_f32..1.0, 0_f32..=1.0).prop_map(
        |(beams, range, distance, types, noise, dropout)| SensorSpec {
            beams,
            range,
            encoding: Encoding { distance, types },
            noise,
            dropout,
        },
    )
}

fn any_pairs() -> impl Strategy<Value = PairSpec> {
    let pair = (-9_f32..9.0, -9_f32..9.0, -6.2_f32..6.2)
        .prop_map(|(x, y, heading)| Pair { start: [x, y, heading], goal: [x + 8.0, y - 0.1] });
    let source = prop_oneof![
        (1_u32..1000, any::<bool>())
            .prop_map(|(count, resample)| PairSource::Drawn { count, resample }),
        vec(pair, 1..5).prop_map(PairSource::Listed),
    ];
    let plan = (proptest::option::of(1_u32..1000), 0_f32..0.9);
    (source, 0_f32..20.0, plan).prop_map(|(source, min_distance, (count_end, mine))| {
        let anew = matches!(source, PairSource::Drawn { resample: true, .. });
        let (count_end, mine) = if anew { (count_end, mine) } else { (None, 0.0) };
        PairSpec { source, min_distance, count_end, mine }
    })
}

fn any_training() -> impl Strategy<Value = TrainingSpec> {
    let selection = prop_oneof![
        Just(Selection::Sus),
        (1_f32..=2.0).prop_map(|pressure| Selection::LinearRank { pressure }),
        (0.01_f32..=1.0).prop_map(|share| Selection::Truncation { share }),
    ];
    let mutation = prop_oneof![
        Just(Mutation::Uniform),
        (0.001_f32..5.0).prop_map(|amplitude| Mutation::Additive { amplitude }),
        (0.001_f32..5.0).prop_map(|sigma| Mutation::Gaussian { sigma }),
        (0.001_f32..5.0).prop_map(|sigma| Mutation::EveryGene { sigma }),
    ];
    let initial = prop_oneof![
        Just(Initial::Uniform),
        (0.001_f32..5.0).prop_map(|sigma| Initial::Gaussian { sigma }),
    ];
    let changes = (mutation, 0_f32..=1.0, proptest::option::of(0.001_f32..5.0), initial);
    let ga = (0_f32..0.5, 0_f32..0.4, selection, changes, any::<bool>()).prop_map(
        |(crossover_share, mutation_share, selection, changes, fan_in)| GaSpec {
            crossover_share,
            mutation_share,
            ranking_share: 0.02,
            random_share: 1.0 - 0.02 - crossover_share - mutation_share,
            selection,
            mutation_rate: changes.1,
            mutation: changes.0,
            sigma_end: changes.2.filter(|_| {
                matches!(changes.0, Mutation::Gaussian { .. } | Mutation::EveryGene { .. })
            }),
            initial: changes.3,
            fan_in,
        },
    );
    let novelty = (1_u32..1000, 0_u32..=2)
        .prop_map(|(neighbours, archive_growth)| NoveltySpec { neighbours, archive_growth });
    let novelty = proptest::option::of(novelty);
    let sizes = (
        2_u32..1000,
        1_u32..1000,
        0.1_f32..10.0,
        0_u32..1000,
        [0.0_f32..1.0, 0.0_f32..1.0, 0.0_f32..1.0],
    );
    (sizes, ga, any::<[bool; 2]>(), novelty).prop_map(|(sizes, ga, flags, novelty)| {
        let [until_reached, stress_in_turns] = flags;
        let (population, generations, weight_bound, validation_pairs, others) = sizes;
        let [stressed_share, stressed_share_start, footprint_padding] = others;
        TrainingSpec {
            population,
            islands: if novelty.is_some() { 1 } else { 1 + population % 5 },
            generations,
            weight_bound,
            validation_pairs,
            stressed_share,
            stressed_share_start,
            stress_in_turns,
            footprint_padding,
            until_reached,
            worlds: None,
            ga,
            novelty,
        }
    })
}

fn any_scenario() -> impl Strategy<Value = Scenario> {
    let network = (
        select(NetworkSpec::HIDDEN.to_vec()),
        select(words::RECURRENCES.to_vec()),
        any::<bool>(),
        select(words::ACTIVATIONS.to_vec()),
    )
        .prop_map(|(hidden, recurrence, biases, activation)| NetworkSpec {
            hidden,
            recurrence: recurrence.1,
            biases,
            activation: activation.1,
        });
    let randomise =
        (0_f32..0.8, 0_f32..0.9, 0_f32..1.5).prop_map(|(wheelbase, step, steer_offset)| {
            RandomiseSpec { wheelbase, step, steer_offset }
        });
    let rules = (select(words::COLLISIONS.to_vec()), select(words::TOUCHES.to_vec()));
    let episode = (1_u32..5000, 0.001_f32..5.0, rules, 0_f32..1.0, 0_f32..3.0, randomise).prop_map(
        |(step_limit, period, rules, start_offset, start_turn, randomise)| EpisodeSpec {
            step_limit,
            period,
            on_collision: rules.0.1,
            reached_by: rules.1.1,
            start_offset,
            start_turn,
            randomise,
        },
    );
    let kinds = select(words::FITNESS_KINDS.to_vec());
    let costs = ([0_f32..1e4, 0_f32..1e4, 0_f32..1e4, 0_f32..1e6], [0_f32..0.5, 0_f32..0.5], kinds);
    let names = ("[A-Za-z0-9_-]{1,64}", "[^\\p{C}]{0,80}");
    let halves = (any_world(), any_vehicle(), any_sensors(), network);
    (names, halves, episode, costs, any_pairs(), any_training()).prop_map(
        |(names, (world, vehicle, sensors, network), episode, costs, pairs, mut training)| {
            if matches!(pairs.source, PairSource::Drawn { resample: true, .. }) {
                (training.until_reached, training.novelty) = (false, None);
            }
            if training.until_reached {
                (training.stressed_share, training.stressed_share_start) = (0.0, 0.0);
                training.footprint_padding = 0.0;
            }
            if let PairSource::Drawn { count, .. } = pairs.source
                && count.min(pairs.count_end.unwrap_or(count)) >= 40
                && pairs.mine == 0.0
                && !(1..40).contains(&training.validation_pairs)
            {
                let side = [5.0 + episode.period, 5.0 + 2.0 * episode.period];
                training.worlds = Some(WorldsSpec {
                    boxes: 3,
                    pillars: 0,
                    rooms: 10,
                    barn_like: 5,
                    partitions: 2,
                    side,
                    renew_every: u32::from(training.validation_pairs >= 40) * training.population,
                    held_out: u32::from(training.validation_pairs >= 40) * 2,
                });
            }
            let ([distance, length, collision, bonus], [time, progress], (_, kind)) = costs;
            Scenario {
                name: names.0,
                description: names.1,
                world,
                vehicle,
                sensors,
                network,
                episode,
                fitness: FitnessSpec { kind, distance, length, collision, bonus, time, progress },
                pairs,
                training,
            }
        },
    )
}

/// A shipped scenario with some bytes cut out, doubled or replaced.
fn damaged_text() -> impl Strategy<Value = String> {
    let text = select(ENTRIES.to_vec()).prop_map(|entry| entry.text);
    let edit = (any::<prop::sample::Index>(), any::<prop::sample::Index>(), ".{0,12}");
    (text, vec(edit, 1..6)).prop_map(|(text, edits)| {
        edits.into_iter().fold(text.to_owned(), |text, (from, length, new)| {
            let characters: Vec<char> = text.chars().collect();
            let from = from.index(characters.len() + 1);
            let upto = (from + length.index(30)).min(characters.len());
            let before: String = characters[..from].iter().collect();
            let after: String = characters[upto..].iter().collect();
            before + &new + &after
        })
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn a_scenario_written_as_a_file_loads_as_the_same_scenario(scenario in any_scenario()) {
        let text = to_toml(&scenario);
        let loaded = load_text(&text).map_err(|failure| {
            TestCaseError::fail(format!("{failure}\n{text}"))
        })?;
        prop_assert_eq!(loaded, scenario);
    }

    #[test]
    fn any_text_loads_or_is_refused_as_bad_input(text in "\\PC{0,200}|(?s).{0,80}") {
        if let Err(failure) = load_text(&text) {
            prop_assert_eq!(failure.exit_code(), 2);
        }
    }

    #[test]
    fn a_damaged_scenario_loads_or_is_refused_with_its_place(text in damaged_text()) {
        if let Err(failure) = load_text(&text) {
            prop_assert_eq!(failure.exit_code(), 2);
            prop_assert!(failure.to_string().contains("room.toml:"), "{}", failure);
        }
    }

    #[test]
    fn any_setting_is_taken_or_refused(setting in "[a-z_.]{0,12}(=.{0,12})?|\\PC{0,30}") {
        let source = Source::new("room.toml", "", Path::new("/nowhere"));
        if let Err(failure) = load(&source, None, &[Setting::set(&setting)]) {
            prop_assert_eq!(failure.exit_code(), 2);
        }
    }
}

#[test]
fn the_preset_written_as_a_file_loads_as_the_same_scenario() {
    for preset in Preset::ALL {
        let scenario = preset.scenario();
        assert_eq!(load_text(&to_toml(&scenario)).unwrap(), scenario);
    }
}

#[test]
fn every_shipped_scenario_written_as_a_file_loads_as_the_same_scenario() {
    for entry in ENTRIES {
        let scenario = load(&find(entry.name).unwrap(), None, &[]).unwrap();
        assert_eq!(load_text(&to_toml(&scenario)).unwrap(), scenario, "{}", entry.name);
    }
}

#[test]
fn a_setting_in_the_file_wins_over_the_paper_and_an_option_over_both() {
    let source = Source::new("a.toml", "[episode]\nstep_limit = 7\nperiod_s = 0.5", Path::new(""));
    let set = |text| Setting::set(text);
    let episode = |settings: &[Setting]| load(&source, None, settings).unwrap().episode;
    assert_eq!((episode(&[]).step_limit, episode(&[]).period), (7, 0.5));
    assert_eq!(episode(&[set("episode.step_limit=8")]).step_limit, 8);
    let twice = [set("episode.step_limit=8"), set("episode.step_limit=9")];
    assert_eq!(episode(&twice).step_limit, 9);
    assert_eq!(episode(&[set("episode.on_collision=stop")]).on_collision, OnCollision::Stop);
    assert_eq!(episode(&[]).on_collision, Preset::Paper.scenario().episode.on_collision);
}

#[test]
fn a_scenario_as_a_file_is_readable() {
    let scenario = load(&find("obstacles").unwrap(), None, &[]).unwrap();
    insta::assert_snapshot!("obstacles_in_full", to_toml(&scenario));
}

#[test]
fn the_preset_robust_wins_over_the_file_and_an_option_over_both() {
    let source = find("complex").unwrap();
    let load = |settings: &[Setting]| load(&source, Some(Preset::Robust), settings).unwrap();
    let (robust, set) = (Preset::Robust.scenario(), load(&[]));
    assert_eq!((set.training, set.fitness), (robust.training, robust.fitness));
    assert_eq!((&set.pairs, set.episode), (&robust.pairs, robust.episode));
    assert_eq!(set.world, super::load(&source, None, &[]).unwrap().world);
    assert_eq!(load(&[Setting::set("training.population=50")]).training.population, 50);
}

#[test]
fn every_preset_says_how_many_islands_there_are() {
    let file = Source::new("a.toml", "[training]\nislands = 3", Path::new(""));
    for preset in Preset::ALL.into_iter().filter(|preset| *preset != Preset::Paper) {
        let training = load(&file, Some(preset), &[]).unwrap().training;
        assert_eq!(training.islands, preset.scenario().training.islands, "{}", preset.name());
    }
}

/// What is said of drawing says nothing where pairs are listed, but pairs that are listed for one
/// world are none for others.
#[test]
fn every_shipped_scenario_makes_sense_with_every_preset_that_drives_its_pairs() {
    for entry in ENTRIES {
        for preset in Preset::ALL {
            let source = find(entry.name).unwrap();
            let listed =
                matches!(load(&source, None, &[]).unwrap().pairs.source, PairSource::Listed(_));
            let loaded = load(&source, Some(preset), &[]);
            let fits = !(listed && preset == Preset::Generalist);
            assert_eq!(loaded.is_ok(), fits, "{} with {}", entry.name, preset.name());
        }
    }
}

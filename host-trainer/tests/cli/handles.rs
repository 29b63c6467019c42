//! Every kind of car, network and world that a scenario can ask for goes all the way through.

use super::bench::Bench;

/// Trains with these settings for three generations, then does everything with the champion.
fn goes_through(name: &str, scenario: &str, settings: &[&str]) {
    let bench = Bench::new();
    let options: Vec<String> = settings.iter().map(|setting| format!("--set={setting}")).collect();
    let options: Vec<&str> = options.iter().map(String::as_str).collect();
    bench.train(scenario, "run", &options).ends_in(0);
    // The run folder stands for the scenario with its settings.
    for line in [
        "evaluate run run --pairs 20",
        "evaluate run obstacles --pairs 20",
        "replay run run --pairs 2 --out own.html",
        "replay run open --pairs 2 --out open.html",
        "inspect run",
        "export run --format bin",
        "export run --format hex",
        "export run --format uf2",
        "export run --format rs",
        "train --resume run --generations 4",
        "inspect run",
    ] {
        let done = bench.say(line);
        assert_eq!(done.code(), Some(0), "{name}: {line}\n{}", done.text());
    }
}

macro_rules! all_the_way {
    ($($name:ident: $scenario:literal $settings:expr;)*) => {
        $(#[test]
        fn $name() {
            goes_through(stringify!($name), $scenario, &$settings);
        })*
    };
}

all_the_way! {
    variable_speed: "open" ["vehicle.step_m=[0.02,0.12]"];
    self_recurrence: "open" ["network.recurrence=self"];
    elman_recurrence_with_variable_speed: "open"
        ["network.recurrence=elman", "vehicle.step_m=[0.0,0.1]"];
    wide_hidden_layers: "open" ["network.hidden=32"];
    no_biases: "open" ["network.biases=false"];
    other_activations: "open" ["network.activation=libm"];
    noise_dropout_delay_and_servo: "obstacles" [
        "sensors.noise_m=0.05",
        "sensors.dropout=0.05",
        "vehicle.delay_periods=2",
        "vehicle.servo_rate_deg_per_s=300",
        "vehicle.steer_limit_deg=30",
    ];
    randomised_cars_and_starts: "open" [
        "episode.randomise.wheelbase=0.1",
        "episode.randomise.step=0.1",
        "episode.randomise.steer_offset_deg=2",
        "episode.start_offset_m=0.1",
        "episode.start_turn_deg=10",
    ];
    collisions_that_stop: "complex" ["episode.on_collision=stop"];
    resampled_pairs: "open" ["pairs.resample=true"];
    a_saturating_law_and_short_beams: "open"
        ["sensors.range_m=2", "sensors.distance_law={saturating_half_m=0.5}"];
    a_ros_map: "tb3_sandbox" [];
}

/// A scenario that lists its pairs leaves nothing to draw.
#[test]
fn a_barn_world_with_its_listed_pair() {
    let bench = Bench::new();
    bench.say("train barn_000 --out run --population 12 --generations 3").ends_in(0);
    bench.say("evaluate run barn_000 --listed").ends_in(0);
    bench.say("evaluate run barn_264 --pairs 20").ends_in(0);
    bench.say("evaluate run barn_000 barn_264 --listed").ends_in(0);
    bench.say("replay run barn_000 --listed").ends_in(0);
}

//! What `--json` promises to the programs that read it.

use serde_json::Value;

use super::bench::Bench;

/// The one object on standard output.
fn json(bench: &Bench, line: &str) -> Value {
    let done = bench.say(line).ends_in(0);
    let value: Value = serde_json::from_str(&done.stdout).unwrap_or_else(|error| {
        panic!("{line}: {error}\n{}", done.stdout);
    });
    assert!(value.is_object(), "{line}");
    value
}

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

/// Where the value is null: NaN and the infinities would be.
fn nulls(value: &Value, path: &str, found: &mut Vec<String>) {
    match value {
        Value::Null => found.push(path.to_owned()),
        Value::Array(items) => items.iter().for_each(|item| nulls(item, path, found)),
        Value::Object(map) => {
            map.iter().for_each(|(key, item)| nulls(item, &format!("{path}.{key}"), found));
        }
        _ => {}
    }
}

#[test]
fn an_evaluation_has_the_keys_that_others_rely_on() {
    let bench = Bench::new();
    bench.train("open", "run", &[]).ends_in(0);
    let found =
        json(&bench, "evaluate run obstacles --pairs 40 --seed 18446744073709551615 --json");
    assert_eq!(found["pairs"], 40);
    assert_eq!(found["seed"], u64::MAX);
    for key in ["reached", "clean"] {
        let share = found[key].as_f64().unwrap();
        let interval = &found[format!("{key}_interval")];
        let [low, high] = [0, 1].map(|end| interval[end].as_f64().unwrap());
        assert!(0.0 <= low && low <= share && share <= high && high <= 1.0, "{found:#}");
    }
    assert!(found["clean"].as_f64() <= found["reached"].as_f64());
}

/// A champion of 3 generations: what counts is the form.
#[test]
fn a_stress_test_adds_its_keys_and_changes_none() {
    let bench = Bench::new();
    bench.train("open", "run", &[]).ends_in(0);
    let line = "evaluate run obstacles --pairs 30 --json --set sensors.noise_m=0.3";
    let plain = json(&bench, line);
    let found = json(&bench, &format!("{line} --stress"));
    for key in keys(&plain) {
        assert_eq!(found[key], plain[key], "{key}");
    }
    let calm = json(&bench, "evaluate run obstacles --pairs 30 --json");
    assert_eq!(found["calm"]["reached"], calm["reached"]);
    assert!(found.get("weakest").is_some(), "{found:#}");
    let factors = found["stress"].as_array().unwrap();
    let names: Vec<&str> =
        factors.iter().map(|factor| factor["factor"].as_str().unwrap()).collect();
    let expected = [
        "distance_noise",
        "dropped_beams",
        "servo_time",
        "dead_time",
        "steer_offset",
        "wheelbase",
        "step_length",
        "start",
    ];
    assert_eq!(names, expected);
    let steps = json(
        &bench,
        "evaluate run obstacles --pairs 30 --json \
        --set episode.randomise.step=0.2",
    );
    // By name: the third level is twice the full size.
    assert_eq!(factors[6]["levels"][2]["magnitude"].as_f64().unwrap() as f32, 0.2);
    for key in ["reached", "reached_interval", "clean", "clean_interval"] {
        assert_eq!(factors[6]["levels"][2][key], steps[key], "{key}");
    }
    assert_eq!(found["together"].as_array().unwrap().len(), 3);
}

#[test]
fn several_scenarios_make_a_table_whose_sum_is_that_of_each_alone() {
    let bench = Bench::new();
    bench.train("open", "run", &[]).ends_in(0);
    let both = json(&bench, "evaluate run open complex --pairs 40 --json");
    let mut reached = 0.0;
    for (place, scenario) in ["open", "complex"].into_iter().enumerate() {
        let alone = json(&bench, &format!("evaluate run {scenario} --pairs 40 --json"));
        assert_eq!(both["scenarios"][place], alone);
        reached += alone["reached"].as_f64().unwrap() / 2.0;
    }
    assert_eq!(both["drives"], 80);
    assert!((both["reached"].as_f64().unwrap() - reached).abs() < 1e-12, "{both:#}");
    let table = bench.say("evaluate run open complex --pairs 40").ends_in(0);
    let row = |name: &str| {
        let row = table.stdout.lines().find(|line| line.trim_start().starts_with(name));
        row.unwrap_or_else(|| panic!("{}", table.stdout)).to_owned()
    };
    assert!(row("complex ").contains("    40  "), "{}", table.stdout);
    assert!(row("all 2 ").contains(&format!("    80  {:.1} % (", 100.0 * reached)));
    let refused = bench.say("evaluate run open complex --stress").ends_in(2);
    assert!(refused.stderr.contains("--stress: found 2 scenarios, expected one"));
}

#[test]
fn of_drivable_pairs_only_the_rest_is_left_out() {
    let bench = Bench::new();
    bench.train("open", "run", &["--set", "vehicle.steer_limit_deg=25"]).ends_in(0);
    let found = json(&bench, "evaluate run complex --pairs 40 --drivable --json");
    assert_eq!(found["drawn"], 40);
    let share = found["drivable"].as_f64().unwrap();
    assert_eq!(found["pairs"].as_f64().unwrap(), (share * 40.0).round());
    assert!(0.3 < share && share < 1.0, "{found:#}");
}

/// What people read as notes on standard error.
#[test]
fn what_the_champions_own_car_replaces_is_listed() {
    let bench = Bench::new();
    bench.train("open", "run", &[]).ends_in(0);
    for verb in ["evaluate run tb3_sandbox", "replay run tb3_sandbox --out a.html"] {
        let found = json(&bench, &format!("{verb} --pairs 2 --json"));
        let expected = serde_json::json!([
            { "what": "beam range", "champion": "10 m", "scenario": "3.5 m" },
            { "what": "step", "champion": "0.1 m", "scenario": "0.05 m" },
            { "what": "period", "champion": "0.1 s", "scenario": "0.05 s" },
        ]);
        assert_eq!(found["champions_car"], expected, "{verb}");
    }
    let twice = bench.say("evaluate run tb3_sandbox tb3_sandbox --pairs 2").ends_in(0);
    let notes = twice.stderr.lines().filter(|line| line.starts_with("note: ")).count();
    assert_eq!(notes, 3, "{}", twice.stderr);
    for verb in ["evaluate run open", "replay run open --out b.html"] {
        let found = json(&bench, &format!("{verb} --pairs 2 --json"));
        assert_eq!(found["champions_car"], serde_json::json!([]), "{verb}");
    }
}

#[test]
fn every_verb_prints_one_object_without_nan_or_infinity() {
    let bench = Bench::new();
    let train = "train open --out run --json --population 12 --generations 2 \
                 --set pairs.count=2 --set episode.step_limit=60";
    let run = json(&bench, train);
    let expected = [
        "best",
        "champion",
        "folder",
        "generations",
        "report",
        "scenario",
        "seed",
        "training",
        "unseen",
    ];
    assert_eq!(keys(&run), expected);
    let lines = [
        "evaluate run open --pairs 7 --json",
        "evaluate run open --pairs 7 --stress --drivable --out curves.svg --json",
        "replay run open --pairs 2 --json",
        "demo --pairs 2 --out demo.html --json",
        "export run --format bin --json",
        "export run --format hex --json",
        "export run --format uf2 --json",
        "export run --format rs --json",
        "inspect run --json",
        "train --resume run --json",
    ];
    for line in lines {
        let value = json(&bench, line);
        let mut found = Vec::new();
        nulls(&value, "", &mut found);
        // Nothing was reached, the drive does not loop, no factor costs anything.
        found.retain(|path| {
            !["mean_steps_when_reached", "loop_period", "weakest"]
                .iter()
                .any(|end| path.ends_with(end))
        });
        let optional = line.starts_with("export");
        assert!(optional || found.is_empty(), "{line}: {found:?}\n{value:#}");
    }
}

/// People read along on standard error, so that standard output stays one object.
#[test]
fn words_for_people_and_json_do_not_mix() {
    let bench = Bench::new();
    bench.train("open", "run", &[]).ends_in(0);
    let plain = bench.say("evaluate run open --pairs 9").ends_in(0);
    let both = bench.say("evaluate run open --pairs 9 --json").ends_in(0);
    assert_eq!(plain.stdout, both.stderr);
    assert!(both.stdout.starts_with("{\n") && both.stdout.ends_with("}\n"), "{}", both.stdout);
}

/// Columns of the CSV files are numbers that any reader takes.
#[test]
fn metrics_hold_finite_numbers_only() {
    let bench = Bench::new();
    bench.train("complex", "run", &[]).ends_in(0);
    for file in ["run/metrics.csv", "run/timing.csv"] {
        let text = std::fs::read_to_string(bench.path(file)).unwrap();
        let columns = text.lines().next().unwrap().split(',').count();
        assert_eq!(text.lines().count(), 4, "{text}");
        for line in text.lines().skip(1) {
            let numbers: Vec<f64> = line.split(',').map(|word| word.parse().unwrap()).collect();
            assert_eq!(numbers.len(), columns, "{line}");
            assert!(numbers.iter().all(|number| number.is_finite()), "{line}");
        }
    }
}

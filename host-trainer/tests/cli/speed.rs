//! `evosteer bench`: the fixed workload, and what it says about a machine.

use super::bench::{Bench, Done};
use host_trainer::vector::{Instructions, OVERRIDE};
use serde_json::Value;

fn measured(set: &str) -> Value {
    let bench = Bench::new();
    let line = format!("bench --short --repeat=1 --json --threads=2 --instructions={set}");
    serde_json::from_str(&bench.say(&line).ends_in(0).stdout).unwrap()
}

/// What happens in the workload's first generation is known from every simulator that has run
/// it: about 6600 crashes, 0 or 1 arrivals, a mean cost of about 1.75. Drives are chaotic, so
/// each simulator's own rounding moves the numbers a little.
#[test]
fn the_workload_goes_as_in_other_simulators_at_any_width() {
    let mut all = Vec::new();
    for set in Instructions::available() {
        let found = measured(&set.to_string());
        let number = |key: &str| found[key].as_f64().unwrap_or_else(|| panic!("{key}: {found}"));
        assert_eq!(found["instructions"], set.to_string());
        assert_eq!([number("threads"), number("golden_steps")], [2.0, 256.0]);
        assert_eq!(number("golden_misses"), 0.0);
        assert!((6_300.0..6_900.0).contains(&number("crashes")), "{found}");
        assert!(number("reached") <= 2.0, "{found}");
        assert!((1.65..1.85).contains(&number("mean_cost")), "{found}");
        assert!(number("steps_per_second") > 10_000.0, "{found}");
        assert!(number("steps_per_second_alone") > 10_000.0, "{found}");
        assert_eq!(found["paper_run_seconds"], Value::Null);
        all.push(["crashes", "reached", "mean_cost"].map(|key| found[key].clone()));
    }
    assert!(all.windows(2).all(|two| two[0] == two[1]), "{all:?}");
}

#[test]
fn instructions_that_this_cpu_does_not_have_are_refused_with_those_that_it_has() {
    let bench = Bench::new();
    let expected = "found \"neon\", expected what this CPU has: scalar";
    let refused = bench.say("bench --instructions neon").ends_in(2);
    assert!(refused.stderr.contains(expected), "{}", refused.stderr);
    let mut command = bench.program(["train", "open", "--out", "run"]);
    command.env(OVERRIDE, "neon");
    let refused = Done::from(command.output().unwrap()).ends_in(2);
    assert!(refused.stderr.contains(&format!("{OVERRIDE}: {expected}")), "{}", refused.stderr);
    assert!(!bench.path("run").exists());
}

//! Boards compared with the host, as a user starts it.

use std::process::Command;

use super::bench::{Bench, Done, neutral};

/// The program in this repository, where the boards' sources are.
fn in_checkout(line: &str) -> Done {
    let mut command = Command::new(env!("CARGO_BIN_EXE_evosteer"));
    command.args(line.split_whitespace());
    command.current_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/.."));
    neutral(&mut command);
    Done::from(command.output().unwrap())
}

#[test]
fn it_says_what_it_can_compare_with() {
    let done = Bench::new().say("verify").ends_in(2);
    assert!(done.stderr.contains("--emulated"), "{}", done.stderr);
}

#[test]
fn an_unknown_board_is_refused_before_anything_is_built() {
    let done = in_checkout("verify --emulated --board mps2-an387").ends_in(2);
    let expected = "error: --board: found `mps2-an387`, expected one of: microbit, mps2-an385, \
                    mps2-an386, mps2-an500, riscv32-virt\n";
    assert_eq!((done.stdout.as_str(), done.stderr.as_str()), ("", expected));
}

#[test]
fn a_champion_that_no_board_has_code_for_is_refused() {
    let wide = "controller-core/tests/golden/v1/wide-micromath.blob";
    let done = in_checkout(&format!("verify --emulated {wide}")).ends_in(2);
    assert!(done.stderr.starts_with(&format!("error: CHAMPION {wide}: ")), "{}", done.stderr);
    assert!(done.stderr.contains("7-12-12-1"), "{}", done.stderr);
}

#[test]
#[ignore = "builds a board's program and runs it in QEMU"]
fn a_champion_and_the_generated_weights_drive_a_board_as_they_drive_the_host() {
    let elman = "controller-core/tests/golden/v1/elman.blob";
    let line = format!("verify --emulated {elman} --board mps2-an386 --steps 20 --json");
    let done = in_checkout(&line).ends_in(0);
    let found: serde_json::Value = serde_json::from_str(&done.stdout).unwrap();
    assert_eq!(found["steps"], 20 * (144 + 16));
    assert_eq!(found["weight_sets"], 145);
    assert_eq!(found["differing_bits"], 0);
    assert_eq!(found["host"][0]["steps"], found["steps"]);
    assert_eq!(found["boards"][0]["name"], "mps2-an386");
    assert_eq!(found["boards"][0]["steps"], found["steps"]);
    assert_eq!(found["boards"].as_array().map(Vec::len), Some(1));
}

//! Weights outside the program: put into a board's flash, read there, or refused.

use std::path::Path;

use controller_core::blob::HEADER_BYTES;
use equivalence_tests::harness::Trouble;
use firmware_example::closed_loop::{self, Drive};

use crate::program::Program;
use crate::{BOARD, boards, bytes, repair, words};

/// What the boards say of a drive, and only of a drive.
const DRIVEN: &str = "steps in the room";

pub(crate) fn drive() -> Result<(), Trouble> {
    for board in boards() {
        let program = Program::build(&board, None)?;
        let names: &[&str] = if board == BOARD {
            &["feedforward", "self", "elman", "no-biases"]
        } else {
            &["elman"]
        };
        for name in names {
            let blob = golden(name);
            assert!(!program.has(&blob), "{name} is built into the program");
            let Drive { weights, digest } =
                closed_loop::drive(bytemuck::cast_slice(&words(&blob)), 200)
                    .expect("the host drives with it");
            let outcome = program.run_with_weights(&blob)?;
            outcome.expect(0)?;
            outcome.expect_text(&format!(
                "weights {weights:016x}: 200 steps in the room, digest {digest:016x}"
            ))?;
        }
    }
    Ok(())
}

pub(crate) fn erased() -> Result<(), Trouble> {
    let program = Program::build(BOARD, None)?;
    for outcome in [program.run()?, program.run_with_weights(&[0xff; 4096])?] {
        outcome.expect(0)?;
        outcome.expect_text("not driving: no blob here: the flash is erased")?;
        outcome.expect_no_text(DRIVEN)?;
    }
    Ok(())
}

pub(crate) fn damaged() -> Result<(), Trouble> {
    let program = Program::build(BOARD, None)?;
    let good = golden("elman");
    let places = [
        (0, "no blob here: it does not start with"),
        (8, "blob format version"),
        (40, "damaged: check"),
        (HEADER_BYTES + 101, "damaged: check"),
        (good.len() - 100, "damaged: check"),
        (good.len() - 1, "damaged: check"),
    ];
    for (place, why) in places {
        let mut bad = good.clone();
        bad[place] ^= 0x10;
        refused(&program, &bad, why)?;
    }
    // Half a blob: what follows in flash is whatever was there.
    refused(&program, &good[..good.len() / 2], "damaged: check")
}

pub(crate) fn other_network() -> Result<(), Trouble> {
    let program = Program::build(BOARD, None)?;
    refused(&program, &golden("two-outputs"), "the blob is 7-12-12-2")?;
    refused(&program, &golden("wide-micromath"), "this program needs 7-12-12-1")
}

pub(crate) fn self_test() -> Result<(), Trouble> {
    let program = Program::build(BOARD, None)?;
    let mut words = words(&golden("elman"));
    // The last word before the check: the output expected in the last triple.
    let output = words.len() - 3;
    words[output] ^= 1;
    repair(&mut words);
    refused(&program, &bytes(&words), "computed")
}

pub(crate) fn too_large() -> Result<(), Trouble> {
    let outcome = Program::build(BOARD, None)?.run_with_weights(&vec![0xff; 65_537])?;
    outcome.expect(2)?;
    outcome.expect_text("has 65537 bytes, at most 65536 expected")
}

fn refused(program: &Program, blob: &[u8], why: &str) -> Result<(), Trouble> {
    let outcome = program.run_with_weights(blob)?;
    outcome.expect(1)?;
    outcome.expect_line("not driving", why)?;
    outcome.expect_no_text(DRIVEN)
}

/// A blob of those that every release has to read.
fn golden(name: &str) -> Vec<u8> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../controller-core/tests/golden/v1");
    let file = Path::new(folder).join(name).with_extension("blob");
    std::fs::read(&file).expect("a golden blob")
}

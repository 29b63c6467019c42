//! The boards in QEMU: the recorded drives bit for bit, and every way to notice that they are not.

#[path = "on_qemu/program.rs"]
mod program;
#[path = "on_qemu/proof.rs"]
mod proof;
#[path = "on_qemu/weights.rs"]
mod weights;

use std::process::ExitCode;

use controller_core::recording;
use equivalence_tests::checkout::Checkout;
use equivalence_tests::harness::{self, Test, Trouble};
use firmware_example::recorded::{self, Drive};
use program::{Outcome, Program};

/// The board that the tests with changed programs run on, where nothing depends on the board.
const BOARD: &str = "mps2-an386";

/// One board per way of handling faults, and what it says then.
const FAULTS: [(&str, &str); 2] = [
    ("mps2-an386", "hard fault at pc"),
    // Exception 2 is the illegal instruction.
    ("riscv32-virt", "exception 2 at pc"),
];

/// Words before the first step, and of what was sensed in a step.
const VALUES_OF_FIRST_STEP: usize = recording::HEADER_WORDS + recording::SENSED_WORDS;

/// Words of a step with hidden layers of 12 and one output.
const STEP: usize = recording::step_words(12, 1);

fn main() -> ExitCode {
    let tests: &[Test] = &[
        ("every_board_replays_the_recorded_drives_it_has_room_for_bit_for_bit", replays),
        (
            "a_bit_changed_in_an_expected_value_is_reported_with_step_neuron_and_both_values",
            changed_value,
        ),
        ("a_bit_changed_anywhere_in_a_recording_ends_the_run_with_failure", damaged_recording),
        (
            "the_lowest_bit_of_a_weight_changes_the_bits_of_every_drive_on_every_board",
            changed_weight,
        ),
        ("weights_put_into_flash_drive_every_board_as_they_drive_the_host", weights::drive),
        ("a_board_with_erased_flash_says_so_and_does_not_drive", weights::erased),
        ("weights_damaged_anywhere_are_refused_and_the_board_does_not_drive", weights::damaged),
        ("weights_of_another_network_are_refused_with_both_named", weights::other_network),
        ("weights_whose_self_test_fails_on_this_machine_are_refused", weights::self_test),
        ("weights_larger_than_the_flash_for_them_are_refused_before_the_start", weights::too_large),
        (
            "a_million_steps_with_144_weight_sets_give_the_hosts_bits_on_the_m4f_and_100_000_on_every_other_board",
            proof::million,
        ),
        ("the_host_computes_the_same_bits_optimised_and_not", proof::builds_of_the_host),
        (
            "every_weight_one_ulp_up_or_down_is_noticed_on_the_board_at_the_step_the_host_says",
            proof::one_ulp,
        ),
        (
            "products_added_in_another_order_or_fused_are_noticed_and_the_first_difference_is_named",
            proof::spoilt_sums,
        ),
        ("a_board_refuses_damaged_cases_and_says_so", proof::damaged_cases),
        ("a_panic_ends_the_run_with_failure", panics),
        ("a_fault_ends_the_run_with_failure", faults),
        ("a_program_that_hangs_is_stopped_and_said_so", hangs),
    ];
    harness::main(tests)
}

fn replays() -> Result<(), Trouble> {
    for board in boards() {
        let program = Program::build(&board, None)?;
        let outcome = program.run()?;
        outcome.expect(0)?;
        for drive in drives(&board, &program) {
            outcome.expect_text(&format!("{}: 200 steps, every bit as recorded", drive.name))?;
        }
    }
    Ok(())
}

fn changed_value() -> Result<(), Trouble> {
    let program = Program::build(BOARD, None)?;
    let drive = recorded::ALL[2];
    let places = [
        (0, "steer angle"),
        (1, "step length"),
        (2, "output neuron 0"),
        (3 + 5, "neuron 5 of the first hidden layer"),
        (3 + 12 + 11, "neuron 11 of the second hidden layer"),
    ];
    for (step, (value, place)) in places.into_iter().enumerate() {
        let mut words = words(drive.recording);
        let index = VALUES_OF_FIRST_STEP + step * STEP + value;
        let computed = words[index];
        words[index] ^= 1;
        repair(&mut words);
        let expected = format!(
            "{}: step {step}: {place}: {computed:08x} computed, {:08x} recorded",
            drive.name, words[index]
        );
        let outcome = program.with(drive.recording, &bytes(&words))?.run()?;
        outcome.expect(1)?;
        outcome.expect_text(&expected)?;
    }
    Ok(())
}

fn damaged_recording() -> Result<(), Trouble> {
    let program = Program::build(BOARD, None)?;
    for (drive, bit) in recorded::ALL.iter().zip([3, 8 * 100 + 5, 8 * 15_000, 8 * 30_439 + 7]) {
        let mut damaged = drive.recording.to_vec();
        damaged[bit / 8] ^= 1 << (bit % 8);
        let outcome = program.with(drive.recording, &damaged)?.run()?;
        outcome.expect(1)?;
        outcome.expect_text(&format!("{}: recording refused", drive.name))?;
    }
    Ok(())
}

fn changed_weight() -> Result<(), Trouble> {
    for board in boards() {
        let mut program = Program::build(&board, None)?;
        let drives = drives(&board, &program);
        for drive in &drives {
            let mut blob = words(drive.blob);
            blob[controller_core::blob::HEADER_BYTES / 4] ^= 1;
            repair(&mut blob);
            // The recording has to name the changed blob, or it would be refused before the first step.
            let mut recorded = words(drive.recording);
            recorded[6..8].copy_from_slice(&blob[blob.len() - 2..]);
            repair(&mut recorded);
            program = program
                .with(drive.blob, &bytes(&blob))?
                .with(drive.recording, &bytes(&recorded))?;
        }
        let outcome = program.run()?;
        outcome.expect(1)?;
        for drive in &drives {
            // The blob's own self-test may notice first; either names the first differing bits.
            outcome.expect_line(drive.name, "computed")?;
        }
    }
    Ok(())
}

fn panics() -> Result<(), Trouble> {
    let outcome = Program::build(BOARD, Some("panic"))?.run()?;
    outcome.expect(1)?;
    outcome.expect_text("on purpose")
}

fn faults() -> Result<(), Trouble> {
    for (board, said) in FAULTS {
        let outcome = Program::build(board, Some("fault"))?.run()?;
        outcome.expect(1)?;
        outcome.expect_text(said)?;
    }
    Ok(())
}

fn hangs() -> Result<(), Trouble> {
    let outcome: Outcome = Program::build(BOARD, Some("hang"))?.run_for(2)?;
    outcome.expect(124)?;
    outcome.expect_text("did not end within 2 s")
}

/// The drives that the board has to replay: all of them, without the spare one on the board with little flash.
fn drives(board: &str, program: &Program) -> Vec<Drive> {
    let little = board == "microbit";
    let expected = recorded::ALL.iter().filter(|drive| !(little && drive.name == recorded::SPARE));
    expected
        .inspect(|drive| assert!(program.has(drive.recording), "{board} lacks {}", drive.name))
        .copied()
        .collect()
}

/// Every emulated board; a test of the list compares it with the folders of boards.
fn boards() -> Vec<String> {
    Checkout::compiled_in().boards().expect("the manifest lists boards")
}

fn words(bytes: &[u8]) -> Vec<u32> {
    bytes.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect()
}

fn bytes(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

/// Makes the check at the end match again; blob and recording use the same one.
fn repair(words: &mut [u32]) {
    let (body, check) = words.split_last_chunk_mut::<2>().expect("long enough");
    *check = recording::check(body);
}

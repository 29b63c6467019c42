//! The recorded drives on the host that runs the tests.

use std::path::{Path, PathBuf};

use controller_core::activation::ActivationKind;
use controller_core::blob::Blob;
use controller_core::network::RecurrenceKind;
use controller_core::recording::Place;
use equivalence_tests::{drive, recorded_drives as cases, room};
use firmware_example::closed_loop;
use firmware_example::recorded::{self, Drive};
use firmware_example::replay::{ReplayError, replay};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../firmware-example/recorded")
}

#[test]
fn the_recorded_files_are_what_this_host_records() {
    let bless = std::env::var_os("EVOSTEER_BLESS").is_some();
    for (name, recorded) in cases::all() {
        for (ending, bytes) in [("blob", recorded.blob()), ("drive", recorded.recording())] {
            let file = folder().join(format!("{name}.{ending}"));
            if bless {
                std::fs::write(&file, bytes).expect("recorded/ can be written");
            }
            let stored = std::fs::read(&file).expect("the recorded file is there");
            assert!(stored == bytes, "{name}.{ending} differs; EVOSTEER_BLESS=1 writes it anew");
        }
    }
}

#[test]
fn the_boards_replay_every_recorded_file() {
    let mut files: Vec<String> = std::fs::read_dir(folder())
        .expect("recorded/")
        .map(|entry| entry.expect("entry").file_name().to_string_lossy().into_owned())
        .collect();
    let mut listed: Vec<String> = recorded::ALL
        .iter()
        .flat_map(|drive| ["blob", "drive"].map(|ending| format!("{}.{ending}", drive.name)))
        .collect();
    files.sort();
    listed.sort();
    assert_eq!(files, listed);
}

#[test]
fn this_host_drives_every_recorded_drive_again_bit_for_bit() {
    for &Drive { name, blob, recording } in recorded::ALL {
        assert_eq!(replay(blob, recording), Ok(drive::STEPS as usize), "{name}");
    }
}

#[test]
fn the_drives_left_on_a_board_with_little_flash_have_every_recurrence_and_every_activation() {
    let left = recorded::ALL.iter().filter(|drive| drive.name != recorded::SPARE);
    let headers = left.map(|drive| *Blob::parse(drive.blob).expect("valid").header());
    let covered: Vec<_> =
        headers.map(|header| (header.topology.recurrence, header.activation)).collect();
    for recurrence in [RecurrenceKind::Feedforward, RecurrenceKind::SelfLoop, RecurrenceKind::Elman]
    {
        assert!(covered.iter().any(|(found, _)| *found == recurrence), "no {recurrence}");
    }
    for activation in [ActivationKind::Rational, ActivationKind::Libm, ActivationKind::Micromath] {
        assert!(covered.iter().any(|(_, found)| *found == activation), "no {activation:?}");
    }
    assert_eq!(covered.len() + 1, recorded::ALL.len());
}

#[test]
fn a_closed_loop_has_the_digest_it_had_in_every_release() {
    let names =
        ["feedforward-rational", "self-libm", "elman-rational", "elman-micromath", "self-rational"];
    let digests =
        names.map(|name| closed_loop::drive(named(name).blob, 200).map(|drive| drive.digest));
    let expected = [
        0x22cf_b434_79e2_dd2d,
        0xfae9_a8d2_d5c2_61c3,
        0xf0ee_9a69_dff6_558b,
        0x654e_d725_d804_d4d9,
        0xf4be_b2d7_b0ed_39c7,
    ];
    assert_eq!(digests, expected.map(Ok));
}

#[test]
fn a_closed_loop_notices_the_lowest_bit_of_nearly_every_weight() {
    let (_, recorded) = cases::all().into_iter().next().expect("cases");
    let digest = |words: &[u32]| closed_loop::drive(bytemuck::cast_slice(words), 200);
    let before = digest(&recorded.blob).expect("valid").digest;
    let first = controller_core::blob::HEADER_BYTES / 4;
    let unnoticed: Vec<usize> = (0..265)
        .filter(|weight| {
            let mut changed = recorded.blob.clone();
            changed[first + weight] ^= 1;
            repair(&mut changed);
            // A refusal is the self-test's doing, before the first step.
            digest(&changed).is_ok_and(|after| after.digest == before)
        })
        .collect();
    // Their lowest bit is lost in every rounding of a sum within these 200 steps.
    assert_eq!(unnoticed, [22, 26, 63, 77, 80, 151, 181, 205]);
}

fn named(name: &str) -> &'static Drive {
    recorded::ALL.iter().find(|drive| drive.name == name).expect("a recorded drive")
}

#[test]
fn a_recording_covers_faults_walls_the_target_and_free_space() {
    for (name, recorded) in cases::all() {
        let text = format!("{:?}", readings(recorded.recording()));
        for kind in ["Nothing", "Wall", "Target", "Missing", "OutOfRange", "Stale"] {
            assert!(text.contains(kind), "{name} has no {kind}");
        }
    }
}

fn readings(recording: &[u8]) -> Vec<impl std::fmt::Debug> {
    let recording =
        controller_core::recording::Recording::<12, 1>::parse(recording).expect("valid");
    recording.steps().map(|step| step.reading(room::RANGE)).collect()
}

#[test]
fn every_word_of_a_step_that_is_compared_is_named_when_it_differs() {
    let (_, recorded) = cases::all().into_iter().last().expect("cases");
    let first_value = 8 + 3 * 38 + 11;
    let expected = [Place::Steer, Place::StepLength, Place::Output(0)]
        .into_iter()
        .chain((0..12).map(Place::First))
        .chain((0..12).map(Place::Second));
    for (offset, place) in expected.enumerate() {
        let mut changed = recorded.clone();
        changed.recording[first_value + offset] ^= 1;
        repair(&mut changed.recording);
        match replay(changed.blob(), changed.recording()) {
            Err(ReplayError::Difference { step: 3, difference }) => {
                assert_eq!(difference.place, place)
            }
            other => panic!("{place}: {other:?}"),
        }
    }
}

#[test]
fn a_damaged_word_is_refused_whichever_part_it_is_in() {
    let (_, recorded) = cases::all().into_iter().next().expect("cases");
    for word in (0..recorded.recording.len()).step_by(7) {
        let mut damaged = recorded.clone();
        damaged.recording[word] ^= 1 << (word % 32);
        let result = replay(damaged.blob(), damaged.recording());
        assert!(matches!(result, Err(ReplayError::Recording(_))), "word {word}: {result:?}");
    }
}

#[test]
fn a_recording_of_other_weights_is_refused() {
    let [(_, first), _, (_, third), ..] = cases::all();
    let result = replay(first.blob(), third.recording());
    assert!(matches!(result, Err(ReplayError::OtherWeights { .. })), "{result:?}");
}

/// Makes the check at the end match again.
fn repair(words: &mut [u32]) {
    let (body, check) = words.split_last_chunk_mut::<2>().expect("long enough");
    *check = controller_core::recording::check(body);
}

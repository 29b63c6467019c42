//! Proofs without an emulator: the file formats, the boards' program on this host, and the lanes.

use std::io::{BufReader, Cursor};

use controller_core::lane::Lanes;
use equivalence_tests::closed_loop::Value;
use equivalence_tests::compare::{self, Drive, Tally};
use equivalence_tests::files::{BLOB_WORDS, Case, CasesWriter, Stream};
use equivalence_tests::on_host::Host;
use equivalence_tests::prove::{Machine, ProofError, prove};
use equivalence_tests::side_by_side;
use equivalence_tests::weight_sets::{self, WeightSet};
use firmware_example::proof::Board;

fn cases(drives: &[Drive]) -> Vec<u8> {
    let mut writer = CasesWriter::new(Stream(Vec::new()), drives.len() as u32).expect("memory");
    for Drive { weights, case } in drives {
        writer.add(*case, weights.words()).expect("memory");
    }
    writer.finish().expect("memory").0
}

/// What a machine makes of these drives.
fn results<M: Machine<Refusal: std::fmt::Display>>(drives: &[Drive]) -> Vec<u8> {
    let mut results = Vec::new();
    let cases = Stream(Cursor::new(cases(drives)));
    let driven = prove::<M, _, _>(cases, Stream(&mut results), &mut [0; BLOB_WORDS])
        .unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(driven.cases as usize, drives.len());
    results
}

fn compared(drives: &[Drive], results: &[u8]) -> Tally {
    compare::with_host(drives, Stream(BufReader::new(results))).expect("whole results")
}

#[test]
fn the_boards_program_computes_on_this_host_what_the_reference_computes() {
    let drives = compare::generated_drives(300);
    for results in [results::<Board>(&drives), results::<Host>(&drives)] {
        let tally = compared(&drives, &results);
        assert_eq!((tally.steps, tally.differing_bits, tally.first), (144 * 300, 0, None));
    }
}

#[test]
fn every_lane_of_a_wide_drive_is_the_same_drive_alone() {
    let drives = compare::generated_drives(300);
    let tally = side_by_side::compare::<Lanes<16>>(&drives);
    assert_eq!((tally.steps, tally.differing_bits, tally.first), (144 * 300, 0, None));
    // Lanes that are left over repeat a drive and are not counted.
    let tally = side_by_side::compare::<Lanes<16>>(&drives[..21]);
    assert_eq!((tally.steps, tally.differing_bits), (21 * 300, 0));
}

#[test]
fn one_flipped_bit_in_the_weights_of_one_drive_is_found_with_its_place() {
    let expected = compare::generated_drives(40);
    let mut driven = expected.clone();
    let weight = driven[20].weights.blob().weights()[0];
    driven[20].weights =
        driven[20].weights.with_weight(0, f32::from_bits(weight.to_bits() ^ 0x10_0000));
    let bytes = results::<Board>(&driven);
    let mut reader =
        equivalence_tests::files::ResultsReader::new(Stream(&bytes[..]), 144).expect("results");
    let mut tally = Tally::default();
    for (driven, expected) in driven.iter().zip(&expected) {
        let (driven, case) = (&driven.weights, expected.case);
        tally.add(
            compare::case_with_host(&mut reader, driven, &expected.weights, case).expect("whole"),
        );
    }
    let first = tally.first.expect("a difference");
    assert_eq!((first.seed, first.step, first.value), (20, 0, Value(3)), "{first}");
    assert!(tally.differing_bits > 1_000, "{}", tally.differing_bits);
}

#[test]
fn results_of_other_weights_are_refused() {
    let drives = compare::generated_drives(2);
    let mut others = drives.clone();
    others.swap(3, 4);
    let refused = compare::with_host(&others, Stream(&results::<Host>(&drives)[..]));
    let said = refused.expect_err("refused").to_string();
    assert!(said.starts_with("results of case 3, 2 steps, weights "), "{said}");
}

#[test]
fn a_machine_names_the_case_whose_weights_it_refuses() {
    let mut file = Vec::new();
    let set = &weight_sets::generated()[0];
    let mut writer = CasesWriter::new(Stream(&mut file), 2).expect("memory");
    writer.add(Case { seed: 0, steps: 1 }, set.words()).expect("memory");
    let mut failing: Vec<u32> = set.words().to_vec();
    let output = failing.len() - 3;
    failing[output] ^= 1;
    let (body, check) = failing.split_last_chunk_mut::<2>().expect("long enough");
    *check = controller_core::recording::check(body);
    writer.add(Case { seed: 0, steps: 1 }, &failing).expect("memory");
    writer.finish().expect("memory");
    let refused = prove::<Board, _, _>(Stream(&file[..]), Stream(Vec::new()), &mut [0; BLOB_WORDS]);
    match refused {
        Err(ProofError::Refused { case: 1, refusal }) => {
            assert!(refusal.to_string().starts_with("self-test 2, output 0: "), "{refusal}");
        }
        other => panic!("{:?}", other.map_err(|error| error.to_string())),
    }
}

#[test]
fn a_blob_given_by_the_user_drives_like_a_generated_one() {
    let golden = concat!(env!("CARGO_MANIFEST_DIR"), "/../controller-core/tests/golden/v1/");
    for name in ["feedforward", "self", "elman", "no-biases"] {
        let bytes = std::fs::read(format!("{golden}{name}.blob")).expect("golden");
        let weights = WeightSet::new(name, &bytes).expect("7-12-12-1");
        let drives = [Drive { weights, case: Case { seed: 1, steps: 500 } }];
        assert_eq!(compared(&drives, &results::<Board>(&drives)).differing_bits, 0);
        assert_eq!(side_by_side::compare::<Lanes<16>>(&drives).differing_bits, 0);
    }
}

//! Released blobs stay readable, and today's writer still writes them.

use crate::buffer::Buffer;
use crate::cases::{Case, all};
use controller_core::blob::Blob;
use controller_core::network::{Elman, Feedforward, RecurrenceKind, SelfLoop};
use serde::Deserialize;
use std::path::PathBuf;

/// The stored bytes of a case. A golden blob is written once, when it is missing and
/// `EVOSTEER_BLESS` is set, and never again: it stands for bytes that are out in the world.
pub(crate) fn stored(case: &Case) -> Buffer {
    let path = folder().join(format!("{}.blob", case.name));
    if !path.exists() && std::env::var_os("EVOSTEER_BLESS").is_some() {
        std::fs::write(&path, &*case.encoded()).unwrap();
    }
    Buffer::from_bytes(&std::fs::read(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display())))
}

/// Where the golden blobs of format version 1 are.
pub(crate) fn folder() -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "tests", "golden", "v1"].iter().collect()
}

#[test]
fn encode_reproduces_every_golden_blob_byte_for_byte() {
    for case in all() {
        assert!(case.encoded() == stored(&case), "{}: other bytes than the golden ones", case.name);
    }
}

#[test]
fn every_file_in_the_golden_folder_has_a_case() {
    let mut files: Vec<String> = std::fs::read_dir(folder())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    files.sort();
    let mut names = all().map(|case| format!("{}.blob", case.name));
    names.sort();
    assert_eq!(files, names);
}

#[test]
fn every_golden_blob_decodes_to_its_numbers() {
    for case in all() {
        let bytes = stored(&case);
        let blob = Blob::parse(&bytes).unwrap();
        assert_eq!(blob.header(), &case.header, "{}", case.name);
        assert_eq!(blob.weights(), case.weights, "{}", case.name);
        assert_eq!(blob.scaling(), case.header.scaling, "{}", case.name);
        assert_eq!(blob.header().provenance.scenario_name(), "golden");
        assert_eq!(blob.check().to_le_bytes(), bytes[bytes.len() - 8..]);
    }
}

#[test]
fn every_golden_blob_passes_its_own_self_test() {
    for case in all() {
        let bytes = stored(&case);
        let blob = Blob::parse(&bytes).unwrap();
        let (topology, tanh) = (case.header.topology, case.header.activation);
        match (topology.recurrence, topology.hidden, topology.outputs) {
            (RecurrenceKind::Feedforward, 12, 1) => blob.self_test::<Feedforward, 12, 1>(tanh),
            (RecurrenceKind::Feedforward, 12, 2) => blob.self_test::<Feedforward, 12, 2>(tanh),
            (RecurrenceKind::Feedforward, 24, 1) => blob.self_test::<Feedforward, 24, 1>(tanh),
            (RecurrenceKind::SelfLoop, 12, 1) => blob.self_test::<SelfLoop, 12, 1>(tanh),
            (RecurrenceKind::Elman, 12, 1) => blob.self_test::<Elman, 12, 1>(tanh),
            _ => panic!("{topology} has no arm here"),
        }
        .unwrap_or_else(|error| panic!("{}: {error}", case.name));
    }
}

/// The Elman genome as a structure, for postcard's own deserialiser.
#[derive(Deserialize)]
struct ElmanWeights {
    first: [[f32; 12]; 7],
    first_memory: [[f32; 12]; 12],
    first_bias: [f32; 12],
    second: [[f32; 12]; 12],
    second_memory: [[f32; 12]; 12],
    second_bias: [f32; 12],
    output: [[f32; 1]; 12],
    output_bias: [f32; 1],
}

#[test]
fn postcard_reads_the_same_weights_by_value_and_by_name() {
    let case = all().into_iter().find(|case| case.name == "elman").unwrap();
    let bytes = stored(&case);
    let (weights, rest) = postcard::take_from_bytes::<ElmanWeights>(&bytes[176..]).unwrap();
    let in_order: Vec<f32> = [
        weights.first.as_flattened(),
        weights.first_memory.as_flattened(),
        &weights.first_bias,
        weights.second.as_flattened(),
        weights.second_memory.as_flattened(),
        &weights.second_bias,
        weights.output.as_flattened(),
        &weights.output_bias,
    ]
    .concat();
    assert_eq!(in_order, Blob::parse(&bytes).unwrap().weights());
    assert_eq!(rest.len(), 4 * case.self_tests.len() + 8);
}

//! Every refusal by name, with the sentence an operator reads.

use crate::buffer::Buffer;
use crate::cases::{header, named};
use controller_core::activation::{ActivationKind, Libm, Rational};
use controller_core::blob::{
    Blob, BlobError, EncodeError, Header, HeaderError, Provenance, SelfTestError, encode,
};
use controller_core::network::{Elman, Feedforward, RecurrenceKind};
use std::f32::consts::{FRAC_PI_2, PI};

fn sentence(bytes: &[u8]) -> String {
    Blob::parse(bytes).unwrap_err().to_string()
}

#[test]
fn bytes_that_are_no_blob_are_told_apart() {
    assert_eq!(sentence(&[]), "0 bytes, a blob of 184 bytes expected");
    assert_eq!(sentence(b"EVOSTE"), "6 bytes, a blob of 184 bytes expected");
    assert_eq!(sentence(b"EVOSTEER\x01\0"), "10 bytes, a blob of 184 bytes expected");
    assert_eq!(sentence(&Buffer::filled(0xff, 4096)), "no blob here: the flash is erased");
    assert_eq!(
        sentence(&Buffer::filled(0, 4096)),
        "no blob here: it does not start with \"EVOSTEER\""
    );
}

#[test]
fn another_version_is_refused_naming_both() {
    let blob = named("feedforward").encoded();
    for version in [0u16, 2, 0xffff] {
        assert_eq!(
            sentence(&blob.with(8, &version.to_le_bytes())),
            format!("blob format version {version}, this program reads version 1")
        );
    }
}

#[test]
fn a_length_that_the_bytes_or_the_topology_contradict_is_refused() {
    let case = named("feedforward");
    let blob = case.encoded();
    let len = blob.len();
    let stated = |length: u32| sentence(&blob.with(12, &length.to_le_bytes()));
    assert_eq!(stated(u32::MAX), format!("{len} bytes, a blob of 4294967295 bytes expected"));
    assert_eq!(stated(0), format!("{len} bytes, the blob ends after 0"));
    assert_eq!(stated(len as u32 - 4), format!("{len} bytes, the blob ends after {}", len - 4));
    // A hidden layer of 13 would need 28 · 4 bytes more; the triples 2 · 3 · 4 more.
    assert_eq!(
        sentence(&blob.with(17, &[13])),
        format!("the header says {len} bytes, its topology gives {}", len + 4 * (35 + 6))
    );
    // Even a blob of no bytes at all is only refused, at every stated length up to a header's.
    for length in 0..184usize {
        let mut short = Buffer::from_bytes(&blob[..length.max(16)]);
        short[12..16].copy_from_slice(&(length as u32).to_le_bytes());
        assert!(Blob::parse(&short).is_err() && Blob::parse_prefix(&short).is_err());
        if length > 24 {
            short.repair();
            assert_eq!(sentence(&short), format!("{length} bytes, a blob of 184 bytes expected"));
        }
    }
}

#[test]
fn damage_is_named_with_both_checks() {
    let mut blob = named("feedforward").encoded();
    let stored = Blob::parse(&blob).unwrap().check();
    blob[200] ^= 1;
    let damaged = crate::buffer::CHECK.checksum(&blob[..blob.len() - 8]);
    assert_eq!(
        sentence(&blob),
        format!("damaged: check {stored:016x} stored, {damaged:016x} computed")
    );
}

#[test]
fn a_start_that_is_no_multiple_of_four_is_refused() {
    let blob = named("feedforward").encoded();
    let mut shifted = Buffer::filled(0, blob.len() + 3);
    for shift in 1..4 {
        shifted[shift..shift + blob.len()].copy_from_slice(&blob);
        assert_eq!(
            sentence(&shifted[shift..shift + blob.len()]),
            "the blob does not start at a multiple of 4 bytes"
        );
    }
}

#[test]
fn every_header_field_is_refused_by_name() {
    let blob = named("feedforward").encoded();
    let code = |offset: usize, value: u8| sentence(&blob.with(offset, &[value]));
    assert_eq!(code(10, 175), "a header of 175 bytes, 176 expected");
    assert_eq!(code(16, 6), "unknown number of inputs 6 in the header");
    assert_eq!(code(17, 0), "unknown hidden layer width 0 in the header");
    assert_eq!(code(18, 3), "unknown number of outputs 3 in the header");
    assert_eq!(code(19, 3), "unknown recurrence 3 in the header");
    assert_eq!(code(20, 2), "unknown biases flag 2 in the header");
    assert_eq!(code(21, 3), "unknown activation 3 in the header");
    assert_eq!(code(22, 0), "unknown summation order 0 in the header");
    assert_eq!(code(23, 6), "unknown number of beams 6 in the header");
    assert_eq!(code(24, 2), "unknown distance law 2 in the header");
    assert_eq!(code(25, 5), "unknown type code 5 in the header");
    for padding in [27, 142, 143] {
        assert_eq!(code(padding, 1), "padding in the header is not zero");
    }

    let number = |offset: usize, value: f32| sentence(&blob.with(offset, &value.to_le_bytes()));
    let outside =
        |field: &str, value: f32| format!("{field} in the header is {value}, outside its range");
    let fields: [(usize, &str, &[f32]); 10] = [
        (28, "half distance", &[1.0, -0.0]),
        (32, "beam range", &[0.0, -1.0]),
        (36, "steer limit", &[0.0, FRAC_PI_2.next_up(), -0.1]),
        (40, "lower step", &[-0.1]),
        (44, "upper step", &[0.0, 0.05]),
        (48, "control period", &[0.0, -1.0]),
        (52, "wheelbase", &[0.0]),
        (56, "beam mount x", &[]),
        (60, "beam mount y", &[]),
        (112, "beam angle", &[PI.next_up(), -4.0]),
    ];
    for (offset, field, values) in fields {
        for value in values.iter().chain(&[f32::NAN, f32::INFINITY, f32::NEG_INFINITY]) {
            assert_eq!(number(offset, *value), outside(field, *value));
        }
    }
    let saturating = named("saturating-libm").encoded();
    for value in [0.0f32, -0.5, f32::NAN, f32::INFINITY] {
        let bytes = saturating.with(28, &value.to_le_bytes());
        assert_eq!(sentence(&bytes), outside("half distance", value));
    }

    let name = "the scenario's name in the header is not padded UTF-8";
    assert_eq!(sentence(&blob.with(144, &[0xc3, 0x28])), name);
    assert_eq!(sentence(&blob.with(175, b"x")), name);
}

#[test]
fn damaged_weights_and_triples_are_named_with_value_and_place() {
    let case = named("feedforward");
    let blob = case.encoded();
    assert_eq!(
        sentence(&blob.with(176 + 4 * 7, &f32::NAN.to_le_bytes())),
        "weight 7 is NaN, finite and within ±1e6 expected"
    );
    assert_eq!(
        sentence(&blob.with(176 + 4 * (265 + 2), &2.0f32.to_le_bytes())),
        "self-test word 2 is 2, a number within ±1 expected"
    );
}

#[test]
fn a_blob_at_the_start_of_a_sector_reads_whatever_follows_it() {
    let blob = named("elman").encoded();
    for tail in [0x00, 0xff, 0x5a] {
        for extra in [0, 1, 3, 4096 - blob.len()] {
            let mut sector = Buffer::filled(tail, blob.len() + extra);
            sector[..blob.len()].copy_from_slice(&blob);
            let found = Blob::parse_prefix(&sector).unwrap();
            assert_eq!(found.weights(), Blob::parse(&blob).unwrap().weights());
        }
    }
    let cut = &blob[..blob.len() - 1];
    assert_eq!(
        Blob::parse_prefix(cut).unwrap_err(),
        BlobError::TooShort { found: cut.len(), expected: blob.len() }
    );
    assert!(Blob::parse_prefix(&Buffer::filled(0xff, 4096)).is_err());
    assert!(Blob::parse_prefix(&[]).is_err());
}

#[test]
fn another_network_is_refused_naming_both() {
    let bytes = named("feedforward").encoded();
    let blob = Blob::parse(&bytes).unwrap();
    assert_eq!(
        blob.network::<Elman, 12, 1>().unwrap_err().to_string(),
        "the blob is 7-12-12-1 feedforward, biases, this program needs 7-12-12-1 elman, biases"
    );
    assert_eq!(
        blob.self_test::<Feedforward, 24, 2>(Rational).unwrap_err().to_string(),
        "the blob is 7-12-12-1 feedforward, biases, this program needs 7-24-24-2 feedforward, biases"
    );
    assert_eq!(
        blob.self_test::<Feedforward, 12, 1>(Libm).unwrap_err().to_string(),
        "the blob was trained with tanh rational, this program runs libm"
    );
}

#[test]
fn a_self_test_that_computes_other_bits_says_which() {
    let case = named("two-outputs");
    let mut self_tests = case.self_tests.clone();
    let words = case.header.self_test_words();
    let last = &mut self_tests[2 * words + words - 1];
    let (recorded, computed) = (last.to_bits() ^ 1, last.to_bits());
    *last = f32::from_bits(recorded);
    let bytes = Buffer::encoded(&case.header, &case.weights, &self_tests);
    let error = Blob::parse(&bytes).unwrap().self_test::<Feedforward, 12, 2>(Rational).unwrap_err();
    assert_eq!(
        error,
        SelfTestError::Output { triple: 2, output: 1, found: computed, expected: recorded }
    );
    assert_eq!(
        error.to_string(),
        format!("self-test 2, output 1: {computed:08x} computed, {recorded:08x} recorded")
    );
}

#[test]
fn a_blob_that_could_not_be_read_is_not_written() {
    let case = named("feedforward");
    let mut room = Buffer::filled(0, case.header.blob_len());
    let write = |header: &Header, weights: &[f32], triples: &[f32], room: &mut [u8]| {
        encode(header, weights, triples, room).unwrap_err()
    };
    let (weights, triples) = (&case.weights[..], &case.self_tests[..]);
    let short = write(&case.header, weights, triples, &mut room[..1000]);
    assert_eq!(short.to_string(), "1000 bytes of room, the blob takes 1628");
    let few = write(&case.header, &weights[1..], triples, &mut room);
    assert_eq!(few.to_string(), "264 numbers given, the header says 265");
    let few = write(&case.header, weights, &triples[..32], &mut room);
    assert_eq!(few, EncodeError::Count { found: 32, expected: 96 });

    let mut bad = case.weights.clone();
    bad[9] = f32::NAN;
    assert_eq!(
        write(&case.header, &bad, triples, &mut room).to_string(),
        "this blob would be refused: weight 9 is NaN, finite and within ±1e6 expected"
    );
    let still = Header { period: 0.0, ..case.header };
    assert_eq!(
        write(&still, weights, triples, &mut room),
        EncodeError::Refused(BlobError::Header(HeaderError::Number {
            field: "control period",
            value: 0.0
        }))
    );
    let one_input_less = Header {
        topology: controller_core::network::Topology { inputs: 6, ..case.header.topology },
        self_tests: 0,
        ..header(RecurrenceKind::Feedforward)
    };
    assert_eq!(
        write(&one_input_less, &weights[12..], &[], &mut room),
        EncodeError::Refused(BlobError::Header(HeaderError::Code {
            field: "number of inputs",
            value: 6
        }))
    );
}

#[test]
fn a_name_is_cut_at_a_characters_boundary() {
    let long = "a-very-long-scenario-name-with-ö-at-the-cut";
    let stored = Provenance::stored_name(long);
    assert_eq!(&stored[..], b"a-very-long-scenario-name-with-\0");
    let provenance = Provenance { scenario: stored, ..header(RecurrenceKind::Elman).provenance };
    assert_eq!(provenance.scenario_name(), "a-very-long-scenario-name-with-");
    let exactly = Provenance::stored_name("32-bytes-long-name-without-a-cut");
    assert_eq!(&exactly[..], b"32-bytes-long-name-without-a-cut");
    let case = named("feedforward");
    let header = Header {
        activation: ActivationKind::Rational,
        provenance: Provenance { scenario: exactly, ..provenance },
        ..case.header
    };
    let bytes = Buffer::encoded(&header, &case.weights, &case.self_tests);
    let blob = Blob::parse(&bytes).unwrap();
    assert_eq!(blob.header().provenance.scenario_name(), "32-bytes-long-name-without-a-cut");
}

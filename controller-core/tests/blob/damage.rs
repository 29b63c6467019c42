//! Bytes that were a blob once.

use crate::buffer::Buffer;
use crate::cases::{Case, all, named, smallest};
use controller_core::blob::{Blob, BlobError, HEADER_BYTES};

fn refused(bytes: &[u8]) -> bool {
    Blob::parse(bytes).is_err()
}

#[test]
fn every_single_bit_flip_is_refused() {
    for case in all() {
        let mut blob = case.encoded();
        for bit in 0..8 * blob.len() {
            blob[bit / 8] ^= 1 << (bit % 8);
            assert!(refused(&blob), "{}: bit {bit} slipped through", case.name);
            blob[bit / 8] ^= 1 << (bit % 8);
        }
        assert!(!refused(&blob));
    }
}

fn every_other_byte_is_refused(case: &Case) {
    let blob = case.encoded();
    let half = blob.len() / 2;
    let check = |range: std::ops::Range<usize>| {
        let mut blob = blob.clone();
        for i in range {
            for difference in 1..=255 {
                blob[i] ^= difference;
                assert!(refused(&blob), "{}: byte {i} ^ {difference}", case.name);
                blob[i] ^= difference;
            }
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(|| check(0..half));
        check(half..blob.len());
    });
}

#[test]
fn every_substitution_of_one_byte_is_refused() {
    every_other_byte_is_refused(&smallest());
}

#[test]
#[ignore = "a minute; the smallest case runs every time"]
fn every_substitution_of_one_byte_in_every_golden_blob_is_refused() {
    all().iter().for_each(every_other_byte_is_refused);
}

#[test]
fn every_truncation_is_refused_as_too_short() {
    for case in all() {
        let blob = case.encoded();
        for len in 0..blob.len() {
            let error = Blob::parse(&blob[..len]).unwrap_err();
            assert!(
                matches!(error, BlobError::TooShort { found, expected }
                if found == len && expected > len),
                "{}: {len} bytes: {error:?}",
                case.name
            );
        }
    }
}

#[test]
fn every_extension_is_refused_as_too_long() {
    let case = named("elman");
    let blob = case.encoded();
    for filler in [0x00, 0xff, 0xa5] {
        let mut longer = Buffer::filled(filler, blob.len() + 4096);
        longer[..blob.len()].copy_from_slice(&blob);
        for extra in 1..=4096 {
            let found = blob.len() + extra;
            let expected = blob.len();
            assert_eq!(
                Blob::parse(&longer[..found]).unwrap_err(),
                BlobError::TooLong { found, expected }
            );
        }
    }
}

#[test]
fn every_swap_of_unequal_neighbours_is_refused() {
    for case in all() {
        let mut blob = case.encoded();
        for i in 1..blob.len() {
            if blob[i - 1] != blob[i] {
                blob.swap(i - 1, i);
                assert!(refused(&blob), "{}: bytes {} and {i}", case.name, i - 1);
                blob.swap(i - 1, i);
            }
        }
    }
}

#[test]
fn bursts_of_up_to_64_bits_are_refused() {
    let clean = named("feedforward").encoded();
    let bits = 8 * clean.len();
    let mut pattern = 0x2545_f491_4f6c_dd1du64;
    for _ in 0..50_000 {
        // Xorshift: where the burst starts, how long it is, which bits it flips.
        pattern ^= pattern << 13;
        pattern ^= pattern >> 7;
        pattern ^= pattern << 17;
        let width = 1 + (pattern >> 3) as usize % 64;
        let start = (pattern >> 17) as usize % (bits - width);
        let mut blob = clean.clone();
        for (i, bit) in (start..start + width).enumerate() {
            let edge = i == 0 || i == width - 1;
            if edge || pattern.rotate_left(i as u32) & 1 == 1 {
                blob[bit / 8] ^= 1 << (bit % 8);
            }
        }
        assert!(refused(&blob), "{width} bits from {start}, {pattern:016x}");
    }
}

#[test]
fn every_weight_that_is_not_finite_and_in_range_is_refused_at_every_position() {
    let bad = [
        f32::NAN,
        f32::from_bits(0x7fa0_0000),
        f32::from_bits(0xffff_ffff),
        f32::INFINITY,
        f32::NEG_INFINITY,
        1_000_000.06,
        -1_000_000.06,
        f32::MAX,
    ];
    let case = named("elman");
    let blob = case.encoded();
    for index in 0..case.weights.len() {
        for value in bad {
            let damaged = blob.with(HEADER_BYTES + 4 * index, &value.to_le_bytes());
            match Blob::parse(&damaged).unwrap_err() {
                BlobError::Weight { index: at, value: found } => {
                    assert_eq!((at, found.to_bits()), (index, value.to_bits()));
                }
                other => panic!("weight {index} = {value}: {other}"),
            }
        }
    }
    for edge in [1.0e6, -1.0e6, f32::from_bits(1), -0.0] {
        let kept = blob.with(HEADER_BYTES, &edge.to_le_bytes());
        assert_eq!(Blob::parse(&kept).unwrap().weights()[0].to_bits(), edge.to_bits());
    }
}

#[test]
fn every_self_test_word_that_is_no_number_within_one_is_refused_at_every_position() {
    let case = named("two-outputs");
    let blob = case.encoded();
    let start = HEADER_BYTES + 4 * case.weights.len();
    for index in 0..case.self_tests.len() {
        for value in [f32::NAN, f32::INFINITY, -1.000_000_1, 1.000_000_1] {
            let damaged = blob.with(start + 4 * index, &value.to_le_bytes());
            match Blob::parse(&damaged).unwrap_err() {
                BlobError::SelfTestValue { index: at, value: found } => {
                    assert_eq!((at, found.to_bits()), (index, value.to_bits()));
                }
                other => panic!("word {index} = {value}: {other}"),
            }
        }
    }
}

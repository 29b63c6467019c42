use proptest::prelude::*;
use serde::Deserialize;

use super::*;

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct State {
    weights: Vec<f32>,
    draws: u64,
}

fn state() -> State {
    State { weights: vec![1.5, -0.25], draws: 300 }
}

/// A container with a right check around any payload.
fn packed(payload: &[u8]) -> Vec<u8> {
    let mut bytes = MAGIC.to_vec();
    bytes.extend(VERSION.to_le_bytes());
    bytes.extend(7_u64.to_le_bytes());
    bytes.extend((payload.len() as u64).to_le_bytes());
    bytes.extend(payload);
    resealed(bytes)
}

/// Appends the check that belongs to the bytes.
fn resealed(mut bytes: Vec<u8>) -> Vec<u8> {
    bytes.extend(CRC.checksum(&bytes).to_le_bytes());
    bytes
}

#[test]
fn the_bytes_are_those_of_the_table_above() {
    // Put together by hand from the table; the check by a bitwise CRC-64/XZ in Python.
    let expected = [
        b"EVOCKPT\0".as_slice(),
        &[2, 0],
        &[7, 0, 0, 0, 0, 0, 0, 0],
        &[11, 0, 0, 0, 0, 0, 0, 0],
        &[2, 0x00, 0x00, 0xc0, 0x3f, 0x00, 0x00, 0x80, 0xbe, 0xac, 0x02],
        &GOLDEN_CHECK.to_le_bytes(),
    ]
    .concat();
    assert_eq!(encode(7, &state()).unwrap(), expected);
    assert_eq!(decode(&expected), Ok((7, state())));
}

const GOLDEN_CHECK: u64 = 0x47ca_a8e6_752c_7e14;

#[test]
fn every_single_bit_flip_is_refused() {
    let good = encode(7, &state()).unwrap();
    for bit in 0..8 * good.len() {
        let mut damaged = good.clone();
        damaged[bit / 8] ^= 1 << (bit % 8);
        assert!(decode::<State>(&damaged).is_err(), "bit {bit} slipped through");
    }
}

#[test]
fn every_other_value_of_every_byte_is_refused() {
    let good = encode(7, &state()).unwrap();
    for index in 0..good.len() {
        for change in 1..=255 {
            let mut damaged = good.clone();
            damaged[index] ^= change;
            assert!(decode::<State>(&damaged).is_err(), "byte {index} ^ {change} slipped through");
        }
    }
}

#[test]
fn every_truncation_and_every_appended_byte_is_refused() {
    let good = encode(7, &state()).unwrap();
    for length in 0..good.len() {
        assert!(decode::<State>(&good[..length]).is_err(), "{length} bytes were enough");
    }
    for extra in 0..=255 {
        let mut longer = good.clone();
        longer.push(extra);
        assert_eq!(
            decode::<State>(&longer),
            Err(CheckpointError::Length { declared: 11, found: 12 })
        );
    }
}

#[test]
fn each_cause_has_its_own_words() {
    let good = encode(7, &state()).unwrap();
    let body = &good[..good.len() - CHECK];
    let patched = |at: usize, with: &[u8]| {
        let mut bytes = body.to_vec();
        bytes[at..at + with.len()].copy_from_slice(with);
        resealed(bytes)
    };
    let mut flipped = good.clone();
    flipped[30] ^= 1;
    let said = |bytes: &[u8]| decode::<State>(bytes).unwrap_err().to_string();

    assert_eq!(said(&[]), "0 bytes, expected at least 34");
    assert_eq!(
        said(b"PK\x03\x04 and more than thirty-four bytes"),
        r#"not a checkpoint: it begins with "PK\x03\x04 and", expected "EVOCKPT\x00""#
    );
    assert_eq!(said(&patched(8, &[9, 0])), "checkpoint version 9, this evosteer reads version 2");
    assert_eq!(said(&patched(8, &[1, 0])), "checkpoint version 1, this evosteer reads version 2");
    assert_eq!(
        said(&patched(18, &[0xff; 8])),
        "11 bytes of state, the header announces 18446744073709551615"
    );
    assert!(said(&flipped).starts_with("damaged: its check is "));
    assert_eq!(
        said(&packed(&[2, 0, 0])),
        "the state does not decode: Hit the end of buffer, expected more data"
    );
    assert_eq!(said(&packed(&[0, 1, 0xee])), "1 bytes follow the state");
    // 1 as a varint of two bytes.
    assert_eq!(said(&packed(&[0, 0x81, 0])), "the state is not in its only allowed encoding");
}

#[test]
fn bits_of_every_float_survive() {
    let odd = vec![f32::NAN, -f32::NAN, f32::INFINITY, -0.0, f32::MIN_POSITIVE / 2.0];
    let (_, back) = decode::<Vec<f32>>(&encode(0, &odd).unwrap()).unwrap();
    let bits = |values: &[f32]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&back), bits(&odd));
}

proptest! {
    #[test]
    fn any_state_comes_back(
        generation: u64, weights in prop::collection::vec(-1e9_f32..1e9, 0..200), draws: u64,
    ) {
        let state = State { weights, draws };
        let bytes = encode(generation, &state).unwrap();
        prop_assert_eq!(decode(&bytes), Ok((generation, state)));
    }

    #[test]
    fn any_bytes_are_decoded_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let _ = decode::<State>(&bytes);
    }

    /// Past the check, so that the decoder of the state meets the rubbish.
    #[test]
    fn any_payload_is_decoded_or_refused(payload in prop::collection::vec(any::<u8>(), 0..60)) {
        if let Ok((generation, state)) = decode::<State>(&packed(&payload)) {
            prop_assert_eq!(encode(generation, &state).unwrap(), packed(&payload));
        }
    }
}

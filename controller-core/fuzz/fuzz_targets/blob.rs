//! Any bytes decode or are refused; what is accepted re-encodes to itself and passes or fails
//! its self-test without a panic.
//!
//! With random bytes every run would end at the magic or the check, so the first byte chooses
//! what is repaired: nothing, or magic, version, lengths and check.
#![no_main]

use controller_core::blob::{Blob, CHECK_BYTES, HEADER_BYTES, encode};
use controller_core::network::{Elman, Feedforward, SelfLoop};
use crc::{CRC_64_XZ, Crc};
use libfuzzer_sys::fuzz_target;

const CHECK: Crc<u64> = Crc::<u64>::new(&CRC_64_XZ);

/// Makes everything right that does not depend on the meaning of the other bytes.
fn repair(bytes: &mut [u8]) {
    let len = bytes.len();
    bytes[..12].copy_from_slice(b"EVOSTEER\x01\0\xb0\0");
    bytes[12..16].copy_from_slice(&(len as u32).to_le_bytes());
    let check = CHECK.checksum(&bytes[..len - CHECK_BYTES]);
    bytes[len - CHECK_BYTES..].copy_from_slice(&check.to_le_bytes());
}

fuzz_target!(|data: &[u8]| {
    let Some((mode, data)) = data.split_first() else { return };
    let mut words = vec![0u32; data.len().div_ceil(4)];
    let bytes = &mut bytemuck::cast_slice_mut(&mut words)[..data.len()];
    bytes.copy_from_slice(data);
    if mode % 4 != 0 && bytes.len() >= HEADER_BYTES + CHECK_BYTES {
        repair(bytes);
    }
    let prefix = Blob::parse_prefix(bytes).is_ok();
    let Ok(blob) = Blob::parse(bytes) else { return };
    assert!(prefix);

    let triples: Vec<f32> = bytes
        [HEADER_BYTES + 4 * blob.weights().len()..bytes.len() - CHECK_BYTES]
        .chunks_exact(4)
        .map(|word| f32::from_le_bytes([word[0], word[1], word[2], word[3]]))
        .collect();
    let mut again = vec![0u32; bytes.len() / 4];
    let again = bytemuck::cast_slice_mut(&mut again);
    encode(blob.header(), blob.weights(), &triples, again)
        .expect("an accepted blob is written again");
    assert!(again == bytes, "re-encoded to other bytes");

    let tanh = blob.header().activation;
    let _ = blob.self_test::<Feedforward, 12, 1>(tanh);
    let _ = blob.self_test::<Feedforward, 12, 2>(tanh);
    let _ = blob.self_test::<SelfLoop, 12, 1>(tanh);
    let _ = blob.self_test::<Elman, 12, 1>(tanh);
});

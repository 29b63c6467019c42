//! What the 64-bit check is worth, proved rather than sampled.
//!
//! An error goes unseen exactly if the XOR of its bits' syndromes is zero. The syndrome of the
//! bit `k` places before the end is `xᵏ` modulo the generator, for message and check alike, so a
//! pattern that is moved along the blob stays seen or unseen: it is enough to look at patterns
//! whose last bit is bit 0.

use crate::buffer::CHECK;
use crate::cases::named;

/// x⁶⁴ + the generator of ECMA-182, bit-reversed: what CRC-64/XZ divides by.
const GENERATOR: u64 = 0xc96c_5795_d787_0f42;

/// Syndromes of all bits, the last bit of the blob first.
fn syndromes(count: usize) -> Vec<u64> {
    std::iter::successors(Some(1u64 << 63), |s| {
        Some(s >> 1 ^ if s & 1 == 1 { GENERATOR } else { 0 })
    })
    .take(count)
    .collect()
}

#[test]
fn flipping_a_bit_changes_the_check_by_its_syndrome() {
    let blob = named("elman").encoded();
    let body = &blob[..blob.len() - 8];
    let syndromes = syndromes(8 * blob.len());
    let check = CHECK.checksum(body);
    for bit in 0..8 * body.len() {
        let mut damaged = body.to_vec();
        damaged[bit / 8] ^= 1 << (bit % 8);
        let from_the_end = 8 * blob.len() - 1 - bit;
        assert_eq!(CHECK.checksum(&damaged) ^ check, syndromes[from_the_end], "bit {bit}");
    }
    // The last 64 bits are the check itself.
    for (k, syndrome) in syndromes[..64].iter().enumerate() {
        assert_eq!(*syndrome, 1 << (63 - k));
    }
}

#[test]
fn no_error_of_up_to_four_bits_goes_unseen_in_a_blob_of_up_to_4_kib() {
    no_error_of_up_to_four_bits_goes_unseen(4096);
}

#[test]
#[ignore = "15 seconds; four times the pairs of the 4 KiB proof"]
fn no_error_of_up_to_four_bits_goes_unseen_in_a_blob_of_up_to_8_kib() {
    no_error_of_up_to_four_bits_goes_unseen(8192);
}

fn no_error_of_up_to_four_bits_goes_unseen(bytes: usize) {
    let syndromes = syndromes(8 * bytes);
    let last = syndromes[0];
    // A bit set of 20-bit digests answers most questions without the sorted list.
    let digest = |s: u64| (s.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 44) as usize;
    let mut seen = vec![0u64; 1 << 14];
    for s in &syndromes {
        seen[digest(*s) / 64] |= 1 << (digest(*s) % 64);
    }
    let mut sorted = syndromes.clone();
    sorted.sort_unstable();
    let is_a_syndrome = |s: u64| {
        seen[digest(s) / 64] >> (digest(s) % 64) & 1 == 1 && sorted.binary_search(&s).is_ok()
    };
    // One bit: no syndrome is zero. Two: no other bit has the last bit's.
    assert!(sorted.windows(2).all(|pair| pair[0] < pair[1]) && sorted[0] != 0);
    for (b, first) in syndromes.iter().enumerate().skip(1) {
        // Three bits: the last, `b`, and one more.
        assert!(!is_a_syndrome(last ^ first), "three bits with {b}");
        // Four: the last, `b`, `c` after it, and one more, wherever it lies.
        for (c, second) in syndromes.iter().enumerate().skip(b + 1) {
            assert!(!is_a_syndrome(last ^ first ^ second), "four bits with {b} and {c}");
        }
    }
}

//! Bytes that start at a multiple of four, as a flash sector does.

use controller_core::blob::{CHECK_BYTES, Header, encode};
use crc::{CRC_64_XZ, Crc};
use std::ops::{Deref, DerefMut};

/// The check computed the other way, from a table.
pub(crate) const CHECK: Crc<u64> = Crc::<u64>::new(&CRC_64_XZ);

/// Some bytes of any length, aligned.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Buffer {
    words: Vec<u32>,
    len: usize,
}

impl Buffer {
    pub(crate) fn filled(byte: u8, len: usize) -> Self {
        Self { words: vec![u32::from_le_bytes([byte; 4]); len.div_ceil(4)], len }
    }

    pub(crate) fn from_bytes(bytes: &[u8]) -> Self {
        let mut buffer = Self::filled(0, bytes.len());
        buffer.copy_from_slice(bytes);
        buffer
    }

    /// An encoded blob.
    pub(crate) fn encoded(header: &Header, weights: &[f32], self_tests: &[f32]) -> Self {
        let mut buffer = Self::filled(0, header.blob_len());
        encode(header, weights, self_tests, &mut buffer).expect("a valid blob");
        buffer
    }

    /// Stores the check that belongs to the other bytes.
    pub(crate) fn repair(&mut self) {
        let body = self.len - CHECK_BYTES;
        let check = CHECK.checksum(&self[..body]);
        self[body..].copy_from_slice(&check.to_le_bytes());
    }

    /// Overwrites a few bytes and repairs the check.
    pub(crate) fn with(&self, offset: usize, bytes: &[u8]) -> Self {
        let mut changed = self.clone();
        changed[offset..offset + bytes.len()].copy_from_slice(bytes);
        changed.repair();
        changed
    }
}

impl Deref for Buffer {
    type Target = [u8];
    fn deref(&self) -> &[u8] {
        &bytemuck::cast_slice(&self.words)[..self.len]
    }
}

impl DerefMut for Buffer {
    fn deref_mut(&mut self) -> &mut [u8] {
        &mut bytemuck::cast_slice_mut(&mut self.words)[..self.len]
    }
}

//! A blob as a Rust source file, to be compiled into a `no_std` program.

use std::fmt::Write;

use controller_core::blob::Blob;

use crate::fingerprint;

/// Source of a module with one item of interest: `pub static CHAMPION`, the blob's bytes at
/// an address that is a multiple of 4.
pub fn encode(blob: &Blob<'_>, bytes: &[u8]) -> String {
    let header = blob.header();
    let provenance = &header.provenance;
    let [major, minor, patch] = provenance.tool;
    let mut source = format!(
        "//! Trained weights, {topology}: scenario \"{name}\", seed {seed}, generation {generation}.\n\
         //!\n\
         //! Check {check:016x}.\n\
         //! SHA-256 {sha256}.\n\
         //! Trained by evosteer {major}.{minor}.{patch}, written by `evosteer export --format rs`.\n\
         \n\
         /// Bytes that start at a multiple of 4, so that the words in them can be read in place.\n\
         #[repr(C, align(4))]\n\
         pub struct AlignedBlob<const N: usize>(pub [u8; N]);\n\
         \n\
         /// The weight blob: read it with `controller_core::blob::Blob::parse(&CHAMPION.0)`.\n\
         #[rustfmt::skip]\n\
         pub static CHAMPION: AlignedBlob<{length}> = AlignedBlob([\n",
        topology = header.topology,
        // A name can hold line ends, and must not end the comment.
        name = provenance.scenario_name().escape_default(),
        seed = provenance.seed,
        generation = provenance.generation,
        check = blob.check(),
        sha256 = fingerprint::sha256(bytes),
        length = bytes.len(),
    );
    for line in bytes.chunks(16) {
        source.push_str("   ");
        for byte in line {
            write!(source, " {byte:#04x},").expect("a String takes everything");
        }
        source.push('\n');
    }
    source.push_str("]);\n");
    source
}

#[cfg(test)]
mod tests;

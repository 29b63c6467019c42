//! What names a champion, for people and for machines.

use std::fmt;

use serde::Serialize;

use crate::blob_file::BlobFile;
use crate::fingerprint;

/// Names of one blob: its bytes, its network and where its weights come from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub(super) struct BlobSummary {
    /// Length of the blob.
    pub(super) bytes: usize,
    /// SHA-256 of the blob, hexadecimal.
    pub(super) sha256: String,
    /// The check at the blob's end, hexadecimal.
    pub(super) check: String,
    /// Sizes and kind of the network.
    pub(super) topology: String,
    /// Number of weights.
    pub(super) weights: usize,
    /// Name of the scenario it was trained on.
    pub(super) scenario: String,
    /// Seed of the run.
    pub(super) seed: u64,
    /// Generation the champion was found in.
    pub(super) generation: u32,
}

impl BlobSummary {
    pub(super) fn of(file: &BlobFile) -> Self {
        let blob = file.blob();
        let provenance = &blob.header().provenance;
        Self {
            bytes: file.bytes().len(),
            sha256: fingerprint::sha256(file.bytes()),
            check: format!("{:016x}", blob.check()),
            topology: blob.header().topology.to_string(),
            weights: blob.weights().len(),
            scenario: provenance.scenario_name().to_owned(),
            seed: provenance.seed,
            generation: provenance.generation,
        }
    }

    /// The network in words.
    pub(super) fn network(&self) -> impl fmt::Display {
        let Self { topology, weights, .. } = self;
        fmt::from_fn(move |f| write!(f, "{topology}, {weights} weights"))
    }

    /// Where the weights come from, in words. The name is quoted: it may hold anything.
    pub(super) fn origin(&self) -> impl fmt::Display {
        let Self { scenario, seed, generation, .. } = self;
        fmt::from_fn(move |f| {
            write!(f, "scenario {scenario:?}, seed {seed}, generation {generation}")
        })
    }
}

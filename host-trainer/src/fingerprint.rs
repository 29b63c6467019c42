//! Names for bytes: what `sha256sum` prints.

use crate::scenario::{Scenario, to_toml};
use sha2::{Digest, Sha256};

/// SHA-256 of `bytes` as 64 lower-case hexadecimal digits.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// SHA-256 of a scenario as a scenario file. A map counts by its file's name, so that the
/// result does not depend on where a checkout lies.
pub fn scenario(scenario: &Scenario) -> [u8; 32] {
    let mut portable = scenario.clone();
    if let Some(map) = &mut portable.world.map
        && let Some(name) = map.yaml.file_name()
    {
        map.yaml = name.into();
    }
    Sha256::digest(to_toml(&portable)).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first example of FIPS 180-4's test vectors.
    #[test]
    fn abc_has_its_published_digest() {
        assert_eq!(
            sha256(b"abc"),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
        );
    }
}

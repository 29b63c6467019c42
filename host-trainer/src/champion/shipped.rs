//! The champions inside this program, so that something drives before anything was trained.
//!
//! How each was made stands beside it in `champions/`: [`Champion::provenance`].

use serde::Deserialize;
use std::path::PathBuf;

use crate::blob_file::{BlobFile, FileBytes};

/// A champion that comes with the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Champion {
    /// The scene it drives, a shipped scenario.
    pub scene: &'static str,
    /// Its weight blob.
    pub blob: &'static [u8],
    /// How it was made and how it drives, as TOML.
    pub provenance: &'static str,
}

macro_rules! champion {
    ($scene:literal) => {
        Champion {
            scene: $scene,
            blob: include_bytes!(concat!("../../../champions/", $scene, ".blob")),
            provenance: include_str!(concat!("../../../champions/", $scene, ".toml")),
        }
    };
}

/// Every champion that comes with the program; the first is shown where none is asked for.
pub const CHAMPIONS: &[Champion] =
    &[champion!("open"), champion!("obstacles"), champion!("complex"), champion!("depot")];

/// The scenes of all of them, as a message lists them.
pub fn scenes() -> String {
    CHAMPIONS.iter().map(|champion| champion.scene).collect::<Vec<_>>().join(", ")
}

impl Champion {
    /// The champion of this scene.
    pub fn of(scene: &str) -> Option<&'static Self> {
        CHAMPIONS.iter().find(|champion| champion.scene == scene)
    }

    /// Control periods that its drives may take, in the figures beside it and in training.
    ///
    /// # Panics
    ///
    /// If the file beside it does not say so: a test reads each.
    pub fn step_limit(&self) -> u32 {
        #[derive(Deserialize)]
        struct Provenance {
            unseen: Unseen,
        }
        #[derive(Deserialize)]
        struct Unseen {
            step_limit: u32,
        }
        let provenance: Provenance = toml::from_str(self.provenance).expect("figures");
        provenance.unseen.step_limit
    }

    /// Its blob, as if read from the repository.
    ///
    /// # Panics
    ///
    /// If the blob is none: a test decodes each.
    pub fn file(&self) -> BlobFile {
        let path = PathBuf::from(format!("champions/{}.blob", self.scene));
        BlobFile::check(FileBytes::new(path, self.blob)).expect("a shipped blob is one")
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::path::Path;

    use super::*;

    #[test]
    fn every_champion_of_the_repository_is_shipped_decodes_and_has_its_provenance() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../champions");
        let names = |extension: &str| -> BTreeSet<String> {
            let files = std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path());
            let files = files.filter(|path| path.extension().is_some_and(|e| e == extension));
            files.map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned()).collect()
        };
        let shipped: BTreeSet<String> = CHAMPIONS.iter().map(|c| c.scene.to_owned()).collect();
        assert_eq!(names("blob"), shipped);
        assert_eq!(names("toml"), shipped);
        for champion in CHAMPIONS {
            let file = champion.file();
            assert_eq!(file.blob().header().provenance.scenario_name(), champion.scene);
            assert!(crate::scenario::find(champion.scene).is_ok());
            assert!(champion.step_limit() > 0);
        }
    }
}

//! What a run is: enough to repeat or resume it, and nothing that differs between equal runs.

use std::fs;
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::RunFolder;
use crate::failure::Failure;
use crate::fingerprint::sha256;
use crate::scenario::shipped;

/// `manifest.toml`: settings, seed, versions and fingerprints. No times and no host names,
/// so that equal runs have equal manifests.
///
/// `S` is the resolved scenario; it becomes the table `[scenario]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest<S> {
    /// Version of evosteer that began the run.
    pub evosteer: String,
    /// Seed of every random draw of the run. Text, because TOML's integers end at 2⁶³ − 1.
    #[serde(with = "decimal")]
    pub seed: u64,
    /// SHA-256 of the `[scenario]` table as TOML text, hexadecimal.
    pub scenario_sha256: String,
    /// Versions of the formats in the folder.
    pub formats: Formats,
    /// Files the scenario refers to, such as maps.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub inputs: Vec<Input>,
    /// The champion that the run began with, if any, as it was given; its copy is
    /// [`RunFolder::FROM`].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<Input>,
    /// The settings, with nothing left to default.
    pub scenario: S,
}

/// Versions of the formats in a run's folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Formats {
    /// Of `manifest.toml` and the CSV files.
    pub manifest: u16,
    /// Of the checkpoints.
    pub checkpoint: u16,
    /// Of `champion.blob`.
    pub blob: u16,
}

/// A file that a run depends on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Input {
    /// As it was given.
    pub path: PathBuf,
    /// What `sha256sum` prints for it.
    pub sha256: String,
}

impl Input {
    /// Reads a file, on disk or inside this program, and takes its fingerprint.
    ///
    /// # Errors
    ///
    /// Input/output, naming the file.
    pub fn of_file(path: &Path) -> Result<Self, Failure> {
        let sha256 = match shipped::bytes(path) {
            Some(bytes) => sha256(bytes),
            None => sha256(&fs::read(path).map_err(|cause| Failure::io("read", path, &cause))?),
        };
        Ok(Self { path: path.to_owned(), sha256 })
    }

    /// Refuses the file, now at `path`, if it is no longer what it was when the run began.
    ///
    /// # Errors
    ///
    /// Bad input, if its fingerprint `found` is another.
    pub fn expect(&self, found: &str, path: &Path, folder: &RunFolder) -> Result<(), Failure> {
        if found == self.sha256 {
            return Ok(());
        }
        Err(Failure::bad_input(format!(
            "{} has changed since the run in {} began: its SHA-256 is {found}, expected {}",
            path.display(),
            folder.path().display(),
            self.sha256
        )))
    }
}

impl<S: Serialize + DeserializeOwned> Manifest<S> {
    /// Version of the manifest's format that this build writes and reads.
    pub const FORMAT: u16 = 2;

    /// Describes a run of `scenario` from `seed`.
    ///
    /// # Errors
    ///
    /// Bad input when the scenario has no TOML form.
    pub fn new(seed: u64, scenario: S, blob: u16, inputs: Vec<Input>) -> Result<Self, Failure> {
        Ok(Self {
            evosteer: env!("CARGO_PKG_VERSION").to_owned(),
            seed,
            scenario_sha256: fingerprint(&scenario)?,
            formats: Formats {
                manifest: Self::FORMAT,
                checkpoint: crate::checkpoint::VERSION,
                blob,
            },
            inputs,
            from: None,
            scenario,
        })
    }

    /// Writes `manifest.toml`.
    ///
    /// # Errors
    ///
    /// Input/output, naming the file; bad input when a path in it is not Unicode.
    pub fn write(&self, folder: &RunFolder) -> Result<(), Failure> {
        folder.write(RunFolder::MANIFEST, to_toml(self)?.as_bytes())
    }

    /// Reads `manifest.toml` and checks that the run it describes is still the same run.
    ///
    /// # Errors
    ///
    /// Bad input when the text is not a manifest (with line and column), of another
    /// version, or its settings or a file it refers to have changed since; input/output
    /// when a file cannot be read.
    pub fn read(folder: &RunFolder) -> Result<Self, Failure> {
        let manifest = Self::read_in(folder.path())?;
        for input in &manifest.inputs {
            let now = Input::of_file(&input.path)?;
            input.expect(&now.sha256, &input.path, folder)?;
        }
        Ok(manifest)
    }

    /// The same for a folder that another process may be using, without looking at the files it
    /// refers to.
    ///
    /// # Errors
    ///
    /// As [`Manifest::read`].
    pub fn read_in(folder: &Path) -> Result<Self, Failure> {
        let path = folder.join(RunFolder::MANIFEST);
        let bytes = fs::read(&path).map_err(|cause| Failure::io("read", &path, &cause))?;
        Self::parse(&path, &bytes)
    }

    fn parse(path: &Path, bytes: &[u8]) -> Result<Self, Failure> {
        let text = std::str::from_utf8(bytes).map_err(|error| {
            let (line, column) = position(bytes, error.valid_up_to());
            refuse(path, line, column, "not UTF-8 text")
        })?;
        let at = |error: toml::de::Error| {
            let (line, column) = position(bytes, error.span().map_or(0, |span| span.start));
            refuse(path, line, column, error.message())
        };
        // The version first: another version's fields need not make sense here.
        let Versioned { formats } = toml::from_str(text).map_err(at)?;
        if formats.manifest != Self::FORMAT {
            return Err(Failure::bad_input(format!(
                "{}: manifest version {}, this evosteer reads version {}",
                path.display(),
                formats.manifest,
                Self::FORMAT
            )));
        }
        let manifest: Self = toml::from_str(text).map_err(at)?;
        let found = fingerprint(&manifest.scenario)?;
        if found != manifest.scenario_sha256 {
            return Err(Failure::bad_input(format!(
                "{}: the settings in [scenario] were changed after the run began; start a new run to use them",
                path.display()
            )));
        }
        Ok(manifest)
    }
}

#[derive(Deserialize)]
struct Versioned {
    formats: ManifestVersion,
}

#[derive(Deserialize)]
struct ManifestVersion {
    manifest: u16,
}

fn refuse(path: &Path, line: usize, column: usize, message: &str) -> Failure {
    Failure::bad_input(format!("{}:{line}:{column}: {message}", path.display()))
}

/// Line and column of a byte, both from 1; columns count characters.
fn position(bytes: &[u8], offset: usize) -> (usize, usize) {
    let before = &bytes[..offset.min(bytes.len())];
    let line_start = before.iter().rposition(|&byte| byte == b'\n').map_or(0, |end| end + 1);
    let line = before.iter().filter(|&&byte| byte == b'\n').count() + 1;
    (line, String::from_utf8_lossy(&before[line_start..]).chars().count() + 1)
}

fn fingerprint<S: Serialize>(scenario: &S) -> Result<String, Failure> {
    Ok(sha256(to_toml(scenario)?.as_bytes()))
}

fn to_toml<T: Serialize>(value: &T) -> Result<String, Failure> {
    toml::to_string(value)
        .map_err(|error| Failure::bad_input(format!("cannot be written as TOML: {error}")))
}

/// A 64-bit number as decimal text.
pub(crate) mod decimal {
    use serde::de::Error;
    use serde::{Deserialize, Deserializer, Serializer};

    pub(crate) fn serialize<S: Serializer>(number: &u64, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(&number.to_string())
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<u64, D::Error> {
        let text = String::deserialize(from)?;
        text.parse().map_err(|_| {
            D::Error::custom(format!(
                "`{text}` is not a seed; expected a whole number from 0 to {}",
                u64::MAX
            ))
        })
    }
}

#[cfg(test)]
mod tests;

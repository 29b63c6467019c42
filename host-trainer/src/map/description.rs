//! The YAML half of a map: which image, how large a cell is, where it lies, what grey means.
//!
//! The keys are those `map_server` reads. It refuses a file without one of them, `mode`
//! apart, and so do we: the two customary values of `free_thresh`, 0.196 and 0.25, lie on
//! either side of the grey that stands for "unknown", so no default could be right.
//! Other keys, which map files in the wild do have, are reported and ignored.

use std::io::Read;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

use serde_saphyr::Spanned;

use super::error::{MapError, MapProblem, Place};
use super::shade::{CellRule, Mode};
use super::yaml::{Keys, UnknownKey, expected, place};

/// Longest YAML file read, bytes; real ones have about 150.
const LONGEST_YAML: u64 = 1 << 20;

/// Edges of a cell that are taken for metres and not for a slip, metres.
const RESOLUTIONS: RangeInclusive<f64> = 1e-6..=1e6;

/// A checked YAML file.
#[derive(Debug)]
pub(super) struct Description {
    /// The image, joined to the YAML's folder.
    pub(super) image: PathBuf,
    /// Where the YAML names the image.
    pub(super) image_place: Place,
    /// Edge of a cell, metres.
    pub(super) resolution: f64,
    /// Pose of the lower left corner: x, y in metres, yaw in radians.
    pub(super) origin: [f64; 3],
    /// Where the YAML says so.
    pub(super) origin_place: Place,
    pub(super) rule: CellRule,
    pub(super) unknown_keys: Vec<UnknownKey>,
}

impl Description {
    /// Reads and checks a YAML file.
    pub(super) fn read(yaml: &Path) -> Result<Self, MapError> {
        let file = super::open(yaml, MapProblem::Missing, Place::File, yaml)?;
        let mut text = Vec::new();
        let unread = |cause| MapProblem::Read(cause).at(yaml, Place::File);
        file.take(LONGEST_YAML + 1).read_to_end(&mut text).map_err(unread)?;
        if text.len() as u64 > LONGEST_YAML {
            return Err(MapProblem::LongYaml { limit: LONGEST_YAML }.at(yaml, Place::File));
        }
        Self::parse(&text, yaml)
    }

    /// Checks the bytes of a YAML file; `yaml` is its path.
    pub(super) fn parse(text: &[u8], yaml: &Path) -> Result<Self, MapError> {
        let keys = Keys::parse(text, yaml)?;
        let refuse = |place, problem: MapProblem| problem.at(yaml, place);
        let image = keys.require(&keys.image, "image", yaml)?;
        let resolution = keys.require(&keys.resolution, "resolution", yaml)?;
        let origin = keys.require(&keys.origin, "origin", yaml)?;
        let negate = keys.require(&keys.negate, "negate", yaml)?;
        let occupied = keys.require(&keys.occupied_thresh, "occupied_thresh", yaml)?;
        let free = keys.require(&keys.free_thresh, "free_thresh", yaml)?;

        if image.value.is_empty() {
            return Err(bad(image, "image", "an empty name", yaml));
        }
        if !RESOLUTIONS.contains(&resolution.value) {
            return Err(bad(resolution, "resolution", format!("{:?}", resolution.value), yaml));
        }
        let Ok(pose) = <[f64; 3]>::try_from(origin.value.as_slice()) else {
            let found = format!("{} numbers", origin.value.len());
            return Err(bad(origin, "origin", found, yaml));
        };
        if !pose.iter().all(|value| value.is_finite()) {
            return Err(bad(origin, "origin", format!("{pose:?}"), yaml));
        }
        for (key, threshold) in [("occupied_thresh", occupied), ("free_thresh", free)] {
            if !(0.0..=1.0).contains(&threshold.value) {
                return Err(bad(threshold, key, format!("{:?}", threshold.value), yaml));
            }
        }
        let negate = truth(&negate.value)
            .ok_or_else(|| bad(negate, "negate", format!("{:?}", negate.value), yaml))?;
        let mode = match &keys.mode {
            None => Mode::default(),
            Some(name) => mode(&name.value)
                .ok_or_else(|| bad(name, "mode", format!("{:?}", name.value), yaml))?,
        };

        // Equal thresholds leave no unknown band, which some converters want; only the
        // stretch of mode `scale` would divide by zero.
        let strict = mode == Mode::Scale;
        let (free_thresh, occupied_thresh) = (free.value, occupied.value);
        if free_thresh > occupied_thresh || strict && free_thresh == occupied_thresh {
            let problem =
                MapProblem::Thresholds { free: free_thresh, occupied: occupied_thresh, strict };
            return Err(refuse(place(free.referenced), problem));
        }

        Ok(Self {
            image: yaml.parent().unwrap_or(Path::new("")).join(&image.value),
            image_place: place(image.referenced),
            resolution: resolution.value,
            origin: pose,
            origin_place: place(origin.referenced),
            rule: CellRule { mode, negate, free_thresh, occupied_thresh },
            unknown_keys: keys.unknown,
        })
    }
}

impl Keys {
    /// The value of a key that must be there.
    fn require<'a, T>(
        &self,
        value: &'a Option<Spanned<T>>,
        key: &'static str,
        yaml: &Path,
    ) -> Result<&'a Spanned<T>, MapError> {
        value.as_ref().ok_or_else(|| {
            let looks_alike = |found: &&String| {
                strsim::damerau_levenshtein(&found.to_ascii_lowercase(), key) <= 2
            };
            let misspelt = self.unknown.iter().map(|unknown| &unknown.key).find(looks_alike);
            MapProblem::MissingKey { key, misspelt: misspelt.cloned() }.at(yaml, Place::File)
        })
    }
}

/// A value that makes no map.
fn bad<T>(value: &Spanned<T>, key: &'static str, found: impl ToString, yaml: &Path) -> MapError {
    let problem = MapProblem::BadValue { key, found: found.to_string(), expected: expected(key) };
    problem.at(yaml, place(value.referenced))
}

/// `negate` as `map_server` reads it: a whole number, where 0 is false, or a YAML 1.1 truth
/// value.
fn truth(text: &str) -> Option<bool> {
    if let Ok(number) = text.parse::<i32>() {
        return Some(number != 0);
    }
    match text.to_ascii_lowercase().as_str() {
        "y" | "yes" | "true" | "on" => Some(true),
        "n" | "no" | "false" | "off" => Some(false),
        _ => None,
    }
}

/// `mode` by its name, in any case.
fn mode(name: &str) -> Option<Mode> {
    match name.to_ascii_lowercase().as_str() {
        "trinary" => Some(Mode::Trinary),
        "scale" => Some(Mode::Scale),
        "raw" => Some(Mode::Raw),
        _ => None,
    }
}

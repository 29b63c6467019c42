//! Why a map cannot be used, said so that the file can be repaired.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use super::{MAX_CELLS, MAX_SIDE};
use crate::failure::Failure;

/// A map that was refused: which file, where in it, and why.
#[derive(Debug)]
pub struct MapError {
    /// The file at fault: the YAML, or the image it names.
    pub file: PathBuf,
    /// Where in that file.
    pub place: Place,
    /// What was found there.
    pub problem: MapProblem,
}

/// A place in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The file as a whole.
    File,
    /// A position in text, both counted from 1.
    Text {
        /// Line.
        line: u64,
        /// Column, in characters.
        column: u64,
    },
    /// Bytes from the start of a binary file.
    Byte(u64),
}

/// What is wrong with a map, one variant per cause.
#[derive(Debug)]
pub enum MapProblem {
    /// Nothing has this name.
    Missing,
    /// The YAML names an image that does not exist.
    ImageMissing {
        /// The path that was tried.
        image: PathBuf,
    },
    /// The name belongs to a folder, a device or another thing without contents of its own.
    NotAFile,
    /// The operating system refused to read.
    Read(io::Error),
    /// The YAML is longer than any map description.
    LongYaml {
        /// Most bytes accepted.
        limit: u64,
    },
    /// Not YAML, or a value of the wrong type; the sentence is the YAML reader's.
    Yaml(String),
    /// A key that ROS's `map_server` insists on is absent.
    MissingKey {
        /// The absent key.
        key: &'static str,
        /// A key in the file that looks like a misspelling of it.
        misspelt: Option<String>,
    },
    /// A key has a value that makes no map.
    BadValue {
        /// The key.
        key: &'static str,
        /// The value, as read.
        found: String,
        /// What it should be.
        expected: &'static str,
    },
    /// Everything would be free and occupied at once.
    Thresholds {
        /// `free_thresh`.
        free: f64,
        /// `occupied_thresh`.
        occupied: f64,
        /// Whether equal values are refused too (mode `scale` divides by the difference).
        strict: bool,
    },
    /// So far from zero that neighbouring cell corners fall together in 32-bit coordinates.
    TooFarOut {
        /// Largest coordinate, metres.
        reach: f64,
        /// Edge of a cell, metres.
        resolution: f64,
    },
    /// Neither PGM nor PNG.
    UnknownFormat {
        /// A name for what the first bytes look like.
        found: String,
    },
    /// A number in a PGM header is absent or out of range.
    PgmHeader {
        /// Which number.
        field: &'static str,
        /// What stands there.
        found: String,
        /// What it should be.
        expected: &'static str,
    },
    /// More cells than a map may have, or none.
    Size {
        /// Columns declared.
        width: u32,
        /// Rows declared.
        height: u32,
    },
    /// There is no memory for this many cells.
    Memory {
        /// Bytes asked for.
        bytes: usize,
    },
    /// The pixels end too soon.
    Truncated {
        /// How many were there.
        found: u64,
        /// How many the header promises.
        expected: u64,
        /// What is counted.
        unit: &'static str,
    },
    /// Something that is no number where a plain PGM has a grey value.
    PgmSample {
        /// What stands there.
        found: String,
        /// The header's largest grey value.
        maxval: u16,
    },
    /// A grey value above the largest one the header allows.
    AboveMaxval {
        /// The value.
        sample: u32,
        /// The header's largest.
        maxval: u16,
        /// Column of the pixel, from 0 at the left.
        x: u32,
        /// Row of the pixel, from 0 at the top.
        row: u32,
    },
    /// The PNG decoder refused; the sentence is its own.
    Png(String),
}

impl MapProblem {
    /// Joins a problem with its file and its place there.
    pub(super) fn at(self, file: &Path, place: Place) -> MapError {
        MapError { file: file.to_owned(), place, problem: self }
    }
}

impl fmt::Display for MapProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing => write!(f, "no such file"),
            Self::ImageMissing { image } => {
                write!(f, "image: there is no file {} (relative to the YAML)", image.display())
            }
            Self::NotAFile => write!(f, "not a regular file"),
            Self::Read(cause) => write!(f, "cannot read: {cause}"),
            Self::LongYaml { limit } => {
                write!(f, "longer than {limit} bytes; expected the YAML file of a map")
            }
            Self::Yaml(message) => f.write_str(message),
            Self::MissingKey { key, misspelt: Some(found) } => {
                write!(f, "missing key `{key}`; is `{found}` a misspelling of it?")
            }
            Self::MissingKey { key, misspelt: None } => write!(
                f,
                "missing key `{key}`; expected image, resolution, origin, negate, \
                 occupied_thresh (map savers write 0.65) and free_thresh (0.196 in ROS 1, \
                 0.25 in ROS 2)"
            ),
            Self::BadValue { key, found, expected } => {
                write!(f, "{key}: found {found}, expected {expected}")
            }
            Self::Thresholds { free, occupied, strict } => write!(
                f,
                "free_thresh {free:?} and occupied_thresh {occupied:?}: expected free_thresh {} \
                 occupied_thresh",
                if *strict { "below" } else { "at or below" }
            ),
            Self::TooFarOut { reach, resolution } => write!(
                f,
                "the map reaches {reach:?} m from zero, where 32-bit coordinates cannot tell \
                 corners {resolution:?} m apart; expected an origin near the map"
            ),
            Self::UnknownFormat { found } => {
                write!(f, "found {found}, expected a PGM (P2 or P5) or PNG image")
            }
            Self::PgmHeader { field, found, expected } => {
                write!(f, "PGM {field}: found {found}, expected {expected}")
            }
            Self::Size { width, height } => write!(
                f,
                "{width} × {height} pixels; expected 1 to {MAX_SIDE} each way and at most \
                 {MAX_CELLS} in all"
            ),
            Self::Memory { bytes } => write!(f, "no memory for {bytes} bytes of cells"),
            Self::Truncated { found, expected, unit } => {
                write!(f, "pixel data ends early: found {found} of {expected} {unit}")
            }
            Self::PgmSample { found, maxval } => {
                write!(
                    f,
                    "found {found}, expected a grey value from 0 to {maxval} in decimal digits"
                )
            }
            Self::AboveMaxval { sample, maxval, x, row } => write!(
                f,
                "grey value {sample} (column {x}, row {row} from the top), expected at most the \
                 header's {maxval}"
            ),
            Self::Png(message) => write!(f, "PNG: {message}"),
        }
    }
}

impl fmt::Display for MapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        match self.place {
            Place::File => {}
            Place::Text { line, column } => write!(f, ":{line}:{column}")?,
            Place::Byte(offset) => write!(f, ": byte {offset}")?,
        }
        write!(f, ": {}", self.problem)
    }
}

impl std::error::Error for MapError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match &self.problem {
            MapProblem::Read(cause) => Some(cause),
            _ => None,
        }
    }
}

/// A map that cannot be read is an input/output failure; every other refusal is bad input.
impl From<MapError> for Failure {
    fn from(error: MapError) -> Self {
        match &error.problem {
            MapProblem::Read(cause) => Failure::io("read", &error.file, cause),
            _ => Failure::bad_input(error.to_string()),
        }
    }
}

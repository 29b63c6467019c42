//! Occupancy maps in the format of ROS's `map_server`: a YAML file and an image.
//!
//! | look in | for |
//! | --- | --- |
//! | [`load`] | both files, checked, as an [`OccupancyMap`] |
//! | [`trace`] | the obstacles' outline as line segments |
//! | [`loops`] | the same as closed loops |
//! | `description` | the YAML: keys, defaults, refusals |
//! | `shade` | from a pixel to a cell, per [`Mode`] |
//! | `pgm`, `png` | the image formats |
//!
//! Cells are counted from the lower left corner, x along the image's rows, y upwards.

mod canvas;
mod description;
mod error;
mod loops;
mod numbers;
mod pgm;
mod png;
mod shade;
#[cfg(test)]
mod tests;
mod trace;
mod yaml;

use std::fs::File;
use std::io::{BufRead, BufReader, Cursor, ErrorKind, Read, Seek};
use std::path::{Path, PathBuf};

pub use error::{MapError, MapProblem, Place};
pub use loops::loops;
pub use shade::{FREE, Mode, OCCUPIED, UNKNOWN};
pub use trace::{Segment, trace, trace_within};
pub use yaml::UnknownKey;

use canvas::Canvas;
use description::Description;
use shade::CellRule;

use crate::scenario::{Bounds, shipped};

/// Most cells of a map: 8192 × 8192, or 410 m each way at 5 cm.
pub const MAX_CELLS: u64 = 1 << 26;

/// Longest side of a map, cells.
pub const MAX_SIDE: u32 = 1 << 16;

/// Smallest share of a cell that 32-bit coordinates must resolve everywhere on a map.
const SHARPNESS: f64 = 1.0 / 16.0;

/// An occupancy grid with its place in the world, as in ROS's `nav_msgs/OccupancyGrid`.
#[derive(Clone, Debug, PartialEq)]
pub struct OccupancyMap {
    /// Columns, at least 1.
    pub width: u32,
    /// Rows, at least 1.
    pub height: u32,
    /// Edge of a cell, metres, above 0.
    pub resolution: f64,
    /// Pose of the grid's lower left corner in the world: x and y in metres, yaw in radians.
    pub origin: [f64; 3],
    /// `width · height` cells, row by row from the bottom: [`UNKNOWN`] or an occupancy from
    /// [`FREE`] to [`OCCUPIED`].
    pub cells: Vec<i8>,
    /// The image file the cells were read from.
    pub image: PathBuf,
    /// Keys of the YAML that mean nothing here; worth a warning.
    pub unknown_keys: Vec<UnknownKey>,
}

/// Reads a map: the YAML file and the image it names.
///
/// ```no_run
/// let map = host_trainer::map::load("depot.yaml".as_ref())?;
/// let walls = host_trainer::map::trace(&map, false, 100);
/// # Ok::<(), host_trainer::map::MapError>(())
/// ```
pub fn load(yaml: &Path) -> Result<OccupancyMap, MapError> {
    let description = Description::read(yaml)?;
    let missing = MapProblem::ImageMissing { image: description.image.clone() };
    let image = open(&description.image, missing, description.image_place, yaml)?;
    let canvas = decode(BufReader::new(image), description.rule)
        .map_err(|(place, problem)| problem.at(&description.image, place))?;
    assemble(canvas, description, yaml)
}

/// The image file that a map's YAML names; the image itself is not read.
pub fn image(yaml: &Path) -> Result<PathBuf, MapError> {
    Ok(Description::read(yaml)?.image)
}

/// The contents of a file, on disk or inside this program.
trait Contents: Read + Seek {}

impl<T: Read + Seek> Contents for T {}

/// Opens an ordinary file or one that is shipped inside this program. If nothing has that name,
/// `missing` is the problem, at `place` of `blamed`.
fn open(
    path: &Path,
    missing: MapProblem,
    place: Place,
    blamed: &Path,
) -> Result<Box<dyn Contents>, MapError> {
    if let Some(bytes) = shipped::bytes(path) {
        return Ok(Box::new(Cursor::new(bytes)));
    }
    let unread = |cause| MapProblem::Read(cause).at(path, Place::File);
    // Asked before opening: opening a pipe would wait for its writer.
    match std::fs::metadata(path) {
        Ok(about) if about.is_file() => {
            File::open(path).map(|file| Box::new(file) as Box<dyn Contents>).map_err(unread)
        }
        Ok(_) => Err(MapProblem::NotAFile.at(path, Place::File)),
        Err(cause) if names_nothing(cause.kind()) => Err(missing.at(blamed, place)),
        Err(cause) => Err(unread(cause)),
    }
}

/// Whether there is no file of that name, be it that no file could have it.
fn names_nothing(kind: ErrorKind) -> bool {
    use ErrorKind::{InvalidFilename, InvalidInput, NotADirectory, NotFound};
    matches!(kind, NotFound | NotADirectory | InvalidFilename | InvalidInput)
}

/// Reads an image of either format, told apart by its first bytes and not by its name.
fn decode(mut input: impl BufRead + Seek, rule: CellRule) -> Result<Canvas, (Place, MapProblem)> {
    let start = input.fill_buf().map_err(|cause| (Place::File, MapProblem::Read(cause)))?;
    match start {
        [b'P', b'2' | b'5', ..] => pgm::read(input, rule),
        [0x89, b'P', b'N', b'G', ..] => png::read(input, rule),
        _ => {
            let found = resembles(start);
            Err((Place::Byte(0), MapProblem::UnknownFormat { found }))
        }
    }
}

/// A name for a file that begins like this.
fn resembles(start: &[u8]) -> String {
    match start {
        [] => "an empty file",
        [b'P', b'1' | b'4', ..] => "a PBM bitmap",
        [b'P', b'3' | b'6', ..] => "a PPM colour image",
        [b'P', b'7', ..] => "a PAM image",
        [b'B', b'M', ..] => "a BMP image",
        [0xff, 0xd8, ..] => "a JPEG image",
        [b'G', b'I', b'F', ..] => "a GIF image",
        [b'I', b'I', ..] | [b'M', b'M', ..] => "a TIFF image",
        _ => return format!("`{}`", start[..start.len().min(8)].escape_ascii()),
    }
    .to_owned()
}

/// Joins both halves and checks that they fit.
fn assemble(
    canvas: Canvas,
    description: Description,
    yaml: &Path,
) -> Result<OccupancyMap, MapError> {
    let map = OccupancyMap {
        width: canvas.width(),
        height: canvas.height(),
        resolution: description.resolution,
        origin: description.origin,
        cells: canvas.finish().map_err(|problem| problem.at(&description.image, Place::File))?,
        image: description.image,
        unknown_keys: description.unknown_keys,
    };
    let reach = map.reach();
    let spacing = (reach as f32).next_up() - reach as f32;
    if f64::from(spacing) <= map.resolution * SHARPNESS {
        return Ok(map);
    }
    let problem = MapProblem::TooFarOut { reach, resolution: map.resolution };
    Err(problem.at(yaml, description.origin_place))
}

impl OccupancyMap {
    /// The cell in column `x` and row `y`; none outside the map.
    pub fn cell(&self, x: u32, y: u32) -> Option<i8> {
        if x >= self.width {
            return None;
        }
        self.cells.get(y as usize * self.width as usize + x as usize).copied()
    }

    /// Whether a cell is in the way: its occupancy is `lethal` (0 to 100) or more, or it is
    /// unknown and unknown cells count. Outside the map nothing is.
    pub fn is_obstacle(&self, x: u32, y: u32, unknown_is_obstacle: bool, lethal: u8) -> bool {
        match self.cell(x, y) {
            Some(UNKNOWN) => unknown_is_obstacle,
            Some(occupancy) => i16::from(occupancy) >= i16::from(lethal),
            None => false,
        }
    }

    /// The cell that holds a point of the world, as column and row; none outside the map.
    pub fn cell_at(&self, point: [f32; 2]) -> Option<(u32, u32)> {
        let [x0, y0, yaw] = self.origin;
        let (dx, dy) = (f64::from(point[0]) - x0, f64::from(point[1]) - y0);
        let (sin, cos) = (libm::sin(yaw), libm::cos(yaw));
        let column = libm::floor((cos * dx + sin * dy) / self.resolution);
        let row = libm::floor((cos * dy - sin * dx) / self.resolution);
        let inside = (0.0..f64::from(self.width)).contains(&column)
            && (0.0..f64::from(self.height)).contains(&row);
        inside.then_some((column as u32, row as u32))
    }

    /// A corner of the grid in the world, metres: `x` in `0..=width`, `y` in `0..=height`.
    ///
    /// The one place that computes corners, so that lines which meet in one meet exactly.
    pub fn corner(&self, x: u32, y: u32) -> [f32; 2] {
        self.corner_f64(x, y).map(|coordinate| coordinate as f32)
    }

    /// The smallest axis-aligned rectangle of the world around the map.
    pub fn bounds(&self) -> Bounds {
        let [mut min, mut max] = [self.corner(0, 0); 2];
        for corner in self.outer_corners() {
            for axis in 0..2 {
                min[axis] = min[axis].min(corner[axis] as f32);
                max[axis] = max[axis].max(corner[axis] as f32);
            }
        }
        Bounds { min, max }
    }

    fn corner_f64(&self, x: u32, y: u32) -> [f64; 2] {
        let [x0, y0, yaw] = self.origin;
        // libm's functions give the same bits on every machine; at yaw 0 they are exact.
        let (sin, cos) = (libm::sin(yaw), libm::cos(yaw));
        let (x, y) = (f64::from(x) * self.resolution, f64::from(y) * self.resolution);
        [x0 + (cos * x - sin * y), y0 + (sin * x + cos * y)]
    }

    fn outer_corners(&self) -> [[f64; 2]; 4] {
        let (w, h) = (self.width, self.height);
        [(0, 0), (w, 0), (w, h), (0, h)].map(|(x, y)| self.corner_f64(x, y))
    }

    /// Largest coordinate on the map, metres from zero.
    fn reach(&self) -> f64 {
        self.outer_corners().into_iter().flatten().map(f64::abs).fold(0.0, f64::max)
    }
}

//! What the beams report, and how five reports become the network's seven inputs.
//!
//! Inputs 0 to 4 are the beams' distances, rightmost first, each in `0.0..=1.0`; inputs 5 and
//! 6 say whether a wall and whether the target is seen, or on which side the target is and whether
//! it is seen. How exactly is an [`Encoding`]: it is recorded in the weight blob and implemented
//! here only.

use crate::lane::Lane;
use serde::{Deserialize, Serialize};

/// Beams of the sensor.
pub const BEAMS: usize = 5;

/// Inputs of the network: a distance per beam, then "wall" and "target".
pub const INPUTS: usize = BEAMS + 2;

/// Control periods after which a reading is stale.
pub const STALE_AFTER: u32 = 3;

/// Where a beam starts and points, in the frame of the front axle (x forward, y left).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct BeamMount {
    /// Metres ahead of the front axle.
    pub x: f32,
    /// Metres left of the middle line.
    pub y: f32,
    /// Radians to the left of straight ahead.
    pub angle: f32,
}

/// What one beam reports.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Echo {
    /// Nothing within range.
    Nothing,
    /// An obstacle, at this distance in metres.
    Wall(f32),
    /// The target, at this distance in metres.
    Target(f32),
}

/// Why a reading cannot be used. The car stops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ReadingError {
    /// A beam did not answer.
    Missing {
        /// Index of the beam, rightmost is 0.
        beam: usize,
    },
    /// A distance is NaN, infinite, negative or beyond the sensor's range.
    OutOfRange {
        /// Index of the beam, rightmost is 0.
        beam: usize,
        /// What it reported, metres.
        distance: f32,
    },
    /// The reading is more than [`STALE_AFTER`] control periods old.
    Stale {
        /// Its age in control periods.
        age: u32,
    },
}

crate::sentences! { ReadingError {
    Self::Missing { beam } => "beam {} did not answer", beam;
    Self::OutOfRange { beam, distance } =>
        "beam {} reported {} m, outside its range", beam, distance;
    Self::Stale { age } => "the reading is {} periods old, {} are allowed", age, STALE_AFTER;
} }

impl core::error::Error for ReadingError {}

/// Five checked beam reports: every distance is finite and within `0.0..=range`.
///
/// ```
/// use controller_core::observation::{Echo, Reading, ReadingError};
///
/// let echoes = [Some(Echo::Wall(2.0)); 5];
/// assert!(Reading::new(echoes, 0, 10.0).is_ok());
///
/// let unplugged = [Some(Echo::Wall(2.0)), None, None, None, None];
/// assert_eq!(Reading::new(unplugged, 0, 10.0), Err(ReadingError::Missing { beam: 1 }));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Reading {
    echoes: [Echo; BEAMS],
    range: f32,
}

impl Reading {
    /// Accepts what the sensors reported, `age` control periods ago, through beams of this
    /// range in metres.
    ///
    /// The range is the one the weights were trained with
    /// ([`Scaling::range`](crate::controller::Scaling::range)): a sensor that sees further
    /// reports [`Echo::Nothing`] past it.
    ///
    /// # Errors
    ///
    /// A beam that is missing or whose distance is not finite and in `0.0..=range`, or an age
    /// of more than [`STALE_AFTER`]: no data is danger, never "free". A beam that sees nothing
    /// counts with its range, so a range that is NaN, infinite or negative refuses every reading.
    pub fn new(echoes: [Option<Echo>; BEAMS], age: u32, range: f32) -> Result<Self, ReadingError> {
        if age > STALE_AFTER {
            return Err(ReadingError::Stale { age });
        }
        let mut checked = [Echo::Nothing; BEAMS];
        for (beam, (slot, echo)) in checked.iter_mut().zip(echoes).enumerate() {
            let echo = echo.ok_or(ReadingError::Missing { beam })?;
            let distance = match echo {
                Echo::Nothing => range,
                Echo::Wall(distance) | Echo::Target(distance) => distance,
            };
            if !(distance.is_finite() && (0.0..=range).contains(&distance)) {
                return Err(ReadingError::OutOfRange { beam, distance });
            }
            *slot = echo;
        }
        Ok(Self { echoes: checked, range })
    }

    /// The five reports, rightmost first.
    pub fn echoes(&self) -> &[Echo; BEAMS] {
        &self.echoes
    }

    /// The reports as numbers.
    pub fn sight(&self) -> Sight<f32> {
        let mut sight =
            Sight { distance: [self.range; BEAMS], wall: [0.0; BEAMS], target: [0.0; BEAMS] };
        for (beam, echo) in self.echoes.iter().enumerate() {
            let (distance, flag) = match echo {
                Echo::Nothing => continue,
                Echo::Wall(distance) => (distance, &mut sight.wall),
                Echo::Target(distance) => (distance, &mut sight.target),
            };
            // `beam` counts to BEAMS; `get_mut` keeps the panic path out of the image.
            if let (Some(slot), Some(seen)) = (sight.distance.get_mut(beam), flag.get_mut(beam)) {
                *slot = *distance;
                *seen = 1.0;
            }
        }
        sight
    }
}

/// Five beam reports as numbers, one robot per lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sight<L> {
    /// Distance to the hit, or the range where nothing was hit, metres.
    pub distance: [L; BEAMS],
    /// 1 where a beam ends on an obstacle, else 0.
    pub wall: [L; BEAMS],
    /// 1 where a beam ends on the target, else 0.
    pub target: [L; BEAMS],
}

/// How distances are normalised to `0.0..=1.0`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[serde(rename_all = "kebab-case")]
pub enum DistanceLaw {
    /// `d / range` (paper, section 3).
    #[default]
    Linear,
    /// `d / (d + half)`: fine near by, coarse far away; one half at `half` metres.
    Saturating {
        /// Distance that maps to 0.5, metres, above 0.
        half: f32,
    },
}

/// How five hit types become two inputs: "wall" and "target" but for [`Self::Bearing`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[serde(rename_all = "kebab-case")]
pub enum TypeCode {
    /// 1 if any beam ends on one.
    #[default]
    Any,
    /// 1 for the type that the shortest beam ends on; the rightmost wins a tie.
    Nearest,
    /// The share of beams that end on one.
    Share,
    /// "Wall" as in [`Self::Nearest`], "target" as in [`Self::Any`].
    NearestWallAnyTarget,
    /// On which side the target is, from -1 (right) to 1 (left), and 1 if any beam ends on it. A
    /// beam that ends on the target counts with its range: the way there is free. Ours; that
    /// something which is not the target is a wall, the distances say already.
    Bearing,
}

/// How readings become network inputs; recorded in the weight blob.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Encoding {
    /// How distances are normalised.
    pub distance: DistanceLaw,
    /// How hit types become two inputs.
    pub types: TypeCode,
}

impl Encoding {
    /// The network's seven inputs for beams of this range in metres, each in `0.0..=1.0` but for
    /// the side of [`TypeCode::Bearing`], which is in `-1.0..=1.0`.
    #[inline(always)]
    pub fn inputs<L: Lane>(self, sight: &Sight<L>, range: f32) -> [L; INPUTS] {
        let one = L::from(1.0);
        // Loops, not closures: see `activation::Rational::polynomial`.
        let mut scaled = sight.distance;
        if matches!(self.types, TypeCode::Bearing) {
            for (distance, target) in scaled.iter_mut().zip(&sight.target) {
                *distance = L::select(target.lt(one), *distance, L::from(range));
            }
        }
        match self.distance {
            DistanceLaw::Linear => {
                let scale = L::from(1.0 / range);
                for distance in &mut scaled {
                    *distance = (*distance * scale).min(one);
                }
            }
            DistanceLaw::Saturating { half } => {
                let half = L::from(half);
                for distance in &mut scaled {
                    *distance = *distance / (*distance + half);
                }
            }
        }
        let [a, b, c, d, e] = scaled;
        let (wall, target) = match self.types {
            TypeCode::Any => (any(&sight.wall), any(&sight.target)),
            TypeCode::Nearest => nearest(sight),
            TypeCode::Share => (share(&sight.wall), share(&sight.target)),
            TypeCode::NearestWallAnyTarget => (nearest(sight).0, any(&sight.target)),
            TypeCode::Bearing => (side(&sight.target), any(&sight.target)),
        };
        [a, b, c, d, e, wall, target]
    }
}

#[inline(always)]
fn any<L: Lane>(seen: &[L; BEAMS]) -> L {
    let mut any = L::from(0.0);
    for beam in seen {
        any = any.max(*beam);
    }
    any
}

#[inline(always)]
fn share<L: Lane>(seen: &[L; BEAMS]) -> L {
    let mut count = L::from(0.0);
    for beam in seen {
        count = count + *beam;
    }
    count * L::from(1.0 / BEAMS as f32)
}

/// The outer beams count twice, so that every beam on one side together makes 1.
#[inline(always)]
fn side<L: Lane>(seen: &[L; BEAMS]) -> L {
    let [outer_right, right, _, left, outer_left] = *seen;
    (outer_left - outer_right) * L::from(2.0 / 3.0) + (left - right) * L::from(1.0 / 3.0)
}

#[inline(always)]
fn nearest<L: Lane>(sight: &Sight<L>) -> (L, L) {
    let mut best = (L::from(f32::INFINITY), L::from(0.0), L::from(0.0));
    for ((distance, wall), target) in sight.distance.iter().zip(&sight.wall).zip(&sight.target) {
        let nearer = distance.lt(best.0);
        best = (
            L::select(nearer, *distance, best.0),
            L::select(nearer, *wall, best.1),
            L::select(nearer, *target, best.2),
        );
    }
    (best.1, best.2)
}

//! Everything a run depends on, checked and in SI units: the world, the car, its sensors,
//! the network's shape, how an episode goes, what it costs, and how evolution searches.
//!
//! A [`Scenario`] is always valid. What a person types (TOML, `--set`, `--preset`) is text;
//! turning it into a scenario is the only place that refuses.
//! Lengths are metres, angles radians, counter-clockwise positive (the ROS convention).
//!
//! | look in | for |
//! | --- | --- |
//! | [`find`], [`load`] | from a name or a path to a scenario, or all that is wrong with it |
//! | [`Setting`], [`Preset`] | what goes over and under a file |
//! | [`refuse`], [`Complaint`] | what a simulator finds wrong, printed with its place in the file |
//! | [`to_toml`], [`to_toml_beside_paper`] | back to a file, in full or what differs from the paper |
//! | [`generate`] | random worlds |
//! | `schema` | every key with its range: the list that reader, writer and README share |
//! | `check`, `polygon` | what must hold between keys |

mod catalogue;
mod check;
pub mod generate;
mod keys;
mod load;
mod number;
mod polygon;
mod preset;
mod problem;
#[cfg(test)]
mod properties;
mod reader;
#[cfg(test)]
mod refusals;
mod schema;
mod shapes;
pub(crate) mod shipped;
mod source;
mod value;
mod words;
mod writer;

use controller_core::activation::ActivationKind;
use controller_core::network::RecurrenceKind;
use controller_core::observation::{BEAMS, BeamMount, Encoding};
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

pub use crate::evolve::NoveltySpec;
pub use crate::evolve::ga::{GaSpec, Initial, Mutation, Selection};
pub use catalogue::{all_shipped, find};
pub use keys::{Key, all_keys};
pub use load::{Setting, load, refuse};
pub use preset::Preset;
pub use problem::Complaint;
pub use shipped::Entry;
pub use source::Source;
pub use words::words_of;
pub use writer::{to_toml, to_toml_beside_paper};

/// Longest name of a scenario, bytes.
const NAME_LENGTH: usize = 64;

/// Longest description of a scenario, characters.
const LINE_LENGTH: usize = 200;

/// A complete, valid description of what to train or judge a controller on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Scenario {
    /// Short name; also the default name of a run folder. Letters, digits, `-` and `_`.
    pub name: String,
    /// One line for people.
    pub description: String,
    /// Obstacles and target.
    pub world: WorldSpec,
    /// The car's body and its steering.
    pub vehicle: VehicleSpec,
    /// The beams and how they become the seven inputs.
    pub sensors: SensorSpec,
    /// The network's shape.
    pub network: NetworkSpec,
    /// How one drive goes and ends.
    pub episode: EpisodeSpec,
    /// What drives cost.
    pub fitness: FitnessSpec,
    /// The start poses and goals that training drives.
    pub pairs: PairSpec,
    /// The search.
    pub training: TrainingSpec,
}

/// Obstacles, the room around them, and the size of the target.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WorldSpec {
    /// The room; starts and goals are drawn inside it.
    pub bounds: Bounds,
    /// Whether the room's edge is a wall.
    pub outer_wall: bool,
    /// Radius of the target disc, metres, above 0.
    pub target_radius: f32,
    /// Solid axis-aligned boxes `[x0, y0, x1, y1]`, `x0 < x1`, `y0 < y1`.
    pub boxes: Vec<[f32; 4]>,
    /// Solid simple polygons, at least three corners each, either orientation.
    pub polygons: Vec<Vec<[f32; 2]>>,
    /// Solid discs.
    pub circles: Vec<Circle>,
    /// Walls along a line of points, with a thickness (0 is allowed: a sheet).
    pub walls: Vec<Wall>,
    /// An occupancy grid in the format of ROS `map_server`.
    pub map: Option<MapSpec>,
}

/// An axis-aligned rectangle, metres.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bounds {
    /// Lower left corner.
    pub min: [f32; 2],
    /// Upper right corner.
    pub max: [f32; 2],
}

/// A solid disc.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Circle {
    /// Centre, metres.
    pub centre: [f32; 2],
    /// Radius, metres, above 0.
    pub radius: f32,
}

/// A wall along an open line of points.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Wall {
    /// At least two points, no two neighbours equal.
    pub points: Vec<[f32; 2]>,
    /// Full thickness in metres, 0 or more; the line is the middle.
    pub thickness: f32,
}

/// An occupancy grid and how to read it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MapSpec {
    /// The map's YAML file, as found (relative paths are relative to the scenario file).
    pub yaml: std::path::PathBuf,
    /// Whether unknown cells are obstacles.
    pub unknown_is_obstacle: bool,
    /// Cells at or above this occupancy (0 to 100) are obstacles. `map_server` publishes
    /// 100 for occupied cells in every mode, so 100 is the usual choice.
    pub lethal: u8,
}

/// The car's body and its steering. The reference point is the middle of the front axle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct VehicleSpec {
    /// Body length, metres.
    pub length: f32,
    /// Body width, metres.
    pub width: f32,
    /// Distance from the front axle to the front bumper, metres, within `0..=length`.
    pub front_overhang: f32,
    /// Distance between the axles, metres.
    pub wheelbase: f32,
    /// How far the car moves in one control period.
    pub step: StepLength,
    /// Largest steer angle, radians, above 0 and at most π/2.
    pub steer_limit: f32,
    /// How fast the steering servo turns, radians per second; none means at once.
    pub servo_rate: Option<f32>,
    /// Whole control periods between deciding and acting, at most
    /// [`VehicleSpec::MAX_DELAY`].
    pub delay_periods: u8,
}

impl VehicleSpec {
    /// Longest actuator delay, control periods.
    pub const MAX_DELAY: u8 = 8;

    /// The same car with a body that is so many metres larger on every side (a *footprint padding*,
    /// as costmaps of ROS call it).
    #[must_use]
    pub fn padded(&self, by: f32) -> Self {
        Self {
            length: self.length + 2.0 * by,
            width: self.width + 2.0 * by,
            front_overhang: self.front_overhang + by,
            ..self.clone()
        }
    }
}

/// Distance per control period, metres.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum StepLength {
    /// Constant speed (the paper's experiments).
    Constant(f32),
    /// Chosen each period by a second output neuron (paper, end of section 3).
    Variable {
        /// At output −1.
        lower: f32,
        /// At output +1.
        upper: f32,
    },
}

impl std::fmt::Display for StepLength {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Constant(step) => write!(f, "{step} m"),
            Self::Variable { lower, upper } => write!(f, "{lower} to {upper} m"),
        }
    }
}

/// The beams and how they become the seven inputs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SensorSpec {
    /// Where each beam starts and points, in the frame of the front axle, rightmost first.
    pub beams: [BeamMount; BEAMS],
    /// Longest distance a beam reports, metres.
    pub range: f32,
    /// How readings become network inputs.
    pub encoding: Encoding,
    /// Standard deviation of Gaussian distance noise, metres; 0 is none.
    pub noise: f32,
    /// Probability that a beam misses its echo and reads "nothing in range".
    pub dropout: f32,
}

/// The network's shape: 7 inputs, two hidden layers, one output, or two with
/// [`StepLength::Variable`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct NetworkSpec {
    /// Neurons in each hidden layer, one of [`NetworkSpec::HIDDEN`].
    pub hidden: u8,
    /// What a hidden neuron remembers.
    pub recurrence: RecurrenceKind,
    /// Whether neurons have biases (the paper's have none).
    pub biases: bool,
    /// The activation of every neuron.
    pub activation: ActivationKind,
}

impl NetworkSpec {
    /// Hidden-layer sizes this build can train.
    pub const HIDDEN: [u8; 4] = [12, 16, 24, 32];
}

/// How one drive goes and ends.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct EpisodeSpec {
    /// Control periods before an episode ends unreached.
    pub step_limit: u32,
    /// Control period, seconds.
    pub period: f32,
    /// What a collision does.
    pub on_collision: OnCollision,
    /// What counts as touching the target.
    pub reached_by: ReachedBy,
    /// Largest random shift of a start, metres in x and in y.
    pub start_offset: f32,
    /// Largest random turn of a start, radians.
    pub start_turn: f32,
    /// How far the simulated car may differ from the described one; drawn per episode.
    pub randomise: RandomiseSpec,
}

/// What a collision does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum OnCollision {
    /// The position is kept for that step, the heading still follows the steering, and
    /// the collision is counted (the paper presets).
    Hold,
    /// The episode ends.
    Stop,
}

/// What counts as touching the target.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ReachedBy {
    /// The body rectangle touches the target disc.
    Body,
    /// The reference point lies in the target disc (BARN and most benchmarks).
    ReferencePoint,
}

/// Half-widths of uniform distributions around the described car; 0 is off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RandomiseSpec {
    /// Relative deviation of the wheelbase, `0.0..1.0`.
    pub wheelbase: f32,
    /// Relative deviation of the step length, `0.0..1.0`.
    pub step: f32,
    /// Constant steering error, radians.
    pub steer_offset: f32,
}

/// What drives cost, minimised.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FitnessSpec {
    /// Which of the following weights count.
    pub kind: FitnessKind,
    /// c1: per metre between robot and target at the end.
    pub distance: f32,
    /// c2: per metre driven.
    pub length: f32,
    /// c3: per collision.
    pub collision: f32,
    /// B: taken off when the target is reached.
    pub bonus: f32,
    /// What a clean drive costs that takes all of its time, `0.0..=0.5`.
    pub time: f32,
    /// What another drive saves that ends in the middle of the target, `0.0..=0.5`.
    pub progress: f32,
}

/// Which cost it is; [`crate::fitness`] says what each one is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FitnessKind {
    /// `F = c1·DTT + c2·LT + c3·C − B·[reached]` (paper, eq. 3).
    Paper,
    /// Reaching clean comes first, then time or nearness.
    ReachedFirst,
}

/// The start poses and goals that training drives.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PairSpec {
    /// Where they come from.
    pub source: PairSource,
    /// Smallest distance between start and goal of a drawn pair, metres.
    pub min_distance: f32,
    /// How many are drawn in the last generation, reached by equal ratios; none keeps the number.
    /// None for pairs that are not drawn anew.
    pub count_end: Option<u32>,
    /// Share of a generation's pairs that the next one keeps: those that the fewest individuals
    /// drove clean, but some did. 0 for pairs that are not drawn anew.
    pub mine: f32,
}

impl PairSpec {
    /// Pairs that are drawn unless a scenario says otherwise (paper, section 3).
    pub const DRAWN: u32 = 5;
}

/// Where start/goal pairs come from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PairSource {
    /// Drawn from the run's seed, once or anew each generation.
    Drawn {
        /// How many, at least 1.
        count: u32,
        /// Whether each generation draws new ones.
        resample: bool,
    },
    /// Written in the scenario, at least 1.
    Listed(Vec<Pair>),
}

/// One task: start here, reach that.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pair {
    /// Start pose of the front axle: x, y, heading.
    pub start: [f32; 3],
    /// Centre of the target disc.
    pub goal: [f32; 2],
}

impl TrainingSpec {
    /// Individuals that a search may have.
    pub const POPULATION: RangeInclusive<u32> = 2..=1_000_000;
    /// Islands that a search may have.
    pub const ISLANDS: RangeInclusive<u32> = 1..=64;
    /// Generations that a run may have.
    pub const GENERATIONS: RangeInclusive<u32> = 1..=1_000_000;

    /// Share of drives under stress at this [progress](crate::evolve::ga::progress) of the run.
    pub fn stressed_share_at(&self, progress: f64) -> f64 {
        let [start, end] = [self.stressed_share_start, self.stressed_share].map(f64::from);
        start + (end - start) * progress
    }

    /// Individuals of the first generation: of all islands.
    pub fn individuals(&self) -> u64 {
        u64::from(self.population) * u64::from(self.islands)
    }

    /// `100 individuals`, or `6 islands of 100 individuals`.
    pub fn individuals_in_words(&self) -> String {
        let Self { population, islands, .. } = self;
        match islands {
            1 => format!("{population} individuals"),
            _ => format!("{islands} islands of {population} individuals"),
        }
    }

    /// Whether any drives are under stress.
    pub fn has_stress(&self) -> bool {
        self.stressed_share > 0.0 || self.stressed_share_start > 0.0
    }
}

fn is_zero_count(count: &u32) -> bool {
    *count == 0
}

fn one() -> u32 {
    1
}

fn is_one(count: &u32) -> bool {
    *count == 1
}

fn is_zero(value: &f32) -> bool {
    *value == 0.0
}

/// Random worlds that a run makes for itself from its seed, as [`generate`] does. Their sizes and
/// densities differ; car, sensors, target and rules are the scenario's.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WorldsSpec {
    /// How many with scattered boxes.
    pub boxes: u32,
    /// How many with round pillars.
    pub pillars: u32,
    /// How many with rooms and doors.
    pub rooms: u32,
    /// How many with a field of thin cylinders like BARN's.
    pub barn_like: u32,
    /// How many with thin walls that make passages and dead ends.
    #[serde(default, skip_serializing_if = "is_zero_count")]
    pub partitions: u32,
    /// Shortest and longest side, metres.
    pub side: [f32; 2],
    /// Generations after which a new world takes the place of an old one, each place in its turn;
    /// 0 keeps all.
    #[serde(default, skip_serializing_if = "is_zero_count")]
    pub renew_every: u32,
    /// The champion is whoever of the last generation does best in so many times as many other worlds,
    /// in which nobody was trained; 0 has it chosen in the worlds of training.
    #[serde(default, skip_serializing_if = "is_zero_count")]
    pub held_out: u32,
}

impl WorldsSpec {
    /// No world yet, of usual sides.
    pub const NONE: Self = Self {
        boxes: 0,
        pillars: 0,
        rooms: 0,
        barn_like: 0,
        partitions: 0,
        side: [8.0, 16.0],
        renew_every: 0,
        held_out: 0,
    };

    /// Most worlds in all, at a time: a large one may take 90 MB once a car has been everywhere.
    pub const MOST: u32 = 64;

    /// How many of each kind, in the order of [`generate::Kind::ALL`].
    pub fn counts(&self) -> [u32; generate::Kind::ALL.len()] {
        [self.boxes, self.pillars, self.rooms, self.barn_like, self.partitions]
    }

    /// How many worlds there are to train in at a time.
    pub fn total(&self) -> u32 {
        self.counts().iter().sum()
    }

    /// In how many worlds the pairs lie that choose the champion.
    pub fn choosing(&self) -> u32 {
        self.total() * self.held_out.max(1)
    }
}

/// The search.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TrainingSpec {
    /// Individuals, at least 2; of each island, if there are several.
    pub population: u32,
    /// Populations that evolve apart from each other, of which all but one are
    /// [given up](crate::evolve::islands) on the way.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub islands: u32,
    /// Generations to run, at least 1.
    pub generations: u32,
    /// Weights are drawn in, and kept in, `-bound..=bound`.
    pub weight_bound: f32,
    /// Pairs, drawn for this alone, on which the best of each generation compete to be the
    /// champion; 0 takes the best of the last generation. No matter for listed pairs.
    pub validation_pairs: u32,
    /// Share of the last generation's drives, and of those that choose the champion, that are
    /// made with a car as imperfect as [stress](crate::stress::in_full) makes it.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub stressed_share: f32,
    /// The same share of the first generation's drives; between the two it changes evenly.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub stressed_share_start: f32,
    /// Whether cars under stress take turns: every other one has all of it, of the rest one [lacks](crate::stress::in_full_but)
    /// the dead time, and the next the slow servo.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub stress_in_turns: bool,
    /// Every other drive of training, and of those that choose the champion, is made with a body
    /// that is so many metres larger on every side; pairs are drawn for the car as it is.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub footprint_padding: f32,
    /// Whether the run ends with the first generation in which somebody reaches the targets of
    /// all pairs.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub until_reached: bool,
    /// Random worlds to train in instead of the scenario's own; none trains in that.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub worlds: Option<WorldsSpec>,
    /// The genetic algorithm.
    pub ga: GaSpec,
    /// How novelty is measured, if that is what selects; none selects by cost.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub novelty: Option<NoveltySpec>,
}

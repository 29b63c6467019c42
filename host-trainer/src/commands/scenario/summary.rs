//! What a scenario is, in a few lines.

use std::path::PathBuf;

use serde::Serialize;

use controller_core::observation::BEAMS;

use crate::car::body_of;
use crate::map;
use crate::output::Output;
use crate::problem::Problem;
use crate::scenario::{MapSpec, OnCollision, PairSource, Scenario, StepLength, words_of};
use crate::world::free_space::{FreeSpace, Part};

/// Parts of the free space below this share of the room are not worth mentioning.
const SMALL: f32 = 0.005;

/// What `scenario check --json` prints.
#[derive(Debug, Serialize)]
pub(super) struct Summary {
    name: String,
    description: String,
    /// Width and height, metres.
    size_m: [f32; 2],
    outer_wall: bool,
    map: Option<Map>,
    /// Straight walls of everything solid.
    walls: usize,
    discs: usize,
    /// Share of the room in which the car's middle can be; none in a room too large to tell.
    free_share: Option<f32>,
    /// The same for each connected part, the largest first, without tiny ones.
    parts: Vec<f32>,
    target_radius_m: f32,
    car: Car,
    sensors: Sensors,
    /// How many pairs training drives in the first generation.
    pairs: u32,
    /// How many in the last.
    pairs_end: u32,
    /// `listed`, `drawn`, or `drawn anew each generation`.
    pairs_are: &'static str,
    min_distance_m: f32,
    network: String,
    /// Weights to search for.
    genome_length: usize,
    step_limit: u32,
    period_s: f32,
    on_collision: &'static str,
    population: u32,
    /// Populations at the beginning; one is left in the end.
    islands: u32,
    #[serde(skip)]
    individuals_in_words: String,
    generations: u32,
    /// Steps of a training run whose every drive goes on to the limit, and of whose islands none leaves.
    most_steps: u64,
}

#[derive(Debug, Serialize)]
struct Car {
    length_m: f32,
    width_m: f32,
    wheelbase_m: f32,
    steer_limit_deg: f32,
    /// Least and most per control period; the same for a constant step.
    step_m: [f32; 2],
    period_s: f32,
}

impl Car {
    fn of(Scenario { vehicle, episode, .. }: &Scenario) -> Self {
        Self {
            length_m: vehicle.length,
            width_m: vehicle.width,
            wheelbase_m: vehicle.wheelbase,
            steer_limit_deg: in_degrees(vehicle.steer_limit),
            step_m: match vehicle.step {
                StepLength::Constant(step) => [step; 2],
                StepLength::Variable { lower, upper } => [lower, upper],
            },
            period_s: episode.period,
        }
    }

    fn in_words(&self) -> String {
        let Self { length_m, width_m, wheelbase_m, steer_limit_deg, period_s, .. } = self;
        let step = match self.step_m {
            [lower, upper] if lower == upper => format!("{upper} m"),
            [lower, upper] => format!("{lower} to {upper} m"),
        };
        format!(
            "{length_m} m × {width_m} m, wheelbase {wheelbase_m} m, steers up to {steer_limit_deg}°, drives {step} in {period_s} s"
        )
    }
}

#[derive(Debug, Serialize)]
struct Sensors {
    /// Rightmost first.
    beams_deg: [f32; BEAMS],
    range_m: f32,
    /// How readings become inputs: distances, then types.
    encoding: String,
}

impl Sensors {
    fn of(Scenario { sensors, .. }: &Scenario) -> Self {
        Self {
            beams_deg: sensors.beams.map(|beam| in_degrees(beam.angle)),
            range_m: sensors.range,
            encoding: words_of(&sensors.encoding),
        }
    }

    fn in_words(&self) -> String {
        let beams = self.beams_deg.map(|degrees| format!("{degrees}°")).join(", ");
        format!("beams at {beams}, range {} m; {}", self.range_m, self.encoding)
    }
}

/// To a hundredth of a degree: more digits are those of the radians.
fn in_degrees(radians: f32) -> f32 {
    let degrees = (f64::from(radians).to_degrees() * 100.0).round() / 100.0;
    // No minus before a zero.
    (degrees + 0.0) as f32
}

#[derive(Debug, Serialize)]
struct Map {
    yaml: PathBuf,
    /// Columns and rows.
    cells: [u32; 2],
    resolution_m: f64,
    unknown_is_obstacle: bool,
}

impl Map {
    /// None if it cannot be read, which has been shown before.
    fn of(spec: &MapSpec) -> Option<Self> {
        let found = map::load(&spec.yaml).ok()?;
        Some(Self {
            yaml: spec.yaml.clone(),
            cells: [found.width, found.height],
            resolution_m: found.resolution,
            unknown_is_obstacle: spec.unknown_is_obstacle,
        })
    }
}

impl Summary {
    pub(super) fn of(problem: &Problem) -> Self {
        let Scenario { name, description, world, episode, pairs, training, .. } = &problem.scenario;
        let body = body_of(&problem.scenario.vehicle);
        let parts = FreeSpace::new(&problem.world, body.half_width).parts(&problem.world);
        let shares = || parts.iter().map(|Part { share, .. }| *share);
        let (pairs_are, count) = match &pairs.source {
            PairSource::Listed(list) => ("listed", list.len() as u32),
            PairSource::Drawn { count, resample: false } => ("drawn", *count),
            PairSource::Drawn { count, resample: true } => ("drawn anew each generation", *count),
        };
        let pairs_end = pairs.count_end.unwrap_or(count);
        let most_steps = [training.generations, count.max(pairs_end), episode.step_limit]
            .into_iter()
            .fold(training.individuals(), |product, factor| {
                product.saturating_mul(u64::from(factor))
            });
        Self {
            name: name.clone(),
            description: description.clone(),
            size_m: world.bounds.size(),
            outer_wall: world.outer_wall,
            map: world.map.as_ref().and_then(Map::of),
            walls: problem.world.segments().len(),
            discs: problem.world.discs().len(),
            free_share: (!parts.is_empty()).then(|| shares().sum()),
            parts: shares().filter(|share| *share >= SMALL).collect(),
            target_radius_m: world.target_radius,
            car: Car::of(&problem.scenario),
            sensors: Sensors::of(&problem.scenario),
            pairs: count,
            pairs_end,
            pairs_are,
            min_distance_m: pairs.min_distance,
            network: problem.topology().to_string(),
            genome_length: problem.topology().weights(),
            step_limit: episode.step_limit,
            period_s: episode.period,
            on_collision: match episode.on_collision {
                OnCollision::Hold => "hold",
                OnCollision::Stop => "stop",
            },
            population: training.population,
            islands: training.islands,
            individuals_in_words: training.individuals_in_words(),
            generations: training.generations,
            most_steps,
        }
    }

    pub(super) fn print(&self, output: &mut Output) {
        output.line(format_args!("{}: {}", self.name, self.description));
        let mut row = |label: &str, text: String| output.line(format_args!("  {label:<11} {text}"));
        let [width, height] = self.size_m;
        let wall = if self.outer_wall { "with an outer wall" } else { "without an outer wall" };
        row("room", format!("{width} m × {height} m, {wall}"));
        if let Some(Map { cells: [columns, rows], resolution_m, unknown_is_obstacle, yaml }) =
            &self.map
        {
            let unknown = if *unknown_is_obstacle { "solid" } else { "free" };
            row("map", yaml.display().to_string());
            row(
                "",
                format!(
                    "{columns} × {rows} cells of {resolution_m} m, unknown cells are {unknown}"
                ),
            );
        }
        row("obstacles", format!("{} straight walls, {} discs", self.walls, self.discs));
        row("free", self.free());
        row("target", format!("{} m radius", self.target_radius_m));
        row("car", self.car.in_words());
        row("sensors", self.sensors.in_words());
        row("pairs", self.pairs());
        row("network", format!("{}, {} weights", self.network, self.genome_length));
        let on_collision = match self.on_collision {
            "hold" => "a collision holds the car for the step",
            _ => "a collision ends the drive",
        };
        row(
            "episode",
            format!("at most {} steps of {} s; {on_collision}", self.step_limit, self.period_s),
        );
        row(
            "training",
            format!(
                "{} × {} generations × {}: at most {} steps",
                self.individuals_in_words,
                self.generations,
                self.pairs_at_a_time(),
                rounded(self.most_steps)
            ),
        );
    }

    fn pairs_at_a_time(&self) -> String {
        let last = counted(self.pairs_end, "pair");
        if self.pairs == self.pairs_end { last } else { format!("{} to {last}", self.pairs) }
    }

    fn free(&self) -> String {
        let Some(free) = self.free_share else {
            return "unknown: the room is too large, or too full, for a map of it".to_owned();
        };
        let share = |share: f32| format!("{:.1} %", share * 100.0);
        match self.parts.as_slice() {
            [] | [_] => format!("{} of the room, for the car's middle", share(free)),
            [main, others @ ..] => format!(
                "{} of the room, for the car's middle, in {} parts; the largest has {}",
                share(free),
                1 + others.len(),
                share(*main)
            ),
        }
    }

    fn pairs(&self) -> String {
        let Self { pairs, pairs_are, min_distance_m, .. } = self;
        match *pairs_are {
            "listed" => format!("{pairs} listed"),
            _ => format!("{pairs} {pairs_are}, at least {min_distance_m} m apart"),
        }
    }
}

/// A number of things: `1 pair`, `5 pairs`.
pub(super) fn counted(count: u32, thing: &str) -> String {
    let ending = if count == 1 { "" } else { "s" };
    format!("{count} {thing}{ending}")
}

/// A count with the two or three digits that matter: `21.6 million`.
fn rounded(count: u64) -> String {
    let scaled = |unit: f64, name: &str| format!("{:.1} {name}", count as f64 / unit);
    match count {
        0..100_000 => count.to_string(),
        100_000..1_000_000_000 => scaled(1e6, "million"),
        _ => scaled(1e9, "billion"),
    }
}

//! `evosteer scenario import`: a ROS map becomes a scenario.

mod fit;
mod path;
mod room;
mod text;

use super::drawing::draw;
use super::summary::counted;
use super::written::{picture_beside, refuse_existing, write_all};
use crate::failure::Failure;
use crate::map::{self, OccupancyMap};
use crate::output::Output;
use crate::problem::Problem;
use crate::scenario::{self, Preset, Scenario, Setting, Source};
use crate::seed::RunSeed;
use fit::Fit;
use room::{Choice, Room};
use serde::Serialize;
use std::path::{Path, PathBuf};
use text::Draft;

/// How many unseen pairs the picture shows.
const PAIRS: u32 = 5;

/// Makes a scenario of a ROS map, and draws it
///
/// Reads the YAML file and the PGM or PNG image that it names, as map_server does. Room, target,
/// pairs and step limit are chosen to fit the map; all of them can be changed in the scenario
/// file.
#[derive(Clone, Debug, clap::Args)]
pub(super) struct ImportArgs {
    /// The map's YAML file
    #[arg(value_name = "MAP.yaml")]
    map: PathBuf,

    /// The scenario file, named after the map if not given; the picture goes beside it
    #[arg(long, value_name = "FILE.toml")]
    out: Option<PathBuf>,

    /// Name of the scenario; that of its file if not given
    #[arg(long)]
    name: Option<String>,

    /// What unknown cells are
    #[arg(long, value_enum, default_value_t = Unknown::Obstacle)]
    unknown: Unknown,

    /// Occupancy from which a cell is solid, percent; matters for maps of mode scale or raw
    #[arg(long, default_value_t = 100, value_parser = clap::value_parser!(u8).range(1..=100))]
    lethal: u8,

    /// Which part of the map is the room
    #[arg(long, value_enum, default_value_t = Choice::Auto)]
    room: Choice,

    /// Replace the files if they exist
    #[arg(long)]
    force: bool,

    /// Print the result as one JSON object
    #[arg(long)]
    pub(super) json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Unknown {
    /// Solid: nobody has seen that one can drive there
    Obstacle,
    /// Free
    Free,
}

#[derive(Debug, Serialize)]
struct Report {
    name: String,
    scenario: String,
    picture: String,
    image: String,
    /// Columns and rows.
    cells: [u32; 2],
    resolution_m: f64,
    origin: [f64; 3],
    occupied_share: f64,
    unknown_share: f64,
    walls: usize,
    loops: usize,
    room_is: &'static str,
    room_m: [[f32; 2]; 2],
    target_radius_m: f32,
    min_distance_m: f32,
    step_limit: u32,
    warnings: Vec<String>,
}

/// Imports a map.
///
/// # Errors
///
/// A map that is refused, with its place; a map in which a car finds no pair to drive; files
/// that exist or cannot be written.
pub(super) fn run(args: &ImportArgs, output: &mut Output) -> Result<(), Failure> {
    let file = args.out.clone().unwrap_or_else(|| {
        PathBuf::from(args.map.file_stem().unwrap_or(args.map.as_os_str())).with_extension("toml")
    });
    let picture = picture_beside(&file)?;
    refuse_existing(&[&file, &picture], args.force)?;
    let map = map::load(&args.map)?;
    let mut warnings: Vec<String> =
        map.unknown_keys.iter().map(|key| format!("{}: {key}", args.map.display())).collect();

    let mut draft = Draft {
        yaml: path::from_to(&file, &args.map)?,
        source: path::name_of(&args.map),
        unknown_is_obstacle: args.unknown == Unknown::Obstacle,
        lethal: args.lethal,
        cells: [map.width, map.height],
        resolution: map.resolution,
        room: None,
        fit: Fit::default(),
    };
    let whole = problem_of(&draft, &file, args)?;
    let loops = whole.world.outlines();
    print_map(&map, &args.map, &loops, output);
    let room = Room::choose(&whole, &map, args.room)?;
    draft.room = room.bounds;
    warnings.extend(room.warning);
    let problem = fit::fit(&whole.scenario, room.bounds.unwrap_or(whole.world.bounds), |fit| {
        draft.fit = fit;
        problem_of(&draft, &file, args)
    })?;
    warnings.extend(room::starts_off_map(&problem, &map));
    let scenario = &problem.scenario;
    let svg = draw(&problem, PAIRS, RunSeed(1))?;
    let text = draft.text(&scenario.name);
    write_all(&[(&file, &text), (&picture, &svg)], args.force)?;

    for warning in &warnings {
        output.warning(warning);
    }
    let [width, height] = scenario.world.bounds.size();
    output.line(format_args!("  room {width:.2} m × {height:.2} m: {}", room.why));
    output.line(format_args!("wrote {} and {}", file.display(), picture.display()));
    output.line(format_args!("next: evosteer train {}", file.display()));
    let share = |wanted: fn(i8) -> bool| share(&map, wanted);
    output.json(&Report {
        name: scenario.name.clone(),
        scenario: file.display().to_string(),
        picture: picture.display().to_string(),
        image: map.image.display().to_string(),
        cells: [map.width, map.height],
        resolution_m: map.resolution,
        origin: map.origin,
        occupied_share: share(|cell| cell == map::OCCUPIED),
        unknown_share: share(|cell| cell == map::UNKNOWN),
        walls: loops.iter().map(Vec::len).sum(),
        loops: loops.len(),
        room_is: room.kind,
        room_m: [scenario.world.bounds.min, scenario.world.bounds.max],
        target_radius_m: scenario.world.target_radius,
        min_distance_m: scenario.pairs.min_distance,
        step_limit: scenario.episode.step_limit,
        warnings,
    });
    Ok(())
}

/// The scenario of a draft as `train` will load it, built.
fn problem_of(draft: &Draft, file: &Path, args: &ImportArgs) -> Result<Problem, Failure> {
    let folder = file.parent().unwrap_or(Path::new(""));
    let source = Source::new(file.to_string_lossy(), draft.settings(), folder);
    let quoted =
        |name: &String| Setting::option("--name", "name", toml::Value::from(name.as_str()));
    let settings: Vec<Setting> = args.name.iter().map(quoted).collect();
    let scenario: Scenario = scenario::load(&source, Some(Preset::Paper), &settings)?;
    Problem::new(scenario)
}

fn print_map(map: &OccupancyMap, yaml: &Path, loops: &[Vec<[f32; 2]>], output: &mut Output) {
    let percent = |wanted: fn(i8) -> bool| 100.0 * share(map, wanted);
    let [x, y, yaw] = map.origin;
    output.line(format_args!(
        "read {}: {}×{} px at {} m, origin ({x}, {y}), yaw {yaw}",
        yaml.display(),
        map.width,
        map.height,
        map.resolution
    ));
    output.line(format_args!(
        "  {:.1} % of the cells occupied, {:.1} % unknown",
        percent(|cell| cell == map::OCCUPIED),
        percent(|cell| cell == map::UNKNOWN)
    ));
    let walls: u32 = loops.iter().map(|corners| corners.len() as u32).sum();
    output.line(format_args!(
        "  outline: {} in {}",
        counted(walls, "straight wall"),
        counted(loops.len() as u32, "loop")
    ));
}

fn share(map: &OccupancyMap, wanted: fn(i8) -> bool) -> f64 {
    map.cells.iter().filter(|cell| wanted(**cell)).count() as f64 / map.cells.len() as f64
}

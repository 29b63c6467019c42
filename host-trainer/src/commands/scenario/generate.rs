//! `evosteer scenario generate`: a random world from a seed.

use super::drawing::draw;
use super::written::{picture_beside, refuse_existing, write_all};
use crate::failure::Failure;
use crate::output::Output;
use crate::problem::Problem;
use crate::scenario::generate::{Kind, Recipe};
use crate::seed::RunSeed;
use serde::Serialize;
use std::path::PathBuf;

/// How many unseen pairs the picture shows.
const PAIRS: u32 = 3;

/// Makes a random world from a seed, as a scenario file and a picture
#[derive(Clone, Debug, clap::Args)]
pub(super) struct GenerateArgs {
    /// The same seed gives the same world
    #[arg(long)]
    seed: RunSeed,

    /// What stands in it: boxes, pillars, rooms, barn-like or partitions
    #[arg(long, default_value_t = Kind::Boxes, value_name = "KIND")]
    kind: Kind,

    /// Width and height, metres
    #[arg(long, default_value = "10x10", value_parser = parse_size, value_name = "WxH")]
    size: Size,

    /// Share of the room that is to be solid; what suits the kind if not given
    #[arg(long, value_name = "SHARE")]
    density: Option<f32>,

    /// The scenario file, named after kind and seed if not given; the picture goes beside it
    #[arg(long, value_name = "FILE.toml")]
    out: Option<PathBuf>,

    /// Replace the files if they exist
    #[arg(long)]
    force: bool,

    /// Print the result as one JSON object
    #[arg(long)]
    pub(super) json: bool,
}

/// Width and height, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Size([f32; 2]);

fn parse_size(text: &str) -> Result<Size, String> {
    let sides = text.split_once(['x', '×']);
    let metres = |side: &str| side.trim().parse::<f32>().ok().filter(|side| side.is_finite());
    sides
        .and_then(|(width, height)| Some(Size([metres(width)?, metres(height)?])))
        .ok_or_else(|| "expected width and height in metres, such as 12x8".to_owned())
}

#[derive(Debug, Serialize)]
struct Report<'a> {
    name: &'a str,
    description: &'a str,
    kind: String,
    seed: RunSeed,
    size_m: [f32; 2],
    density: f32,
    scenario: String,
    picture: String,
}

/// Generates a world.
///
/// # Errors
///
/// A size or density out of range, or files that exist or cannot be written.
pub(super) fn run(args: &GenerateArgs, output: &mut Output) -> Result<(), Failure> {
    let density = args.density.unwrap_or_else(|| args.kind.usual_density());
    let recipe = Recipe { kind: args.kind, seed: args.seed, size: args.size.0, density };
    let scenario = recipe.scenario()?;
    let named = || PathBuf::from(format!("{}.toml", scenario.name));
    let file = args.out.clone().unwrap_or_else(named);
    let picture = picture_beside(&file)?;
    refuse_existing(&[&file, &picture], args.force)?;
    let text = recipe.toml()?;
    let problem = Problem::new(scenario)?;
    let svg = draw(&problem, PAIRS, RunSeed(1))?;
    write_all(&[(&file, &text), (&picture, &svg)], args.force)?;
    let scenario = &problem.scenario;
    output.line(format_args!("{}: {}", scenario.name, scenario.description));
    output.line(format_args!("wrote {} and {}", file.display(), picture.display()));
    output.line(format_args!("next: evosteer train {}", file.display()));
    output.json(&Report {
        name: &scenario.name,
        description: &scenario.description,
        kind: args.kind.to_string(),
        seed: args.seed,
        size_m: args.size.0,
        density,
        scenario: file.display().to_string(),
        picture: picture.display().to_string(),
    });
    Ok(())
}

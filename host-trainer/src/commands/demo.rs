//! `evosteer demo`: something drives before anything was trained.

use super::film::Film;
use super::setup::{ScenarioOptions, WhichPairs, problem_for};
use crate::champion::shipped::{CHAMPIONS, Champion, scenes};
use crate::failure::Failure;
use crate::output::Output;

/// Drives a shipped champion and writes an animated page that opens offline
///
/// The champions and how they were made lie in `champions/` of the repository.
#[derive(Clone, Debug, clap::Args)]
pub struct DemoArgs {
    /// The scene whose champion drives
    #[arg(default_value = CHAMPIONS[0].scene, value_parser = parse_scene)]
    scene: String,

    #[command(flatten)]
    film: Film,

    /// Print the result as one JSON object
    #[arg(long)]
    pub json: bool,
}

fn parse_scene(text: &str) -> Result<String, String> {
    match Champion::of(text) {
        Some(champion) => Ok(champion.scene.to_owned()),
        None => Err(format!("expected a scene with a shipped champion: {}", scenes())),
    }
}

/// Drives the champion of a scene there.
///
/// # Errors
///
/// A page that cannot be written.
pub fn run(args: &DemoArgs, output: &mut Output) -> Result<(), Failure> {
    let Film { pairs, seed, .. } = args.film;
    args.film.check_page()?;
    let champion = Champion::of(&args.scene).expect("the parser knows it");
    let steps = format!("episode.step_limit={}", champion.step_limit());
    let options = ScenarioOptions { set: vec![steps], ..ScenarioOptions::default() };
    let champion = champion.file();
    let (problem, replaced) = problem_for(&champion, &args.scene, &options, output)?;
    let drawn = WhichPairs { listed: false };
    let pairs = drawn.pairs(&problem, &args.scene, &options, pairs, seed)?;
    args.film.shoot(&champion, &problem, &pairs, replaced, output)
}

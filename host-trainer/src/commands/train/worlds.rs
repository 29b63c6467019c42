//! The random worlds of a run in its folder, as scenarios to drive in and as pictures.

use crate::failure::Failure;
use crate::picture;
use crate::problem::Problem;
use crate::report::tasks_svg;
use crate::run_folder::RunFolder;
use crate::training::Training;

/// Writes every world that the run makes for itself in this generation; nothing if it drives in the
/// scenario's own.
///
/// # Errors
///
/// A file that cannot be written.
pub(super) fn write(
    folder: &RunFolder,
    training: &Training<'_>,
    generation: u32,
) -> Result<(), Failure> {
    for recipe in training.worlds_in(generation)? {
        let problem = Problem::new(recipe.scenario()?)?;
        let svg = tasks_svg(&picture::scene(&problem), &picture::body(&problem), &[]);
        let name = &problem.scenario.name;
        for (ending, text) in [("toml", recipe.toml()?), ("svg", svg)] {
            folder.write(&format!("{}/{name}.{ending}", RunFolder::WORLDS), text.as_bytes())?;
        }
    }
    Ok(())
}

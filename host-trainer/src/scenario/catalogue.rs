//! Finds a scenario by what a person types: a name or a path.

use std::path::Path;

use super::shipped::{ENTRIES, Entry};
use super::source::Source;
use super::words::{listed, nearest};
use crate::failure::Failure;

/// The scenarios that come with the program, the paper's first.
pub fn all_shipped() -> &'static [Entry] {
    ENTRIES
}

/// The scenario of this name, or the file at this path; names of shipped scenarios come first.
///
/// # Errors
///
/// Bad input for a name that is neither, with the names there are; otherwise those of
/// [`Source::read`].
pub fn find(name_or_path: &str) -> Result<Source, Failure> {
    if let Some(entry) = ENTRIES.iter().find(|entry| entry.name == name_or_path) {
        return Ok(Source::shipped(entry));
    }
    let path = Path::new(name_or_path);
    let looks_like_a_file = path.components().count() > 1 || path.extension().is_some();
    if looks_like_a_file || path.exists() {
        return Source::read(path);
    }
    let names = || ENTRIES.iter().map(|entry| entry.name);
    let meant = nearest(name_or_path, names());
    let hint = meant.map(|name| format!("; did you mean `{name}`?")).unwrap_or_default();
    let names = listed(names().map(str::to_owned));
    Err(Failure::bad_input(format!(
        "no scenario `{}`{hint}\n  expected {names}, or the path of a scenario file",
        name_or_path.escape_debug()
    )))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::{Scenario, Setting, load};

    fn shipped_scenario(name: &str) -> Scenario {
        load(&find(name).unwrap(), None, &[]).unwrap_or_else(|failure| panic!("{failure}"))
    }

    #[test]
    fn every_shipped_scenario_loads_by_name_and_from_its_file_alike() {
        for entry in all_shipped() {
            let by_name = shipped_scenario(entry.name);
            let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios").join(entry.path);
            let mut by_path = load(&Source::read(&path).unwrap(), None, &[]).unwrap();
            assert_eq!(by_name.name, entry.name);
            assert_eq!(by_path.world.map.is_some(), by_name.world.map.is_some());
            by_path.world.map.clone_from(&by_name.world.map);
            assert_eq!(by_path, by_name);
        }
    }

    #[test]
    fn the_papers_scenes_have_the_boxes_and_the_settings_of_the_paper() {
        let scenes = ["open", "obstacles", "complex"].map(shipped_scenario);
        assert_eq!(scenes.each_ref().map(|scene| scene.world.boxes.len()), [0, 5, 9]);
        assert_eq!(scenes[1].world.boxes[4], [5.5, 7.0, 6.5, 8.0]);
        assert_eq!(scenes[2].world.boxes[8], [8.0, 4.5, 10.0, 5.0]);
        for scene in scenes {
            assert_eq!(scene.fitness, crate::scenario::Preset::Paper.scenario().fitness);
            assert_eq!(scene.pairs.min_distance, 4.0);
            assert!((80..=160).contains(&scene.training.population));
        }
    }

    #[test]
    fn a_barn_world_starts_where_the_benchmark_does() {
        let scenario = shipped_scenario("barn_264");
        let crate::scenario::PairSource::Listed(pairs) = scenario.pairs.source else {
            panic!("drawn pairs");
        };
        assert_eq!(pairs[0].start, [-2.25, 3.0, 1.57]);
        assert_eq!(pairs[0].goal, [-2.25, 13.0]);
        assert_eq!(scenario.world.circles.len(), 273);
    }

    #[test]
    fn a_map_is_the_room_unless_the_scenario_gives_another() {
        let depot = shipped_scenario("depot");
        assert_eq!(depot.world.bounds.min, [0.0, 0.0]);
        assert_eq!(depot.world.bounds.max, [30.2, 15.35]);
        assert_eq!(shipped_scenario("tb3_sandbox").world.bounds.max, [2.8, 2.7]);
        let settings = [Setting::set("world.min_m=[40,0]"), Setting::set("world.max_m=[50,9]")];
        let failure = load(&find("depot").unwrap(), None, &settings).unwrap_err();
        assert!(failure.to_string().contains("the map lies outside the room"), "{failure}");
    }

    #[test]
    fn an_unknown_name_is_answered_with_the_nearest_and_all_names() {
        let failure = find("obstacle").unwrap_err();
        assert_eq!(failure.exit_code(), 2);
        let text = failure.to_string();
        assert!(
            text.contains("did you mean `obstacles`?") && text.contains("medium_maze"),
            "{text}"
        );
        assert_eq!(find("nowhere/room.toml").unwrap_err().exit_code(), 2);
    }

    #[test]
    fn a_setting_changes_a_shipped_scenario() {
        let settings = [Setting::set("episode.step_limit=400")];
        let scenario = load(&find("open").unwrap(), None, &settings).unwrap();
        assert_eq!(scenario.episode.step_limit, 400);
    }
}

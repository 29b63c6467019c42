use std::fs;
use std::path::Path;

use clap::{Args, Command, FromArgMatches};
use tempfile::{TempDir, tempdir};

use super::*;
use crate::output::Page;
use crate::scenario::{self, Source};

/// What a verb prints, and how it ends; `DIR` stands for a folder of its own.
struct Said {
    stdout: String,
    stderr: String,
    result: Result<(), (u8, String)>,
}

impl Said {
    fn ok(self) -> String {
        assert_eq!(self.result, Ok(()));
        self.stdout
    }

    fn refusal(self) -> String {
        let (code, text) = self.result.unwrap_err();
        assert_eq!(code, 2, "{text}");
        text
    }
}

/// Runs `evosteer scenario` with arguments in which `DIR` is `folder`.
fn scenario(folder: &TempDir, arguments: &str) -> Said {
    let here = folder.path().display().to_string();
    let arguments = arguments.split_whitespace().map(|word| word.replace("DIR", &here));
    let command = ScenarioArgs::augment_args(Command::new("scenario").no_binary_name(true));
    let args = command.try_get_matches_from(arguments);
    let args = args.and_then(|matches| ScenarioArgs::from_arg_matches(&matches));
    let args = args.unwrap_or_else(|error| panic!("{error}"));
    let (stdout, stderr) = (Page::default(), Page::default());
    let mut output = Output::to(args.wants_json(), stdout.clone(), stderr.clone());
    let result = run(&args, &mut output);
    output.finish().unwrap();
    let neutral = |text: String| text.replace(&here, "DIR");
    Said {
        stdout: neutral(stdout.text()),
        stderr: neutral(stderr.text()),
        result: result.map_err(|failure| (failure.exit_code(), neutral(failure.to_string()))),
    }
}

/// The maps that come with the program, in a folder of their own.
fn with_maps() -> TempDir {
    let folder = tempdir().unwrap();
    let maps = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/worlds/nav2");
    fs::create_dir(folder.path().join("maps")).unwrap();
    for name in ["depot.yaml", "depot.pgm", "tb3_sandbox.yaml", "tb3_sandbox.pgm"] {
        fs::copy(maps.join(name), folder.path().join("maps").join(name)).unwrap();
    }
    folder
}

/// A map of cells of 10 cm, drawn with `#` for occupied and anything else for free.
fn draw_map(folder: &TempDir, name: &str, rows: &[String]) {
    let grey: String = rows
        .iter()
        .flat_map(|row| row.chars().map(|c| if c == '#' { "0 " } else { "254 " }))
        .collect();
    let pgm = format!("P2 {} {} 255\n{grey}\n", rows[0].len(), rows.len());
    let yaml = format!(
        "image: {name}.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\n\
         occupied_thresh: 0.65\nfree_thresh: 0.25\nmap_name: {name}\n"
    );
    fs::write(folder.path().join(format!("{name}.pgm")), pgm).unwrap();
    fs::write(folder.path().join(format!("{name}.yaml")), yaml).unwrap();
}

fn read(folder: &TempDir, name: &str) -> String {
    fs::read_to_string(folder.path().join(name)).unwrap()
}

fn names(folder: &TempDir) -> Vec<String> {
    let name = |entry: std::io::Result<fs::DirEntry>| entry.unwrap().file_name();
    let entries = fs::read_dir(folder.path()).unwrap().map(name);
    let mut names: Vec<String> = entries.map(|name| name.into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn the_list_has_a_line_for_every_shipped_scenario() {
    let folder = tempdir().unwrap();
    insta::assert_snapshot!("list", scenario(&folder, "list").ok());
}

#[test]
fn a_sound_scenario_is_summed_up() {
    let folder = tempdir().unwrap();
    let summaries = ["depot", "barn_000", "medium_maze"]
        .map(|name| scenario(&folder, &format!("check {name}")).ok());
    insta::assert_snapshot!("check", summaries.join("\n"));
}

#[test]
fn the_summary_for_a_machine_has_the_numbers() {
    let folder = tempdir().unwrap();
    let text = scenario(&folder, "check open --json --set episode.step_limit=250").ok();
    let found: serde_json::Value = serde_json::from_str(&text).unwrap();
    for (key, value) in [("walls", 4), ("genome_length", 265), ("step_limit", 250), ("pairs", 5)] {
        assert_eq!(found[key], value, "{text}");
    }
    assert_eq!(found["car"]["steer_limit_deg"], 90.0, "{text}");
    assert_eq!(found["sensors"]["beams_deg"][0], -30.0, "{text}");
    // 80 individuals, 40 generations, 5 pairs, 250 steps.
    assert_eq!(found["most_steps"], 80 * 40 * 5 * 250);
    // A band of half a car's width along each wall is lost, to the width of a cell.
    let free = found["free_share"].as_f64().unwrap();
    assert!((free - 0.98 * 0.98).abs() < 0.01, "{free}");
}

#[test]
fn tasks_that_cannot_be_driven_are_refused_with_their_place() {
    let folder = tempdir().unwrap();
    let file = folder.path().join("bad.toml");
    let mut texts = Vec::new();
    for text in [
        "[world]\nboxes = [[4, 0, 5, 10]]\n[pairs]\nlist = [{ start = [1, 1, 0], goal = [9, 9] }]\n",
        "[world]\nboxes = [[2, 0, 10, 10]]\n[pairs]\nmin_distance_m = 11\n",
        "[world]\nboxes = [[0.2, 0, 10, 10]]\n",
    ] {
        fs::write(&file, text).unwrap();
        texts.push(scenario(&folder, "check DIR/bad.toml").refusal());
    }
    insta::assert_snapshot!("refused", texts.join("\n\n"));
}

#[test]
fn a_picture_shows_listed_and_unseen_pairs_and_is_not_overwritten() {
    let folder = tempdir().unwrap();
    let said = scenario(&folder, "show barn_000 --out DIR/a.svg --pairs 2");
    assert_eq!(said.ok(), "wrote DIR/a.svg (open it in a browser)\n");
    let svg = read(&folder, "a.svg");
    for (label, count) in [(">1</text>", 4), (">u1</text>", 4), (">u2</text>", 4), (">u3<", 0)] {
        assert_eq!(svg.matches(label).count(), count, "{label}");
    }
    let again = scenario(&folder, "show open --out DIR/a.svg").refusal();
    assert!(again.contains("DIR/a.svg exists already") && again.contains("--force"), "{again}");
    assert_eq!(read(&folder, "a.svg"), svg);
    scenario(&folder, "show open --out DIR/a.svg --force").ok();
    assert_ne!(read(&folder, "a.svg"), svg);
}

#[test]
fn the_picture_of_a_map_is_filled_and_small() {
    let folder = tempdir().unwrap();
    scenario(&folder, "show depot --out DIR/depot.svg").ok();
    let svg = read(&folder, "depot.svg");
    assert!(svg.contains("fill-rule=\"evenodd\"") && svg.len() < 60_000, "{} bytes", svg.len());
}

#[test]
fn what_is_shown_as_toml_is_the_scenario() {
    let folder = tempdir().unwrap();
    let text = scenario(&folder, "show depot --toml --set pairs.count=7").ok();
    let shown = scenario::load(&Source::new("shown.toml", text, folder.path()), None, &[]).unwrap();
    let settings = [scenario::Setting::set("pairs.count=7")];
    let loaded = scenario::load(&scenario::find("depot").unwrap(), None, &settings).unwrap();
    assert_eq!(shown, loaded);
}

#[test]
fn shipped_maps_become_scenarios_that_check() {
    let folder = with_maps();
    let mut said = String::new();
    for name in ["depot", "tb3_sandbox"] {
        said +=
            &scenario(&folder, &format!("import DIR/maps/{name}.yaml --out DIR/{name}.toml")).ok();
        said += &read(&folder, &format!("{name}.toml"));
        scenario(&folder, &format!("check DIR/{name}.toml")).ok();
    }
    insta::assert_snapshot!("import", said);
    assert_eq!(
        names(&folder),
        ["depot.svg", "depot.toml", "maps", "tb3_sandbox.svg", "tb3_sandbox.toml"]
    );
}

#[test]
fn a_building_on_a_larger_map_is_the_room_and_unknown_keys_are_warned_of() {
    let folder = tempdir().unwrap();
    // 10 × 10 m, free on both sides of a square wall from 3 m to 7 m.
    let on_wall = |i: usize, j: usize| {
        let (inside, edge) = (30..70, [30, 69]);
        inside.contains(&i) && inside.contains(&j) && (edge.contains(&i) || edge.contains(&j))
    };
    let rows: Vec<String> = (0..100)
        .map(|j| (0..100).map(|i| if on_wall(i, j) { '#' } else { '.' }).collect())
        .collect();
    draw_map(&folder, "house", &rows);
    // 14.4 of 84 m² are inside: too little to be taken for the building without being asked.
    let text = scenario(&folder, "import DIR/house.yaml --out DIR/yard.toml").ok();
    assert!(text.contains("most of its free space goes on to its edge"), "{text}");
    let said = scenario(&folder, "import DIR/house.yaml --out DIR/house.toml --room enclosed");
    assert_eq!(said.stderr, "warning: DIR/house.yaml: line 7: unknown key `map_name` ignored\n");
    said.ok();
    let source = Source::read(&folder.path().join("house.toml")).unwrap();
    let bounds = scenario::load(&source, None, &[]).unwrap().world.bounds;
    for axis in 0..2 {
        assert!((2.7..3.1).contains(&bounds.min[axis]), "{bounds:?}");
        assert!((6.9..7.3).contains(&bounds.max[axis]), "{bounds:?}");
    }
}

#[test]
fn a_map_that_lies_askew_is_cut_to_its_arena_too() {
    let folder = with_maps();
    let yaml = read(&folder, "maps/tb3_sandbox.yaml")
        .replace("[-10.000000, -10.000000, 0.000000]", "[-10, -10, 0.5]");
    assert!(yaml.contains("0.5]"), "{yaml}");
    fs::write(folder.path().join("maps/askew.yaml"), yaml).unwrap();
    let said = scenario(&folder, "import DIR/maps/askew.yaml --out DIR/askew.toml --json");
    assert_eq!(said.result, Ok(()));
    assert!(!said.stderr.contains("warning"), "{}", said.stderr);
    let found: serde_json::Value = serde_json::from_str(&said.stdout).unwrap();
    assert_eq!(found["room_is"], "enclosed");
    let source = Source::read(&folder.path().join("askew.toml")).unwrap();
    let [width, height] = scenario::load(&source, None, &[]).unwrap().world.bounds.size();
    assert!((5.0..6.5).contains(&width) && (5.0..6.5).contains(&height), "{width} {height}");
}

#[test]
fn a_map_without_room_for_a_car_is_refused_and_leaves_nothing() {
    let folder = tempdir().unwrap();
    draw_map(&folder, "full", &vec!["#".repeat(50); 50]);
    let text = scenario(&folder, "import DIR/full.yaml --out DIR/full.toml").refusal();
    assert!(text.contains("no start and goal found on the map"), "{text}");
    let text = scenario(&folder, "import DIR/full.yaml --out DIR/x.toml --room enclosed").refusal();
    assert!(text.contains("--room enclosed: no free space"), "{text}");
    let text = scenario(&folder, "import DIR/none.yaml --out DIR/x.toml").refusal();
    assert!(text.contains("DIR/none.yaml: no such file"), "{text}");
    let text = scenario(&folder, "import DIR/full.yaml --out DIR/x.svg").refusal();
    assert!(text.contains("expected a name that ends in .toml"), "{text}");
    assert_eq!(names(&folder), ["full.pgm", "full.yaml"]);
}

#[test]
fn a_name_that_no_scenario_may_have_is_refused_by_its_option() {
    let folder = with_maps();
    let said = scenario(&folder, "import DIR/maps/depot.yaml --out DIR/a.toml --name a/b");
    let text = said.refusal();
    assert!(text.contains("--name:1:"), "{text}");
}

#[test]
fn one_seed_generates_one_world_as_file_and_picture() {
    let folder = tempdir().unwrap();
    for name in ["a", "b"] {
        let line = format!("generate --seed 5 --kind pillars --size 8x6 --out DIR/{name}.toml");
        scenario(&folder, &line).ok();
    }
    assert_eq!(names(&folder), ["a.svg", "a.toml", "b.svg", "b.toml"]);
    assert_eq!(read(&folder, "a.toml"), read(&folder, "b.toml"));
    scenario(&folder, "check DIR/a.toml").ok();
    let text = scenario(&folder, "generate --seed 5 --out DIR/a.toml").refusal();
    assert!(text.contains("DIR/a.toml exists already"), "{text}");
    let text = scenario(&folder, "generate --seed 5 --size 2x9 --out DIR/c.toml").refusal();
    assert!(text.contains("--size has 2"), "{text}");
}

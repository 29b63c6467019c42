//! What the files beside the shipped champions say is what their blobs hold and how they drive.

use super::pages;
use host_trainer::blob_file::BlobFile;
use host_trainer::champion::shipped::{CHAMPIONS, Champion};
use host_trainer::evaluation::Evaluation;
use host_trainer::fingerprint;
use host_trainer::pairs::PairSampler;
use host_trainer::problem::{Problem, adopt_car};
use host_trainer::scenario::{self, Scenario, Setting};
use host_trainer::seed::RunSeed;
use host_trainer::signals::StopFlag;
use std::collections::BTreeSet;
use std::fmt::Write;

/// Pairs and their seed, for the figures.
const UNSEEN: (u32, RunSeed) = (1000, RunSeed(2));

/// The line that says how a champion was made.
fn command(champion: &Champion) -> &str {
    command_in(champion.provenance)
}

fn command_in(provenance: &str) -> &str {
    let lines = provenance.lines();
    let mut lines = lines.filter_map(|line| line.strip_prefix("command = \"")?.strip_suffix('"'));
    lines.next().unwrap_or_else(|| panic!("no command: {provenance}"))
}

/// What champion a command begins with, below the repository.
fn begins_with(command: &str) -> Option<&str> {
    let mut words = command.split_whitespace();
    words.find(|word| *word == "--from")?;
    words.next()
}

/// Scenario and seed that a command trains with.
fn trained_with(command: &str) -> (Scenario, RunSeed) {
    let mut words = command.split_whitespace();
    assert_eq!([words.next(), words.next()], [Some("evosteer"), Some("train")], "{command}");
    let name = words.next().unwrap();
    let (mut settings, mut seed, mut preset) = (Vec::new(), RunSeed(1), None);
    while let Some(option) = words.next() {
        let value = words.next().unwrap_or_else(|| panic!("{option} of {command}"));
        match option {
            "--seed" => seed = value.parse().unwrap(),
            "--set" => settings.push(Setting::set(value)),
            "--preset" => {
                preset = scenario::Preset::ALL.into_iter().find(|preset| preset.name() == value);
                assert!(preset.is_some(), "{command}");
            }
            "--population" | "--generations" => {
                let key = format!("training.{}", &option[2..]);
                settings.push(Setting::option(option, &key, value));
            }
            "--from" => assert!(value.starts_with("champions/"), "{command}"),
            _ => panic!("{option} of {command} is not known here"),
        }
    }
    (scenario::load(&scenario::find(name).unwrap(), preset, &settings).unwrap(), seed)
}

/// How long its drives were in training.
fn step_limit(champion: &Champion) -> u32 {
    trained_with(command(champion)).0.episode.step_limit
}

/// How a champion drives its scene.
fn figures(champion: &Champion) -> Evaluation {
    let file = champion.file();
    let mut scene = scenario::load(&scenario::find(champion.scene).unwrap(), None, &[]).unwrap();
    adopt_car(&mut scene, file.blob().header());
    scene.episode.step_limit = step_limit(champion);
    let problem = Problem::new(scene).unwrap();
    let (count, seed) = UNSEEN;
    let pairs = PairSampler::new(&problem.world, &problem.scenario).unseen(seed, count).unwrap();
    Evaluation::of(&problem, file.blob().weights(), &pairs, seed, &StopFlag::default()).unwrap()
}

/// By what command a blob was made, and what its header says.
fn made(command: &str, file: &BlobFile) -> String {
    let made = file.blob().header().provenance;
    let [major, minor, patch] = made.tool;
    format!(
        "command = \"{command}\"\nevosteer = \"{major}.{minor}.{patch}\"\nseed = {}\n\
         generation = {}\nsha256 = \"{}\"\n",
        made.seed,
        made.generation,
        fingerprint::sha256(file.bytes())
    )
}

/// What stands beside a champion.
fn provenance(champion: &Champion) -> String {
    let Champion { scene, .. } = champion;
    let drives = figures(champion);
    let mut text = format!(
        "# How champions/{scene}.blob was made, and how it drives on pairs that no training has seen.\n\
         # `cargo xtask champions {scene}` trains it again and compares every byte.\n"
    );
    text += &made(command(champion), &champion.file());
    let mut line = |line: String| writeln!(text, "{line}").unwrap();
    line(format!("\n[unseen]\nscenario = \"{scene}\""));
    line(format!("step_limit = {}", step_limit(champion)));
    line(format!("pairs = {}", drives.pairs));
    line(format!("seed = {}", drives.seed));
    for (name, share, [low, high]) in [
        ("reached", drives.reached, drives.reached_interval),
        ("clean", drives.clean, drives.clean_interval),
    ] {
        line(format!("{name} = {share:.4}"));
        line(format!("{name}_interval = [{low:.4}, {high:.4}]"));
    }
    text
}

#[test]
fn a_champions_file_says_what_its_blob_holds_and_how_it_drives() {
    for champion in CHAMPIONS {
        pages::expect(&format!("champions/{}.toml", champion.scene), &provenance(champion));
    }
}

/// What a shipped champion's training begins with lies there, with the command that makes it.
#[test]
fn the_first_stages_of_champions_are_what_their_files_say() {
    let mut stages = BTreeSet::new();
    for champion in CHAMPIONS {
        let Some(blob) = begins_with(command(champion)) else { continue };
        let file = BlobFile::read(&pages::root().join(blob)).unwrap();
        let page = blob.replace(".blob", ".toml");
        let command = command_in(&pages::read(&page)).to_owned();
        let scene = champion.scene;
        let text = format!(
            "# How {blob} was made, with which the training of champions/{scene}.blob begins.\n\
             # `cargo xtask champions {scene}` trains both again and compares every byte.\n{}",
            made(&command, &file)
        );
        pages::expect(&page, &text);
        assert_made_by(&command, &file);
        stages.insert(page);
    }
    let folder = std::fs::read_dir(pages::root().join("champions/stages"));
    assert_eq!(
        folder.map_or(0, Iterator::count),
        2 * stages.len(),
        "a blob and its file for each of {stages:?}"
    );
}

/// Training takes too long for a test; that nothing that decides it has changed does not.
/// `cargo xtask champions` trains.
#[test]
fn the_recorded_command_means_the_settings_that_the_blob_was_trained_with() {
    for champion in CHAMPIONS {
        assert_made_by(command(champion), &champion.file());
    }
}

fn assert_made_by(command: &str, file: &BlobFile) {
    let (scenario, seed) = trained_with(command);
    let made = file.blob().header().provenance;
    let digest = fingerprint::scenario(&scenario);
    assert_eq!(made.scenario_hash, digest[..8], "{command}: other settings");
    assert_eq!(made.seed, seed.0, "{command}");
    assert!(made.generation < scenario.training.generations, "{command}");
    let [major, minor, patch] = made.tool;
    assert_eq!(format!("{major}.{minor}.{patch}"), env!("CARGO_PKG_VERSION"), "{command}");
}

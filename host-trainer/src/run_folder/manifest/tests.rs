use proptest::prelude::*;
use tempfile::{TempDir, tempdir};

use super::*;
use crate::failure::FailureKind;

/// Stands for a scenario: the shapes of value that settings have.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Settings {
    name: String,
    step: Step,
    servo_rate: Option<f32>,
    boxes: Vec<[f32; 4]>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
enum Step {
    Constant(f32),
    Variable { lower: f32, upper: f32 },
}

fn settings() -> Settings {
    Settings {
        name: "open".to_owned(),
        step: Step::Variable { lower: 0.1, upper: 0.3 },
        servo_rate: None,
        boxes: vec![[2.0, 2.0, 3.0, 4.0]],
    }
}

fn run() -> (TempDir, RunFolder) {
    let base = tempdir().unwrap();
    let folder = RunFolder::create(&base.path().join("run")).unwrap();
    (base, folder)
}

fn refusal(folder: &RunFolder) -> String {
    let failure = Manifest::<Settings>::read(folder).unwrap_err();
    assert_eq!(failure.kind(), FailureKind::BadInput);
    failure.to_string().replace(&folder.path().display().to_string(), "RUN")
}

/// Writes a manifest with one piece of its text replaced.
fn edited(folder: &RunFolder, from: &str, to: &str) {
    let text = to_toml(&Manifest::new(7, settings(), 1, vec![]).unwrap()).unwrap();
    assert!(text.contains(from), "{text}");
    folder.write(RunFolder::MANIFEST, text.replacen(from, to, 1).as_bytes()).unwrap();
}

#[test]
fn a_manifest_reads_like_this() {
    let manifest = Manifest::new(u64::MAX, settings(), 3, vec![]).unwrap();
    insta::assert_snapshot!(to_toml(&manifest).unwrap(), @r#"
    evosteer = "0.1.0"
    seed = "18446744073709551615"
    scenario_sha256 = "715cd70136c76c595c5720c1a0a95f46832beb4dbb5301a007152d685faf76fd"

    [formats]
    manifest = 2
    checkpoint = 2
    blob = 3

    [scenario]
    name = "open"
    boxes = [[2.0, 2.0, 3.0, 4.0]]

    [scenario.step.variable]
    lower = 0.1
    upper = 0.3
    "#);
}

#[test]
fn the_fingerprint_is_what_sha256sum_says_of_the_scenario_s_text() {
    let text = "name = \"open\"\nboxes = [[2.0, 2.0, 3.0, 4.0]]\n\n\
                [step.variable]\nlower = 0.1\nupper = 0.3\n";
    assert_eq!(to_toml(&settings()).unwrap(), text);
    assert_eq!(
        Manifest::new(7, settings(), 1, vec![]).unwrap().scenario_sha256,
        "715cd70136c76c595c5720c1a0a95f46832beb4dbb5301a007152d685faf76fd"
    );
}

#[test]
fn what_was_written_is_read_back() {
    let (base, folder) = run();
    let map = base.path().join("map.pgm");
    fs::write(&map, b"abc").unwrap();
    let input = Input::of_file(&map).unwrap();
    // FIPS 180-2, appendix B.1.
    assert_eq!(input.sha256, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    let manifest = Manifest::new(u64::MAX, settings(), 1, vec![input]).unwrap();
    manifest.write(&folder).unwrap();
    assert_eq!(Manifest::read(&folder).unwrap(), manifest);
}

#[test]
fn a_run_whose_map_has_changed_is_not_resumed() {
    let (base, folder) = run();
    let map = base.path().join("map.pgm");
    fs::write(&map, b"abc").unwrap();
    let inputs = vec![Input::of_file(&map).unwrap()];
    Manifest::new(1, settings(), 1, inputs).unwrap().write(&folder).unwrap();
    fs::write(&map, b"abd").unwrap();
    let text = refusal(&folder);
    assert!(text.contains("map.pgm has changed since the run in RUN began"), "{text}");

    fs::remove_file(&map).unwrap();
    let failure = Manifest::<Settings>::read(&folder).unwrap_err();
    assert_eq!(failure.kind(), FailureKind::InputOutput);
    assert!(failure.to_string().contains("map.pgm"), "{failure}");
}

#[test]
fn damage_is_refused_with_its_line_and_column() {
    let (_base, folder) = run();
    edited(&folder, "lower = 0.1", "lower = \"slow\"");
    assert_eq!(
        refusal(&folder),
        "RUN/manifest.toml:15:9: invalid type: string \"slow\", expected f32"
    );
    edited(&folder, "seed = \"7\"", "seed = \"7e3\"");
    assert_eq!(
        refusal(&folder),
        "RUN/manifest.toml:2:8: `7e3` is not a seed; \
         expected a whole number from 0 to 18446744073709551615"
    );
    edited(&folder, "evosteer =", "evosteer");
    assert_eq!(refusal(&folder), "RUN/manifest.toml:1:10: key with no value, expected `=`");
    folder.write(RunFolder::MANIFEST, b"a = \"\xff\"").unwrap();
    assert_eq!(refusal(&folder), "RUN/manifest.toml:1:6: not UTF-8 text");
}

#[test]
fn another_version_is_named_before_its_fields_are_looked_at() {
    let (_base, folder) = run();
    edited(&folder, "manifest = 2", "manifest = 1\nsomething = \"new\"");
    assert_eq!(
        refusal(&folder),
        "RUN/manifest.toml: manifest version 1, this evosteer reads version 2"
    );
}

#[test]
fn settings_changed_by_hand_are_refused() {
    let (_base, folder) = run();
    edited(&folder, "lower = 0.1", "lower = 0.2");
    assert!(refusal(&folder).contains("the settings in [scenario] were changed"));
    // A comment or a blank changes no setting.
    edited(&folder, "lower = 0.1", "lower  =  0.10 # metres");
    assert_eq!(Manifest::<Settings>::read(&folder).unwrap().scenario, settings());
}

proptest! {
    #[test]
    fn any_setting_keeps_its_bits(bits: [u32; 4], seed: u64) {
        let numbers = bits.map(f32::from_bits);
        prop_assume!(numbers.iter().all(|number| number.is_finite()));
        let settings = Settings {
            step: Step::Constant(numbers[0]),
            servo_rate: Some(numbers[1]),
            boxes: vec![numbers],
            ..settings()
        };
        let manifest = Manifest::new(seed, settings, 1, vec![]).unwrap();
        let text = to_toml(&manifest).unwrap();
        let back: Manifest<Settings> =
            Manifest::parse(Path::new("manifest.toml"), text.as_bytes()).unwrap();
        prop_assert_eq!(back.scenario.boxes[0].map(f32::to_bits), bits);
        prop_assert_eq!(back, manifest);
    }
}

#[test]
fn a_shipped_file_has_the_fingerprint_of_the_file_in_the_repository() {
    let shipped = Input::of_file(Path::new("shipped:worlds/nav2/depot.yaml")).unwrap();
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenarios/worlds/nav2/depot.yaml");
    assert_eq!(shipped.sha256, Input::of_file(Path::new(file)).unwrap().sha256);
}

use std::fs;
use std::path::Path;

use clap::{Args, Command};
use controller_core::blob::Provenance;
use controller_core::network::{Elman, Feedforward};
use controller_core::observation::{DistanceLaw, TypeCode};
use tempfile::tempdir;

use super::*;
use crate::output::Page;
use crate::sample_blob::SampleBlob;

/// What `inspect` prints and how it ends, for a file with these bytes in a folder called `DIR`.
fn inspect(bytes: &[u8], json: bool) -> (String, Result<(), (u8, String)>) {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.blob");
    fs::write(&path, bytes).unwrap();
    let (stdout, stderr) = (Page::default(), Page::default());
    let mut output = Output::to(json, stdout.clone(), stderr.clone());
    let result = run(&InspectArgs { blob: path, json }, &mut output);
    output.finish().unwrap();
    assert_eq!(stderr.text().is_empty(), !json);
    let neutral = |text: String| text.replace(&folder.path().display().to_string(), "DIR");
    let result = result.map_err(|failure| (failure.exit_code(), neutral(failure.to_string())));
    (neutral(stdout.text()), result)
}

#[test]
fn a_good_blob_is_shown_as_a_table() {
    let (text, result) = inspect(&SampleBlob::new::<Elman, 12, 1>(true).bytes(), false);
    assert_eq!(result, Ok(()));
    insta::assert_snapshot!(text);
}

#[test]
fn a_good_blob_is_shown_as_json() {
    let mut sample = SampleBlob::new::<Feedforward, 16, 2>(false);
    sample.header.scaling.encoding.distance = DistanceLaw::Saturating { half: 1.5 };
    sample.header.scaling.encoding.types = TypeCode::NearestWallAnyTarget;
    sample.header.scaling.step_lower = 0.05;
    let (text, result) = inspect(&sample.bytes(), true);
    assert_eq!(result, Ok(()));
    insta::assert_snapshot!(text);

    let (text, _) = inspect(&sample.bytes(), false);
    for line in [
        "distances   saturating, one half at 1.5 m, up to 10 m",
        "hit types   nearest-wall-any-target: wall as nearest, target as any",
        "speed       0.05 to 0.1 m every 0.1 s",
    ] {
        assert!(text.contains(line), "{text}");
    }
}

#[test]
fn a_damaged_blob_shows_what_can_still_be_read() {
    let mut bytes = SampleBlob::new::<Elman, 12, 1>(true).bytes();
    bytes[500] ^= 4;
    let (text, result) = inspect(&bytes, false);
    insta::assert_snapshot!(text);
    let (code, message) = result.unwrap_err();
    assert_eq!(code, 2);
    assert!(message.starts_with("DIR/a.blob is refused: damaged: check "), "{message}");
}

#[test]
fn a_refusal_is_json_too() {
    let (text, result) = inspect(&SampleBlob::new::<Elman, 12, 1>(true).bytes()[..100], true);
    insta::assert_snapshot!(text);
    let message = "DIR/a.blob is refused: 100 bytes, a blob of 2652 bytes expected".to_owned();
    assert_eq!(result, Err((2, message)));
}

#[test]
fn another_version_shows_only_what_all_versions_share() {
    let mut bytes = SampleBlob::new::<Elman, 12, 1>(true).bytes();
    bytes[8] = 2;
    let (text, result) = inspect(&bytes, false);
    let message = "DIR/a.blob is refused: blob format version 2, this program reads version 1";
    assert_eq!(result, Err((2, message.to_owned())));
    assert!(text.contains("version  2\n") && !text.contains("network"), "{text}");
}

#[test]
fn a_flash_dump_says_where_the_blob_in_it_ends() {
    let mut bytes = SampleBlob::new::<Elman, 12, 1>(true).bytes();
    bytes.resize(4096, 0xff);
    let (text, result) = inspect(&bytes, false);
    let message = "DIR/a.blob is refused: 4096 bytes, the blob ends after 2652";
    assert_eq!(result, Err((2, message.to_owned())));
    assert!(text.contains("hint     the first 2652 bytes are a whole blob; cut off the rest\n"));
}

#[test]
fn a_self_test_that_fails_here_is_bad_input_after_the_table() {
    let mut sample = SampleBlob::new::<Elman, 12, 1>(true);
    let last = sample.self_tests.last_mut().unwrap();
    *last = f32::from_bits(last.to_bits() ^ 1);
    let (text, result) = inspect(&sample.bytes(), false);
    let (code, message) = result.unwrap_err();
    assert_eq!(code, 2);
    assert!(message.starts_with("DIR/a.blob: self-test 1, output 0: "), "{message}");
    assert!(text.contains("self-test   2 recorded; FAILED: self-test 1, output 0: "), "{text}");
}

#[test]
fn a_hostile_name_reaches_the_terminal_escaped() {
    let mut sample = SampleBlob::new::<Elman, 12, 1>(true);
    sample.header.provenance.scenario = Provenance::stored_name("\u{1b}[2J\r\n");
    let (text, _) = inspect(&sample.bytes(), false);
    assert!(text.contains(r#"scenario "\u{1b}[2J\r\n", seed 42"#), "{text}");
}

#[test]
fn a_missing_file_names_the_argument() {
    let args = InspectArgs { blob: Path::new("/no/such.blob").to_owned(), json: false };
    let mut output = Output::to(false, Page::default(), Page::default());
    let failure = run(&args, &mut output).unwrap_err();
    assert_eq!(failure.exit_code(), 2);
    assert_eq!(
        failure.to_string(),
        "BLOB /no/such.blob: no such file; a weight blob or a run folder expected"
    );
}

#[test]
fn the_help_says_what_is_accepted() {
    let mut command = InspectArgs::augment_args(Command::new("inspect"));
    insta::assert_snapshot!(command.render_long_help());
}

#[test]
fn every_golden_blob_is_accepted_and_computes_its_recorded_bits_here() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../controller-core/tests/golden/v1");
    let mut seen = 0;
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "blob") {
            continue;
        }
        let (text, result) = inspect(&fs::read(&path).unwrap(), false);
        assert_eq!(result, Ok(()), "{}", path.display());
        assert!(text.contains("recorded; passed: "), "{}\n{text}", path.display());
        seen += 1;
    }
    assert!(seen >= 7, "{seen} golden blobs");
}

use std::path::PathBuf;
use std::process::Command;

use controller_core::blob::{NAME_BYTES, Provenance};
use controller_core::network::Elman;
use tempfile::tempdir;

use super::*;
use crate::blob_file::{BlobFile, FileBytes};
use crate::sample_blob::SampleBlob;

fn source_of(sample: &SampleBlob) -> (String, Vec<u8>) {
    let file = FileBytes::new(PathBuf::from("champion.blob"), &sample.bytes());
    let file = BlobFile::check(file).unwrap();
    (encode(&file.blob(), file.bytes()), sample.bytes())
}

/// The compiler that cargo uses for this test.
fn rustc() -> Command {
    Command::new(std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()))
}

#[test]
fn the_source_begins_with_where_the_weights_come_from() {
    let (source, bytes) = source_of(&SampleBlob::new::<Elman, 12, 1>(true));
    let head: Vec<&str> = source.lines().take(14).collect();
    let sha256 = fingerprint::sha256(&bytes);
    let text = head.join("\n").replace(&sha256, "<sha256>");
    insta::assert_snapshot!(text);
    assert!(source.is_ascii());
    assert!(source.lines().all(|line| line.len() <= 100));
}

#[test]
fn the_source_compiles_without_std_and_holds_the_same_bytes_aligned() {
    let (source, bytes) = source_of(&SampleBlob::new::<Elman, 12, 1>(true));
    let folder = tempdir().unwrap();
    std::fs::write(folder.path().join("champion.rs"), &source).unwrap();

    let library = "#![no_std]\n#![forbid(unsafe_code)]\n#![deny(warnings, missing_docs)]\n//! Car.\n/// Weights.\npub mod champion;\n\
                   const _: () = assert!(core::mem::align_of_val(&champion::CHAMPION) == 4);\n";
    let path = folder.path().join("car.rs");
    std::fs::write(&path, library).unwrap();
    let run = rustc()
        .args(["--edition=2024", "--crate-type=lib", "--emit=metadata", "--out-dir"])
        .args([folder.path(), &path])
        .output()
        .unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));

    let program = "mod champion;\nuse std::io::Write;\nfn main() {\n\
                   std::io::stdout().write_all(&champion::CHAMPION.0).unwrap();\n}\n";
    let path = folder.path().join("print.rs");
    std::fs::write(&path, program).unwrap();
    let executable = folder.path().join("print").with_extension(std::env::consts::EXE_EXTENSION);
    let run = rustc().args(["--edition=2024", "-o"]).args([&executable, &path]).output().unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    assert!(Command::new(&executable).output().unwrap().stdout == bytes);
}

#[test]
fn a_hostile_scenario_name_stays_inside_the_comment() {
    let mut sample = SampleBlob::new::<Elman, 12, 1>(false);
    let name = "ä\n*/ }\rfn main() {\u{1b}[2J\u{202e}";
    assert!(name.len() <= NAME_BYTES);
    sample.header.provenance.scenario = Provenance::stored_name(name);
    let (source, _) = source_of(&sample);
    assert!(
        source.starts_with(
            "//! Trained weights, 7-12-12-1 elman, no biases: scenario \"\\u{e4}\\n*/"
        )
    );
    assert!(source.is_ascii() && !source.contains(['\r', '\u{1b}']));
    assert!(
        source.lines().filter(|line| line.contains("fn main")).all(|line| line.starts_with("//!"))
    );
}

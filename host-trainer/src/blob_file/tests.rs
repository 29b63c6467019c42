use controller_core::network::Feedforward;
use tempfile::tempdir;

use super::*;
use crate::sample_blob::SampleBlob;

fn sample() -> Vec<u8> {
    SampleBlob::new::<Feedforward, 12, 1>(true).bytes()
}

/// Exit code and message, with the test's folder called `DIR`.
fn refusal_of(folder: &Path, path: &Path) -> (u8, String) {
    let failure = BlobFile::read(path).unwrap_err();
    let folder = folder.display().to_string();
    (failure.exit_code(), failure.to_string().replace(&folder, "DIR"))
}

#[test]
fn a_file_and_the_run_folder_around_it_name_the_same_champion() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("champion.blob");
    fs::write(&path, sample()).unwrap();
    for argument in [&path, folder.path()] {
        let champion = BlobFile::read(argument).unwrap();
        assert_eq!(champion.path(), path);
        assert_eq!(champion.bytes(), sample());
        assert_eq!(champion.blob().weights().len(), 265);
        assert_eq!(champion.blob().header().provenance.seed, 42);
    }
}

#[test]
fn what_is_not_there_is_bad_input_that_names_the_argument() {
    let folder = tempdir().unwrap();
    let missing = folder.path().join("x.blob");
    let expected = "CHAMPION DIR/x.blob: no such file; a weight blob or a run folder expected";
    assert_eq!(refusal_of(folder.path(), &missing), (2, expected.to_owned()));

    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    let expected = "CHAMPION DIR/file/x: no such file; a weight blob or a run folder expected";
    assert_eq!(refusal_of(folder.path(), &file.join("x")), (2, expected.to_owned()));
}

#[test]
fn a_folder_without_a_champion_says_whether_a_run_can_be_finished() {
    let folder = tempdir().unwrap();
    let expected =
        "CHAMPION DIR: a folder without champion.blob; a weight blob or a run folder expected";
    assert_eq!(refusal_of(folder.path(), folder.path()), (2, expected.to_owned()));

    fs::write(folder.path().join("manifest.toml"), "").unwrap();
    let expected = "CHAMPION DIR: this run has not finished and holds no champion.blob yet; \
                    finish it with: evosteer train --resume DIR";
    assert_eq!(refusal_of(folder.path(), folder.path()), (2, expected.to_owned()));
}

#[test]
fn a_damaged_blob_is_refused_with_its_path_and_the_reason() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("a.blob");
    let refused = |bytes: &[u8]| {
        fs::write(&path, bytes).unwrap();
        refusal_of(folder.path(), &path)
    };
    let whole = sample();
    let expected = [
        (&b""[..], "DIR/a.blob is refused: 0 bytes, a blob of 184 bytes expected"),
        (
            b"[scenario]\n",
            "DIR/a.blob is refused: no blob here: it does not start with \"EVOSTEER\"",
        ),
        (&whole[..1000], "DIR/a.blob is refused: 1000 bytes, a blob of 1500 bytes expected"),
    ];
    for (bytes, message) in expected {
        assert_eq!(refused(bytes), (2, message.to_owned()));
    }
}

#[test]
fn a_large_file_is_refused_before_it_is_read() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("disk.img");
    // Sparse: a terabyte that would not fit into memory if somebody tried.
    File::create(&path).unwrap().set_len(1 << 40).unwrap();
    let expected =
        "CHAMPION DIR/disk.img: more than 1 MiB, a weight blob of a few kB expected".to_owned();
    assert_eq!(refusal_of(folder.path(), &path), (2, expected));
}

#[test]
#[cfg(target_os = "linux")]
fn an_endless_device_is_refused_after_a_mebibyte() {
    let (code, message) = refusal_of(Path::new("DIR"), Path::new("/dev/zero"));
    assert_eq!(code, 2);
    assert_eq!(message, "CHAMPION /dev/zero: more than 1 MiB, a weight blob of a few kB expected");
}

#[test]
fn every_length_of_file_comes_back_as_it_was() {
    for length in 0..9 {
        let bytes: Vec<u8> = (1..=length).collect();
        let copy = FileBytes::new(PathBuf::from("x"), &bytes);
        assert_eq!(copy.bytes(), bytes);
        assert_eq!(copy.bytes().as_ptr().addr() % 4, 0);
    }
}

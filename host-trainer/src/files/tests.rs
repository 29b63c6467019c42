use std::fs;
use std::path::Path;

use tempfile::tempdir;

use super::*;
use crate::failure::FailureKind;

fn names_in(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn a_written_file_holds_exactly_the_bytes_and_nothing_lies_beside_it() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("champion.blob");
    write(&path, b"first, longer").unwrap();
    write(&path, b"second").unwrap();
    assert_eq!(fs::read(&path).unwrap(), b"second");
    assert_eq!(names_in(folder.path()), ["champion.blob"]);
}

#[test]
fn write_new_leaves_an_existing_file_alone() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("champion.blob");
    write_new(&path, b"kept").unwrap();
    let failure = write_new(&path, b"lost").unwrap_err();
    assert_eq!(failure.kind(), FailureKind::BadInput);
    assert!(failure.to_string().contains("champion.blob exists already"), "{failure}");
    assert_eq!(fs::read(&path).unwrap(), b"kept");
    assert_eq!(names_in(folder.path()), ["champion.blob"]);
}

#[test]
fn of_many_writers_of_a_new_file_one_wins() {
    let folder = tempdir().unwrap();
    for round in 0..50 {
        let path = folder.path().join(format!("{round}.bin"));
        let winners: Vec<u8> = std::thread::scope(|scope| {
            let writers: Vec<_> = (0..4_u8)
                .map(|who| {
                    let path = &path;
                    scope.spawn(move || write_new(path, &[who; 1000]).map(|()| who))
                })
                .collect();
            writers.into_iter().filter_map(|writer| writer.join().unwrap().ok()).collect()
        });
        assert_eq!(winners.len(), 1, "round {round}: {winners:?}");
        assert_eq!(fs::read(&path).unwrap(), [winners[0]; 1000]);
    }
    assert_eq!(names_in(folder.path()).len(), 50);
}

#[test]
fn a_missing_folder_is_named() {
    let folder = tempdir().unwrap();
    let failure = write(&folder.path().join("not/here/a.svg"), b"").unwrap_err();
    assert_eq!(failure.kind(), FailureKind::InputOutput);
    let missing = folder.path().join("not/here");
    assert!(
        failure.to_string().ends_with(&format!("the folder {} does not exist", missing.display())),
        "{failure}"
    );
}

#[test]
fn a_folder_in_the_place_of_the_file_is_refused() {
    let folder = tempdir().unwrap();
    let failure = write(folder.path(), b"").unwrap_err();
    assert!(failure.to_string().ends_with("is a directory"), "{failure}");
}

#[test]
fn strays_of_the_dead_go_and_everything_else_stays() {
    let folder = tempdir().unwrap();
    let stray = folder.path().join(format!("{TEMPORARY_PREFIX}Ab3dE6"));
    fs::write(&stray, b"half").unwrap();
    fs::write(folder.path().join("user.tmp"), b"not ours").unwrap();
    fs::create_dir(folder.path().join(format!("{TEMPORARY_PREFIX}folder"))).unwrap();
    let living = temporary_in(folder.path(), b"in progress", None).unwrap();

    assert_eq!(remove_strays(folder.path()).unwrap(), [stray]);
    assert!(living.path().exists());
    living.persist(folder.path().join("done.bin")).unwrap();
    assert_eq!(
        names_in(folder.path()),
        [&format!("{TEMPORARY_PREFIX}folder"), "done.bin", "user.tmp"]
    );
    assert_eq!(remove_strays(folder.path()).unwrap(), Vec::<PathBuf>::new());
}

#[cfg(unix)]
mod unix {
    use std::os::unix::fs::{FileTypeExt, PermissionsExt, symlink};

    use super::*;

    #[test]
    fn a_link_still_points_to_the_file_that_was_rewritten() {
        let folder = tempdir().unwrap();
        let (real, link) = (folder.path().join("real.blob"), folder.path().join("link.blob"));
        fs::write(&real, b"old").unwrap();
        symlink(&real, &link).unwrap();
        write(&link, b"new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&real).unwrap(), b"new");
    }

    #[test]
    fn a_rewritten_file_keeps_its_permissions_and_a_new_one_follows_the_umask() {
        let folder = tempdir().unwrap();
        let path = folder.path().join("a.csv");
        write(&path, b"1").unwrap();
        let ordinary = folder.path().join("b.csv");
        fs::write(&ordinary, b"").unwrap();
        let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
        assert_eq!(mode(&path), mode(&ordinary));

        fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
        write(&path, b"2").unwrap();
        assert_eq!(mode(&path), 0o640);
    }

    #[test]
    fn a_device_is_written_to_and_not_replaced() {
        let device = Path::new("/dev/null");
        write(device, b"gone").unwrap();
        assert!(fs::metadata(device).unwrap().file_type().is_char_device());
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn a_full_device_is_an_input_output_failure_with_its_cause() {
        let failure = write(Path::new("/dev/full"), b"x").unwrap_err();
        assert_eq!(failure.kind(), FailureKind::InputOutput);
        assert_eq!(
            failure.to_string(),
            "cannot write /dev/full: No space left on device (os error 28)"
        );
    }
}

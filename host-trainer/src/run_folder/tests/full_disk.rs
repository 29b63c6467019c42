//! Checkpoints when there is no room: each child starts with one good checkpoint and then
//! tries one that is too large.
#![cfg(unix)]

use std::path::Path;
use std::process::{Command, Output};

use tempfile::tempdir;

use super::super::*;
use crate::checkpoint::Checkpoints;
use crate::signals::survive_a_full_file;
use crate::test_process;

const CHILD: &str = "run_folder::tests::full_disk::child_saves_too_much";

#[test]
fn child_saves_too_much() {
    let Some(path) = test_process::folder() else { return };
    survive_a_full_file().unwrap();
    let folder = RunFolder::create(&path.join("run")).unwrap();
    let (mut checkpoints, _) = Checkpoints::open::<Vec<u8>>(&folder).unwrap();
    checkpoints.save(&folder, 1, &vec![1_u8; 100]).unwrap();
    let failure = checkpoints.save(&folder, 2, &vec![2_u8; 200_000]).unwrap_err();
    test_process::say(format_args!("{} {failure}", failure.exit_code()));

    let (_, newest) = Checkpoints::open::<Vec<u8>>(&folder).unwrap();
    let newest = newest.unwrap();
    assert_eq!((newest.generation, newest.state), (1, vec![1; 100]));
    let mut names: Vec<_> =
        fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, ["checkpoint-a.bin", "lock"]);
    test_process::say("the first checkpoint is whole");
    std::process::exit(0);
}

fn heard(Output { status, stdout, stderr }: Output) -> Vec<String> {
    let stdout = String::from_utf8(stdout).unwrap();
    assert!(status.success(), "{status}\n{stdout}{}", String::from_utf8_lossy(&stderr));
    stdout.lines().filter_map(|line| Some(line.split_once("said ")?.1.to_owned())).collect()
}

fn expected(folder: &Path, cause: &str) -> [String; 2] {
    let file = folder.join("run/checkpoint-b.bin");
    [
        format!("3 cannot write {}: {cause}", file.display()),
        "the first checkpoint is whole".to_owned(),
    ]
}

#[test]
fn a_file_size_limit_is_an_error_and_not_the_end_of_the_process() {
    let base = tempdir().unwrap();
    let child = test_process::under_shell("ulimit -f 64", CHILD, base.path()).output().unwrap();
    assert_eq!(heard(child), expected(base.path(), "File too large (os error 27)"));
}

/// A file system of 64 kB in a mount namespace of the child's own, gone with it.
#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_leaves_the_last_checkpoint_and_names_the_cause() {
    let base = tempdir().unwrap();
    let mount = "mount -t tmpfs -o size=64k none \"$EVOSTEER_TEST_FOLDER\"";
    let may_mount = Command::new("unshare")
        .args(["--map-root-user", "--mount", "sh", "-c", mount])
        .env("EVOSTEER_TEST_FOLDER", base.path())
        .output()
        .is_ok_and(|tried| tried.status.success());
    if !may_mount {
        eprintln!("NOT RUN: no private mounts here (unshare --map-root-user --mount)");
        return;
    }
    let inner = test_process::under_shell(mount, CHILD, base.path());
    let child = Command::new("unshare")
        .args(["--map-root-user", "--mount"])
        .arg(inner.get_program())
        .args(inner.get_args())
        .env("EVOSTEER_TEST_FOLDER", base.path())
        .output()
        .unwrap();
    assert_eq!(heard(child), expected(base.path(), "No space left on device (os error 28)"));
}

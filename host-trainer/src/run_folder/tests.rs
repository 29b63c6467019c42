use std::io::Write;
use std::process::Child;
use std::time::{Duration, Instant};

use tempfile::tempdir;

use super::*;
use crate::test_process;

#[test]
fn a_new_folder_is_made_with_its_parents_and_an_empty_one_is_taken() {
    let base = tempdir().unwrap();
    let path = base.path().join("deep/in/here");
    drop(RunFolder::create(&path).unwrap());
    // Only the lock of a process that was killed before it wrote a manifest.
    drop(RunFolder::create(&path).unwrap());
    RunFolder::create(base.path()).unwrap_err();
}

#[test]
fn a_folder_of_the_users_is_refused_and_not_touched() {
    let base = tempdir().unwrap();
    fs::write(base.path().join("thesis.tex"), "").unwrap();
    let failure = RunFolder::create(base.path()).unwrap_err();
    assert_eq!(failure.kind(), FailureKind::BadInput);
    assert!(failure.to_string().contains("is not empty (thesis.tex is in it)"), "{failure}");
    assert_eq!(fs::read_dir(base.path()).unwrap().count(), 1);
}

#[test]
fn an_existing_run_is_not_overwritten_and_resume_is_proposed() {
    let base = tempdir().unwrap();
    let path = base.path().join("run");
    let folder = RunFolder::create(&path).unwrap();
    folder.write(RunFolder::MANIFEST, b"kept").unwrap();
    drop(folder);
    let failure = RunFolder::create(&path).unwrap_err();
    assert_eq!(failure.kind(), FailureKind::BadInput);
    let advice = format!("--resume {}", path.display());
    assert!(failure.to_string().contains(&advice), "{failure}");
    assert_eq!(fs::read(path.join(RunFolder::MANIFEST)).unwrap(), b"kept");
}

#[test]
fn a_file_in_the_place_of_the_folder_is_refused() {
    let base = tempdir().unwrap();
    let path = base.path().join("run");
    fs::write(&path, "").unwrap();
    for refused in [RunFolder::create(&path), RunFolder::resume(&path)] {
        let failure = refused.unwrap_err();
        assert_eq!(failure.kind(), FailureKind::BadInput);
        assert!(failure.to_string().contains("run is a file"), "{failure}");
    }
}

#[test]
fn only_a_run_is_resumed() {
    let base = tempdir().unwrap();
    let missing = RunFolder::resume(&base.path().join("nowhere")).unwrap_err();
    assert_eq!(missing.kind(), FailureKind::BadInput);
    assert!(missing.to_string().contains("nowhere does not exist"), "{missing}");

    let other = RunFolder::resume(base.path()).unwrap_err();
    assert_eq!(other.kind(), FailureKind::BadInput);
    assert!(other.to_string().contains("has no manifest.toml"), "{other}");
    assert_eq!(fs::read_dir(base.path()).unwrap().count(), 0, "a lock was left in it");

    let path = base.path().join("run");
    let folder = RunFolder::create(&path).unwrap();
    assert_eq!(RunFolder::resume(&path).unwrap_err().kind(), FailureKind::Busy);
    drop(folder);
    let begun = RunFolder::resume(&path).unwrap_err();
    assert_eq!(begun.kind(), FailureKind::BadInput);

    let folder = RunFolder::create(&path).unwrap();
    folder.write(RunFolder::MANIFEST, b"").unwrap();
    drop(folder);
    RunFolder::resume(&path).unwrap();
}

#[test]
fn a_resumed_folder_is_cleared_of_unfinished_files() {
    let base = tempdir().unwrap();
    let folder = RunFolder::create(&base.path().join("run")).unwrap();
    folder.write(RunFolder::MANIFEST, b"").unwrap();
    folder.write("plots/fitness.svg", b"<svg/>").unwrap();
    let strays = ["x", "plots/x"].map(|name| {
        let name = name.replace('x', &format!("{}x", files::TEMPORARY_PREFIX));
        fs::write(folder.join(&name), b"half").unwrap();
        folder.join(&name)
    });
    let path = folder.path().to_owned();
    drop(folder);
    RunFolder::resume(&path).unwrap();
    assert_eq!(strays.map(|stray| stray.exists()), [false, false]);
    assert!(path.join("plots/fitness.svg").exists());
}

#[test]
fn names_that_are_taken_get_a_number() {
    let base = tempdir().unwrap();
    let runs = base.path().join("runs");
    let chosen: Vec<RunFolder> =
        (0..3).map(|_| RunFolder::choose(&runs, "open", 7).unwrap()).collect();
    let names: Vec<_> = chosen.iter().map(|folder| folder.path().file_name().unwrap()).collect();
    assert_eq!(names, ["open-7", "open-7-2", "open-7-3"]);
}

#[test]
fn runs_that_choose_at_the_same_time_get_different_folders() {
    let base = tempdir().unwrap();
    for seed in 0..20 {
        let mut chosen: Vec<PathBuf> = std::thread::scope(|scope| {
            let choosing: Vec<_> = (0..4)
                .map(|_| scope.spawn(|| RunFolder::choose(base.path(), "open", seed).unwrap()))
                .collect();
            choosing.into_iter().map(|run| run.join().unwrap().path().to_owned()).collect()
        });
        chosen.sort();
        let name = |suffix: &str| base.path().join(format!("open-{seed}{suffix}"));
        assert_eq!(chosen, ["", "-2", "-3", "-4"].map(name));
    }
}

/// In a child: makes a run in the folder when told to, and holds it until told again.
#[test]
fn child_holds_the_folder() {
    let Some(path) = test_process::folder() else { return };
    test_process::wait_for_parent();
    let result = RunFolder::create(&path);
    match &result {
        Ok(folder) => {
            folder.write(RunFolder::MANIFEST, b"").unwrap();
            test_process::say("0");
        }
        Err(failure) => test_process::say(format_args!("{} {failure}", failure.exit_code())),
    }
    test_process::wait_for_parent();
    std::process::exit(0);
}

fn spawn_holder(path: &Path) -> Child {
    test_process::command("run_folder::tests::child_holds_the_folder", path).spawn().unwrap()
}

fn tell(child: &mut Child) {
    child.stdin.as_mut().unwrap().write_all(b"\n").unwrap();
}

#[test]
fn of_processes_that_race_for_a_folder_one_wins_and_the_rest_are_told_it_is_busy() {
    const RACES: usize = 60;
    let base = tempdir().unwrap();
    for race in 0..RACES {
        let path = base.path().join(format!("run-{race}"));
        let mut children: Vec<Child> = (0..2 + race % 3).map(|_| spawn_holder(&path)).collect();
        children.iter_mut().for_each(tell);
        let begin = Instant::now();
        let mut said: Vec<String> = children.iter_mut().map(test_process::hear).collect();
        assert!(begin.elapsed() < Duration::from_secs(5), "race {race}");
        for mut child in children {
            drop(child.stdin.take());
            child.wait().unwrap();
        }
        said.sort();
        assert_eq!(said[0], "0", "race {race}");
        let busy = format!("4 another evosteer is using the run folder {}", path.display());
        assert!(said[1..].iter().all(|said| *said == busy), "race {race}: {said:?}");
    }
}

#[test]
fn a_killed_process_frees_its_folder() {
    let base = tempdir().unwrap();
    let path = base.path().join("run");
    let mut child = spawn_holder(&path);
    tell(&mut child);
    assert_eq!(test_process::hear(&mut child), "0");
    assert_eq!(RunFolder::resume(&path).unwrap_err().kind(), FailureKind::Busy);
    // SIGKILL on Unix.
    child.kill().unwrap();
    child.wait().unwrap();
    RunFolder::resume(&path).unwrap();
}

#[test]
#[cfg(target_os = "linux")]
fn a_folder_that_cannot_be_made_is_an_input_output_failure() {
    // Not even root makes files in procfs.
    let failure = RunFolder::create(Path::new("/proc/self/evosteer")).unwrap_err();
    assert_eq!(failure.kind(), FailureKind::InputOutput);
    assert!(failure.to_string().contains("/proc/self/evosteer"), "{failure}");
}

/// An ordinary user's case: the folder is there and someone else may write to it.
#[test]
#[cfg(unix)]
fn a_folder_without_write_permission_is_refused_before_anything_is_done() {
    use std::os::unix::fs::PermissionsExt;
    let base = tempdir().unwrap();
    fs::set_permissions(base.path(), fs::Permissions::from_mode(0o555)).unwrap();
    if fs::write(base.path().join("probe"), "").is_ok() {
        eprintln!("NOT RUN: this user may write everywhere (root)");
        return;
    }
    let failure = RunFolder::create(base.path()).unwrap_err();
    assert_eq!(failure.kind(), FailureKind::InputOutput);
    assert!(failure.to_string().contains("Permission denied"), "{failure}");
}

mod full_disk;

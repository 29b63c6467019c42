use std::path::Path;

use tempfile::{TempDir, tempdir};

use super::*;
use crate::failure::FailureKind;

fn run() -> (TempDir, RunFolder) {
    let base = tempdir().unwrap();
    let folder = RunFolder::create(&base.path().join("run")).unwrap();
    (base, folder)
}

fn newest(folder: &RunFolder) -> Option<(u64, Vec<u32>)> {
    Checkpoints::open(folder).unwrap().1.map(|loaded| (loaded.generation, loaded.state))
}

fn damage(path: &Path) {
    let mut bytes = fs::read(path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 0x10;
    fs::write(path, bytes).unwrap();
}

#[test]
fn a_new_run_has_no_checkpoint() {
    assert_eq!(newest(&run().1), None);
}

#[test]
fn the_newest_of_two_files_written_in_turn_is_found() {
    let (_base, folder) = run();
    let (mut checkpoints, none) = Checkpoints::open::<Vec<u32>>(&folder).unwrap();
    assert_eq!(none, None);
    for generation in 1..6 {
        checkpoints.save(&folder, generation, &vec![generation as u32; 3]).unwrap();
        assert_eq!(newest(&folder), Some((generation, vec![generation as u32; 3])));
    }
    let in_slot = |name| decode::<Vec<u32>>(&fs::read(folder.join(name)).unwrap()).unwrap().0;
    assert_eq!(RunFolder::CHECKPOINTS.map(in_slot), [5, 4]);
}

#[test]
fn a_resumed_run_overwrites_the_older_file() {
    for last in [4, 5] {
        let (_base, folder) = run();
        let (mut before, _) = Checkpoints::open::<Vec<u32>>(&folder).unwrap();
        (1..=last).for_each(|generation| before.save(&folder, generation, &vec![0_u32]).unwrap());
        let (mut after, _) = Checkpoints::open::<Vec<u32>>(&folder).unwrap();
        after.save(&folder, last + 1, &vec![0_u32]).unwrap();
        let newer = &RunFolder::CHECKPOINTS[(last % 2) as usize];
        damage(&folder.join(newer));
        assert_eq!(newest(&folder), Some((last, vec![0])));
    }
}

#[test]
fn a_damaged_newer_file_falls_back_with_a_warning_and_is_the_next_to_be_written() {
    let (_base, folder) = run();
    let (mut checkpoints, _) = Checkpoints::open::<Vec<u32>>(&folder).unwrap();
    checkpoints.save(&folder, 1, &vec![1_u32]).unwrap();
    checkpoints.save(&folder, 2, &vec![2_u32]).unwrap();
    damage(&folder.join("checkpoint-b.bin"));

    let (mut checkpoints, loaded) = Checkpoints::open::<Vec<u32>>(&folder).unwrap();
    let loaded = loaded.unwrap();
    assert_eq!((loaded.generation, loaded.state), (1, vec![1]));
    let [warning] = &loaded.warnings[..] else { panic!("{:?}", loaded.warnings) };
    assert!(warning.contains("checkpoint-b.bin: "), "{warning}");
    assert!(warning.ends_with("going on from generation 1"), "{warning}");

    checkpoints.save(&folder, 2, &vec![2_u32]).unwrap();
    assert_eq!(newest(&folder), Some((2, vec![2])));
    damage(&folder.join("checkpoint-b.bin"));
    assert_eq!(newest(&folder), Some((1, vec![1])), "the good file was overwritten");
}

#[test]
fn a_damaged_older_file_is_reported_too() {
    let (_base, folder) = run();
    let (mut checkpoints, _) = Checkpoints::open::<Vec<u32>>(&folder).unwrap();
    checkpoints.save(&folder, 1, &vec![1_u32]).unwrap();
    checkpoints.save(&folder, 2, &vec![2_u32]).unwrap();
    fs::write(folder.join("checkpoint-a.bin"), b"").unwrap();
    let loaded = Checkpoints::open::<Vec<u32>>(&folder).unwrap().1.unwrap();
    assert_eq!((loaded.generation, loaded.warnings.len()), (2, 1));
}

#[test]
fn two_damaged_files_are_refused_with_the_fault_of_each() {
    let (_base, folder) = run();
    fs::write(folder.join("checkpoint-a.bin"), b"EVOCKPT\0").unwrap();
    fs::write(folder.join("checkpoint-b.bin"), b"something else").unwrap();
    let failure = Checkpoints::open::<Vec<u32>>(&folder).unwrap_err();
    assert_eq!(failure.kind(), FailureKind::BadInput);
    let text = failure.to_string();
    assert!(text.contains("checkpoint-a.bin: 8 bytes, expected at least 34"), "{text}");
    assert!(text.contains("checkpoint-b.bin: not a checkpoint"), "{text}");
}

#[test]
fn a_checkpoint_that_cannot_be_read_is_no_reason_to_begin_anew() {
    let (_base, folder) = run();
    fs::create_dir(folder.join("checkpoint-a.bin")).unwrap();
    let failure = Checkpoints::open::<Vec<u32>>(&folder).unwrap_err();
    assert_eq!(failure.kind(), FailureKind::InputOutput);
}

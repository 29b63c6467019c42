use super::*;
use crate::failure::FailureKind;
use crate::reproduce::method::PAPER;
use crate::reproduce::sample;
use crate::reproduce::{Method, PaperScene, Plan};

fn run(setup: &Setup) -> Trial {
    Trial::run(setup, RunSeed(1), &StopFlag::default(), || true).unwrap().unwrap()
}

fn folder() -> (tempfile::TempDir, RunFolder) {
    let base = tempfile::tempdir().unwrap();
    let folder = RunFolder::create(&base.path().join("run")).unwrap();
    (base, folder)
}

#[test]
fn a_longer_run_is_the_same_run_seen_later() {
    let trial = run(&Setup::new(PaperScene::Open, PAPER, &sample::plan()).unwrap());
    let seen: Vec<u32> = trial.stages.iter().map(|stage| stage.generations).collect();
    assert_eq!(seen, [2, 4, 6]);
    let longer = Plan { generations: Some(6), ..sample::plan() };
    let once = Method { lengths: &[1], ..PAPER };
    let alone = run(&Setup::new(PaperScene::Open, once, &longer).unwrap());
    assert_eq!(alone.history, trial.history);
    assert_eq!(alone.stages[0], trial.stages[2]);
}

#[test]
fn drives_on_training_pairs_are_those_that_the_last_row_counted() {
    let trial = run(&Setup::new(PaperScene::Open, PAPER, &sample::plan()).unwrap());
    for stage in &trial.stages {
        let row = &trial.history[stage.best.generation as usize];
        let collisions: u64 = stage.training.iter().map(|end| u64::from(end.collisions)).sum();
        assert_eq!((stage.training_reached(), collisions), (row.bonus, row.collisions));
    }
}

#[test]
fn a_trial_reads_back_as_it_was_written_and_another_seed_has_none() {
    let setup = Setup::new(PaperScene::Open, PAPER, &sample::plan()).unwrap();
    let (_base, folder) = folder();
    let trial = run(&setup);
    trial.write(&setup, &folder).unwrap();
    assert_eq!(Trial::read(&setup, RunSeed(1), &folder).unwrap(), Some(trial));
    assert_eq!(Trial::read(&setup, RunSeed(2), &folder).unwrap(), None);
}

#[test]
fn a_damaged_trial_is_done_again_and_one_of_other_settings_refused() {
    let plan = sample::plan();
    let setup = Setup::new(PaperScene::Open, PAPER, &plan).unwrap();
    let (_base, folder) = folder();
    run(&setup).write(&setup, &folder).unwrap();
    let other = Setup::new(PaperScene::Open, PAPER, &Plan { pairs: 13, ..plan }).unwrap();
    let refusal = Trial::read(&other, RunSeed(1), &folder).unwrap_err();
    assert_eq!(refusal.kind(), FailureKind::BadInput);
    assert!(refusal.to_string().contains("open-paper-1.bin was made with other"), "{refusal}");
    let path = folder.join(&setup.file(RunSeed(1)));
    let mut bytes = std::fs::read(&path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    std::fs::write(&path, bytes).unwrap();
    assert_eq!(Trial::read(&setup, RunSeed(1), &folder).unwrap(), None);
}

#[test]
fn a_trial_that_nobody_waits_for_gives_nothing() {
    let setup = Setup::new(PaperScene::Open, PAPER, &sample::plan()).unwrap();
    let none = Trial::run(&setup, RunSeed(1), &StopFlag::default(), || false).unwrap();
    assert_eq!(none, None);
}

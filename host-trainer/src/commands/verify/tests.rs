use equivalence_tests::closed_loop::Value;
use equivalence_tests::compare::Difference;
use equivalence_tests::on_host;

use super::*;
use crate::output::Page;

fn args(champions: &[&str]) -> VerifyArgs {
    let golden = concat!(env!("CARGO_MANIFEST_DIR"), "/../controller-core/tests/golden/v1/");
    VerifyArgs {
        champions: champions.iter().map(|name| format!("{golden}{name}.blob").into()).collect(),
        emulated: true,
        boards: Vec::new(),
        steps: 7,
        json: true,
    }
}

#[test]
fn more_than_a_hundred_generated_sets_drive_and_champions_besides() {
    let (generated, sets) = drives(&args(&[])).unwrap();
    assert_eq!((generated.len(), sets), (144, 144));
    let (all, sets) = drives(&args(&["elman", "no-biases"])).unwrap();
    assert_eq!((all.len(), sets), (144 + 2 * 16, 146));
    assert_eq!(all[..144], generated);
    assert!(all[144].weights.name().ends_with("elman.blob"));
    assert!(all.iter().all(|drive| drive.case.steps == 7));
}

#[test]
fn the_courses_of_a_champion_differ() {
    let (all, _) = drives(&args(&["elman"])).unwrap();
    let last = |drive: &Drive| {
        let blob = drive.weights.blob();
        on_host::steps(&blob, drive.case).unwrap().nth(6)
    };
    let champions = &all[144..];
    for (index, one) in champions.iter().enumerate() {
        assert!(champions[..index].iter().all(|other| last(one) != last(other)), "{index}");
    }
}

#[test]
fn a_champion_with_another_network_is_refused_with_both_named() {
    let said = drives(&args(&["elman", "two-outputs"])).unwrap_err();
    assert_eq!(said.exit_code(), 2);
    let said = said.to_string();
    assert!(said.starts_with("CHAMPION ") && said.contains("two-outputs.blob: "), "{said}");
    assert!(said.contains("7-12-12-2") && said.contains("7-12-12-1"), "{said}");
}

#[test]
fn outside_a_checkout_it_says_what_is_needed_and_how_to_get_it() {
    let nowhere = tempfile::tempdir().unwrap();
    let said = checkout(&[nowhere.path().to_owned()]).unwrap_err();
    assert_eq!(said.exit_code(), 2);
    assert!(said.to_string().contains("clone its repository"), "{said}");
    let here = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
    assert!(checkout(&[nowhere.path().to_owned(), here]).is_ok());
}

#[test]
fn a_board_that_there_is_not_is_refused_with_those_that_there_are() {
    let there = ["a".to_owned(), "b".to_owned()];
    let said = chosen(&["b".to_owned(), "c".to_owned()], &there).unwrap_err();
    assert_eq!(said.to_string(), "--board: found `c`, expected one of: a, b");
    assert_eq!(chosen(&[], &there).unwrap(), there);
    assert_eq!(chosen(&["b".to_owned()], &there).unwrap(), ["b"]);
    assert_eq!(chosen(&["b".to_owned(), "a".to_owned(), "b".to_owned()], &there).unwrap(), there);
}

#[test]
fn a_difference_is_in_the_table_in_the_object_and_in_the_failure() {
    let (drives, sets) = drives(&args(&[])).unwrap();
    let steps = 7 * 144;
    let first = Difference {
        weights: "some weights".into(),
        seed: 3,
        step: 5,
        value: Value(8),
        found: 0x3f80_0001,
        expected: 0x3f80_0000,
    };
    let equal = || Tally { steps, ..Tally::default() };
    let different = Tally { steps, differing_bits: 12, first: Some(first) };
    for json in [false, true] {
        let mut report = Report::new(sets, 7, &drives);
        report.host.push(Machine::new("host, 16 lanes", equal()));
        report.boards.push(Machine::new("first", equal()));
        report.boards.push(Machine::new("second", different.clone()));
        let (stdout, stderr) = (Page::default(), Page::default());
        report.print(&mut Output::to(json, stdout.clone(), stderr.clone()));
        let sentence = "some weights, course 3, step 5: neuron 5 of the first hidden layer: \
                        3f800001 computed, 3f800000 expected (1.0000001e0 and 1e0)";
        assert_eq!(
            report.first_difference(),
            Some(format!("second computes other bits: {sentence}"))
        );
        let (stdout, stderr) = (stdout.text(), stderr.text());
        let table = if json { &stderr } else { &stdout };
        let rows: Vec<Vec<&str>> =
            table.lines().map(|line| line.split_whitespace().collect()).collect();
        assert!(rows.contains(&vec!["first", "1008", "0"]), "{table}");
        assert!(rows.contains(&vec!["second", "1008", "12"]), "{table}");
        if json {
            let object: serde_json::Value = serde_json::from_str(&stdout).unwrap();
            assert_eq!(object["steps"], 1008);
            assert_eq!(object["differing_bits"], 12);
            assert_eq!(object["boards"][0]["first_difference"], serde_json::Value::Null);
            assert_eq!(object["boards"][1]["name"], "second");
            assert_eq!(object["boards"][1]["first_difference"], sentence);
        }
    }
}

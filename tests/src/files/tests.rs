use std::io::Cursor;

use super::*;
use crate::closed_loop::VALUES;

type Reader = Stream<Cursor<Vec<u8>>>;

const CASE: Case = Case { seed: 7, steps: 2 };
const STEPS: [[u32; VALUES]; 2] = [[11; VALUES], [13; VALUES]];

fn reader(bytes: &[u8]) -> Reader {
    Stream(Cursor::new(bytes.to_vec()))
}

fn cases() -> Vec<u8> {
    let mut writer = CasesWriter::new(Stream(Vec::new()), 2).expect("memory");
    writer.add(CASE, &[1, 2, 3]).expect("memory");
    writer.add(Case { seed: 8, steps: 0 }, &[4]).expect("memory");
    writer.finish().expect("memory").0
}

fn read_cases(bytes: &[u8]) -> Result<Vec<(Case, Vec<u32>)>, FileError<std::io::Error>> {
    let mut cases = CasesReader::new(reader(bytes))?;
    let mut room = [0; BLOB_WORDS];
    let mut found = Vec::new();
    while let Some((case, blob)) = cases.next(&mut room)? {
        found.push((case, blob.to_vec()));
    }
    Ok(found)
}

fn results() -> Vec<u8> {
    let mut writer = ResultsWriter::new(Stream(Vec::new()), 1).expect("memory");
    writer.begin(CASE, 0x1234_5678_9abc_def0).expect("memory");
    for step in &STEPS {
        writer.step(step).expect("memory");
    }
    writer.end().expect("memory");
    writer.finish().expect("memory").0
}

fn read_results(bytes: &[u8]) -> Result<Vec<[u32; VALUES]>, FileError<std::io::Error>> {
    let mut results = ResultsReader::new(reader(bytes), 1)?;
    results.begin(CASE, 0x1234_5678_9abc_def0)?;
    let steps = [results.step()?, results.step()?];
    results.end()?;
    results.finish()?;
    Ok(steps.to_vec())
}

#[test]
fn what_is_written_is_read() {
    let found = read_cases(&cases()).expect("as written");
    assert_eq!(found, [(CASE, vec![1, 2, 3]), (Case { seed: 8, steps: 0 }, vec![4])]);
    assert_eq!(read_results(&results()).expect("as written"), STEPS);
}

#[test]
fn the_files_lie_as_specified() {
    let words = |bytes: &[u8]| -> Vec<u32> {
        bytes.as_chunks().0.iter().map(|word| u32::from_le_bytes(*word)).collect()
    };
    let cases = cases();
    assert_eq!(&cases[..8], b"EVOCASES");
    assert_eq!(words(&cases)[2..10], [1, 2, 7, 2, 3, 1, 2, 3]);
    assert_eq!(words(&cases).len(), 4 + (3 + 3 + 2) + (3 + 1 + 2));
    let results = results();
    assert_eq!(&results[..8], b"EVOTRACE");
    assert_eq!(words(&results)[2..9], [1, 1, 0, 2, 0x9abc_def0, 0x1234_5678, 11]);
    assert_eq!(words(&results).len(), 4 + 4 + 2 * VALUES + 2);
}

#[test]
fn every_flipped_bit_is_refused() {
    for (file, read) in [
        (cases(), (|bytes| read_cases(bytes).is_err()) as fn(&[u8]) -> bool),
        (results(), |bytes| read_results(bytes).is_err()),
    ] {
        for bit in 0..8 * file.len() {
            let mut damaged = file.clone();
            damaged[bit / 8] ^= 1 << (bit % 8);
            assert!(read(&damaged), "bit {bit} slipped through");
        }
    }
}

#[test]
fn a_file_of_another_length_is_refused() {
    let (cases, results) = (cases(), results());
    for end in 0..cases.len() {
        assert!(read_cases(&cases[..end]).is_err(), "{end} bytes of cases");
    }
    for end in 0..results.len() {
        assert!(read_results(&results[..end]).is_err(), "{end} bytes of results");
    }
    let longer = |bytes: &[u8]| [bytes, &[0; 4]].concat();
    assert!(matches!(read_cases(&longer(&cases)), Err(FileError::GoesOn)));
    assert!(matches!(read_results(&longer(&results)), Err(FileError::GoesOn)));
}

#[test]
fn refusals_name_what_was_found_and_what_was_expected() {
    let said = |error: FileError<std::io::Error>| error.to_string();
    let refused = |bytes: &[u8]| said(read_results(bytes).expect_err("refused"));
    assert_eq!(refused(&cases()), "it starts with 434f5645 53455341, 544f5645 45434152 expected");
    let mut other = results();
    other[8] = 2;
    assert_eq!(refused(&other), "format version 2, this program reads version 1");
    let mut other = results();
    other[12] = 9;
    assert_eq!(refused(&other), "9 cases, 1 expected");
    let mut other = results();
    other[20] = 3;
    assert_eq!(
        refused(&other),
        "results of case 0, 3 steps, weights 123456789abcdef0; \
         expected case 0, 2 steps, weights 123456789abcdef0"
    );
    let mut long = cases();
    long[25] = 5;
    assert_eq!(
        said(read_cases(&long).expect_err("refused")),
        "a weight blob of 1283 words, at most 1024 expected"
    );
}

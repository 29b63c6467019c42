//! The host as a machine in a proof: `prove-on-host FOLDER` reads `cases` there and writes `results`, as a board does.
//!
//! A process of its own, so that one build can be compared with another.

use std::fs::File;
use std::io::{BufReader, BufWriter};
use std::path::PathBuf;
use std::process::ExitCode;

use equivalence_tests::files::{BLOB_WORDS, Stream};
use equivalence_tests::on_host::Host;
use equivalence_tests::prove::prove;

fn main() -> ExitCode {
    let arguments: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    let [folder] = arguments.as_slice() else {
        eprintln!("prove-on-host: expected one folder with a file `cases`");
        return ExitCode::from(2);
    };
    let files = File::open(folder.join("cases"))
        .and_then(|cases| Ok((cases, File::create(folder.join("results"))?)));
    let said = match files {
        Err(error) => format!("{}: {error}", folder.display()),
        Ok((cases, results)) => {
            let cases = Stream(BufReader::new(cases));
            let results = Stream(BufWriter::new(results));
            match prove::<Host, _, _>(cases, results, &mut [0; BLOB_WORDS]) {
                Ok(_) => return ExitCode::SUCCESS,
                Err(error) => error.to_string(),
            }
        }
    };
    eprintln!("prove-on-host: {said}");
    ExitCode::FAILURE
}

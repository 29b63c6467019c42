//! Programs of this machine that tests use as second opinions.

use std::env;
use std::path::PathBuf;

/// The program of that name on the search path.
///
/// Without it a test is left out, and says so; where everything must run (`CI` or
/// `EVOSTEER_REQUIRE_ALL` is set) that is a failure.
pub(crate) fn find(program: &str) -> Option<PathBuf> {
    let path = env::var_os("PATH").unwrap_or_default();
    let found = env::split_paths(&path)
        .map(|folder| folder.join(program).with_extension(env::consts::EXE_EXTENSION))
        .find(|candidate| candidate.is_file());
    let must_run = ["CI", "EVOSTEER_REQUIRE_ALL"].iter().any(|name| env::var_os(name).is_some());
    match found {
        None if must_run => panic!("{program} is not installed here, and every test must run"),
        None => eprintln!("NOT RUN: {program} is not installed here"),
        Some(_) => {}
    }
    found
}

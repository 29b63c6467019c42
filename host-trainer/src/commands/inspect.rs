//! `evosteer inspect`: what a blob holds, or why it is refused.

mod layers;
mod remains;
mod report;
mod self_test;

use std::path::PathBuf;

use crate::blob_file::{BlobFile, FileBytes, refusal};
use crate::failure::Failure;
use crate::output::Output;
use remains::Remains;
use report::Report;
use self_test::SelfTest;

/// Shows what a weight blob holds, or why it is refused
///
/// Header, weights and check are read by the code that the car runs, and the self-test that
/// the blob records is computed on this machine.
#[derive(Clone, Debug, clap::Args)]
pub struct InspectArgs {
    /// A weight blob, or a run folder for its champion.blob
    blob: PathBuf,

    /// Print the result as one JSON object
    #[arg(long)]
    pub json: bool,
}

/// Inspects a blob.
///
/// # Errors
///
/// Bad input for a file that is no blob, after printing what it is, and for a blob that
/// computes something else here than where it was trained; input/output when it cannot be
/// read.
pub fn run(args: &InspectArgs, output: &mut Output) -> Result<(), Failure> {
    match BlobFile::check(FileBytes::read("BLOB", &args.blob)?) {
        Err((file, cause)) => {
            Remains::new(&file, &cause).print(output);
            Err(refusal(file.path(), &cause))
        }
        Ok(file) => {
            let self_test = SelfTest::run(&file.blob());
            Report::new(&file, &self_test).print(output);
            match self_test {
                SelfTest::Failed(error) => {
                    Err(Failure::bad_input(format!("{}: {error}", file.path().display())))
                }
                _ => Ok(()),
            }
        }
    }
}

#[cfg(test)]
mod tests;

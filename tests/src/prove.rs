//! Drives every case of a file and writes down what came of it: the program of every machine in a proof.

use controller_core::blob::{Blob, BlobError};

use crate::closed_loop::{ClosedLoop, Inspect};
use crate::course::Course;
use crate::files::{BLOB_WORDS, Case, CasesReader, FileError, ResultsWriter, Sink, Source};

/// What computes: how a machine makes a controller of a weight blob.
pub trait Machine {
    /// Its controllers.
    type Controller<'w>: Inspect;

    /// Why it makes none.
    type Refusal;

    /// A controller at the start of a drive.
    ///
    /// # Errors
    ///
    /// Weights that this machine cannot use.
    fn controller<'w>(blob: &Blob<'w>) -> Result<Self::Controller<'w>, Self::Refusal>;
}

/// Why a machine did not get to the end of its cases.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ProofError<R, S, K> {
    /// The cases cannot be read.
    Cases(FileError<S>),
    /// The results cannot be written.
    Results(K),
    /// A case's weights are no blob.
    Blob {
        /// Number of the case.
        case: u32,
        /// Why not.
        error: BlobError,
    },
    /// The machine cannot use a case's weights.
    Refused {
        /// Number of the case.
        case: u32,
        /// Why not.
        refusal: R,
    },
}

controller_core::sentences! { impl<R, S, K> ProofError<R, S, K> {
    Self::Cases(error) => "cases refused: {}", error;
    Self::Results(error) => "results cannot be written: {}", error;
    Self::Blob { case, error } => "case {}: weights refused: {}", case, error;
    Self::Refused { case, refusal } => "case {}: weights refused: {}", case, refusal;
} }

/// What was driven.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Driven {
    /// Cases.
    pub cases: u32,
    /// Steps of all of them.
    pub steps: u32,
}

/// What came of a machine's cases.
pub type Proof<M, S, K> =
    Result<Driven, ProofError<<M as Machine>::Refusal, <S as Source>::Error, <K as Sink>::Error>>;

/// Reads cases, drives each on `M`, and writes every value of every step. `room` holds one weight blob.
///
/// # Errors
///
/// The first thing that is wrong; the results then end early.
pub fn prove<M: Machine, S: Source, K: Sink>(
    cases: S,
    results: K,
    room: &mut [u32; BLOB_WORDS],
) -> Proof<M, S, K> {
    let mut cases = CasesReader::new(cases).map_err(ProofError::Cases)?;
    let mut results = ResultsWriter::new(results, cases.left()).map_err(ProofError::Results)?;
    let mut driven = Driven::default();
    while let Some((case, words)) = cases.next(room).map_err(ProofError::Cases)? {
        let number = driven.cases;
        let blob = Blob::parse(bytemuck::cast_slice(words))
            .map_err(|error| ProofError::Blob { case: number, error })?;
        let mut controller = M::controller(&blob)
            .map_err(|refusal| ProofError::Refused { case: number, refusal })?;
        drive(case, &blob, &mut controller, &mut results).map_err(ProofError::Results)?;
        driven.cases = driven.cases.wrapping_add(1);
        driven.steps = driven.steps.wrapping_add(case.steps);
    }
    results.finish().map_err(ProofError::Results)?;
    Ok(driven)
}

fn drive<K: Sink>(
    case: Case,
    blob: &Blob<'_>,
    controller: &mut impl Inspect,
    results: &mut ResultsWriter<K>,
) -> Result<(), K::Error> {
    results.begin(case, blob.check())?;
    let mut car = ClosedLoop::new(blob.header(), Course::Seeded(case.seed));
    for _ in 0..case.steps {
        results.step(&car.step(controller))?;
    }
    results.end()
}

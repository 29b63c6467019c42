//! Why a command ended early, and the exit code that says so to a script.

use std::fmt;
use std::path::Path;

/// The reason a command did not finish: a sentence for people and a code for machines.
#[derive(Debug)]
pub struct Failure {
    kind: FailureKind,
    message: String,
}

/// What kind of thing went wrong; decides the exit code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FailureKind {
    /// What had to be equal is not: 1.
    Different,
    /// The user's files or options do not make sense: 2.
    BadInput,
    /// Reading or writing failed: 3.
    InputOutput,
    /// Another process holds the run folder: 4.
    Busy,
    /// A signal asked us to stop and the checkpoint is written: 128 + its number.
    Interrupted {
        /// Number of the signal: 2 is SIGINT, 15 is SIGTERM.
        signal: u8,
    },
}

impl Failure {
    /// Bad input; the message names the place and what was expected.
    pub fn bad_input(message: impl Into<String>) -> Self {
        Self { kind: FailureKind::BadInput, message: message.into() }
    }

    /// An operating-system error while doing `what` with `path`.
    pub fn io(what: &str, path: &Path, cause: &std::io::Error) -> Self {
        let message = format!("cannot {what} {}: {cause}", path.display());
        Self { kind: FailureKind::InputOutput, message }
    }

    /// Any failure, with its kind.
    pub fn new(kind: FailureKind, message: impl Into<String>) -> Self {
        Self { kind, message: message.into() }
    }

    /// What kind of thing went wrong.
    pub fn kind(&self) -> FailureKind {
        self.kind
    }

    /// The process's exit code (1 different, 2 bad input, 3 input/output, 4 busy, 130/143 interrupted).
    pub fn exit_code(&self) -> u8 {
        match self.kind {
            FailureKind::Different => 1,
            FailureKind::BadInput => 2,
            FailureKind::InputOutput => 3,
            FailureKind::Busy => 4,
            FailureKind::Interrupted { signal } => 128 + signal,
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for Failure {}

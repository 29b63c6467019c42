//! Why a task ended early, and the exit code for it.

use std::fmt;

/// The sentence an operator reads, and the process's exit code.
#[derive(Debug)]
pub(crate) struct Failure {
    message: String,
    code: u8,
}

impl Failure {
    /// A check, a build or a board failed: 1.
    pub(crate) fn failed(message: impl Into<String>) -> Self {
        Self { message: message.into(), code: 1 }
    }

    /// The command line makes no sense: 2.
    pub(crate) fn usage(message: impl Into<String>) -> Self {
        Self { message: message.into(), code: 2 }
    }

    /// Something that has to be installed first is not there: 3.
    pub(crate) fn missing(what: &str, fix: &str) -> Self {
        Self { message: format!("{what} is missing; get it with: {fix}"), code: 3 }
    }

    /// A board ended with `code`, or was stopped with it.
    #[cfg(feature = "decode")]
    pub(crate) fn board(message: impl Into<String>, code: u8) -> Self {
        Self { message: message.into(), code }
    }

    /// The process's exit code, never 0.
    pub(crate) fn exit_code(&self) -> u8 {
        self.code
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

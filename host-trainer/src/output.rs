//! What a command says, to people and to machines, over streams that may break.
//!
//! | | without `--json` | with `--json` |
//! | --- | --- | --- |
//! | lines for people | standard output | standard error |
//! | the one JSON object | – | standard output |
//! | warnings, notes, progress | standard error | standard error |
//!
//! Nothing here panics. After the reader of a pipe has gone (`| head -1`) the rest is
//! dropped in silence and the work goes on; a full disk is a failure, reported by
//! [`Output::finish`] when the work is safe.

#[cfg(test)]
mod page;
pub mod progress;
mod stream;
mod trials;

use std::collections::HashSet;
use std::fmt::Display;
use std::io::{IsTerminal, Write};

use serde::Serialize;

#[cfg(test)]
pub(crate) use page::Page;
pub use progress::Progress;
use stream::Stream;
pub use trials::TrialProgress;

use crate::failure::{Failure, FailureKind};

/// A command's standard output and standard error.
#[derive(Debug)]
pub struct Output {
    json: bool,
    stdout: Stream,
    stderr: Stream,
    /// Notes that were printed.
    noted: HashSet<String>,
}

impl Output {
    /// The process's streams; `json` is the option `--json`.
    pub fn new(json: bool) -> Self {
        Self::to(json, std::io::stdout(), std::io::stderr())
    }

    /// Any streams.
    pub fn to(
        json: bool,
        stdout: impl Write + Send + 'static,
        stderr: impl Write + Send + 'static,
    ) -> Self {
        Self {
            json,
            stdout: Stream::new(stdout),
            stderr: Stream::new(stderr),
            noted: HashSet::new(),
        }
    }

    /// Whether the result goes to a machine.
    pub fn is_json(&self) -> bool {
        self.json
    }

    /// Whether standard error is a terminal, where a progress bar makes sense.
    pub fn is_interactive() -> bool {
        std::io::stderr().is_terminal()
    }

    /// Prints a line for people.
    pub fn line(&mut self, text: impl Display) {
        let stream = if self.json { &mut self.stderr } else { &mut self.stdout };
        stream.write(format!("{text}\n").as_bytes());
    }

    /// Prints a warning: something the user should know and need not act on.
    pub fn warning(&mut self, text: impl Display) {
        self.stderr.write(format!("warning: {text}\n").as_bytes());
    }

    /// Prints a note: what was done that the user may not expect. Each text once.
    pub fn note(&mut self, text: impl Display) {
        let text = text.to_string();
        if self.noted.insert(text.clone()) {
            self.stderr.write(format!("note: {text}\n").as_bytes());
        }
    }

    /// Prints a line of progress, to standard error.
    pub fn status(&mut self, text: impl Display) {
        self.stderr.write(format!("{text}\n").as_bytes());
    }

    /// Prints the result as one JSON object when asked for by `--json`.
    ///
    /// JSON has no infinities and no NaN: serde_json writes them as `null`.
    pub fn json(&mut self, result: &impl Serialize) {
        if !self.json {
            return;
        }
        match serde_json::to_vec_pretty(result) {
            Ok(mut bytes) => {
                bytes.push(b'\n');
                self.stdout.write(&bytes);
            }
            Err(error) => self.stdout.fail(error.into()),
        }
    }

    /// Writes raw bytes to standard output, for commands whose product is a file.
    pub fn bytes(&mut self, bytes: &[u8]) {
        self.stdout.write(bytes);
    }

    /// Reports what went wrong with standard output, if anything did.
    ///
    /// A closed pipe is no failure: its reader has seen enough. Trouble with standard
    /// error is none either, since there is nowhere left to tell it.
    ///
    /// # Errors
    ///
    /// Input/output with the system's reason.
    pub fn finish(mut self) -> Result<(), Failure> {
        match self.stdout.take_error() {
            Some(cause) => Err(Failure::new(
                FailureKind::InputOutput,
                format!("cannot write to standard output: {cause}"),
            )),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests;

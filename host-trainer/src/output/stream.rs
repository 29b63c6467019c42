//! One stream that remembers how it broke instead of panicking.

use std::fmt;
use std::io::{self, ErrorKind, Write};

/// A stream that accepts everything; what cannot be delivered is dropped.
pub(super) struct Stream {
    to: Box<dyn Write + Send>,
    state: State,
}

#[derive(Debug)]
enum State {
    Open,
    /// The reader has gone.
    Closed,
    Failed(io::Error),
}

impl Stream {
    pub(super) fn new(to: impl Write + Send + 'static) -> Self {
        Self { to: Box::new(to), state: State::Open }
    }

    /// Delivers `bytes` now, not when some buffer is full.
    pub(super) fn write(&mut self, bytes: &[u8]) {
        if !matches!(self.state, State::Open) {
            return;
        }
        if let Err(cause) = self.to.write_all(bytes).and_then(|()| self.to.flush()) {
            self.fail(cause);
        }
    }

    /// Takes the stream out of use.
    pub(super) fn fail(&mut self, cause: io::Error) {
        self.state = match cause.kind() {
            ErrorKind::BrokenPipe => State::Closed,
            _ => State::Failed(cause),
        };
    }

    /// The error that took the stream out of use, unless its reader just left.
    pub(super) fn take_error(&mut self) -> Option<io::Error> {
        match std::mem::replace(&mut self.state, State::Closed) {
            State::Failed(cause) => Some(cause),
            State::Open | State::Closed => None,
        }
    }
}

impl fmt::Debug for Stream {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Stream").field("state", &self.state).finish_non_exhaustive()
    }
}

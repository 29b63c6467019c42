//! Signals become a flag that the training loop looks at, or an error that a write returns.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

use crate::failure::{Failure, FailureKind};

/// Makes a write past the file-size limit, which would kill the process by SIGXFSZ, an ordinary
/// error. A closed pipe is one already: Rust's start-up ignores SIGPIPE.
///
/// # Errors
///
/// Input/output when the system refuses the handler.
pub fn survive_a_full_file() -> Result<(), Failure> {
    // Handled rather than ignored: signal-hook offers no SIG_IGN, and any handler will do.
    #[cfg(unix)]
    flag::register(signal_hook::consts::SIGXFSZ, Arc::new(AtomicBool::new(false)))
        .map_err(|cause| refused(&cause))?;
    Ok(())
}

fn refused(cause: &io::Error) -> Failure {
    Failure::new(FailureKind::InputOutput, format!("cannot handle signals: {cause}"))
}

/// Whether someone asked the process to stop.
///
/// The first SIGINT (Ctrl-C) or SIGTERM raises the flag; the second one ends the process at
/// once with code 128 + its number.
#[derive(Clone, Debug, Default)]
pub struct StopFlag {
    /// Number of the signal that came, 0 while none did.
    signal: Arc<AtomicUsize>,
}

impl StopFlag {
    /// Takes over this process's SIGINT and SIGTERM. Call it once.
    ///
    /// # Errors
    ///
    /// Input/output when the system refuses the handlers.
    pub fn install() -> Result<Self, Failure> {
        Self::try_install().map_err(|cause| refused(&cause))
    }

    fn try_install() -> io::Result<Self> {
        let stop = Self::default();
        let armed = Arc::new(AtomicBool::new(false));
        for signal in [SIGINT, SIGTERM] {
            // In this order, so that the first signal arms what the second one meets.
            flag::register_conditional_shutdown(signal, 128 + signal, Arc::clone(&armed))?;
            flag::register_usize(signal, Arc::clone(&stop.signal), signal as usize)?;
            flag::register(signal, Arc::clone(&armed))?;
        }
        Ok(stop)
    }

    /// Asks to stop as if `signal` had come, for callers that run training inside
    /// another program.
    pub fn request(&self, signal: u8) {
        self.signal.store(usize::from(signal), Ordering::SeqCst);
    }

    /// Number of the signal that asked to stop, if one did: 2 is SIGINT, 15 is SIGTERM.
    ///
    /// ```
    /// use host_trainer::signals::StopFlag;
    ///
    /// let stop = StopFlag::default();
    /// assert_eq!(stop.requested(), None);
    /// stop.request(2);
    /// assert_eq!(stop.requested(), Some(2));
    /// ```
    pub fn requested(&self) -> Option<u8> {
        u8::try_from(self.signal.load(Ordering::SeqCst)).ok().filter(|&signal| signal != 0)
    }
}

#[cfg(test)]
#[cfg(unix)]
mod tests;

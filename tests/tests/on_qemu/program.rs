//! A board's program: built by xtask, changed in place, run by xtask.

use std::ffi::OsStr;
use std::path::PathBuf;
use std::process::Output;
use std::sync::atomic::{AtomicU32, Ordering};

use equivalence_tests::checkout::Checkout;
use equivalence_tests::harness::Trouble;

/// An ELF file for a board.
pub(crate) struct Program {
    board: String,
    elf: Vec<u8>,
}

/// How a run ended.
pub(crate) struct Outcome {
    code: Option<i32>,
    text: String,
}

impl Program {
    /// Builds it, with the `sabotage-*` feature given.
    pub(crate) fn build(board: &str, sabotage: Option<&str>) -> Result<Self, Trouble> {
        let path = Checkout::compiled_in().build(board, sabotage)?;
        let elf = std::fs::read(&path)
            .map_err(|error| Trouble::Failed(format!("{}: {error}", path.display())))?;
        Ok(Self { board: board.to_owned(), elf })
    }

    /// Whether the data is built in.
    pub(crate) fn has(&self, data: &[u8]) -> bool {
        self.elf.windows(data.len()).any(|window| window == data)
    }

    /// The same program with other data in the place of `data`, which must be in it exactly once.
    pub(crate) fn with(&self, data: &[u8], other: &[u8]) -> Result<Self, Trouble> {
        assert_eq!(data.len(), other.len(), "the program's layout must stay");
        let places: Vec<usize> = self
            .elf
            .windows(data.len())
            .enumerate()
            .filter_map(|(place, window)| (window == data).then_some(place))
            .collect();
        let [place] = places.as_slice() else {
            return Err(Trouble::Failed(format!(
                "the data is in the program {} times",
                places.len()
            )));
        };
        let mut elf = self.elf.clone();
        elf[*place..place + data.len()].copy_from_slice(other);
        Ok(Self { board: self.board.clone(), elf })
    }

    /// Runs it to its end, its flash for weights erased.
    pub(crate) fn run(&self) -> Result<Outcome, Trouble> {
        self.run_for(60)
    }

    /// Runs it to its end with these bytes in its flash for weights.
    pub(crate) fn run_with_weights(&self, weights: &[u8]) -> Result<Outcome, Trouble> {
        let weights = Temporary::new("blob", weights)?;
        self.start(&["--weights", &weights.path()])
    }

    /// Runs it for so many seconds at most.
    pub(crate) fn run_for(&self, seconds: u32) -> Result<Outcome, Trouble> {
        self.start(&["--timeout", &seconds.to_string()])
    }

    fn start(&self, options: &[&str]) -> Result<Outcome, Trouble> {
        let elf = Temporary::new("elf", &self.elf)?;
        let path = elf.path();
        let mut arguments = vec!["qemu", &path, "--board", &self.board];
        arguments.extend(options);
        let arguments: Vec<&OsStr> = arguments.into_iter().map(OsStr::new).collect();
        let output = Checkout::compiled_in().xtask(&arguments)?;
        Ok(Outcome { code: output.status.code(), text: text(&output) })
    }
}

/// A file that is gone when it is no longer needed.
struct Temporary(PathBuf);

impl Temporary {
    fn new(ending: &str, bytes: &[u8]) -> Result<Self, Trouble> {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let number = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = format!("{}-{number}.{ending}", std::process::id());
        let file = Self(PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name));
        std::fs::write(&file.0, bytes)
            .map_err(|error| Trouble::Failed(format!("{}: {error}", file.path())))?;
        Ok(file)
    }

    fn path(&self) -> String {
        self.0.display().to_string()
    }
}

impl Drop for Temporary {
    fn drop(&mut self) {
        // A file left behind in cargo's folder for such files harms nobody.
        let _ = std::fs::remove_file(&self.0);
    }
}

impl Outcome {
    /// Fails unless the run ended with this exit code.
    pub(crate) fn expect(&self, code: i32) -> Result<(), Trouble> {
        if self.code == Some(code) {
            return Ok(());
        }
        Err(Trouble::Failed(format!(
            "exit code {code} expected, found {:?}:\n{}",
            self.code, self.text
        )))
    }

    /// Fails unless the run printed this.
    pub(crate) fn expect_text(&self, text: &str) -> Result<(), Trouble> {
        if self.text.contains(text) {
            return Ok(());
        }
        Err(Trouble::Failed(format!("expected `{text}`, found:\n{}", self.text)))
    }

    /// Fails if the run printed this.
    pub(crate) fn expect_no_text(&self, text: &str) -> Result<(), Trouble> {
        if self.text.contains(text) {
            return Err(Trouble::Failed(format!("`{text}` not expected, found:\n{}", self.text)));
        }
        Ok(())
    }

    /// Fails unless the run printed a line about `subject` with this in it.
    pub(crate) fn expect_line(&self, subject: &str, text: &str) -> Result<(), Trouble> {
        let about = format!("{subject}:");
        if self.text.lines().any(|line| line.contains(&about) && line.contains(text)) {
            return Ok(());
        }
        Err(Trouble::Failed(format!("{about} expected `{text}`, found:\n{}", self.text)))
    }
}

fn text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

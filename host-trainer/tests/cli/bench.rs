//! A folder to work in, and the program started there.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Output, Stdio};

use tempfile::TempDir;

/// Options of a training that takes a few hundredths of a second.
pub(crate) const TINY: &[&str] =
    &["--population=12", "--generations=3", "--set=pairs.count=2", "--set=episode.step_limit=60"];

/// A working directory, removed at the end of the test.
pub(crate) struct Bench(TempDir);

/// What the program left behind on its way out.
pub(crate) struct Done {
    pub(crate) stdout: String,
    pub(crate) stderr: String,
    status: ExitStatus,
}

impl Bench {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    pub(crate) fn path(&self, name: impl AsRef<Path>) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn file(&self, name: &str, bytes: impl AsRef<[u8]>) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }

    /// The program, about to start here as if from a shell.
    pub(crate) fn program(&self, arguments: impl IntoIterator<Item: AsRef<OsStr>>) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_evosteer"));
        command.args(arguments).current_dir(self.0.path());
        neutral(&mut command);
        command
    }

    /// Runs the program to its end.
    pub(crate) fn run(&self, arguments: impl IntoIterator<Item: AsRef<OsStr>>) -> Done {
        Done::from(self.program(arguments).output().unwrap())
    }

    /// Runs it with the words of one line; none of them may hold a blank.
    pub(crate) fn say(&self, line: &str) -> Done {
        self.run(line.split_whitespace())
    }

    /// Trains on `scenario` in a moment, into `folder`.
    pub(crate) fn train(&self, scenario: &str, folder: &str, more: &[&str]) -> Done {
        let place = ["train", scenario, "--out", folder];
        self.run(place.iter().chain(TINY).chain(more))
    }

    /// Everything that equal runs have in common: all files but those about this very process.
    pub(crate) fn results(&self, folder: &str) -> BTreeMap<String, Vec<u8>> {
        let mut files = self.all_files(folder);
        files.retain(|name, _| {
            !["timing.csv", "lock", "checkpoint-a.bin", "checkpoint-b.bin"].contains(&&**name)
        });
        files
    }

    pub(crate) fn all_files(&self, folder: &str) -> BTreeMap<String, Vec<u8>> {
        fn collect(base: &Path, folder: &Path, files: &mut BTreeMap<String, Vec<u8>>) {
            for entry in std::fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                if path.is_dir() {
                    collect(base, &path, files);
                } else {
                    let name = path.strip_prefix(base).unwrap().display().to_string();
                    files.insert(name, std::fs::read(&path).unwrap());
                }
            }
        }
        let base = self.path(folder);
        let mut files = BTreeMap::new();
        collect(&base, &base, &mut files);
        files
    }
}

/// Takes what the test runner's environment would change about the program's words.
pub(crate) fn neutral(command: &mut Command) {
    for name in ["CARGO_PKG_NAME", "COLUMNS", "CLICOLOR_FORCE", "RUST_BACKTRACE"] {
        command.env_remove(name);
    }
    command.stdin(Stdio::null());
}

impl Done {
    /// The exit code; none after a signal.
    pub(crate) fn code(&self) -> Option<i32> {
        self.status.code()
    }

    /// Both streams.
    pub(crate) fn text(&self) -> String {
        format!("{}{}", self.stdout, self.stderr)
    }

    /// Itself, if it ended in this code and without a panic.
    #[track_caller]
    pub(crate) fn ends_in(self, code: i32) -> Self {
        assert_eq!(self.code(), Some(code), "{}\n{}", self.status, self.text());
        self
    }
}

impl From<Output> for Done {
    #[track_caller]
    fn from(output: Output) -> Self {
        let Output { stdout, stderr, status } = output;
        let text = |bytes| String::from_utf8(bytes).unwrap();
        let done = Self { stdout: text(stdout), stderr: text(stderr), status };
        let words = ["panicked", "RUST_BACKTRACE", "stack backtrace", "memory allocation of"];
        assert!(!words.iter().any(|word| done.text().contains(word)), "{}", done.text());
        done
    }
}

/// Whether a folder holds files that were begun and not finished.
pub(crate) fn unfinished(files: &BTreeMap<String, Vec<u8>>) -> Vec<&String> {
    files.keys().filter(|name| name.contains(".evosteer-unfinished-")).collect()
}

/// Says that a test cannot run here; fails instead where nothing may be left out.
#[cfg(unix)]
pub(crate) fn not_run(why: &str) {
    assert!(std::env::var("EVOSTEER_REQUIRE_ALL").as_deref() != Ok("1"), "NOT RUN: {why}");
    eprintln!("NOT RUN: {why}");
}

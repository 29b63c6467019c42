//! The emulated boards: built and run by `cargo xtask` in a checkout of this repository.

use std::ffi::OsStr;
use std::fmt;
use std::fs::File;
use std::io::{BufReader, BufWriter};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use crate::compare::{self, Drive, Tally};
use crate::files::{CasesWriter, Stream};

/// xtask's exit code where a tool is missing.
const MISSING: i32 = 3;

/// Steps a second that the slowest board makes even on a busy host; a proof that takes longer hangs.
const SLOWEST: u64 = 30;

/// A folder with this repository's sources.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Checkout(PathBuf);

/// Why a board did not do its part.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Trouble {
    /// A tool is missing: which, and the command that gets it.
    Missing(String),
    /// It did not run to its end, or its results cannot be used.
    Failed(String),
}

impl fmt::Display for Trouble {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing(said) | Self::Failed(said) => f.write_str(said),
        }
    }
}

impl std::error::Error for Trouble {}

impl Checkout {
    /// The checkout that this program was compiled in.
    pub fn compiled_in() -> Self {
        Self(PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/..")))
    }

    /// The checkout that this folder lies in, if it lies in one.
    pub fn around(folder: &Path) -> Option<Self> {
        let is_one = |folder: &&Path| {
            ["xtask/Cargo.toml", "firmware-example/boards", "controller-core/Cargo.toml"]
                .iter()
                .all(|part| folder.join(part).exists())
        };
        folder.ancestors().find(is_one).map(|folder| Self(folder.to_owned()))
    }

    /// Its top folder.
    pub fn folder(&self) -> &Path {
        &self.0
    }

    /// The boards that an emulator stands in for, sorted: those whose feature asks for the feature `emulated`.
    ///
    /// # Errors
    ///
    /// A manifest that cannot be read, or that lists none.
    pub fn boards(&self) -> Result<Vec<String>, Trouble> {
        let manifest = self.0.join("firmware-example/Cargo.toml");
        let text = std::fs::read_to_string(&manifest)
            .map_err(|error| Trouble::Failed(format!("{}: {error}", manifest.display())))?;
        let mut boards: Vec<String> = text
            .lines()
            .filter_map(|line| line.strip_prefix("board-")?.split_once(" = ["))
            .filter(|(_, features)| features.contains("\"emulated\""))
            .map(|(board, _)| board.to_owned())
            .collect();
        boards.sort();
        if boards.is_empty() {
            return Err(Trouble::Failed(format!("{}: no emulated board", manifest.display())));
        }
        Ok(boards)
    }

    /// Runs `cargo xtask` with these arguments and returns what it said and how it ended.
    ///
    /// # Errors
    ///
    /// A tool is missing, or cargo cannot be started.
    pub fn xtask(&self, arguments: &[&OsStr]) -> Result<Output, Trouble> {
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let output = Command::new(&cargo)
            .current_dir(&self.0)
            .arg("xtask")
            .args(arguments)
            .output()
            .map_err(|error| {
                Trouble::Missing(format!("cannot start {}: {error}", cargo.display()))
            })?;
        if output.status.code() == Some(MISSING) {
            let said = String::from_utf8_lossy(&output.stderr);
            let reason = said.lines().last().unwrap_or_default();
            return Err(Trouble::Missing(reason.trim_start_matches("xtask: ").to_owned()));
        }
        Ok(output)
    }

    /// Builds a board's program, spoilt by the `sabotage-*` feature given; returns where it is.
    ///
    /// # Errors
    ///
    /// A tool is missing, or the build fails.
    pub fn build(&self, board: &str, sabotage: Option<&str>) -> Result<PathBuf, Trouble> {
        let mut arguments = vec!["build", board];
        arguments.extend(sabotage.into_iter().flat_map(|sabotage| ["--sabotage", sabotage]));
        let arguments: Vec<&OsStr> = arguments.into_iter().map(OsStr::new).collect();
        self.made(&arguments)
    }

    /// Runs a `cargo xtask` that prints the path of what it makes, and returns the path.
    ///
    /// # Errors
    ///
    /// A tool is missing, or the command fails.
    pub fn made(&self, arguments: &[&OsStr]) -> Result<PathBuf, Trouble> {
        let output = succeeded(self.xtask(arguments)?)?;
        Ok(PathBuf::from(String::from_utf8_lossy(&output.stdout).trim_end()))
    }

    /// Has a board drive all of `drives` and returns the file with its results, in `folder`, which has to be there
    /// and gets its cases too.
    ///
    /// # Errors
    ///
    /// A tool is missing, the files cannot be written, or the board does not get to the end.
    pub fn drive(
        &self,
        board: &str,
        program: &Path,
        folder: &Path,
        drives: &[Drive],
    ) -> Result<Stream<BufReader<File>>, Trouble> {
        let cases = folder.join("cases");
        write_cases(&cases, drives)
            .map_err(|error| Trouble::Failed(format!("{}: {error}", cases.display())))?;
        let steps: u64 = drives.iter().map(|drive| u64::from(drive.case.steps)).sum();
        let seconds = (60 + steps / SLOWEST).min(86_400).to_string();
        let arguments: [&OsStr; 8] = [
            "qemu".as_ref(),
            program.as_ref(),
            "--board".as_ref(),
            board.as_ref(),
            "--prove".as_ref(),
            folder.as_ref(),
            "--timeout".as_ref(),
            seconds.as_ref(),
        ];
        succeeded(self.xtask(&arguments)?)?;
        let results = folder.join("results");
        let file = File::open(&results)
            .map_err(|error| Trouble::Failed(format!("{}: {error}", results.display())))?;
        Ok(Stream(BufReader::with_capacity(1 << 16, file)))
    }

    /// Has a board drive all of `drives` and compares every value with what the host computes; `folder` is for its
    /// files.
    ///
    /// # Errors
    ///
    /// As [`Self::drive`], and results that are damaged.
    pub fn prove(
        &self,
        board: &str,
        program: &Path,
        folder: &Path,
        drives: &[Drive],
    ) -> Result<Tally, Trouble> {
        let results = self.drive(board, program, folder, drives)?;
        compare::with_host(drives, results)
            .map_err(|error| Trouble::Failed(format!("results of {board} refused: {error}")))
    }
}

/// Writes a file of cases.
///
/// # Errors
///
/// What the system reports.
pub fn write_cases(file: &Path, drives: &[Drive]) -> std::io::Result<()> {
    let stream = Stream(BufWriter::new(File::create(file)?));
    let mut writer = CasesWriter::new(stream, drives.len() as u32)?;
    for Drive { weights, case } in drives {
        writer.add(*case, weights.words())?;
    }
    writer.finish().map(|_| ())
}

fn succeeded(output: Output) -> Result<Output, Trouble> {
    if output.status.success() {
        return Ok(output);
    }
    let said =
        [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned());
    Err(Trouble::Failed(said.concat().trim_end().to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_checkout_is_found_from_any_folder_in_it_and_nowhere_else() {
        let here = Path::new(env!("CARGO_MANIFEST_DIR"));
        let found = Checkout::around(&here.join("src")).expect("this is one");
        assert_eq!(found.folder(), here.parent().expect("the workspace"));
        assert_eq!(Checkout::around(Path::new("/")), None);
    }

    #[test]
    fn the_emulated_boards_are_those_with_a_folder_but_the_real_one() {
        let mut folders: Vec<String> =
            std::fs::read_dir(Checkout::compiled_in().folder().join("firmware-example/boards"))
                .expect("boards")
                .map(|entry| entry.expect("entry").file_name().to_string_lossy().into_owned())
                .filter(|name| name != "pico2")
                .collect();
        folders.sort();
        assert_eq!(Checkout::compiled_in().boards().expect("listed"), folders);
    }
}

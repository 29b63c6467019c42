//! The champion that a run begins with, where it does not begin with random networks.

use crate::blob_file::BlobFile;
use crate::champion::shipped::{Champion, scenes};
use crate::failure::Failure;
use crate::fingerprint::sha256;
use crate::output::Output;
use crate::problem::{Problem, adopt_car};
use crate::run_folder::RunFolder;
use crate::run_folder::manifest::Input;
use crate::scenario::words_of;
use std::fmt;
use std::path::{Path, PathBuf};

/// What `--from` may name, as messages say it.
fn what_it_names() -> String {
    format!("a weight blob, a run folder, or the scene of a shipped champion: {}", scenes())
}

/// Why a refinement without `--from` is refused.
pub(super) fn missing() -> Failure {
    Failure::bad_input(format!(
        "--preset refine goes on from a champion; expected --from with {}",
        what_it_names()
    ))
}

/// Such a champion, read and checked.
pub(super) struct Beginning {
    champion: BlobFile,
    /// What it is called on the command line, and what it was then.
    input: Input,
}

impl Beginning {
    /// Reads what `--from` names: the scene of a shipped champion, a weight blob, or a run folder.
    ///
    /// # Errors
    ///
    /// Nothing there, or no blob.
    pub(super) fn read(path: &Path) -> Result<Self, Failure> {
        let champion = match path.to_str().and_then(Champion::of) {
            Some(shipped) => shipped.file(),
            None if !path.exists() => {
                return Err(Failure::bad_input(format!(
                    "--from {}: no such file; expected {}",
                    path.display(),
                    what_it_names()
                )));
            }
            None => BlobFile::read_as("--from", path)?,
        };
        let sha256 = sha256(champion.bytes());
        // A manifest is Unicode.
        let path = PathBuf::from(path.to_string_lossy().into_owned());
        Ok(Self { champion, input: Input { path, sha256 } })
    }

    /// The copy that a run has, or the original, unchanged, where the run was killed before it had one.
    ///
    /// # Errors
    ///
    /// Neither is there, or it is no longer what it was.
    pub(super) fn of_run(folder: &RunFolder, input: Input) -> Result<Self, Failure> {
        let path = folder.join(RunFolder::FROM);
        let has_copy = path.exists();
        let champion = if has_copy {
            BlobFile::read_as("--resume", &path)?
        } else {
            let original = Self::read(&input.path).map_err(|cause| {
                Failure::bad_input(format!(
                    "--resume: the run in {} has lost {}, its copy of the champion that it began with, and the \
                     original cannot take its place: {cause}",
                    folder.path().display(),
                    RunFolder::FROM
                ))
            })?;
            original.champion
        };
        input.expect(&sha256(champion.bytes()), champion.path(), folder)?;
        let beginning = Self { champion, input };
        if !has_copy {
            beginning.copy_to(folder)?;
        }
        Ok(beginning)
    }

    /// Refuses a champion whose weights would mean something else: with another network than the
    /// problem's, another encoding of its inputs, or weights beyond the bound. Says what it begins with,
    /// and where the car is another one.
    ///
    /// # Errors
    ///
    /// Such a champion.
    pub(super) fn check(&self, problem: &Problem, output: &mut Output) -> Result<(), Failure> {
        let blob = self.champion.blob();
        let header = blob.header();
        let name = self.input.path.display();
        let refused = |what: &str, its: &dyn fmt::Display, ours: &dyn fmt::Display| {
            Failure::bad_input(format!(
                "--from {name}: its {what} is {its}, expected that of the scenario, {ours} (which a --preset \
                 or --set can change)"
            ))
        };
        let (its, ours) = (header.topology, problem.topology());
        if its != ours {
            return Err(refused("network", &its, &ours));
        }
        let (its, ours) = (header.scaling.encoding, problem.scaling().encoding);
        if its != ours {
            return Err(refused("encoding", &words_of(&its), &words_of(&ours)));
        }
        let bound = problem.scenario.training.weight_bound;
        let beyond = |weight: &&f32| weight.abs() > bound;
        if let Some(weight) = blob.weights().iter().find(beyond) {
            return Err(Failure::bad_input(format!(
                "--from {name}: it has the weight {weight}, expected at most training.weight_bound, {bound}, in \
                 magnitude (which a --preset or --set can change)"
            )));
        }
        let made = &header.provenance;
        output.status(format_args!(
            "begins with {}, trained in {}, seed {}, generation {}",
            self.champion.path().display(),
            made.scenario_name(),
            made.seed,
            made.generation
        ));
        let (its, ours) = (header.activation, problem.scenario.network.activation);
        if its != ours {
            output.note(format_args!("its tanh was {its}; the scenario's, {ours}, counts"));
        }
        for change in adopt_car(&mut problem.scenario.clone(), header) {
            output.note(format_args!(
                "its {} was {}; the scenario's, {}, counts",
                change.what, change.champion, change.scenario
            ));
        }
        Ok(())
    }

    /// The weights.
    pub(super) fn genome(&self) -> &[f32] {
        self.champion.blob().weights()
    }

    /// What the manifest says of it.
    pub(super) fn input(&self) -> &Input {
        &self.input
    }

    /// Leaves a copy in the run's folder.
    ///
    /// # Errors
    ///
    /// It cannot be written.
    pub(super) fn copy_to(&self, folder: &RunFolder) -> Result<(), Failure> {
        folder.write(RunFolder::FROM, self.champion.bytes())
    }
}

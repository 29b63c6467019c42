//! What is to be done: enough to do it again, or to go on with it.

use super::claim::PaperScene;
use super::method::{self, Method};
use super::setup::Setup;
use crate::failure::Failure;
use crate::run_folder::RunFolder;
use crate::seed::RunSeed;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// `reproduction.toml`: everything that decides a reproduction's results.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Plan {
    /// Version of evosteer that began it.
    pub evosteer: String,
    /// The scenes, in the paper's order.
    pub scenes: Vec<PaperScene>,
    /// Names of the methods.
    pub methods: Vec<String>,
    /// The first seed. Text, because TOML's integers end at 2⁶³ − 1.
    #[serde(with = "crate::run_folder::manifest::decimal")]
    pub seed: u64,
    /// How many seeds, one after the other.
    pub seeds: u32,
    /// Unseen pairs that each champion is judged on.
    pub pairs: u32,
    /// Generations, where they are not the scene's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub generations: Option<u32>,
    /// Individuals, where they are not the scene's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub population: Option<u32>,
}

impl Plan {
    /// The file that it is kept in.
    pub const FILE: &'static str = RunFolder::REPRODUCTION;

    /// The seeds, in order.
    pub fn seeds(&self) -> impl Iterator<Item = RunSeed> + Clone {
        (0..u64::from(self.seeds)).map(|place| RunSeed(self.seed + place))
    }

    /// The methods, in order.
    ///
    /// # Errors
    ///
    /// A name that is none of this version's.
    pub fn methods(&self) -> Result<Vec<Method>, Failure> {
        let find = |name: &String| {
            let unknown = || Failure::bad_input(format!("this evosteer has no method `{name}`"));
            method::by_name(name).ok_or_else(unknown)
        };
        self.methods.iter().map(find).collect()
    }

    /// Every scene with every method, built.
    ///
    /// # Errors
    ///
    /// A scene that the settings make impossible.
    pub fn setups(&self) -> Result<Vec<Setup>, Failure> {
        let methods = self.methods()?;
        let each = self.scenes.iter().flat_map(|scene| methods.iter().map(|m| (*scene, *m)));
        each.map(|(scene, method)| Setup::new(scene, method, self)).collect()
    }

    /// Writes it into a reproduction's folder.
    ///
    /// # Errors
    ///
    /// Input/output, naming the file.
    pub fn write(&self, folder: &RunFolder) -> Result<(), Failure> {
        let text = toml::to_string(self)
            .map_err(|error| Failure::bad_input(format!("cannot be written as TOML: {error}")))?;
        folder.write(Self::FILE, text.as_bytes())
    }

    /// Reads it from there.
    ///
    /// # Errors
    ///
    /// A file that cannot be read or is no plan.
    pub fn read(folder: &RunFolder) -> Result<Self, Failure> {
        let path = folder.join(Self::FILE);
        let text =
            std::fs::read_to_string(&path).map_err(|cause| Failure::io("read", &path, &cause))?;
        Self::parse(&path, &text)
    }

    fn parse(path: &Path, text: &str) -> Result<Self, Failure> {
        let refuse = |why: String| Failure::bad_input(format!("{}: {why}", path.display()));
        let plan: Self = toml::from_str(text).map_err(|error| refuse(error.to_string()))?;
        let last = plan.seed.checked_add(u64::from(plan.seeds));
        if plan.seeds == 0 || plan.pairs == 0 || plan.scenes.is_empty() || last.is_none() {
            return Err(refuse("it leaves nothing to do, or seeds that are none".to_owned()));
        }
        Ok(plan)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::sample;

    #[test]
    fn a_plan_reads_back_as_it_was_written() {
        let folder = tempfile::tempdir().unwrap();
        let folder = RunFolder::create(&folder.path().join("plan")).unwrap();
        let plan = Plan { seed: u64::MAX - 40, generations: None, ..sample::plan() };
        plan.write(&folder).unwrap();
        assert_eq!(Plan::read(&folder).unwrap(), plan);
    }

    #[test]
    fn a_plan_that_was_changed_to_nonsense_is_refused_with_its_file() {
        let text = toml::to_string(&sample::plan()).unwrap();
        for (from, to) in [
            ("seeds = 2", "seeds = 0"),
            ("seeds = 2", "seeds = \"two\""),
            ("seed = \"1\"", "seed = \"18446744073709551615\""),
            ("\"open\"", "\"opne\""),
            ("pairs = ", "pears = "),
        ] {
            let changed = text.replace(from, to);
            assert_ne!(changed, text, "{from}");
            let refusal = Plan::parse(Path::new("x/plan.toml"), &changed).unwrap_err();
            assert!(refusal.to_string().starts_with("x/plan.toml: "), "{refusal}");
        }
    }
}

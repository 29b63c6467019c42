//! What is to be done, and a course with a method, built.

use super::course::Course;
use super::method::MazeMethod;
use crate::failure::Failure;
use crate::fingerprint;
use crate::problem::Problem;
use crate::run_folder::RunFolder;
use crate::scenario::{self, Preset, Setting};
use crate::seed::RunSeed;
use crate::training::{Training, too_large};
use serde::{Deserialize, Serialize};
use std::path::Path;

/// `reproduction.toml`: everything that decides the results.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MazePlan {
    /// Version of evosteer that began it.
    pub evosteer: String,
    /// The courses.
    pub courses: Vec<Course>,
    /// The methods.
    pub methods: Vec<MazeMethod>,
    /// The first seed. Text, because TOML's integers end at 2⁶³ − 1.
    #[serde(with = "crate::run_folder::manifest::decimal")]
    pub seed: u64,
    /// How many seeds, one after the other.
    pub seeds: u32,
    /// Most generations of a run, where they are not the preset's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub generations: Option<u32>,
    /// Individuals, where they are not the preset's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub population: Option<u32>,
}

impl MazePlan {
    /// The seeds, in order.
    pub fn seeds(&self) -> impl Iterator<Item = RunSeed> + Clone {
        (0..u64::from(self.seeds)).map(|place| RunSeed(self.seed + place))
    }

    /// Every course with every method, built.
    ///
    /// # Errors
    ///
    /// A course that the settings make impossible.
    pub fn setups(&self) -> Result<Vec<MazeSetup>, Failure> {
        let methods = &self.methods;
        let each = self.courses.iter().flat_map(|course| methods.iter().map(|m| (*course, *m)));
        each.map(|(course, method)| MazeSetup::new(course, method, self)).collect()
    }

    /// Writes it into its folder.
    ///
    /// # Errors
    ///
    /// Input/output, naming the file.
    pub fn write(&self, folder: &RunFolder) -> Result<(), Failure> {
        let text = toml::to_string(self)
            .map_err(|error| Failure::bad_input(format!("cannot be written as TOML: {error}")))?;
        folder.write(RunFolder::REPRODUCTION, text.as_bytes())
    }

    /// Reads it from there; none if what the folder holds is about the paper's scenes.
    ///
    /// # Errors
    ///
    /// A file that cannot be read or is no plan.
    pub fn read(folder: &RunFolder) -> Result<Option<Self>, Failure> {
        let path = folder.join(RunFolder::REPRODUCTION);
        let text =
            std::fs::read_to_string(&path).map_err(|cause| Failure::io("read", &path, &cause))?;
        let table = toml::from_str::<toml::Table>(&text).unwrap_or_default();
        if table.contains_key("courses") { Self::parse(&path, &text).map(Some) } else { Ok(None) }
    }

    fn parse(path: &Path, text: &str) -> Result<Self, Failure> {
        let refuse = |why: String| Failure::bad_input(format!("{}: {why}", path.display()));
        let plan: Self = toml::from_str(text).map_err(|error| refuse(error.to_string()))?;
        let last = plan.seed.checked_add(u64::from(plan.seeds));
        let nothing = plan.seeds == 0 || plan.courses.is_empty() || plan.methods.is_empty();
        if nothing || last.is_none() {
            return Err(refuse("it leaves nothing to do, or seeds that are none".to_owned()));
        }
        Ok(plan)
    }
}

/// A course with a method, built.
#[derive(Debug)]
pub struct MazeSetup {
    /// The course.
    pub course: Course,
    /// The method.
    pub method: MazeMethod,
    /// What is searched on.
    pub problem: Problem,
}

impl MazeSetup {
    /// Builds it.
    ///
    /// # Errors
    ///
    /// Settings that make no sense for this course.
    pub fn new(course: Course, method: MazeMethod, plan: &MazePlan) -> Result<Self, Failure> {
        let source = scenario::find(course.scenario())?;
        let mut settings = Vec::new();
        for (option, key, value) in [
            ("--generations", "training.generations", plan.generations),
            ("--population", "training.population", plan.population),
        ] {
            settings.extend(value.map(|value| Setting::option(option, key, value)));
        }
        let mut scenario = scenario::load(&source, Some(Preset::Novelty), &settings)?;
        method.adopt(&mut scenario);
        scenario.episode.on_collision = course.on_collision();
        let problem = Problem::new(scenario)?;
        if let Some(complaint) = too_large(&problem.scenario) {
            return Err(scenario::refuse(&source, &settings, &[complaint]));
        }
        Training::new(&problem, RunSeed(plan.seed))?;
        Ok(Self { course, method, problem })
    }

    /// Most individuals that a run may judge.
    pub fn budget(&self) -> u64 {
        self.work_of_a_generation() * u64::from(self.problem.scenario.training.generations)
    }

    /// Individuals of one generation.
    pub fn work_of_a_generation(&self) -> u64 {
        u64::from(self.problem.scenario.training.population)
    }

    /// What a trial of this setup is made of; another number means another trial.
    pub fn fingerprint(&self) -> [u8; 32] {
        fingerprint::scenario(&self.problem.scenario)
    }

    /// Where the trial of this seed is kept, in the folder.
    pub fn file(&self, seed: RunSeed) -> String {
        let (course, method) = (self.course.name(), self.method.name());
        format!("{}/{course}-{method}-{seed}.bin", super::super::Setup::TRIALS)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan() -> MazePlan {
        MazePlan {
            evosteer: "0.0.0".to_owned(),
            courses: vec![Course::MediumMaze, Course::SwitchbackMazeClean],
            methods: MazeMethod::ALL.to_vec(),
            seed: u64::MAX - 40,
            seeds: 2,
            generations: None,
            population: Some(30),
        }
    }

    #[test]
    fn a_plan_reads_back_as_it_was_written() {
        let base = tempfile::tempdir().unwrap();
        let folder = RunFolder::create(&base.path().join("plan")).unwrap();
        plan().write(&folder).unwrap();
        assert_eq!(MazePlan::read(&folder).unwrap(), Some(plan()));
    }

    #[test]
    fn a_plan_that_was_changed_to_nonsense_is_refused_with_its_file() {
        let text = toml::to_string(&plan()).unwrap();
        for (from, to) in [
            ("seeds = 2", "seeds = 0"),
            ("\"medium-maze\"", "\"easy-maze\""),
            ("\"chance\"", "\"luck\""),
            ("population = ", "popularity = "),
        ] {
            let changed = text.replace(from, to);
            assert_ne!(changed, text, "{from}");
            let refusal = MazePlan::parse(Path::new("x/plan.toml"), &changed).unwrap_err();
            assert!(refusal.to_string().starts_with("x/plan.toml: "), "{refusal}");
        }
    }

    #[test]
    fn every_course_and_every_method_is_another_trial() {
        let courses = Course::ALL.to_vec();
        let setups = MazePlan { seed: 1, courses, ..plan() }.setups().unwrap();
        let mut prints: Vec<[u8; 32]> = setups.iter().map(MazeSetup::fingerprint).collect();
        prints.sort_unstable();
        prints.dedup();
        assert_eq!((setups.len(), prints.len()), (12, 12));
    }
}

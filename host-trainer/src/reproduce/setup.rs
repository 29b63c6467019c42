//! A scene with a method, built: what a trial trains on, and what its champion is judged on.

use super::claim::PaperScene;
use super::method::Method;
use super::plan::Plan;
use crate::champion;
use crate::failure::Failure;
use crate::fingerprint;
use crate::problem::{Problem, adopt_car};
use crate::scenario::{self, Preset, Scenario, Setting};
use crate::seed::RunSeed;
use crate::training::{Training, too_large};
use sha2::{Digest, Sha256};

/// One scene with one method.
#[derive(Debug)]
pub struct Setup {
    /// The scene.
    pub scene: PaperScene,
    /// The method.
    pub method: Method,
    /// What is trained on.
    pub problem: Problem,
    /// What champions are judged on, where that is something else.
    judge: Option<Problem>,
    /// Unseen pairs.
    pub pairs: u32,
}

impl Setup {
    /// Builds it.
    ///
    /// # Errors
    ///
    /// Settings that make no sense for this scene.
    pub fn new(scene: PaperScene, method: Method, plan: &Plan) -> Result<Self, Failure> {
        let source = scenario::find(scene.name())?;
        let mut settings: Vec<Setting> = method.settings().collect();
        for (option, key, value) in [
            ("--generations", "training.generations", plan.generations),
            ("--population", "training.population", plan.population),
        ] {
            settings.extend(value.map(|value| Setting::option(option, key, value)));
        }
        let problem = Problem::new(scenario::load(&source, Some(method.preset), &settings)?)?;
        if let Some(complaint) = too_large(&problem.scenario) {
            return Err(scenario::refuse(&source, &settings, &[complaint]));
        }
        Training::new(&problem, RunSeed(plan.seed))?;
        let mut rules = scenario::load(&source, Some(Preset::Paper), &[])?;
        adopt_car(&mut rules, &champion::car(&problem));
        let same = drives_alike(&rules, &problem.scenario);
        let judge = if same { None } else { Some(Problem::new(rules)?) };
        Ok(Self { scene, method, problem, judge, pairs: plan.pairs })
    }

    /// What champions are judged on: the scene under the paper's rules (its step limit, what a
    /// collision does, what counts as reached), with the method's own car and network. All
    /// methods answer the same questions.
    pub fn judge(&self) -> &Problem {
        self.judge.as_ref().unwrap_or(&self.problem)
    }

    /// Generations of the variant of this length.
    pub fn generations(&self, length: u32) -> u32 {
        self.problem.scenario.training.generations * length
    }

    /// Generations of a whole trial.
    pub fn all_generations(&self) -> u32 {
        self.generations(self.method.lengths.last().copied().unwrap_or(1))
    }

    /// Drives of a whole trial's training: a measure of how long it takes.
    pub fn work(&self) -> u64 {
        u64::from(self.all_generations()) * self.work_of_a_generation()
    }

    /// Drives of one generation.
    pub fn work_of_a_generation(&self) -> u64 {
        self.problem.scenario.training.individuals()
    }

    /// What a trial of this setup is made of; another number means another trial.
    pub fn fingerprint(&self) -> [u8; 32] {
        let lengths = self.method.lengths.iter().flat_map(|length| length.to_le_bytes());
        Sha256::new()
            .chain_update(fingerprint::scenario(&self.problem.scenario))
            .chain_update(fingerprint::scenario(&self.judge().scenario))
            .chain_update(lengths.collect::<Vec<u8>>())
            .chain_update(self.pairs.to_le_bytes())
            .finalize()
            .into()
    }

    /// Where the trial of this seed is kept, in the reproduction's folder.
    pub fn file(&self, seed: RunSeed) -> String {
        format!("{}/{}-{}-{seed}.bin", Self::TRIALS, self.scene.name(), self.method.name)
    }

    /// The folder of the trials.
    pub const TRIALS: &'static str = "trials";
}

/// Whether a drive goes the same in both, and unseen pairs are the same.
fn drives_alike(a: &Scenario, b: &Scenario) -> bool {
    (&a.world, &a.vehicle, &a.sensors, a.network, a.episode, a.pairs.min_distance)
        == (&b.world, &b.vehicle, &b.sensors, b.network, b.episode, b.pairs.min_distance)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::method::{self, PAPER};
    use crate::reproduce::sample;

    #[test]
    fn a_scene_has_the_papers_population_and_generations() {
        let size = |scene| {
            let plan = Plan { generations: None, population: None, ..sample::plan() };
            let training = Setup::new(scene, PAPER, &plan).unwrap().problem.scenario.training;
            (training.population, training.generations)
        };
        assert_eq!(PaperScene::ALL.map(size), [(80, 40), (120, 60), (160, 200)]);
    }

    #[test]
    fn the_papers_method_is_judged_where_it_was_trained_whatever_its_network() {
        for method in method::all().iter().filter(|method| method.preset == Preset::Paper) {
            let setup = Setup::new(PaperScene::Complex, *method, &sample::plan()).unwrap();
            assert!(setup.judge.is_none(), "{}", method.name);
        }
    }

    #[test]
    fn other_rules_of_a_drive_do_not_reach_the_judge() {
        let stop = Method {
            name: "stop",
            settings: &[
                ("episode.on_collision", "\"stop\""),
                ("episode.step_limit", "900"),
                ("sensors.range_m", "4"),
            ],
            ..PAPER
        };
        let setup = Setup::new(PaperScene::Open, stop, &sample::plan()).unwrap();
        let judge = &setup.judge().scenario;
        let papers = scenario::load(&scenario::find("open").unwrap(), None, &[]).unwrap();
        assert_eq!(judge.episode, papers.episode);
        assert_eq!(judge.sensors.range, 4.0, "a controller keeps its own sensors");
    }

    #[test]
    fn another_setting_or_another_number_of_pairs_is_another_trial() {
        let plan = sample::plan();
        let print =
            |scene, method, plan: &Plan| Setup::new(scene, method, plan).unwrap().fingerprint();
        let known = print(PaperScene::Open, PAPER, &plan);
        assert_eq!(print(PaperScene::Open, PAPER, &plan), known);
        let others = [
            print(PaperScene::Complex, PAPER, &plan),
            print(PaperScene::Open, method::by_name("elman").unwrap(), &plan),
            print(PaperScene::Open, Method { lengths: &[1], ..PAPER }, &plan),
            print(PaperScene::Open, PAPER, &Plan { pairs: plan.pairs + 1, ..plan.clone() }),
            print(PaperScene::Open, PAPER, &Plan { population: Some(13), ..plan.clone() }),
        ];
        assert!(others.iter().all(|print| *print != known));
    }
}

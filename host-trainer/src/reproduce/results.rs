//! All numbers of a reproduction: `results.json`, and what `--json` prints.

use super::claim::PaperScene;
use super::failures::Unreached;
use super::plan::Plan;
use super::setup::Setup;
use super::spread::{SeedBySeed, Spread};
use super::trial::{Stage, Trial};
use crate::evaluation::Share;
use serde::Serialize;

/// Everything.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Results {
    /// Version of evosteer.
    pub evosteer: String,
    /// The first seed.
    pub seed: u64,
    /// How many seeds.
    pub seeds: u32,
    /// Unseen pairs per champion.
    pub pairs: u32,
    /// The scenes, in the paper's order.
    pub scenes: Vec<SceneResults>,
}

/// One scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SceneResults {
    /// Its name.
    pub scene: PaperScene,
    /// The share of successes that the paper prints, 0 to 1.
    pub papers_success_rate: Option<f64>,
    /// The paper's sentences and figures, and what was found.
    pub claims: Vec<Found>,
    /// One row per variant, the paper's method first.
    pub rows: Vec<Row>,
}

/// A claim of the paper and what stands beside it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Found {
    /// The figure or place.
    pub place: &'static str,
    /// The paper's words.
    pub paper: &'static str,
    /// What was found here.
    pub here: String,
}

/// Some of many, with Wilson's 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Counted {
    /// Those that count.
    pub count: u32,
    /// All.
    pub of: u32,
    /// The share, 0 to 1.
    pub share: f64,
    /// Its interval.
    pub interval: [f64; 2],
}

impl From<Share> for Counted {
    fn from(share: Share) -> Self {
        let Share { count, of } = share;
        Self { count, of, share: share.value(), interval: share.interval() }
    }
}

/// `70 of 100: 70.0 % (60.4 to 78.1)`.
impl std::fmt::Display for Counted {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { count, of, .. } = *self;
        write!(f, "{count} of {of}: {}", Share { count, of })
    }
}

/// One variant in one scene, over all seeds.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Its name.
    pub variant: String,
    /// Its method.
    pub method: &'static str,
    /// What that changes.
    pub what: &'static str,
    /// The network.
    pub network: String,
    /// Individuals, of each island.
    pub population: u32,
    /// Populations at the beginning.
    pub islands: u32,
    /// Generations.
    pub generations: u32,
    /// Training pairs reached, all seeds together.
    pub training: Counted,
    /// The same, seed by seed against the paper's method; none for that itself.
    pub training_against_paper: Option<SeedBySeed>,
    /// Runs that reached all of their training pairs.
    pub all_reached: Counted,
    /// Generations after which the best individual first reached all its pairs, over the runs in
    /// which one did.
    pub learned_after: Option<Spread>,
    /// The champion's fitness.
    pub best: Spread,
    /// Share of unseen pairs reached, 0 to 1.
    pub unseen_reached: Spread,
    /// Share reached without one collision, 0 to 1.
    pub unseen_clean: Spread,
    /// Unseen pairs reached, seed by seed against the paper's method.
    pub unseen_against_paper: Option<SeedBySeed>,
    /// How drives of training pairs ended that did not arrive.
    pub unreached: Unreached,
    /// The seeds one by one.
    pub seeds: Vec<SeedRow>,
}

/// One variant in one scene from one seed.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SeedRow {
    /// The seed.
    pub seed: u64,
    /// The champion's fitness.
    pub best: f64,
    /// The generation it was found in, from 0.
    pub found_in: u32,
    /// Training pairs.
    pub training_pairs: u32,
    /// Those reached.
    pub training_reached: u32,
    /// Those reached without one collision.
    pub training_clean: u32,
    /// Generations after which the best individual first reached all of them.
    pub learned_after: Option<u32>,
    /// Unseen pairs.
    pub unseen_pairs: u32,
    /// Those reached.
    pub unseen_reached: u32,
    /// Those reached without one collision.
    pub unseen_clean: u32,
    /// How drives of training pairs ended that did not arrive.
    pub unreached: Unreached,
}

impl Results {
    /// Counts everything; `trials` has one list per setup, by seed, none of them empty.
    pub fn of(plan: &Plan, setups: &[Setup], trials: &[Vec<Trial>]) -> Self {
        let together: Vec<(&Setup, &[Trial])> =
            setups.iter().zip(trials.iter().map(Vec::as_slice)).collect();
        let scenes = together.chunk_by(|(a, _), (b, _)| a.scene == b.scene);
        Self {
            evosteer: plan.evosteer.clone(),
            seed: plan.seed,
            seeds: plan.seeds,
            pairs: plan.pairs,
            scenes: scenes.map(SceneResults::of).collect(),
        }
    }
}

impl SceneResults {
    fn of(methods: &[(&Setup, &[Trial])]) -> Self {
        let mut rows: Vec<Row> = Vec::new();
        for (setup, trials) in methods {
            for (stage, length) in setup.method.lengths.iter().enumerate() {
                rows.push(Row::of(setup, *length, stage, trials, rows.first()));
            }
        }
        let scene = methods[0].0.scene;
        let papers_success_rate = scene.success_rate();
        let mut results = Self { scene, papers_success_rate, claims: Vec::new(), rows };
        let found = scene.claims().iter().map(|claim| Found {
            place: claim.place,
            paper: claim.says,
            here: claim.found(&results),
        });
        results.claims = found.collect();
        results
    }

    /// The paper's own method.
    pub fn papers(&self) -> &Row {
        &self.rows[0]
    }
}

impl Row {
    fn of(
        setup: &Setup,
        length: u32,
        stage: usize,
        trials: &[Trial],
        papers: Option<&Self>,
    ) -> Self {
        let seeds: Vec<SeedRow> =
            trials.iter().map(|trial| SeedRow::of(trial, &trial.stages[stage])).collect();
        let sum = |value: fn(&SeedRow) -> u32| seeds.iter().map(value).sum();
        let spread = |value: fn(&SeedRow) -> f64| {
            Spread::of(seeds.iter().map(value)).expect("a plan has at least one seed")
        };
        let against = |value: fn(&SeedRow) -> u32| {
            let others = papers?.seeds.iter();
            Some(SeedBySeed::of(seeds.iter().zip(others).map(|(a, b)| (value(a), value(b)))))
        };
        let of_all = |seed: &&SeedRow| seed.training_reached == seed.training_pairs;
        let all_reached = seeds.iter().filter(of_all).count() as u32;
        let endings = trials.iter().flat_map(|trial| &trial.stages[stage].training);
        Self {
            variant: setup.method.variant(length),
            method: setup.method.name,
            what: setup.method.what,
            network: setup.problem.topology().to_string(),
            population: setup.problem.scenario.training.population,
            islands: setup.problem.scenario.training.islands,
            generations: setup.generations(length),
            training: Share { count: sum(|s| s.training_reached), of: sum(|s| s.training_pairs) }
                .into(),
            training_against_paper: against(|seed| seed.training_reached),
            all_reached: Share { count: all_reached, of: seeds.len() as u32 }.into(),
            learned_after: Spread::of(
                seeds.iter().filter_map(|seed| seed.learned_after).map(f64::from),
            ),
            best: spread(|seed| seed.best),
            unseen_reached: spread(|s| f64::from(s.unseen_reached) / f64::from(s.unseen_pairs)),
            unseen_clean: spread(|s| f64::from(s.unseen_clean) / f64::from(s.unseen_pairs)),
            unseen_against_paper: against(|seed| seed.unseen_reached),
            unreached: Unreached::count(endings),
            seeds,
        }
    }
}

impl SeedRow {
    fn of(trial: &Trial, stage: &Stage) -> Self {
        let judged = &trial.history[..stage.generations as usize];
        let learned = judged.iter().position(|row| row.reached >= 1.0);
        Self {
            seed: trial.seed,
            best: stage.best.cost.value(),
            found_in: stage.best.generation,
            training_pairs: stage.training.len() as u32,
            training_reached: stage.training_reached(),
            training_clean: stage.training_clean(),
            learned_after: learned.map(|place| place as u32 + 1),
            unseen_pairs: stage.unseen.pairs,
            unseen_reached: stage.unseen.reached,
            unseen_clean: stage.unseen.clean,
            unreached: Unreached::count(stage.training.iter()),
        }
    }
}

/// A share as a percentage.
pub fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

/// A median of whole numbers, with a half where it has one.
pub fn median(spread: &Spread) -> String {
    format!("{:.1}", spread.median).trim_end_matches(".0").to_owned()
}

/// `28.2 % (15.4 to 38.6)`: the median of shares, the least and the most.
pub fn range(spread: &Spread) -> String {
    let [least, most] = [spread.least, spread.most].map(|share| 100.0 * share);
    format!("{} ({least:.1} to {most:.1})", percent(spread.median))
}

#[cfg(test)]
mod tests;

//! What the search is told of each individual; all else is the preset `novelty`.

use crate::scenario::{Scenario, Selection};
use serde::{Deserialize, Serialize};

/// What selects.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MazeMethod {
    /// How far from where others ended, now and before.
    Novelty,
    /// How near to the goal: the objective.
    Distance,
    /// Nothing: parents are drawn from everybody, which shows how hard a maze is.
    Chance,
}

impl MazeMethod {
    /// Every method, in the order of the tables.
    pub const ALL: [Self; 3] = [Self::Novelty, Self::Distance, Self::Chance];

    /// Its name, also on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Novelty => "novelty",
            Self::Distance => "distance",
            Self::Chance => "chance",
        }
    }

    /// What selects, in a few words.
    pub fn what(self) -> &'static str {
        match self {
            Self::Novelty => "ending where nobody has ended",
            Self::Distance => "ending near the goal",
            Self::Chance => "nothing: every individual is as good a parent",
        }
    }

    /// Turns the preset's scenario into this method's.
    pub(super) fn adopt(self, scenario: &mut Scenario) {
        let training = &mut scenario.training;
        match self {
            Self::Novelty => {}
            Self::Distance => training.novelty = None,
            Self::Chance => {
                training.novelty = None;
                // Copies of the best would be a selection.
                let ga = &mut training.ga;
                ga.mutation_share += ga.ranking_share;
                ga.ranking_share = 0.0;
                ga.selection = Selection::Truncation { share: 1.0 };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenario::Preset;

    fn adopted(method: MazeMethod) -> Scenario {
        let mut scenario = Preset::Novelty.scenario();
        method.adopt(&mut scenario);
        scenario.training.ga.check().unwrap();
        scenario
    }

    #[test]
    fn novelty_is_the_preset_and_distance_is_that_without_novelty() {
        let preset = Preset::Novelty.scenario();
        assert_eq!(adopted(MazeMethod::Novelty), preset);
        let mut distance = adopted(MazeMethod::Distance);
        assert_eq!(distance.training.novelty.take(), None);
        distance.training.novelty = preset.training.novelty;
        assert_eq!(distance, preset);
    }

    #[test]
    fn chance_has_neither_a_selection_nor_copies_of_the_best() {
        let ga = adopted(MazeMethod::Chance).training.ga;
        assert_eq!((ga.mutation_share, ga.ranking_share), (1.0, 0.0));
        assert_eq!(ga.selection, Selection::Truncation { share: 1.0 });
    }
}

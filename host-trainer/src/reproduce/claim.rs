//! What the paper shows and says of each scene, and what here stands beside it.
//!
//! The paper prints two numbers (60 generations, 75 %) and pictures without scales; what can be
//! put beside a picture is the same picture over many seeds.

use super::results::{Row, SceneResults, median, percent};
use serde::{Deserialize, Serialize};

/// A scene of the paper's experiments.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PaperScene {
    /// Without obstacles (Fig. 3).
    Open,
    /// With five boxes (Fig. 4 to 6).
    Obstacles,
    /// The hardest one (Fig. 7 and 8).
    Complex,
}

/// Something the paper shows or says.
#[derive(Clone, Copy, Debug)]
pub struct Claim {
    /// Where: a figure, or a place in the text.
    pub place: &'static str,
    /// In the paper's words.
    pub says: &'static str,
    /// What was found here.
    found: fn(&SceneResults) -> String,
}

impl Claim {
    /// What was found here, in a sentence.
    pub fn found(&self, results: &SceneResults) -> String {
        (self.found)(results)
    }
}

impl PaperScene {
    /// Every scene, in the paper's order.
    pub const ALL: [Self; 3] = [Self::Open, Self::Obstacles, Self::Complex];

    /// Its name, also on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Open => "open",
            Self::Obstacles => "obstacles",
            Self::Complex => "complex",
        }
    }

    /// The paper's figures of it.
    pub fn figures(self) -> &'static str {
        match self {
            Self::Open => "Fig. 3",
            Self::Obstacles => "Fig. 4 to 6",
            Self::Complex => "Fig. 7 and 8",
        }
    }

    /// The share of successes that the paper prints, 0 to 1.
    pub fn success_rate(self) -> Option<f64> {
        match self {
            Self::Open | Self::Obstacles => None,
            Self::Complex => Some(0.75),
        }
    }

    /// Everything the paper shows or says of it.
    pub fn claims(self) -> &'static [Claim] {
        match self {
            Self::Open => &OPEN,
            Self::Obstacles => &OBSTACLES,
            Self::Complex => &COMPLEX,
        }
    }
}

const OPEN: [Claim; 2] = [
    Claim {
        place: "Fig. 3",
        says: "Robot trajectory from start (blue diamond) to goal (green square).",
        found: |scene| on_training_pairs(scene.papers()),
    },
    Claim {
        place: "Text",
        says: "After evolution the robot was able to move from arbitrary starting point to \
               arbitrary goal point.",
        found: |scene| on_unseen_pairs(scene.papers()),
    },
];

const OBSTACLES: [Claim; 4] = [
    Claim {
        place: "Fig. 4",
        says: "Robot trajectory in environment with obstacles.",
        found: |scene| on_training_pairs(scene.papers()),
    },
    Claim {
        place: "Fig. 5",
        says: "Graphs of fitness function for two independent GA runs.",
        found: |scene| {
            let best = scene.papers().best;
            format!(
                "The best fitness at the end is {:.0} in the median, from {:.0} to {:.0}: drawn below.",
                best.median, best.least, best.most
            )
        },
    },
    Claim {
        place: "Fig. 6",
        says: "Graphs of partial criterions of the fitness function for two independent GA runs.",
        found: |_| "Drawn below, with the same two runs.".to_owned(),
    },
    Claim {
        place: "Text",
        says: "Sixty generation of evolution were needed to learn the robot to move in the \
               environment with obstacles.",
        found: |scene| learned(scene.papers()),
    },
];

const COMPLEX: [Claim; 3] = [
    Claim {
        place: "Fig. 7",
        says: "The success rate of reaching the target after 200 generation of evolution was 75 %.",
        found: |scene| {
            let row = scene.papers();
            let [low, high] = row.training.interval;
            let place = match 0.75 {
                share if share < low => "above the paper's 75 %",
                share if share > high => "below the paper's 75 %",
                _ => "the paper's 75 % lies inside the interval",
            };
            format!("{} training pairs reached: {place}.", row.training)
        },
    },
    Claim {
        place: "Fig. 8",
        says: "Unsuccessful evolution result. The robot (red dot) starts to move in periodic loops.",
        found: |scene| unsuccessful(scene.papers()),
    },
    Claim {
        place: "Text",
        says: "An increase of the success rate can be obtained using more neurons in the hidden \
               layers, the use of recurrent links in the ANN (see Fig. 2) as well as by applying \
               more generations of the GA run.",
        found: advice,
    },
];

fn on_training_pairs(row: &Row) -> String {
    format!("{} training pairs reached.", row.training)
}

fn on_unseen_pairs(row: &Row) -> String {
    format!(
        "Of start and goal pairs that training never used, {} are reached and {} are reached \
         without touching anything (medians over the seeds).",
        percent(row.unseen_reached.median),
        percent(row.unseen_clean.median)
    )
}

fn learned(row: &Row) -> String {
    let when = match &row.learned_after {
        Some(spread) => format!(
            ", in the median after {} generations (from {} to {})",
            median(spread),
            spread.least,
            spread.most
        ),
        None => String::new(),
    };
    format!(
        "{} of {} runs reached all their training pairs within {} generations{when}.",
        row.all_reached.count, row.all_reached.of, row.generations
    )
}

fn unsuccessful(row: &Row) -> String {
    let lost = row.unreached;
    match lost.drives {
        0 => "No champion left a training pair unreached.".to_owned(),
        drives => format!(
            "Of {drives} drives of training pairs that did not arrive, {} ended in a periodic loop \
             and {} stood still. One is drawn below.",
            lost.in_loops, lost.stuck
        ),
    }
}

fn advice(scene: &SceneResults) -> String {
    let said = scene.rows.iter().skip(1).map(|row| {
        let against = row.training_against_paper.as_ref();
        let split = against.map(ToString::to_string).unwrap_or_default();
        format!("{}: {} ({split})", row.variant, percent(row.training.share))
    });
    let said: Vec<String> = said.collect();
    if said.is_empty() {
        return "Not tried: only the paper's own method was asked for.".to_owned();
    }
    format!("Training pairs reached, against the paper's own, seed by seed: {}.", said.join("; "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::sample;

    #[test]
    fn every_figure_of_the_experiments_has_its_place() {
        let places: Vec<&str> =
            PaperScene::ALL.iter().flat_map(|scene| scene.claims()).map(|c| c.place).collect();
        for figure in 3..=8 {
            assert!(places.contains(&&*format!("Fig. {figure}")), "{figure}");
        }
    }

    #[test]
    fn something_stands_beside_every_claim_also_after_a_run_that_learned_nothing() {
        let mut results = sample::results(&sample::plan());
        for (scene, rows) in PaperScene::ALL.iter().zip([2, 1, 2]) {
            let mine = &mut results.scenes[0];
            mine.rows.truncate(rows);
            for claim in scene.claims() {
                let found = claim.found(mine);
                assert!(found.ends_with('.') && !found.contains("NaN"), "{found}");
            }
        }
    }
}

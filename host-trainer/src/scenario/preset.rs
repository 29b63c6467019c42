//! Named sets of settings: what lies under a scenario file and what goes over it.

use std::f32::consts::FRAC_PI_2;
use std::path::Path;

use controller_core::activation::ActivationKind;
use controller_core::network::RecurrenceKind;
use controller_core::observation::{BEAMS, BeamMount, DistanceLaw, Encoding, TypeCode};

use super::*;

/// A named set of settings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Preset {
    /// The paper's settings, with our readings where it is silent.
    #[default]
    Paper,
    /// Drives clean where it has never been: more pairs, other costs, another mutation.
    Robust,
    /// Goes on from a champion: as the one above, with one population and small changes.
    Refine,
    /// `Robust` in many random worlds: one controller for places that nobody has described.
    Generalist,
    /// Searches for what nobody has done yet, until a target is reached: for mazes.
    Novelty,
}

impl Preset {
    /// Every preset, in the order they are listed to people.
    pub const ALL: [Self; 5] =
        [Self::Paper, Self::Robust, Self::Refine, Self::Generalist, Self::Novelty];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Robust => "robust",
            Self::Refine => "refine",
            Self::Generalist => "generalist",
            Self::Novelty => "novelty",
        }
    }

    /// What goes over a scenario file, as scenario files of which later ones win. The paper's
    /// settings lie under it.
    pub(super) fn over(self) -> &'static [&'static str] {
        match self {
            Self::Paper => &[],
            Self::Robust => &[include_str!("robust.toml")],
            Self::Refine => &[include_str!("robust.toml"), include_str!("refine.toml")],
            Self::Generalist => &[include_str!("robust.toml"), include_str!("generalist.toml")],
            Self::Novelty => &[include_str!("novelty.toml")],
        }
    }

    /// The preset as a scenario: an empty room of 10 × 10 m with these settings.
    pub fn scenario(self) -> Scenario {
        let source = Source::new("unnamed", "", Path::new(""));
        load(&source, Some(self), &[]).expect("a preset makes sense")
    }
}

/// Printed in the paper: beam angles, network, fitness weights, genetic algorithm, five pairs.
/// Everything else is our reading.
pub(super) fn paper() -> Scenario {
    Scenario {
        name: "unnamed".to_owned(),
        description: String::new(),
        world: WorldSpec {
            bounds: Bounds { min: [0.0, 0.0], max: [10.0, 10.0] },
            outer_wall: true,
            target_radius: 0.4,
            boxes: Vec::new(),
            polygons: Vec::new(),
            circles: Vec::new(),
            walls: Vec::new(),
            map: None,
        },
        vehicle: VehicleSpec {
            length: 0.4,
            width: 0.2,
            front_overhang: 0.05,
            wheelbase: 0.3,
            step: StepLength::Constant(0.1),
            steer_limit: FRAC_PI_2,
            servo_rate: None,
            delay_periods: 0,
        },
        sensors: SensorSpec {
            beams: paper_beams(),
            range: 10.0,
            // A reading: of the four codes this one trained best (docs).
            encoding: Encoding {
                distance: DistanceLaw::Linear,
                types: TypeCode::NearestWallAnyTarget,
            },
            noise: 0.0,
            dropout: 0.0,
        },
        network: NetworkSpec {
            hidden: 12,
            recurrence: RecurrenceKind::Feedforward,
            biases: true,
            activation: ActivationKind::Rational,
        },
        episode: EpisodeSpec {
            step_limit: 300,
            period: 0.1,
            on_collision: OnCollision::Hold,
            reached_by: ReachedBy::Body,
            start_offset: 0.0,
            start_turn: 0.0,
            randomise: RandomiseSpec::default(),
        },
        fitness: FitnessSpec {
            kind: FitnessKind::Paper,
            distance: 100.0,
            length: 100.0,
            collision: 150.0,
            bonus: 5000.0,
            time: 0.1,
            progress: 0.1,
        },
        pairs: PairSpec {
            source: PairSource::Drawn { count: 5, resample: false },
            min_distance: 4.0,
            count_end: None,
            mine: 0.0,
        },
        training: TrainingSpec {
            population: 120,
            islands: 1,
            generations: 60,
            weight_bound: 1.0,
            validation_pairs: 0,
            stressed_share: 0.0,
            stressed_share_start: 0.0,
            stress_in_turns: false,
            footprint_padding: 0.0,
            until_reached: false,
            worlds: None,
            ga: GaSpec::PAPER,
            novelty: None,
        },
    }
}

/// Beams at −30, −15, 0, +15 and +30° from the middle of the front axle.
fn paper_beams() -> [BeamMount; BEAMS] {
    [-30.0, -15.0, 0.0, 15.0, 30.0].map(|degrees: f64| BeamMount {
        x: 0.0,
        y: 0.0,
        angle: degrees.to_radians() as f32,
    })
}

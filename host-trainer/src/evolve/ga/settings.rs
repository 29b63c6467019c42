//! What can be set about the genetic algorithm, and which values make sense.

use std::fmt;

use serde::{Deserialize, Serialize};

/// The paper's genetic algorithm: four groups make the next population.
///
/// The shares add up to 1; [`GaSpec::group_sizes`] makes whole numbers of them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GaSpec {
    /// P1: share selected for single-point crossover.
    pub crossover_share: f32,
    /// P2: share selected for mutation.
    pub mutation_share: f32,
    /// P3: share copied by rank, best first.
    pub ranking_share: f32,
    /// P4: share copied at random.
    pub random_share: f32,
    /// How P1 and P2 are selected.
    pub selection: Selection,
    /// The toolbox's rate: `ceil(strings · genes · rate · U(0,1))` genes change.
    pub mutation_rate: f32,
    /// What a changed gene becomes.
    pub mutation: Mutation,
    /// The mutation's sigma in the last generation, reached by equal ratios; none keeps it.
    pub sigma_end: Option<f32>,
    /// How the first genes are drawn.
    pub initial: Initial,
    /// Whether every normal draw is multiplied by its gene's scale, see [`Outlook`].
    ///
    /// [`Outlook`]: super::Outlook
    pub fan_in: bool,
}

/// How the first genes are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Initial {
    /// Uniform within the bounds.
    Uniform,
    /// Normal around 0, kept within the bounds.
    Gaussian {
        /// Standard deviation, above 0.
        sigma: f32,
    },
}

/// How parents are selected.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Selection {
    /// Stochastic universal sampling, weight `1/(f − f_min + 1)` (toolbox `selsus`).
    Sus,
    /// Stochastic universal sampling over linear ranks.
    LinearRank {
        /// Expected copies of the best, `1.0..=2.0`.
        pressure: f32,
    },
    /// The best share of the population, each equally often.
    Truncation {
        /// Above 0, at most 1.
        share: f32,
    },
}

/// What a changed gene becomes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mutation {
    /// A new uniform value within the bounds (toolbox `mutx`).
    Uniform,
    /// Its old value plus `U(−1, 1) · amplitude`, kept within the bounds (toolbox `muta`).
    Additive {
        /// Largest change, above 0.
        amplitude: f32,
    },
    /// Its old value plus a normal draw, kept within the bounds.
    Gaussian {
        /// Standard deviation, above 0.
        sigma: f32,
    },
    /// As [`Self::Gaussian`], and every gene of the group changes, whatever the rate.
    EveryGene {
        /// Standard deviation, above 0.
        sigma: f32,
    },
}

/// A setting of the search that makes no sense.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SettingError {
    /// Name of the setting, as written in a scenario.
    pub setting: &'static str,
    /// Its value.
    pub found: f64,
    /// What would have been accepted.
    pub expected: &'static str,
}

impl fmt::Display for SettingError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} is {}, expected {}", self.setting, self.found, self.expected)
    }
}

impl std::error::Error for SettingError {}

impl GaSpec {
    /// The values printed in the paper (its algorithm listing, steps 2.2 to 2.8).
    pub const PAPER: Self = Self {
        crossover_share: 0.40,
        mutation_share: 0.40,
        ranking_share: 0.02,
        random_share: 0.18,
        selection: Selection::Sus,
        mutation_rate: 0.1,
        mutation: Mutation::Uniform,
        sigma_end: None,
        initial: Initial::Uniform,
        fan_in: false,
    };

    /// How far the four shares may be from adding up to 1.
    pub const SHARE_TOLERANCE: f32 = 1e-4;

    /// The four shares in the order the groups are joined: P1, P2, P3, P4.
    pub fn shares(&self) -> [f32; 4] {
        [self.crossover_share, self.mutation_share, self.ranking_share, self.random_share]
    }

    /// Refuses the first setting, in the order of the fields, that makes no sense.
    ///
    /// A sum of shares other than 1 is reported under the setting `shares`.
    pub fn check(&self) -> Result<(), SettingError> {
        let names = ["crossover_share", "mutation_share", "ranking_share", "random_share"];
        for (setting, share) in names.into_iter().zip(self.shares()) {
            require((0.0..=1.0).contains(&share), setting, share, "a share from 0 to 1")?;
        }
        let sum: f32 = self.shares().iter().sum();
        let whole = (sum - 1.0).abs() <= Self::SHARE_TOLERANCE;
        require(whole, "shares", sum, "the four shares to add up to 1")?;
        self.selection.check()?;
        let rate = self.mutation_rate;
        require((0.0..=1.0).contains(&rate), "mutation_rate", rate, "a rate from 0 to 1")?;
        self.mutation.check()?;
        if let Some(sigma) = self.sigma_end {
            require(sigma > 0.0 && sigma.is_finite(), "sigma_end", sigma, FINITE)?;
            let expected = "a mutation with a sigma beside it";
            require(self.mutation.sigma().is_some(), "sigma_end", sigma, expected)?;
        }
        match self.initial {
            Initial::Uniform => Ok(()),
            Initial::Gaussian { sigma } => {
                require(sigma > 0.0 && sigma.is_finite(), "initial", sigma, FINITE)
            }
        }
    }

    /// The mutation of the generation that lies `progress`, 0 to 1, of the way from the first to
    /// the last.
    pub fn mutation_at(&self, progress: f64) -> Mutation {
        let (Some(start), Some(end)) = (self.mutation.sigma(), self.sigma_end) else {
            return self.mutation;
        };
        let sigma = between(start.into(), end.into(), progress) as f32;
        match self.mutation {
            Mutation::Gaussian { .. } => Mutation::Gaussian { sigma },
            Mutation::EveryGene { .. } => Mutation::EveryGene { sigma },
            other @ (Mutation::Uniform | Mutation::Additive { .. }) => other,
        }
    }
}

const FINITE: &str = "a finite number above 0";

/// The number that lies `progress`, 0 to 1, of the way from `start` to `end`, both above 0, by
/// equal ratios.
pub fn between(start: f64, end: f64, progress: f64) -> f64 {
    start * libm::pow(end / start, progress)
}

impl Selection {
    fn check(&self) -> Result<(), SettingError> {
        match *self {
            Self::Sus => Ok(()),
            Self::LinearRank { pressure } => require(
                (1.0..=2.0).contains(&pressure),
                "pressure",
                pressure,
                "a number from 1 to 2",
            ),
            Self::Truncation { share } => {
                let fits = share > 0.0 && share <= 1.0;
                require(fits, "share", share, "a share above 0 and at most 1")
            }
        }
    }
}

impl Mutation {
    fn check(&self) -> Result<(), SettingError> {
        let (setting, size) = match *self {
            Self::Uniform => return Ok(()),
            Self::Additive { amplitude } => ("amplitude", amplitude),
            Self::Gaussian { sigma } | Self::EveryGene { sigma } => ("sigma", sigma),
        };
        require(size > 0.0 && size.is_finite(), setting, size, FINITE)
    }

    /// The standard deviation of a mutation that has one.
    fn sigma(&self) -> Option<f32> {
        match *self {
            Self::Uniform | Self::Additive { .. } => None,
            Self::Gaussian { sigma } | Self::EveryGene { sigma } => Some(sigma),
        }
    }
}

/// A share as written, in whole millionths: 0.4 is 400 000, although the nearest `f32` is a
/// little more and would round up to one individual too many.
pub(super) fn millionths(share: f32) -> u128 {
    (f64::from(share) * 1e6).round() as u128
}

/// `Ok` when the setting fits; `NaN` never does, because every comparison with it is false.
pub(in crate::evolve) fn require(
    fits: bool,
    setting: &'static str,
    found: impl Into<f64>,
    expected: &'static str,
) -> Result<(), SettingError> {
    if fits { Ok(()) } else { Err(SettingError { setting, found: found.into(), expected }) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_papers_settings_make_sense() {
        assert_eq!(GaSpec::PAPER.check(), Ok(()));
    }

    #[test]
    fn every_senseless_setting_is_refused_under_its_own_name() {
        let paper = GaSpec::PAPER;
        let linear = |pressure| Selection::LinearRank { pressure };
        let annealed = GaSpec { mutation: Mutation::EveryGene { sigma: 0.1 }, ..paper };
        let cases = [
            ("crossover_share", GaSpec { crossover_share: -0.1, ..paper }),
            ("mutation_share", GaSpec { mutation_share: 1.5, ..paper }),
            ("ranking_share", GaSpec { ranking_share: f32::NAN, ..paper }),
            ("random_share", GaSpec { random_share: f32::INFINITY, ..paper }),
            ("shares", GaSpec { random_share: 0.2, ..paper }),
            ("mutation_rate", GaSpec { mutation_rate: 1.1, ..paper }),
            ("pressure", GaSpec { selection: linear(2.5), ..paper }),
            ("pressure", GaSpec { selection: linear(f32::NAN), ..paper }),
            ("share", GaSpec { selection: Selection::Truncation { share: 0.0 }, ..paper }),
            ("amplitude", GaSpec { mutation: Mutation::Additive { amplitude: 0.0 }, ..paper }),
            ("sigma", GaSpec { mutation: Mutation::Gaussian { sigma: f32::INFINITY }, ..paper }),
            ("sigma", GaSpec { mutation: Mutation::EveryGene { sigma: 0.0 }, ..paper }),
            ("sigma_end", GaSpec { sigma_end: Some(0.1), ..paper }),
            ("sigma_end", GaSpec { sigma_end: Some(f32::NAN), ..annealed }),
            ("initial", GaSpec { initial: Initial::Gaussian { sigma: -1.0 }, ..paper }),
        ];
        for (setting, spec) in cases {
            assert_eq!(spec.check().map_err(|error| error.setting), Err(setting), "{spec:?}");
        }
    }

    /// By hand: half of the way from 0.1 to 0.001 by equal ratios is 0.01.
    #[test]
    fn sigma_falls_by_equal_ratios_from_the_first_generation_to_the_last() {
        for mutation in
            [|sigma| Mutation::EveryGene { sigma }, |sigma| Mutation::Gaussian { sigma }]
        {
            let mutation: fn(f32) -> Mutation = mutation;
            let spec = GaSpec { mutation: mutation(0.1), sigma_end: Some(0.001), ..GaSpec::PAPER };
            let at = |progress| spec.mutation_at(progress);
            assert_eq!([at(0.0), at(1.0)], [0.1, 0.001].map(mutation));
            let middle = at(0.5).sigma().unwrap();
            assert!((middle / 0.01 - 1.0).abs() < 1e-6, "{middle}");
            let kept = GaSpec { sigma_end: None, ..spec };
            assert_eq!(kept.mutation_at(0.7), kept.mutation);
        }
        assert_eq!(GaSpec::PAPER.mutation_at(0.5), Mutation::Uniform);
    }

    #[test]
    fn a_refusal_says_what_was_found_and_what_was_expected() {
        let error = GaSpec { mutation_rate: 2.0, ..GaSpec::PAPER }.check().unwrap_err();
        assert_eq!(error.to_string(), "mutation_rate is 2, expected a rate from 0 to 1");
    }
}

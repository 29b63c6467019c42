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
        self.mutation.check()
    }
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
            Self::Gaussian { sigma } => ("sigma", sigma),
        };
        require(size > 0.0 && size.is_finite(), setting, size, "a finite number above 0")
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
        ];
        for (setting, spec) in cases {
            assert_eq!(spec.check().map_err(|error| error.setting), Err(setting), "{spec:?}");
        }
    }

    #[test]
    fn a_refusal_says_what_was_found_and_what_was_expected() {
        let error = GaSpec { mutation_rate: 2.0, ..GaSpec::PAPER }.check().unwrap_err();
        assert_eq!(error.to_string(), "mutation_rate is 2, expected a rate from 0 to 1");
    }
}

//! Numbers over seeds: where the middle is, how far they spread, and whether one variant beats
//! another.

use serde::Serialize;
use std::cmp::Ordering;

/// How values spread over seeds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// The smallest.
    pub least: f64,
    /// A quarter lies below.
    pub lower_quartile: f64,
    /// Half lies below.
    pub median: f64,
    /// A quarter lies above.
    pub upper_quartile: f64,
    /// The largest.
    pub most: f64,
    /// The median's 95 % confidence interval, from the ranks alone; none of fewer than six values.
    pub median_interval: Option<[f64; 2]>,
}

impl Spread {
    /// Of at least one value; none of them NaN.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let mut values: Vec<f64> = values.into_iter().collect();
        values.sort_by(f64::total_cmp);
        let (least, most) = (*values.first()?, *values.last()?);
        let rank = outer_rank(values.len());
        Some(Self {
            least,
            lower_quartile: quantile(&values, 0.25),
            median: quantile(&values, 0.5),
            upper_quartile: quantile(&values, 0.75),
            most,
            median_interval: rank.map(|rank| [values[rank], values[values.len() - 1 - rank]]),
        })
    }
}

/// Linear between the two neighbours (the usual definition, R's type 7).
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let place = share * (sorted.len() - 1) as f64;
    let below = place.floor() as usize;
    let above = (below + 1).min(sorted.len() - 1);
    sorted[below] + (place - below as f64) * (sorted[above] - sorted[below])
}

/// The rank from 0, from either end, between which the median lies with at least 95 %
/// confidence whatever the distribution.
fn outer_rank(count: usize) -> Option<usize> {
    let tail = |rank: usize| tail_of_coins(count as u32, rank as u32);
    (0..count / 2).take_while(|rank| tail(*rank) <= 0.025).last()
}

/// Probability that at most `heads` of `coins` fair coins show heads.
fn tail_of_coins(coins: u32, heads: u32) -> f64 {
    // In logarithms: 2⁻ⁿ vanishes from n = 1075 on.
    let mut term = -f64::from(coins) * core::f64::consts::LN_2;
    let mut sum = 0.0;
    for k in 0..=heads {
        sum += libm::exp(term);
        term += libm::log(f64::from(coins - k)) - libm::log(f64::from(k + 1));
    }
    sum
}

/// One variant against another, on the same seeds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct SeedBySeed {
    /// Seeds on which it did better.
    pub better: u32,
    /// Seeds on which it did worse.
    pub worse: u32,
    /// Probability of a split at least as uneven if neither were better (sign test, two-sided).
    pub p: f64,
}

impl SeedBySeed {
    /// Compares pairs of (this variant, the other); larger is better, equal ones count for none.
    pub fn of<T: Ord>(pairs: impl Iterator<Item = (T, T)>) -> Self {
        let (mut better, mut worse) = (0, 0);
        for (this, other) in pairs {
            match this.cmp(&other) {
                Ordering::Greater => better += 1,
                Ordering::Less => worse += 1,
                Ordering::Equal => {}
            }
        }
        let p = 2.0 * tail_of_coins(better + worse, better.min(worse));
        Self { better, worse, p: p.min(1.0) }
    }
}

impl std::fmt::Display for SeedBySeed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} better, {} worse", self.better, self.worse)?;
        if self.p < 0.001 { f.write_str(", p < 0.001") } else { write!(f, ", p = {:.3}", self.p) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Expected: numpy.percentile with its default method.
    #[test]
    fn quartiles_are_linear_between_neighbours() {
        let spread = Spread::of([7.0, 1.0, 3.0, 2.0]).unwrap();
        let Spread { least, lower_quartile, median, upper_quartile, most, .. } = spread;
        assert_eq!(
            [least, lower_quartile, median, upper_quartile, most],
            [1.0, 1.75, 2.5, 4.0, 7.0]
        );
        assert_eq!(Spread::of([]), None);
        assert_eq!(Spread::of([0.3]).unwrap().median, 0.3);
    }

    /// Expected: table of ranks for the median's 95 % interval (W. J. Conover, *Practical
    /// Nonparametric Statistics*): of 6 values the ends, of 20 the 6th and the 15th.
    #[test]
    fn the_medians_interval_is_that_of_the_sign_test() {
        let interval = |count: u32| {
            let values = (1..=count).map(f64::from);
            Spread::of(values).unwrap().median_interval
        };
        assert_eq!(interval(5), None);
        assert_eq!(interval(6), Some([1.0, 6.0]));
        assert_eq!(interval(20), Some([6.0, 15.0]));
        assert_eq!(interval(30), Some([10.0, 21.0]));
    }

    /// Expected: scipy.stats.binomtest(k, n).pvalue.
    #[test]
    fn an_uneven_split_is_unlikely_and_ties_say_nothing() {
        let split = |better, worse| {
            let wins = (0..better).map(|_| (2, 1));
            let losses = (0..worse).map(|_| (1, 2));
            SeedBySeed::of(wins.chain(losses).chain([(3, 3)]))
        };
        assert_eq!(format!("{:.4}", split(9, 1).p), "0.0215");
        assert_eq!(format!("{:.4}", split(5, 5).p), "1.0000");
        assert_eq!(split(0, 0), SeedBySeed { better: 0, worse: 0, p: 1.0 });
        assert_eq!(split(3, 12).to_string(), "3 better, 12 worse, p = 0.035");
        assert_eq!(split(1000, 100).to_string(), "1000 better, 100 worse, p < 0.001");
    }
}

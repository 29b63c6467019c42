//! Measures of fit for tests of random things.

/// Pearson's chi-square of counts in equally likely cells.
pub(crate) fn chi_square(counts: impl IntoIterator<Item = usize>) -> f64 {
    let counts: Vec<f64> = counts.into_iter().map(|count| count as f64).collect();
    let expected = counts.iter().sum::<f64>() / counts.len() as f64;
    counts.iter().map(|count| (count - expected) * (count - expected) / expected).sum()
}

/// Whether values follow a distribution, by Kolmogorov and Smirnov's test: 99.99 % of
/// samples of size n stay within 2.23/√n of it everywhere.
pub(crate) fn follows(mut values: Vec<f64>, distribution: impl Fn(f64) -> f64) -> bool {
    values.sort_by(f64::total_cmp);
    let size = values.len() as f64;
    values.iter().enumerate().all(|(rank, &value)| {
        let expected = distribution(value);
        let [below, up_to] = [rank as f64 / size, (rank + 1) as f64 / size];
        (expected - below).abs().max((expected - up_to).abs()) < 2.23 / size.sqrt()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Worked by hand: (4² + 0² + 4²)/10.
    #[test]
    fn chi_square_adds_squared_misses_over_the_expectation() {
        assert_eq!(chi_square([6, 10, 14]), 3.2);
    }

    #[test]
    fn an_even_spread_follows_the_uniform_distribution_and_a_squeezed_one_does_not() {
        let even: Vec<f64> = (0..1000).map(|k| (f64::from(k) + 0.5) / 1000.0).collect();
        let squeezed = even.iter().map(|value| 0.9 * value).collect();
        assert!(follows(even, |value| value));
        assert!(!follows(squeezed, |value| value));
    }
}

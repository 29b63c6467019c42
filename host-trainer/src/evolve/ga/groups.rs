//! How four shares become four whole numbers that add up to the population.

use super::settings::{GaSpec, millionths};

impl GaSpec {
    /// Sizes of P1, P2, P3 and P4 in a population of `population`, which they add up to.
    ///
    /// The paper gives percentages only; this rounding is our reading. Shares are counted in
    /// millionths. Each group gets the whole part of its share, and the places left over go
    /// to the largest remainders, the earlier group first among equals. Then a group with a
    /// share above 0 that came away empty takes one place from the largest group, as long as
    /// that leaves it one: without it a population below 25 would lose its best individual.
    ///
    /// Expects settings that pass [`GaSpec::check`].
    pub fn group_sizes(&self, population: usize) -> [usize; 4] {
        let parts = self.shares().map(millionths);
        let whole = parts.iter().sum::<u128>().max(1);
        let exact = parts.map(|part| part * population as u128);
        let mut sizes = exact.map(|places| (places / whole) as usize);

        let mut by_remainder = [0, 1, 2, 3];
        by_remainder.sort_by_key(|&group| std::cmp::Reverse(exact[group] % whole));
        let left_over = population - sizes.iter().sum::<usize>();
        for group in by_remainder.into_iter().take(left_over) {
            sizes[group] += 1;
        }

        for group in 0..4 {
            let largest = (0..4).rev().max_by_key(|&group| sizes[group]).unwrap_or(0);
            if parts[group] > 0 && sizes[group] == 0 && sizes[largest] > 1 {
                sizes[largest] -= 1;
                sizes[group] = 1;
            }
        }
        sizes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Worked by hand from 40 %, 40 %, 2 % and 18 %.
    #[test]
    fn the_papers_shares_become_these_groups() {
        let sizes = |population| GaSpec::PAPER.group_sizes(population);
        assert_eq!(sizes(100), [40, 40, 2, 18]);
        assert_eq!(sizes(150), [60, 60, 3, 27]);
        assert_eq!(sizes(80), [32, 32, 2, 14]); // 1.6 and 14.4
        assert_eq!(sizes(160), [64, 64, 3, 29]); // 3.2 and 28.8
        assert_eq!(sizes(25), [10, 10, 1, 4]); // 0.5 and 4.5
        assert_eq!(sizes(10), [3, 4, 1, 2]); // 0.2: takes one from P1
        assert_eq!(sizes(3), [1, 1, 0, 1]); // nothing to take
        assert_eq!(sizes(2), [1, 1, 0, 0]);
    }

    #[test]
    fn groups_add_up_and_stay_within_one_place_of_their_share() {
        let spec = GaSpec {
            crossover_share: 0.333,
            mutation_share: 0.333,
            ranking_share: 0.001,
            random_share: 0.333,
            ..GaSpec::PAPER
        };
        for spec in [GaSpec::PAPER, spec] {
            for population in 2..=2_000 {
                let sizes = spec.group_sizes(population);
                assert_eq!(sizes.iter().sum::<usize>(), population);
                for (size, share) in sizes.into_iter().zip(spec.shares()) {
                    let exact = population as f64 * f64::from(share);
                    assert!((size as f64 - exact).abs() < 2.0, "{population}: {sizes:?}");
                    assert!(size > 0 || population < 4, "{population}: {sizes:?}");
                }
            }
        }
    }

    #[test]
    fn a_group_without_a_share_stays_empty() {
        let spec = GaSpec {
            crossover_share: 0.0,
            mutation_share: 1.0,
            ranking_share: 0.0,
            random_share: 0.0,
            ..GaSpec::PAPER
        };
        assert_eq!(spec.group_sizes(7), [0, 7, 0, 0]);
    }
}

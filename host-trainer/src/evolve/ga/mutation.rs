//! Mutation (toolbox `mutx` and `muta`).
//!
//! One call makes `ceil(genes · rate · U)` changes, with one `U` uniform in `0.0..1.0` for
//! all strings together, each at a gene drawn with replacement. So a rate of 0.1 changes
//! `1 − (1 − e^−0.1)/0.1`, 4.8 %, of the genes on average, and not 10 %.
//!
//! [`Mutation::EveryGene`] is no operator of the toolbox: it changes every gene, in order.

use super::Mutation;
use crate::seed::Stream;

/// Changes some of `genes`, the strings of one group end to end; they stay in
/// `-bound..=bound`. Normal draws for gene `g` of a string are multiplied by `scales[g]`.
pub fn mutate(
    mutation: Mutation,
    rate: f32,
    bound: f32,
    scales: &[f32],
    genes: &mut [f32],
    stream: &mut Stream,
) {
    if let Mutation::EveryGene { sigma } = mutation {
        for (gene, scale) in genes.iter_mut().zip(scales.iter().cycle()) {
            *gene = (*gene + sigma * scale * stream.normal()).clamp(-bound, bound);
        }
        return;
    }
    let changes = (genes.len() as f64 * f64::from(rate) * stream.unit_f64()).ceil() as usize;
    for _ in 0..changes {
        // One draw over all genes is a random string and a random gene of it.
        let index = stream.index(genes.len());
        let gene = &mut genes[index];
        *gene = match mutation {
            Mutation::Uniform => stream.within(-bound, bound),
            Mutation::Additive { amplitude } => *gene + stream.within(-amplitude, amplitude),
            Mutation::Gaussian { sigma } | Mutation::EveryGene { sigma } => {
                *gene + sigma * scales[index % scales.len()] * stream.normal()
            }
        }
        .clamp(-bound, bound);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::statistics::follows;
    use crate::seed::{Purpose, RunSeed};

    const GENES: usize = 64 * 240;

    fn stream(generation: u32) -> Stream {
        RunSeed(1).stream(Purpose::Breeding, generation, 0)
    }

    /// Genes after one call on zeros; 0.0 itself is hit with probability 2⁻²³ only.
    fn mutated(mutation: Mutation, rate: f32, bound: f32, generation: u32) -> Vec<f32> {
        let mut genes = vec![0.0; GENES];
        mutate(mutation, rate, bound, &[1.0], &mut genes, &mut stream(generation));
        genes
    }

    fn changed(genes: &[f32]) -> Vec<f64> {
        genes.iter().filter(|&&gene| gene != 0.0).map(|&gene| f64::from(gene)).collect()
    }

    /// Expected: the mean of `1 − e^(−0.1 U)` over U, 0.04837; its standard deviation is
    /// 0.0275, the limit five standard errors.
    #[test]
    fn a_rate_of_a_tenth_changes_five_percent_of_the_genes() {
        let calls = 2_000;
        let share: f64 = (0..calls)
            .map(|call| changed(&mutated(Mutation::Uniform, 0.1, 3.0, call)).len() as f64)
            .sum::<f64>()
            / f64::from(calls)
            / GENES as f64;
        assert!((share - 0.04837).abs() < 5.0 * 0.0275 / f64::from(calls).sqrt(), "{share}");
    }

    /// `U` is the stream's first draw; hits on one gene twice only ever lower the count.
    #[test]
    fn one_number_decides_how_many_genes_change() {
        for generation in 0..200 {
            let number = stream(generation).unit_f64();
            let limit = (GENES as f64 * f64::from(0.1_f32) * number).ceil();
            let count = changed(&mutated(Mutation::Uniform, 0.1, 3.0, generation)).len() as f64;
            assert!(count <= limit && count >= 0.9 * limit - 3.0, "{count} of {limit}");
        }
    }

    #[test]
    fn no_rate_or_no_genes_change_nothing() {
        assert_eq!(mutated(Mutation::Uniform, 0.0, 3.0, 0), [0.0; GENES]);
        mutate(Mutation::Uniform, 0.1, 3.0, &[1.0], &mut [], &mut stream(0));
    }

    #[test]
    fn even_the_smallest_rate_changes_one_gene() {
        assert_eq!(changed(&mutated(Mutation::Uniform, 1e-6, 3.0, 0)).len(), 1);
    }

    #[test]
    fn a_new_value_is_uniform_within_the_bounds() {
        let values =
            (0..20).flat_map(|call| changed(&mutated(Mutation::Uniform, 0.1, 2.0, call))).collect();
        assert!(follows(values, |value| (value + 2.0) / 4.0));
    }

    /// Variance of `U(−1, 1) · amplitude` is `amplitude²/3`, of a normal draw `sigma²`.
    /// The rate is so low that hardly any gene is hit twice; the limit is 5 %.
    #[test]
    fn added_changes_have_the_variance_of_their_distribution() {
        let spread = |mutation| {
            let values: Vec<f64> =
                (0..400).flat_map(|call| changed(&mutated(mutation, 0.005, 100.0, call))).collect();
            assert!(values.len() > 10_000);
            values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64
        };
        let additive = spread(Mutation::Additive { amplitude: 0.6 });
        assert!((additive / 0.12 - 1.0).abs() < 0.05, "{additive}");
        let gaussian = spread(Mutation::Gaussian { sigma: 0.5 });
        assert!((gaussian / 0.25 - 1.0).abs() < 0.05, "{gaussian}");
    }

    #[test]
    fn an_added_change_never_exceeds_its_amplitude() {
        let genes = mutated(Mutation::Additive { amplitude: 0.25 }, 1e-3, 3.0, 1);
        assert!(genes.iter().all(|gene| gene.abs() <= 0.25));
    }

    #[test]
    fn changes_past_the_bounds_stop_there() {
        for mutation in [
            Mutation::Additive { amplitude: f32::MAX },
            Mutation::Gaussian { sigma: f32::MAX },
            Mutation::EveryGene { sigma: f32::MAX },
        ] {
            let genes = mutated(mutation, 1.0, 1.5, 0);
            assert!(genes.iter().all(|gene| gene.abs() <= 1.5));
            assert!(genes.contains(&1.5) && genes.contains(&-1.5));
        }
    }

    #[test]
    fn every_gene_changes_by_a_normal_draw_of_its_own_scale() {
        for mutation in [Mutation::EveryGene { sigma: 0.5 }, Mutation::Gaussian { sigma: 0.5 }] {
            let mut genes = vec![0.0; GENES];
            mutate(mutation, 0.01, 1e6, &[2.0, 0.2], &mut genes, &mut stream(4));
            for (first, sigma) in [(0, 1.0), (1, 0.1)] {
                let own: Vec<f64> =
                    genes.iter().skip(first).step_by(2).map(|gene| f64::from(*gene)).collect();
                if mutation == (Mutation::EveryGene { sigma: 0.5 }) {
                    assert!(own.iter().all(|gene| *gene != 0.0));
                }
                let changed: Vec<f64> = own.into_iter().filter(|gene| *gene != 0.0).collect();
                let cumulative = |x: f64| 0.5 * libm::erfc(-x / (sigma * std::f64::consts::SQRT_2));
                assert!(follows(changed, cumulative), "{mutation:?}, {sigma}");
            }
        }
    }
}

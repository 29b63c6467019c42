//! Single-point crossover (toolbox `crossov` with one point and random couples).
//!
//! Every selected string is in exactly one couple, couples are drawn at random, and both
//! children are kept, one after the other; there is no crossover probability. With an odd
//! number one string, drawn at random, stays as it is.

use super::super::Population;
use crate::seed::Stream;

/// Breeds `children`, as many genomes as there are `parents`; `parents` is left in the order
/// of the couples.
///
/// A couple is cut between two genes, each of the `genome_len − 1` places equally likely; a
/// genome of one gene has no such place and is copied.
pub fn single_point(
    old: &Population,
    parents: &mut [usize],
    children: &mut [f32],
    stream: &mut Stream,
) {
    let len = old.genome_len();
    stream.shuffle(parents);
    let (couples, single) = parents.as_chunks::<2>();
    let mut families = children.chunks_exact_mut(2 * len);
    for (&[a, b], family) in couples.iter().zip(&mut families) {
        let cut = if len > 1 { 1 + stream.index(len - 1) } else { len };
        let (a, b) = (old.genome(a), old.genome(b));
        let (first, second) = family.split_at_mut(len);
        first[..cut].copy_from_slice(&a[..cut]);
        first[cut..].copy_from_slice(&b[cut..]);
        second[..cut].copy_from_slice(&b[..cut]);
        second[cut..].copy_from_slice(&a[cut..]);
    }
    if let &[single] = single {
        families.into_remainder().copy_from_slice(old.genome(single));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::SearchSpace;
    use crate::seed::statistics::chi_square;
    use crate::seed::{Purpose, RunSeed};

    const LEN: usize = 6;

    fn stream(generation: u32) -> Stream {
        RunSeed(1).stream(Purpose::Breeding, generation, 0)
    }

    /// Gene `g` of genome `i` is `10 i + g`, so that every gene tells where it comes from.
    fn labelled(population: usize, genome_len: usize) -> Population {
        let mut labelled =
            Population::zeros(&SearchSpace { population, genome_len, bound: 1000.0 });
        for (index, gene) in labelled.genes_mut().iter_mut().enumerate() {
            *gene = (10 * (index / genome_len) + index % genome_len) as f32;
        }
        labelled
    }

    fn cross(old: &Population, parents: &[usize], stream: &mut Stream) -> Vec<Vec<f32>> {
        let mut children = vec![f32::NAN; parents.len() * old.genome_len()];
        single_point(old, &mut parents.to_vec(), &mut children, stream);
        children.chunks_exact(old.genome_len()).map(<[f32]>::to_vec).collect()
    }

    /// Parent of each gene, and a check that it kept its place.
    fn origins(child: &[f32]) -> Vec<usize> {
        let place = |(locus, gene): (usize, &f32)| {
            assert_eq!(*gene as usize % 10, locus, "a gene moved to another place");
            *gene as usize / 10
        };
        child.iter().enumerate().map(place).collect()
    }

    #[test]
    fn every_place_keeps_the_genes_its_parents_brought() {
        for count in 0..10 {
            let old = labelled(10, LEN);
            let parents: Vec<usize> = (0..count).map(|k| (3 * k) % 10).collect();
            let children = cross(&old, &parents, &mut stream(count as u32));
            for locus in 0..LEN {
                let mut brought: Vec<usize> = parents.clone();
                let mut kept: Vec<usize> = children.iter().map(|c| origins(c)[locus]).collect();
                brought.sort_unstable();
                kept.sort_unstable();
                assert_eq!(kept, brought);
            }
        }
    }

    #[test]
    fn siblings_swap_their_parents_after_one_cut_inside_the_genome() {
        let old = labelled(10, LEN);
        let children = cross(&old, &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9], &mut stream(0));
        for family in children.as_chunks::<2>().0 {
            let [first, second] = [origins(&family[0]), origins(&family[1])];
            let (a, b) = (first[0], second[0]);
            let cut = first.iter().position(|&parent| parent == b).expect("a cut");
            assert_ne!(a, b);
            assert!(first[..cut].iter().all(|&p| p == a) && first[cut..].iter().all(|&p| p == b));
            assert!(second[..cut].iter().all(|&p| p == b) && second[cut..].iter().all(|&p| p == a));
        }
    }

    /// Chi-square of five equally likely cuts: 99.99 % of samples stay below 23.5.
    #[test]
    fn every_cut_is_equally_likely() {
        let old = labelled(2, LEN);
        let mut counts = [0; LEN];
        for generation in 0..10_000 {
            let children = cross(&old, &[0, 1], &mut stream(generation));
            let child = origins(&children[0]);
            counts[child.iter().filter(|&&parent| parent == child[0]).count()] += 1;
        }
        assert!(counts[0] == 0 && chi_square(counts[1..].to_vec()) < 23.5, "{counts:?}");
    }

    /// Three couplings of four strings: 99.99 % of chi-squares stay below 18.4.
    #[test]
    fn every_coupling_is_equally_likely() {
        let old = labelled(4, 2);
        let mut counts = [0; 4];
        for generation in 0..9_000 {
            let children = cross(&old, &[0, 1, 2, 3], &mut stream(generation));
            let family_of_0 = children.as_chunks::<2>().0.iter().map(|family| origins(&family[0]));
            let partner = family_of_0.map(|o| (o[0], o[1])).find_map(|(a, b)| match (a, b) {
                (0, other) | (other, 0) => Some(other),
                _ => None,
            });
            counts[partner.expect("0 has a partner")] += 1;
        }
        assert!(counts[0] == 0 && chi_square(counts[1..].to_vec()) < 18.4, "{counts:?}");
    }

    #[test]
    fn an_odd_one_out_and_genomes_of_one_gene_are_copied() {
        let old = labelled(3, LEN);
        let children = cross(&old, &[0, 1, 2], &mut stream(0));
        assert!(old.genomes().any(|genome| genome == children[2]));

        let tiny = labelled(2, 1);
        let mut children = cross(&tiny, &[0, 1], &mut stream(0)).concat();
        children.sort_by(f32::total_cmp);
        assert_eq!(children, [0.0, 10.0]);
    }
}

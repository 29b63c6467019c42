//! Beams that may meet more than one obstacle, in one row.
//!
//! Most beams have to be tested with one obstacle or none. But side by side they take as long as the one with most, and
//! among sixteen there mostly is one with three. So those with more than one are taken out of all questions, and stand
//! without gaps. In large worlds, where what a name means takes longest to find out, that would not pay.

use super::asked::{IN_HALF, Names};
use super::beams::Met;
use super::words::NAME;
use crate::vector::{MOST_LANES, Vector};
use controller_core::geometry::Ray;

/// A word's half of each beam.
type Halves<const Q: usize> = [[u32; MOST_LANES]; Q];

/// How many beams have been added; none to begin with.
#[derive(Default)]
pub(super) struct Added(usize);

/// Beams of `Q` questions, in the order in which they were added.
pub(super) struct Later<V, const Q: usize> {
    /// Origins and directions.
    rays: [[V; Q]; 4],
    /// Low halves of words, whose first names are done with.
    halves: Halves<Q>,
    /// What they have met, as [`Met::numbers`].
    met: [[V; Q]; 2],
    /// The lanes of each question whose beams these are, as bits.
    lanes: [u32; Q],
    /// How many there are, once [all are added](Self::end).
    count: usize,
}

impl<V: Vector, const Q: usize> Later<V, Q> {
    /// None yet.
    #[inline(always)]
    pub(super) fn new() -> Self {
        Self {
            rays: [[V::from(0.0); Q]; 4],
            halves: [[0; MOST_LANES]; Q],
            met: [[V::from(0.0); Q]; 2],
            lanes: [0; Q],
            count: 0,
        }
    }

    /// Adds those of a question's beams that may meet more than the first obstacle named. Every question is added, or
    /// [none of it](Self::add_none), once and in order: so there is always room.
    #[inline(always)]
    pub(super) fn add(
        &mut self,
        Added(count): &mut Added,
        question: usize,
        ray: &Ray<V>,
        Names { halves, .. }: Names<'_>,
    ) {
        let lanes = V::lanes_with(halves, u32::MAX << NAME);
        let Ray { origin, direction } = ray;
        let numbers = [origin.0, origin.1, direction.0, direction.1];
        debug_assert!(*count <= question * V::WIDTH, "every question once and in order");
        // It is no farther out; said so, writing needs no test.
        let place = (*count).min((Q - 1) * V::WIDTH);
        for (all, number) in self.rays.iter_mut().zip(numbers) {
            put(all, place, number.squeezed(lanes));
        }
        put_words::<V>(self.halves.as_flattened_mut(), place, halves, lanes);
        self.lanes[question] = lanes;
        *count += lanes.count_ones() as usize;
    }

    /// Adds none of a question's beams.
    #[inline(always)]
    pub(super) fn add_none(&mut self, question: usize) {
        self.lanes[question] = 0;
    }

    /// All questions are added.
    #[inline(always)]
    pub(super) fn end(&mut self, Added(count): Added) {
        self.count = count;
    }

    /// How many vectors they fill.
    #[inline(always)]
    pub(super) fn vectors(&self) -> usize {
        self.count.div_ceil(V::WIDTH)
    }

    /// The beams of one vector.
    #[inline(always)]
    pub(super) fn ray(&self, vector: usize) -> Ray<V> {
        let [x, y, dx, dy] = &self.rays;
        Ray { origin: (x[vector], y[vector]), direction: (dx[vector], dy[vector]) }
    }

    /// What they may meet in a round, if any of them still may: from round 1 on.
    #[inline(always)]
    pub(super) fn names(&self, vector: usize, round: usize) -> Option<Names<'_>> {
        let first = vector * V::WIDTH;
        let halves = self.halves.as_flattened()[first..].first_chunk();
        let halves = halves.expect("as many as the widest vector has lanes");
        // Lanes that are left over in the last vector hold anything.
        let used = u32::MAX.checked_shr(u32::BITS.saturating_sub((self.count - first) as u32));
        let used = used.unwrap_or(0);
        let is_named =
            round < IN_HALF && V::lanes_with(halves, 0xff << (NAME * round as u32)) & used != 0;
        is_named.then_some(Names { halves, byte: round, legend_starts: &[0; MOST_LANES] })
    }

    /// Writes down what the beams of one vector have met.
    #[inline(always)]
    pub(super) fn set_met(&mut self, vector: usize, met: &Met<V>) {
        for (all, number) in self.met.iter_mut().zip(met.numbers()) {
            all[vector] = number;
        }
    }

    /// What beams of a question have met, by lane; `taken` counts those of the questions before.
    #[inline(always)]
    pub(super) fn met(&self, question: usize, taken: &mut usize) -> Option<Met<V>> {
        let lanes = self.lanes[question];
        if lanes == 0 {
            return None;
        }
        let mut numbers = [V::from(f32::INFINITY); 2];
        for (number, all) in numbers.iter_mut().zip(&self.met) {
            let all: &[f32] = bytemuck::must_cast_slice(all);
            let squeezed: &[u8] = bytemuck::must_cast_slice(&all[*taken..][..V::WIDTH]);
            *number = bytemuck::pod_read_unaligned::<V>(squeezed).spread(lanes, *number);
        }
        *taken += lanes.count_ones() as usize;
        Some(Met::of(numbers))
    }
}

/// Writes numbers from this place on.
#[inline(always)]
fn put<V: Vector>(to: &mut [V], place: usize, numbers: V) {
    let to: &mut [f32] = bytemuck::must_cast_slice_mut(to);
    to[place..][..V::WIDTH].copy_from_slice(numbers.lanes());
}

/// Writes words of these lanes, likewise.
#[inline(always)]
fn put_words<V: Vector>(to: &mut [u32], place: usize, words: &[u32; MOST_LANES], lanes: u32) {
    let words: &[u8] = bytemuck::must_cast_slice(&words[..V::WIDTH]);
    let squeezed = bytemuck::pod_read_unaligned::<V>(words).squeezed(lanes);
    to[place..][..V::WIDTH].copy_from_slice(bytemuck::must_cast_slice(squeezed.lanes()));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::{Instructions, Kernel};

    const QUESTIONS: usize = 5;

    /// What a beam meets that starts in this question and lane: two numbers nobody else has.
    fn numbers(question: usize, lane: usize) -> [f32; 2] {
        [(100 * question + lane) as f32, (1000 + 100 * question + lane) as f32]
    }

    /// How many names each lane of each question has, from the first on.
    struct Row([[u32; MOST_LANES]; QUESTIONS]);

    impl Row {
        fn halves(&self, question: usize) -> [u32; MOST_LANES] {
            self.0[question].map(|names| (0..names).fold(0, |half, name| half | 7 << (8 * name)))
        }
    }

    impl Kernel for &[Row] {
        type Output = ();

        #[inline(always)]
        fn run<V: Vector>(self) {
            let mut later = Later::<V, QUESTIONS>::new();
            for row in self {
                let mut added = Added::default();
                let mut expected = Vec::new();
                for question in 0..QUESTIONS {
                    let halves = row.halves(question);
                    let mut x = V::from(0.0);
                    for (lane, number) in x.lanes_mut().iter_mut().enumerate() {
                        [*number, _] = numbers(question, lane);
                    }
                    let ray = Ray { origin: (x, -x), direction: (x + x, x) };
                    let names = Names { halves: &halves, byte: 1, legend_starts: &[0; MOST_LANES] };
                    let has_more = |lane: &usize| row.0[question][*lane] > 1;
                    let lanes: Vec<usize> = (0..V::WIDTH).filter(has_more).collect();
                    if lanes.is_empty() {
                        later.add_none(question);
                    } else {
                        later.add(&mut added, question, &ray, names);
                    }
                    expected.extend(lanes.into_iter().map(|lane| (question, lane)));
                }
                later.end(added);
                let vectors = later.vectors();
                assert_eq!(vectors, expected.len().div_ceil(V::WIDTH));
                for vector in 0..vectors {
                    let ray = later.ray(vector);
                    let mut met = [V::from(0.0); 2];
                    let mut rounds = 1;
                    while later.names(vector, rounds).is_some() {
                        rounds += 1;
                    }
                    let beams = expected.chunks(V::WIDTH).nth(vector).unwrap();
                    let most = beams.iter().map(|(question, lane)| row.0[*question][*lane]).max();
                    assert_eq!(Some(rounds as u32), most);
                    for (at, (question, lane)) in beams.iter().enumerate() {
                        let number = numbers(*question, *lane);
                        let (x, dx) = (ray.origin.0.lanes()[at], ray.direction.0.lanes()[at]);
                        assert_eq!((x, dx), (number[0], 2.0 * number[0]));
                        (met[0].lanes_mut()[at], met[1].lanes_mut()[at]) = (number[0], number[1]);
                    }
                    later.set_met(vector, &Met::of(met));
                }
                let mut taken = 0;
                for question in 0..QUESTIONS {
                    let of = |lane: usize| expected.contains(&(question, lane));
                    let Some(met) = later.met(question, &mut taken) else {
                        assert!((0..V::WIDTH).all(|lane| !of(lane)));
                        continue;
                    };
                    for (which, found) in met.numbers().iter().enumerate() {
                        for (lane, found) in found.lanes().iter().enumerate() {
                            let beam = numbers(question, lane)[which];
                            assert_eq!(*found, if of(lane) { beam } else { f32::INFINITY });
                        }
                    }
                }
                assert_eq!(taken, expected.len());
            }
        }
    }

    #[test]
    fn beams_with_more_names_stand_in_a_row_and_each_gets_back_what_it_has_met() {
        let all = |names: u32| Row([[names; MOST_LANES]; QUESTIONS]);
        let mut rows = vec![all(0), all(4), all(1), all(2), all(0)];
        for seed in 0..200_u32 {
            let names = |question: u32, lane: u32| {
                let mixed = (seed * 80 + question * 16 + lane).wrapping_mul(2_654_435_761) >> 24;
                // Some rows nearly empty, some nearly full, and questions that have none.
                let least = [255, 200, 128, 40, 0][(seed as usize + question as usize) % 5];
                if mixed < least { mixed % 2 } else { 2 + mixed % 3 }
            };
            rows.push(Row(std::array::from_fn(|question| {
                std::array::from_fn(|lane| names(question as u32, lane as u32))
            })));
        }
        for set in Instructions::available() {
            set.run(&rows[..]);
        }
    }
}

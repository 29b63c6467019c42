//! One layer: sums of weighted inputs, passed through the tanh.
//!
//! Neurons are worked on in groups, so that the sums of a group stay in the registers until they are done. A neuron's own
//! order of additions is the same in a group of any size.

use super::Recurrence;
use crate::activation::Activation;
use crate::lane::Lane;
use core::fmt;

/// One layer's weights, borrowed.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layer<'a, W: Copy, const IN: usize, const OUT: usize> {
    pub(super) weights: &'a [[W; OUT]; IN],
    pub(super) bias: Option<&'a [W; OUT]>,
}

impl<const IN: usize, const OUT: usize> Layer<'_, f32, IN, OUT> {
    /// The same with biases of `+0.0` where there are none: what a sum without bias starts from.
    #[inline(always)]
    pub(super) fn with_bias(self) -> Self {
        Self { bias: Some(self.bias.unwrap_or(const { &[0.0; OUT] })), ..self }
    }
}

impl<W: Copy + fmt::Debug, const IN: usize, const OUT: usize> Layer<'_, W, IN, OUT> {
    /// Replaces the layer's previous outputs by new ones, `N` neurons at a time.
    #[inline(always)]
    pub(super) fn run<const N: usize, R: Recurrence, L: Lane + From<W>>(
        &self,
        memory: R::Weights<'_, W, OUT>,
        activation: impl Activation,
        input: &[L; IN],
        outputs: &mut [L; OUT],
    ) {
        let previous = *outputs;
        let (groups, rest) = outputs.as_chunks_mut::<N>();
        let mut first = 0;
        for group in groups {
            *group = self.group::<N, R, L>(first, memory, activation, input, group, &previous);
            first += N;
        }
        for output in rest {
            [*output] =
                self.group::<1, R, L>(first, memory, activation, input, &[*output], &previous);
            first += 1;
        }
    }

    /// The same with the previous outputs in another place, and if `SUMS_FIRST` the sums of all neurons before the tanh of any:
    /// then the tanh takes no registers from the sums. A function of its own: with it a board's step in place would take
    /// 2 % more instructions.
    #[inline(always)]
    pub(super) fn run_between<
        const N: usize,
        const SUMS_FIRST: bool,
        R: Recurrence,
        L: Lane + From<W>,
    >(
        &self,
        memory: R::Weights<'_, W, OUT>,
        activation: impl Activation,
        input: &[L; IN],
        previous: &[L; OUT],
        outputs: &mut [L; OUT],
    ) {
        let (groups, rest) = outputs.as_chunks_mut::<N>();
        let (own_of_groups, own_of_rest) = previous.as_chunks::<N>();
        let mut first = 0;
        for (group, own) in groups.iter_mut().zip(own_of_groups) {
            *group = self.sums::<N, R, L>(first, memory, input, own, previous);
            if !SUMS_FIRST {
                activation.apply(group);
            }
            first += N;
        }
        for (output, own) in rest.iter_mut().zip(own_of_rest) {
            [*output] = self.sums::<1, R, L>(first, memory, input, &[*own], previous);
            if !SUMS_FIRST {
                activation.apply(core::array::from_mut(output));
            }
            first += 1;
        }
        if SUMS_FIRST {
            activation.apply(outputs);
        }
    }

    /// New outputs of the `N` neurons from `first` on, whose previous ones are `own`.
    #[inline(always)]
    fn group<const N: usize, R: Recurrence, L: Lane + From<W>>(
        &self,
        first: usize,
        memory: R::Weights<'_, W, OUT>,
        activation: impl Activation,
        input: &[L; IN],
        own: &[L; N],
        previous: &[L; OUT],
    ) -> [L; N] {
        let mut sums = self.sums::<N, R, L>(first, memory, input, own, previous);
        activation.apply(&mut sums);
        sums
    }

    /// What goes into their tanh.
    #[inline(always)]
    fn sums<const N: usize, R: Recurrence, L: Lane + From<W>>(
        &self,
        first: usize,
        memory: R::Weights<'_, W, OUT>,
        input: &[L; IN],
        own: &[L; N],
        previous: &[L; OUT],
    ) -> [L; N] {
        let mut sums = match self.bias.and_then(|bias| group(bias, first)) {
            Some(bias) => <[W; N]>::map(*bias, L::from),
            None => [L::from(0.0f32); N],
        };
        add_products(&mut sums, first, self.weights, input);
        R::add(&mut sums, first, memory, own, previous);
        sums
    }
}

/// Adds `weight · input`, input by input, to the sums of the `N` neurons from `first` on.
#[inline(always)]
pub(super) fn add_products<
    L: Lane + From<W>,
    W: Copy,
    const IN: usize,
    const OUT: usize,
    const N: usize,
>(
    sums: &mut [L; N],
    first: usize,
    weights: &[[W; OUT]; IN],
    input: &[L; IN],
) {
    for (row, value) in weights.iter().zip(input) {
        let Some(row) = group::<W, OUT, N>(row, first) else { continue };
        for (sum, weight) in sums.iter_mut().zip(row) {
            *sum = *sum + L::from(*weight) * *value;
        }
    }
}

/// `N` of a layer's values from `first` on; callers stay within the layer.
#[inline(always)]
pub(super) fn group<T, const ALL: usize, const N: usize>(
    all: &[T; ALL],
    first: usize,
) -> Option<&[T; N]> {
    all.get(first..)?.first_chunk()
}

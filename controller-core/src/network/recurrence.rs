//! What a layer remembers of the step before: its weights and what they add.

use super::RecurrenceKind;
use super::layer::{add_products, group};
use crate::lane::Lane;
use core::fmt;

/// A recurrence as a type, so that a device carries the code of its own kind only.
pub trait Recurrence: Copy {
    /// The same as a value.
    const KIND: RecurrenceKind;

    /// The recurrent weights of one layer of width `H`.
    type Weights<'a, W: Copy + fmt::Debug + 'a, const H: usize>: Copy + fmt::Debug;

    /// Takes one layer's recurrent weights off the front of the genome.
    fn take<'a, W: Copy + fmt::Debug, const H: usize>(
        genome: &mut &'a [W],
    ) -> Option<Self::Weights<'a, W, H>>;

    /// Adds the recurrent part to the sums of the `N` neurons from `first` on: `own` are their
    /// previous outputs, `previous` those of their whole layer.
    fn add<L: Lane + From<W>, W: Copy + fmt::Debug, const H: usize, const N: usize>(
        sums: &mut [L; N],
        first: usize,
        weights: Self::Weights<'_, W, H>,
        own: &[L; N],
        previous: &[L; H],
    );
}

/// [`RecurrenceKind::Feedforward`] as a type.
#[derive(Clone, Copy, Debug)]
pub struct Feedforward;

/// [`RecurrenceKind::SelfLoop`] as a type.
#[derive(Clone, Copy, Debug)]
pub struct SelfLoop;

/// [`RecurrenceKind::Elman`] as a type.
#[derive(Clone, Copy, Debug)]
pub struct Elman;

impl Recurrence for Feedforward {
    const KIND: RecurrenceKind = RecurrenceKind::Feedforward;
    type Weights<'a, W: Copy + fmt::Debug + 'a, const H: usize> = ();

    fn take<W: Copy + fmt::Debug, const H: usize>(_: &mut &[W]) -> Option<()> {
        Some(())
    }

    #[inline(always)]
    fn add<L: Lane + From<W>, W: Copy + fmt::Debug, const H: usize, const N: usize>(
        _: &mut [L; N],
        _: usize,
        (): (),
        _: &[L; N],
        _: &[L; H],
    ) {
    }
}

impl Recurrence for SelfLoop {
    const KIND: RecurrenceKind = RecurrenceKind::SelfLoop;
    type Weights<'a, W: Copy + fmt::Debug + 'a, const H: usize> = &'a [W; H];

    fn take<'a, W: Copy + fmt::Debug, const H: usize>(genome: &mut &'a [W]) -> Option<&'a [W; H]> {
        take_row(genome)
    }

    #[inline(always)]
    fn add<L: Lane + From<W>, W: Copy + fmt::Debug, const H: usize, const N: usize>(
        sums: &mut [L; N],
        first: usize,
        weights: &[W; H],
        own: &[L; N],
        _: &[L; H],
    ) {
        let Some(weights) = group::<W, H, N>(weights, first) else { return };
        for ((sum, weight), output) in sums.iter_mut().zip(weights).zip(own) {
            *sum = *sum + L::from(*weight) * *output;
        }
    }
}

impl Recurrence for Elman {
    const KIND: RecurrenceKind = RecurrenceKind::Elman;
    type Weights<'a, W: Copy + fmt::Debug + 'a, const H: usize> = &'a [[W; H]; H];

    fn take<'a, W: Copy + fmt::Debug, const H: usize>(
        genome: &mut &'a [W],
    ) -> Option<&'a [[W; H]; H]> {
        take_matrix(genome)
    }

    #[inline(always)]
    fn add<L: Lane + From<W>, W: Copy + fmt::Debug, const H: usize, const N: usize>(
        sums: &mut [L; N],
        first: usize,
        weights: &[[W; H]; H],
        _: &[L; N],
        previous: &[L; H],
    ) {
        add_products(sums, first, weights, previous);
    }
}

pub(super) fn take_row<'a, W, const N: usize>(genome: &mut &'a [W]) -> Option<&'a [W; N]> {
    let (row, rest) = genome.split_first_chunk()?;
    *genome = rest;
    Some(row)
}

pub(super) fn take_matrix<'a, W, const IN: usize, const OUT: usize>(
    genome: &mut &'a [W],
) -> Option<&'a [[W; OUT]; IN]> {
    let (matrix, rest) = genome.split_at_checked(IN * OUT)?;
    *genome = rest;
    matrix.as_chunks().0.try_into().ok()
}

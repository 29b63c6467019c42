//! Rows of four numbers by their one-byte names.

use super::{MOST_LANES, RowOfLane};

/// Names that there are.
const NAMES: usize = 1 << u8::BITS;

/// A row for every name.
#[derive(Debug)]
pub struct Table {
    rows: Box<[[f32; 4]; NAMES]>,
    columns: Option<Box<Columns>>,
}

/// Few rows once more, so that they can be taken from registers.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Columns {
    pub(super) columns: [[f32; Self::ROWS]; 4],
    /// Whether the last quarter of each is never asked for.
    pub(super) are_few: bool,
}

impl Columns {
    /// Most rows.
    pub(super) const ROWS: usize = 4 * MOST_LANES;
}

impl Table {
    /// These rows, by name; further names have the first one's.
    ///
    /// # Panics
    ///
    /// Without a row, or with more than there are names.
    pub fn new(given: &[[f32; 4]]) -> Self {
        assert!(given.len() <= NAMES, "{} rows", given.len());
        let mut rows = Box::new([given[0]; NAMES]);
        rows[..given.len()].copy_from_slice(given);
        let columns = (given.len() <= Columns::ROWS).then(|| {
            let column = |number: usize| std::array::from_fn(|row| rows[row][number]);
            let are_few = given.len() <= Columns::ROWS / 4 * 3;
            Box::new(Columns { columns: std::array::from_fn(column), are_few })
        });
        Self { rows, columns }
    }

    /// The same by columns, if all named rows are among the first [`Columns::ROWS`].
    #[inline(always)]
    pub(super) fn columns(&self) -> Option<&Columns> {
        self.columns.as_deref()
    }
}

/// The rows that bytes of numbers name.
#[derive(Clone, Copy, Debug)]
pub struct ByName<'a> {
    /// The rows.
    pub table: &'a Table,
    /// Each lane's number.
    pub names: &'a [u32; MOST_LANES],
    /// Which byte of the numbers, lowest first.
    pub byte: usize,
}

impl RowOfLane for ByName<'_> {
    #[inline(always)]
    fn row(&self, lane: usize) -> &[f32; 4] {
        // Little-endian, as controller-core demands.
        let bytes: &[u8] = bytemuck::must_cast_slice(self.names);
        &self.table.rows[usize::from(bytes[lane * size_of::<u32>() + self.byte])]
    }
}

//! Consecutive parts of the rows of a symmetric matrix whose lower triangle is stored, for products in
//! parallel.

use std::ops::Range;

use rayon::prelude::*;

/// Smallest number of 3 x 3 block rows in a part. Shorter parts have too many entries in common with others.
pub(crate) const ROWS: usize = 8192;

/// Divides rows into parts of an eighth of all rows, but of at least `smallest` rows and at most four times
/// as many. The parts depend on the number of rows alone, so that the bits of a result do not depend on the
/// threads.
pub(crate) fn parts(rows: usize, smallest: usize) -> Vec<Range<usize>> {
    let count = (rows / (rows / 8).clamp(smallest, 4 * smallest)).max(1);
    (0..count).map(|part| rows * part / count..rows * (part + 1) / count).collect()
}

/// Rows that one task multiplies. The transposes of their blocks also contribute to rows before them.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct RowPart {
    pub rows: Range<usize>,
    /// Columns before these rows, ascending.
    pub before: Vec<u32>,
    /// Position in `before` of every entry of the rows in such a column, row after row.
    pub places: Vec<u32>,
}

impl RowPart {
    /// Builds the parts of a lower triangle with these columns (ascending, the diagonal last) of each row.
    pub fn of<'a>(rows: usize, columns: impl Fn(usize) -> &'a [u32] + Sync) -> Vec<RowPart> {
        let part = |rows: Range<usize>| {
            let start = rows.start as u32;
            let outer = |row: usize| columns(row).iter().copied().take_while(move |&j| j < start);
            let mut before: Vec<u32> = rows.clone().flat_map(outer).collect();
            before.sort_unstable();
            before.dedup();
            let mut place = vec![0; rows.start];
            before.iter().zip(0..).for_each(|(&j, at)| place[j as usize] = at);
            let places = rows.clone().flat_map(outer).map(|j| place[j as usize]).collect();
            RowPart { rows, before, places }
        };
        parts(rows, ROWS).into_par_iter().map(part).collect()
    }

    /// Splits a vector into the entries of each part.
    pub fn split<'a, T>(parts: &[RowPart], vector: &'a mut [T]) -> Vec<&'a mut [T]> {
        let mut rest = vector;
        let part = |part: &RowPart| rest.split_off_mut(..part.rows.len()).expect("an entry for every row");
        parts.iter().map(part).collect()
    }
}

//! Sets of numbers by rows, such as the nodes of one level that belong to each node of another, and rows in
//! parallel.

use std::ops::Range;

use rayon::prelude::*;

/// Compressed rows of ascending numbers.
pub(super) struct Sets {
    pub offsets: Vec<usize>,
    pub members: Vec<u32>,
}

impl Sets {
    /// Builds for each row `i` the union of several lists of numbers below `count`. `visit(i, add)` calls
    /// `add` with each list of the row.
    pub fn unions(rows: usize, count: usize, visit: impl Fn(usize, &mut dyn FnMut(&[u32])) + Sync) -> Sets {
        const PART: usize = 512;
        let parts: Vec<(Vec<u32>, Vec<usize>)> = (0..rows.div_ceil(PART))
            .into_par_iter()
            .map_init(
                || vec![u32::MAX; count],
                |mark, part| {
                    let (mut members, mut lengths) = (Vec::new(), Vec::new());
                    for i in part * PART..rows.min((part + 1) * PART) {
                        let start = members.len();
                        visit(i, &mut |numbers| {
                            for &n in numbers {
                                if mark[n as usize] != i as u32 {
                                    mark[n as usize] = i as u32;
                                    members.push(n);
                                }
                            }
                        });
                        members[start..].sort_unstable();
                        lengths.push(members.len() - start);
                    }
                    (members, lengths)
                },
            )
            .collect();
        let mut offsets = vec![0];
        let mut members = Vec::with_capacity(parts.iter().map(|p| p.0.len()).sum());
        for (part, lengths) in parts {
            for length in lengths {
                offsets.push(offsets[offsets.len() - 1] + length);
            }
            members.extend(part);
        }
        Sets { offsets, members }
    }

    #[inline]
    pub fn of(&self, i: usize) -> &[u32] {
        &self.members[self.offsets[i]..self.offsets[i + 1]]
    }

    /// Returns for each number below `count` the rows that contain the number, ascending. `row(i)` gives the
    /// numbers of row `i`, `rows` the number of rows.
    pub fn transposed<'a>(rows: usize, count: usize, row: impl Fn(usize) -> &'a [u32]) -> Sets {
        let mut offsets = vec![0; count + 1];
        for i in 0..rows {
            row(i).iter().for_each(|&n| offsets[n as usize + 1] += 1);
        }
        for n in 0..count {
            offsets[n + 1] += offsets[n];
        }
        let mut next = offsets.clone();
        let mut members = vec![0; offsets[count]];
        for i in 0..rows {
            for &n in row(i) {
                members[next[n as usize]] = i as u32;
                next[n as usize] += 1;
            }
        }
        Sets { offsets, members }
    }
}

/// Takes the first entries off a slice.
#[inline(always)]
pub(super) fn first<'a, T>(rest: &mut &'a mut [T], count: usize) -> &'a mut [T] {
    rest.split_off_mut(..count).expect("as many entries are left")
}

/// Splits the entries of compressed rows into those of consecutive rows, for tasks.
pub(super) fn by_rows<'a, T>(offsets: &[usize], entries: &'a mut [T]) -> Vec<(Range<usize>, &'a mut [T])> {
    const PART: usize = 512;
    let rows = offsets.len() - 1;
    let mut rest = entries;
    let part = |start: usize| {
        let end = rows.min(start + PART);
        (start..end, first(&mut rest, offsets[end] - offsets[start]))
    };
    (0..rows).step_by(PART).map(part).collect()
}

/// Calls `run` for every row with its entries, concurrently.
pub(super) fn each_row<T: Send>(offsets: &[usize], entries: &mut [T], run: impl Fn(usize, &mut [T]) + Sync) {
    by_rows(offsets, entries).into_par_iter().for_each(|(rows, mut entries)| {
        rows.for_each(|row| run(row, first(&mut entries, offsets[row + 1] - offsets[row])));
    });
}

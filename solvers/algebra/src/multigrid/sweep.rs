//! Products of a level's rows with a vector: residuals and Gauss-Seidel sweeps, on the processor's widest
//! lanes.

use std::ops::Range;

use lanes::{LanePath, madd_f32, on_path};

use super::operator::{Entry, Operator, Part, times};

impl<const B: usize> Operator<B> {
    /// Computes `out = b - A x`.
    pub fn residual(&self, b: &[Entry<B>], x: &[Entry<B>], out: &mut [Entry<B>]) {
        let path = LanePath::best();
        self.each_chunk(out, |chunk, out| residual_rows(path, self, chunk, b, x, out));
    }

    /// Sweeps forward from zero, `x = (D + L)^-1 b`, then computes `rest = b - A x`.
    pub fn sweep_forward(&self, b: &[Entry<B>], x: &mut [Entry<B>], rest: &mut [Entry<B>]) {
        let path = LanePath::best();
        self.each_chunk_of_two(x, rest, |chunk, x, rest| forward_rows(path, self, chunk, b, x, rest));
        if self.is_chunked() {
            let x = &*x;
            self.each_chunk(rest, |chunk, rest| outside_rows(path, self, chunk, x, rest));
        }
    }

    /// Sweeps backward from `x`, `x = (D + L^T)^-1 (b - L x)`: the transpose of the forward sweep. `rest` is
    /// workspace.
    pub fn sweep_backward(&self, b: &[Entry<B>], x: &mut [Entry<B>], rest: &mut [Entry<B>]) {
        let path = LanePath::best();
        let start = &*x;
        self.each_chunk(rest, |chunk, rest| {
            rest.copy_from_slice(&b[chunk.clone()]);
            if self.is_chunked() {
                for (i, rest) in chunk.clone().zip(&mut *rest) {
                    let added = self.added_part(i, &start[i]);
                    rest.iter_mut().zip(added).for_each(|(rest, added)| *rest += added);
                }
                outside_rows(path, self, chunk, start, rest);
            }
        });
        self.each_chunk_of_two(x, rest, |chunk, x, rest| backward_rows(path, self, chunk, x, rest));
    }
}

on_path! {
    fn residual_rows<const B: usize>(
        matrix: &Operator<B>, chunk: &Range<usize>, b: &[Entry<B>], x: &[Entry<B>], out: &mut [Entry<B>],
    ) = residual_lanes
}
on_path! {
    fn outside_rows<const B: usize>(
        matrix: &Operator<B>, chunk: &Range<usize>, x: &[Entry<B>], rest: &mut [Entry<B>],
    ) = outside_lanes
}
on_path! {
    fn forward_rows<const B: usize>(
        matrix: &Operator<B>, chunk: &Range<usize>, b: &[Entry<B>], x: &mut [Entry<B>], rest: &mut [Entry<B>],
    ) = forward_lanes
}
on_path! {
    fn backward_rows<const B: usize>(
        matrix: &Operator<B>, chunk: &Range<usize>, x: &mut [Entry<B>], rest: &mut [Entry<B>],
    ) = backward_lanes
}

#[inline(always)]
fn residual_lanes<const FMA: bool, const B: usize>(
    matrix: &Operator<B>,
    chunk: &Range<usize>,
    b: &[Entry<B>],
    x: &[Entry<B>],
    out: &mut [Entry<B>],
) {
    out.copy_from_slice(&b[chunk.clone()]);
    outside_lanes::<FMA, B>(matrix, chunk, x, out);
    for i in chunk.clone() {
        let mut sum = Sum::<FMA, B>::new();
        sum.add(matrix.diagonal(i), &x[i]);
        sum.add_all(matrix.inside(i), &x[chunk.clone()], chunk.start);
        out[i - chunk.start] = sum.from(&out[i - chunk.start]);
        subtract_transposed::<FMA, B>(matrix.inside(i), &x[i], out, chunk.start);
    }
}

/// Subtracts the products with entries of other chunks from `rest`.
#[inline(always)]
fn outside_lanes<const FMA: bool, const B: usize>(
    matrix: &Operator<B>,
    chunk: &Range<usize>,
    x: &[Entry<B>],
    rest: &mut [Entry<B>],
) {
    for (i, rest) in chunk.clone().zip(rest) {
        let outside = matrix.outside(i);
        if !outside.0.is_empty() {
            let mut sum = Sum::<FMA, B>::new();
            sum.add_all(outside, x, 0);
            *rest = sum.from(rest);
        }
    }
}

/// Solves `(D + L) x = b`. The upper triangle and the additions to the diagonal leave their products in
/// `rest`.
#[inline(always)]
fn forward_lanes<const FMA: bool, const B: usize>(
    matrix: &Operator<B>,
    chunk: &Range<usize>,
    b: &[Entry<B>],
    x: &mut [Entry<B>],
    rest: &mut [Entry<B>],
) {
    for i in chunk.clone() {
        let here = i - chunk.start;
        let row = matrix.inside(i);
        let mut sum = Sum::<FMA, B>::new();
        sum.add_all(row, x, chunk.start);
        let own = times(matrix.inverse(i), &sum.from(&b[i]));
        x[here] = own;
        rest[here] = matrix.added_part(i, &own);
        subtract_transposed::<FMA, B>(row, &own, rest, chunk.start);
    }
}

/// Solves backward. `rest` holds the right-hand side, less the products with rows already swept.
#[inline(always)]
fn backward_lanes<const FMA: bool, const B: usize>(
    matrix: &Operator<B>,
    chunk: &Range<usize>,
    x: &mut [Entry<B>],
    rest: &mut [Entry<B>],
) {
    for i in chunk.clone().rev() {
        let here = i - chunk.start;
        let row = matrix.inside(i);
        let mut sum = Sum::<FMA, B>::new();
        sum.add_all_from_last(row, x, chunk.start);
        let own = times(matrix.inverse(i), &sum.from(&rest[here]));
        x[here] = own;
        subtract_transposed::<FMA, B>(row, &own, rest, chunk.start);
    }
}

/// Computes `out -= A^T x` for part of a row, where `out` begins at node `start`.
#[inline(always)]
fn subtract_transposed<const FMA: bool, const B: usize>(
    (columns, blocks): Part<'_, B>,
    x: &Entry<B>,
    out: &mut [Entry<B>],
    start: usize,
) {
    let minus = x.map(|x| -x);
    for (&j, block) in columns.iter().zip(blocks) {
        for (out, column) in out[j as usize - start].iter_mut().zip(block) {
            *out = column.iter().zip(&minus).fold(*out, |sum, (a, x)| madd_f32::<FMA>(*a, *x, sum));
        }
    }
}

/// Sum of products of blocks. Columns go to three sums in turn, so that none waits for the other two.
struct Sum<const FMA: bool, const B: usize>([[f32; WIDTH]; 3]);

/// Lanes of a sum: blocks have 3 or 6 rows.
const WIDTH: usize = 6;

impl<const FMA: bool, const B: usize> Sum<FMA, B> {
    #[inline(always)]
    fn new() -> Self {
        const { assert!(B == 3 || B == 6) }
        Sum([[0.0; WIDTH]; 3])
    }

    /// Computes `self += A x` for part of a row, where `x` begins at node `start`.
    #[inline(always)]
    fn add_all(&mut self, (columns, blocks): Part<'_, B>, x: &[Entry<B>], start: usize) {
        for (&j, block) in columns.iter().zip(blocks) {
            self.add(block, &x[j as usize - start]);
        }
    }

    /// The same from the last column to the first: a backward sweep then reads the memory downward, which the
    /// processor prefetches.
    #[inline(always)]
    fn add_all_from_last(&mut self, (columns, blocks): Part<'_, B>, x: &[Entry<B>], start: usize) {
        for (&j, block) in columns.iter().zip(blocks).rev() {
            self.add(block, &x[j as usize - start]);
        }
    }

    /// Computes `self += block x`.
    #[inline(always)]
    fn add(&mut self, block: &[[f32; B]; B], x: &Entry<B>) {
        let [first, second, third] = &mut self.0;
        if B == 3 {
            // Four lanes at once, of which three count. The last column is read one entry early: its upper
            // lanes count.
            let entries = block.as_flattened();
            for l in 0..4 {
                first[l] = madd_f32::<FMA>(entries[l], x[0], first[l]);
            }
            for l in 0..4 {
                second[l] = madd_f32::<FMA>(entries[3 + l], x[1], second[l]);
            }
            for l in 0..4 {
                third[l] = madd_f32::<FMA>(entries[5 + l], x[2], third[l]);
            }
        } else {
            for (columns, x) in block.chunks_exact(3).zip(x.chunks_exact(3)) {
                for l in 0..B {
                    first[l] = madd_f32::<FMA>(columns[0][l], x[0], first[l]);
                }
                for l in 0..B {
                    second[l] = madd_f32::<FMA>(columns[1][l], x[1], second[l]);
                }
                for l in 0..B {
                    third[l] = madd_f32::<FMA>(columns[2][l], x[2], third[l]);
                }
            }
        }
    }

    /// Returns `b` less this sum.
    #[inline(always)]
    fn from(&self, b: &Entry<B>) -> Entry<B> {
        let [first, second, third] = &self.0;
        let shift = if B == 3 { 1 } else { 0 };
        std::array::from_fn(|a| b[a] - (first[a] + second[a] + third[a + shift]))
    }
}

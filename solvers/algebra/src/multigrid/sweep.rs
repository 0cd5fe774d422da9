//! Products of a level's rows with a vector: residuals and Gauss-Seidel sweeps, on the processor's widest lanes.

use std::ops::Range;

use lanes::{LanePath, madd_f32, on_path};
use rayon::prelude::*;

use super::operator::{Entry, Operator, Part};

/// Rows of a residual that are made at once.
const ROWS: usize = 512;

impl<const B: usize> Operator<B> {
    /// `out = b - A x`.
    pub fn residual(&self, b: &[Entry<B>], x: &[Entry<B>], out: &mut [Entry<B>]) {
        let path = LanePath::best();
        out.par_chunks_mut(ROWS).enumerate().for_each(|(part, out)| {
            let start = part * ROWS;
            residual_rows(path, self, &(start..start + out.len()), b, x, out);
        });
    }

    /// One sweep forward from zero: `x = (D + L)^-1 b`; then `rest = b - A x`.
    pub fn sweep_forward(&self, b: &[Entry<B>], x: &mut [Entry<B>], rest: &mut [Entry<B>]) {
        let path = LanePath::best();
        self.each_chunk(x, |chunk, x| forward_rows(path, self, chunk, b, x));
        let x = &*x;
        self.each_chunk(rest, |chunk, rest| rest_rows(path, self, chunk, x, rest));
    }

    /// One sweep backward: the transpose of the sweep forward.
    pub fn sweep_backward(&self, b: &[Entry<B>], x: &mut [Entry<B>], before: &mut [Entry<B>]) {
        if self.is_chunked() {
            before.copy_from_slice(x);
        }
        let (path, before) = (LanePath::best(), &*before);
        self.each_chunk(x, |chunk, x| backward_rows(path, self, chunk, b, before, x));
    }
}

on_path! {
    fn residual_rows<const B: usize>(
        matrix: &Operator<B>, rows: &Range<usize>, b: &[Entry<B>], x: &[Entry<B>], out: &mut [Entry<B>],
    ) = residual_lanes
}
on_path! {
    fn forward_rows<const B: usize>(
        matrix: &Operator<B>, chunk: &Range<usize>, b: &[Entry<B>], x: &mut [Entry<B>],
    ) = forward_lanes
}
on_path! {
    fn rest_rows<const B: usize>(
        matrix: &Operator<B>, chunk: &Range<usize>, x: &[Entry<B>], rest: &mut [Entry<B>],
    ) = rest_lanes
}
on_path! {
    fn backward_rows<const B: usize>(
        matrix: &Operator<B>, chunk: &Range<usize>, b: &[Entry<B>], before: &[Entry<B>], x: &mut [Entry<B>],
    ) = backward_lanes
}

#[inline(always)]
fn residual_lanes<const FMA: bool, const B: usize>(
    matrix: &Operator<B>,
    rows: &Range<usize>,
    b: &[Entry<B>],
    x: &[Entry<B>],
    out: &mut [Entry<B>],
) {
    for (i, out) in rows.clone().zip(out) {
        let mut sum = Sum::<FMA, B>::new();
        sum.add_all(matrix.whole(i), x, 0);
        *out = sum.from(&b[i]);
    }
}

#[inline(always)]
fn forward_lanes<const FMA: bool, const B: usize>(
    matrix: &Operator<B>,
    chunk: &Range<usize>,
    b: &[Entry<B>],
    x: &mut [Entry<B>],
) {
    for i in chunk.clone() {
        let (_, inside) = split(matrix.before(i), chunk.start);
        let mut sum = Sum::<FMA, B>::new();
        sum.add_all(inside, x, chunk.start);
        x[i - chunk.start] = times(matrix.inverse(i), &sum.from(&b[i]));
    }
}

/// What a forward sweep from zero leaves: `D + L` took its part, what the chunks did not see of each other and the upper triangle stay.
#[inline(always)]
fn rest_lanes<const FMA: bool, const B: usize>(
    matrix: &Operator<B>,
    chunk: &Range<usize>,
    x: &[Entry<B>],
    rest: &mut [Entry<B>],
) {
    for (i, rest) in chunk.clone().zip(rest) {
        let (outside, _) = split(matrix.before(i), chunk.start);
        let mut sum = Sum::<FMA, B>::new();
        sum.add_all(outside, x, 0);
        sum.add_all(matrix.after(i), x, 0);
        *rest = sum.from(&matrix.added_part(i, &x[i]));
    }
}

#[inline(always)]
fn backward_lanes<const FMA: bool, const B: usize>(
    matrix: &Operator<B>,
    chunk: &Range<usize>,
    b: &[Entry<B>],
    before: &[Entry<B>],
    x: &mut [Entry<B>],
) {
    for i in chunk.clone().rev() {
        let here = i - chunk.start;
        let mut right = matrix.added_part(i, &x[here]);
        right.iter_mut().zip(&b[i]).for_each(|(s, b)| *s += b);
        let (outside, inside) = split(matrix.before(i), chunk.start);
        let mut sum = Sum::<FMA, B>::new();
        sum.add_all(outside, before, 0);
        sum.add_all(inside, x, chunk.start);
        let (inside, outside) = split(matrix.after(i), chunk.end);
        sum.add_all(inside, x, chunk.start);
        sum.add_all(outside, before, 0);
        x[here] = times(matrix.inverse(i), &sum.from(&right));
    }
}

/// A part of a row before a column, and from it on.
#[inline(always)]
fn split<const B: usize>((columns, blocks): Part<'_, B>, column: usize) -> (Part<'_, B>, Part<'_, B>) {
    let place = match columns {
        [.., last] if (*last as usize) < column => columns.len(),
        [first, ..] if (*first as usize) < column => columns.partition_point(|&j| (j as usize) < column),
        _ => 0,
    };
    ((&columns[..place], &blocks[..place]), (&columns[place..], &blocks[place..]))
}

/// A sum of products of blocks: columns go to three sums in turn, none of which has to wait for the other two.
struct Sum<const FMA: bool, const B: usize>([[f32; WIDTH]; 3]);

/// Lanes of a sum: blocks have 3 or 6 rows.
const WIDTH: usize = 6;

impl<const FMA: bool, const B: usize> Sum<FMA, B> {
    #[inline(always)]
    fn new() -> Self {
        const { assert!(B == 3 || B == 6) }
        Sum([[0.0; WIDTH]; 3])
    }

    /// `self += A x` of a part of a row, where `x` begins at node `start`.
    #[inline(always)]
    fn add_all(&mut self, (columns, blocks): Part<'_, B>, x: &[Entry<B>], start: usize) {
        for (&j, block) in columns.iter().zip(blocks) {
            self.add(block, &x[j as usize - start]);
        }
    }

    /// `self += block x`.
    #[inline(always)]
    fn add(&mut self, block: &[[f32; B]; B], x: &Entry<B>) {
        let [first, second, third] = &mut self.0;
        if B == 3 {
            // Four lanes at once, of which three count: those of the last column are the upper ones.
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

    /// `b` less this sum.
    #[inline(always)]
    fn from(&self, b: &Entry<B>) -> Entry<B> {
        let [first, second, third] = &self.0;
        let shift = if B == 3 { 1 } else { 0 };
        std::array::from_fn(|a| b[a] - (first[a] + second[a] + third[a + shift]))
    }
}

/// `block x`.
#[inline(always)]
pub(super) fn times<const B: usize>(block: &[[f32; B]; B], x: &Entry<B>) -> Entry<B> {
    let mut sum = [0.0; B];
    for (column, x) in block.iter().zip(x) {
        for (s, a) in sum.iter_mut().zip(column) {
            *s += a * x;
        }
    }
    sum
}

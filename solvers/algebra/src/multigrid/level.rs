//! Levels and the cycles over them.

use std::sync::Mutex;

use super::aggregate::{Modes, aggregates, orthonormal};
use super::galerkin::galerkin;
use super::graph::Graph;
use super::lower_triangle::{Lower, LowerRows};
use super::operator::{Entry, Operator};
use super::transfer::{Dense, Transfer, Weight};
use crate::linear_solver::{FactorError, Factorization, Symmetric, factor};

/// Largest number of degrees of freedom that are solved directly. The dense factor has 6 MB and is read twice
/// in each solve.
const COARSEST: usize = 1200;

/// Number of solves of a level for each solve of the finer level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cycle {
    /// One solve.
    V,
    /// Two solves: on a cube of 100,000 unknowns 18 iterations instead of 22, for a ninth less time.
    W,
}

/// Approximate inverse of a level's matrix: a symmetric positive definite map.
pub(super) trait Level<const B: usize>: Send + Sync {
    /// Sets `x` to an approximation of `A^-1 b`.
    fn solve(&self, b: &[Entry<B>], x: &mut [Entry<B>], cycle: Cycle);
    /// Improves `x` by a second W-cycle on its residual.
    fn improve(&self, b: &[Entry<B>], x: &mut [Entry<B>]);
    /// Appends the degrees of freedom and the matrix entries of this level and of all coarser levels.
    fn sizes(&self, sizes: &mut Vec<(usize, usize)>);
}

/// Level with a coarser level below.
struct Smoothed<const B: usize, const C: usize, W> {
    matrix: Operator<B>,
    transfer: Transfer<W>,
    below: Box<dyn Level<C>>,
    scratch: Mutex<Scratch<B, C>>,
    second: Mutex<Second<B>>,
}

/// Work arrays of a cycle, kept between cycles.
struct Scratch<const B: usize, const C: usize> {
    rest: Vec<Entry<B>>,
    restricted: Vec<Entry<C>>,
    correction: Vec<Entry<C>>,
}

/// Additional work arrays of a second cycle.
#[derive(Default)]
struct Second<const B: usize> {
    left: Vec<Entry<B>>,
    more: Vec<Entry<B>>,
}

impl<const B: usize, const C: usize, W: Weight<B, C>> Smoothed<B, C, W> {
    fn new(matrix: Operator<B>, transfer: Transfer<W>, below: Box<dyn Level<C>>) -> Smoothed<B, C, W> {
        let coarse = vec![[0.0; C]; transfer.count];
        let scratch =
            Scratch { rest: vec![[0.0; B]; matrix.nodes()], restricted: coarse.clone(), correction: coarse };
        Smoothed { matrix, transfer, below, scratch: Mutex::new(scratch), second: Mutex::default() }
    }
}

impl<const B: usize, const C: usize, W: Weight<B, C>> Level<B> for Smoothed<B, C, W> {
    fn solve(&self, b: &[Entry<B>], x: &mut [Entry<B>], cycle: Cycle) {
        let mut scratch = self.scratch.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        let Scratch { rest, restricted, correction } = &mut *scratch;
        self.matrix.sweep_forward(b, x, rest);
        self.transfer.restrict(rest, restricted);
        self.below.solve(restricted, correction, cycle);
        if cycle == Cycle::W {
            self.below.improve(restricted, correction);
        }
        self.transfer.prolong(correction, x);
        self.matrix.sweep_backward(b, x, rest);
    }

    fn improve(&self, b: &[Entry<B>], x: &mut [Entry<B>]) {
        let mut scratch = self.second.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        let Second { left, more } = &mut *scratch;
        left.resize(x.len(), [0.0; B]);
        more.resize(x.len(), [0.0; B]);
        self.matrix.residual(b, x, left);
        self.solve(left, more, Cycle::W);
        for (x, more) in x.iter_mut().flatten().zip(more.iter().flatten()) {
            *x += more;
        }
    }

    fn sizes(&self, sizes: &mut Vec<(usize, usize)>) {
        sizes.push((B * self.matrix.nodes(), B * B * self.matrix.block_count()));
        self.below.sizes(sizes);
    }
}

/// Coarsest level, solved by a direct factor.
struct Coarsest<const B: usize> {
    factor: Factorization,
    scale: f64,
}

impl<const B: usize> Level<B> for Coarsest<B> {
    fn solve(&self, b: &[Entry<B>], x: &mut [Entry<B>], _: Cycle) {
        let mut values: Vec<f64> = b.iter().flatten().map(|&b| f64::from(b) / self.scale).collect();
        // A definite factor always solves. If it failed, conjugate gradients would stop at the first NaN
        // product.
        if self.factor.solve_once(&mut values).is_err() {
            values.fill(f64::NAN);
        }
        for (x, value) in x.iter_mut().flatten().zip(values) {
            *x = value as f32;
        }
    }

    /// Does nothing: a direct solution needs no improvement.
    fn improve(&self, _: &[Entry<B>], _: &mut [Entry<B>]) {}

    fn sizes(&self, sizes: &mut Vec<(usize, usize)>) {
        sizes.push((self.factor.dim(), self.factor.dim().pow(2)));
    }
}

/// Builds the hierarchy of aggregates for `scale` times a matrix.
pub(super) fn by_aggregates<const B: usize>(
    lower: &impl LowerRows<B>,
    modes: &[Modes<B>],
    scale: f64,
) -> Result<Box<dyn Level<B>>, FactorError> {
    if B * lower.nodes() <= COARSEST {
        return coarsest(lower, scale);
    }
    let matrix = Operator::new(lower, scale);
    let graph = Graph::new(lower);
    let aggregates = aggregates(&matrix, &graph);
    if 2 * aggregates.count > lower.nodes() {
        // The nodes are hardly coupled: no coarser level would be much smaller.
        return coarsest(lower, scale);
    }
    let (functions, coarse_modes) = orthonormal(&aggregates, modes);
    let transfer = Transfer::<Dense<B>>::smoothed(&matrix, &graph, &aggregates, &functions);
    drop((aggregates, functions));
    let coarse = galerkin(lower, &graph, &transfer);
    drop(graph);
    let below = by_aggregates(&coarse, &coarse_modes, scale)?;
    Ok(Box::new(Smoothed::new(matrix, transfer, below)))
}

/// Builds a level whose next coarser level is a nested mesh with these `modes`.
pub(super) fn nested(
    lower: &impl LowerRows<3>,
    transfer: Transfer<super::transfer::Diagonal>,
    modes: &[Modes<3>],
    scale: f64,
) -> Result<Box<dyn Level<3>>, FactorError> {
    let matrix = Operator::new(lower, scale);
    let graph = Graph::new(lower);
    let coarse: Lower<3> = galerkin(lower, &graph, &transfer);
    drop(graph);
    let below = by_aggregates(&coarse, modes, scale)?;
    Ok(Box::new(Smoothed::new(matrix, transfer, below)))
}

fn coarsest<const B: usize>(lower: &impl LowerRows<B>, scale: f64) -> Result<Box<dyn Level<B>>, FactorError> {
    let dim = B * lower.nodes();
    let mut matrix = Symmetric {
        offsets: vec![0],
        rows: Vec::new(),
        values: Vec::new(),
        multipliers: dim,
        vertices: (0..=lower.nodes()).map(|i| B * i).collect(),
    };
    for i in 0..lower.nodes() {
        let columns = lower.columns(i);
        for a in 0..B {
            for (at, &j) in columns.iter().enumerate() {
                let block = lower.block(i, at);
                let width = if j as usize == i { a + 1 } else { B };
                for (b, column) in block.iter().enumerate().take(width) {
                    matrix.rows.push(B * j as usize + b);
                    matrix.values.push(column[a]);
                }
            }
            matrix.offsets.push(matrix.rows.len());
        }
    }
    Ok(Box::new(Coarsest::<B> { factor: factor(matrix, COARSEST)?, scale }))
}

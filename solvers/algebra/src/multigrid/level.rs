//! Levels and the cycles over them.

use std::sync::Mutex;

use shape::Vector3;

use super::aggregate::{Modes, aggregates, orthonormal};
use super::coarsest::{COARSEST, Coarsest};
use super::galerkin::galerkin;
use super::graph::Graph;
use super::lower_triangle::{Lower, LowerRows};
use super::operator::{Entry, Operator};
use super::patch::Patch;
use super::transfer::{Dense, Transfer, Weight};
use crate::linear_solver::FactorError;

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
    /// Whether the nodes on weak supports are solved together.
    fn has_patch(&self) -> bool {
        false
    }
    /// Sets `x` to the solution for `b` of the nodes on weak supports alone, if these are solved together.
    fn start(&self, _b: &[Vector3], _x: &mut [Vector3]) {}
    /// Appends the degrees of freedom and the matrix entries of this level and of all coarser levels.
    fn sizes(&self, sizes: &mut Vec<(usize, usize)>);
}

/// Level with a coarser level below.
struct Smoothed<const B: usize, const C: usize, W> {
    matrix: Operator<B>,
    transfer: Transfer<W>,
    below: Box<dyn Level<C>>,
    /// Nodes on weak supports.
    patch: Option<Patch<B>>,
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
    fn new(
        matrix: Operator<B>,
        transfer: Transfer<W>,
        below: Box<dyn Level<C>>,
        patch: Option<Patch<B>>,
    ) -> Smoothed<B, C, W> {
        let coarse = vec![[0.0; C]; transfer.count];
        let scratch =
            Scratch { rest: vec![[0.0; B]; matrix.nodes()], restricted: coarse.clone(), correction: coarse };
        Smoothed { matrix, transfer, below, patch, scratch: Mutex::new(scratch), second: Mutex::default() }
    }
}

impl<const B: usize, const C: usize, W: Weight<B, C>> Level<B> for Smoothed<B, C, W> {
    fn solve(&self, b: &[Entry<B>], x: &mut [Entry<B>], cycle: Cycle) {
        let mut scratch = self.scratch.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        let Scratch { rest, restricted, correction } = &mut *scratch;
        self.matrix.sweep_forward(b, x, rest);
        if let Some(patch) = &self.patch {
            patch.correct(x, rest);
        }
        self.transfer.restrict(rest, restricted);
        self.below.solve(restricted, correction, cycle);
        if cycle == Cycle::W {
            self.below.improve(restricted, correction);
        }
        self.transfer.prolong(correction, x);
        if let Some(patch) = &self.patch {
            patch.solve(b, x);
        }
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

    fn has_patch(&self) -> bool {
        self.patch.is_some()
    }

    fn start(&self, b: &[Vector3], x: &mut [Vector3]) {
        self.patch.iter().for_each(|patch| patch.start(b, x));
    }

    fn sizes(&self, sizes: &mut Vec<(usize, usize)>) {
        sizes.push((B * self.matrix.nodes(), B * B * self.matrix.block_count()));
        self.below.sizes(sizes);
    }
}

impl<const B: usize> Level<B> for Coarsest<B> {
    fn solve(&self, b: &[Entry<B>], x: &mut [Entry<B>], _: Cycle) {
        Coarsest::solve(self, b, x);
    }

    /// Does nothing: a direct solution needs no improvement.
    fn improve(&self, _: &[Entry<B>], _: &mut [Entry<B>]) {}

    fn sizes(&self, sizes: &mut Vec<(usize, usize)>) {
        sizes.push((self.dim(), self.dim().pow(2)));
    }
}

/// Builds the hierarchy of aggregates for `scale` times a matrix. The nodes of `patch` are also solved
/// together.
pub(super) fn by_aggregates<const B: usize>(
    lower: &impl LowerRows<B>,
    modes: &[Modes<B>],
    scale: f64,
    patch: &[u32],
) -> Result<Box<dyn Level<B>>, FactorError> {
    if B * lower.nodes() <= COARSEST {
        return Ok(Box::new(Coarsest::new(lower, scale)?));
    }
    let graph = Graph::new(lower);
    let matrix = Operator::new(lower, &graph, scale);
    let aggregates = aggregates(&matrix, &graph);
    if 2 * aggregates.count > lower.nodes() {
        // The nodes are hardly coupled: no coarser level would be much smaller.
        return Ok(Box::new(Coarsest::new(lower, scale)?));
    }
    let (functions, coarse_modes) = orthonormal(&aggregates, modes);
    let transfer = Transfer::<Dense<B>>::smoothed(&matrix, &graph, &aggregates, &functions);
    drop((aggregates, functions));
    let coarse = galerkin(lower, &graph, &transfer);
    drop(graph);
    let below = by_aggregates(&coarse, &coarse_modes, scale, &[])?;
    Ok(Box::new(Smoothed::new(matrix, transfer, below, Patch::new(lower, patch, scale)?)))
}

/// Builds a level whose next coarser level is a nested mesh with these `modes`.
pub(super) fn nested(
    lower: &impl LowerRows<3>,
    transfer: Transfer<super::transfer::Diagonal>,
    modes: &[Modes<3>],
    scale: f64,
) -> Result<Box<dyn Level<3>>, FactorError> {
    let graph = Graph::new(lower);
    let matrix = Operator::new(lower, &graph, scale);
    let coarse: Lower<3> = galerkin(lower, &graph, &transfer);
    drop(graph);
    let below = by_aggregates(&coarse, modes, scale, &[])?;
    Ok(Box::new(Smoothed::new(matrix, transfer, below, None)))
}

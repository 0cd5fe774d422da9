//! Computation of chunks of points: neighbours, fits and rows.

use std::cmp::Reverse;

use lanes::{LANES, LanePath, on_path};
use shape::{Point3, Vector3};

use super::{Approximation, Chunk, Functions, LeastSquares};
use crate::basis::Basis;
use crate::coupling::{Layer, joined};
use crate::error::EfgError;
use crate::info::Outcome;
use crate::max_entropy::NoPoint;
use crate::mls::Group;

/// Condition number above which supports next to finite elements are enlarged. The nodes on the other side of
/// such a point are removed. Up to this number, the sum of a row is one within 1e-10. Elsewhere medians are
/// 10 to 100.
const MOST_CONDITION: f64 = 1e5;

impl Approximation {
    /// Fills a chunk with the same arithmetic in the same order on every path, hence with the same bits.
    /// Fused multiply-add is not used on purpose: it would change the last bits from machine to machine.
    pub(super) fn fill<const GRAD: bool>(
        &self,
        points: &[Point3],
        chunk: &mut Chunk,
    ) -> Result<(), EfgError> {
        let Some(coupling) = &self.coupling else { return self.fill_own::<GRAD>(points, chunk) };
        coupling.layers(points, &mut chunk.layers)?;
        self.fill_own::<GRAD>(points, chunk)?;
        let Chunk { rows, outcomes, layers, .. } = chunk;
        *rows = joined::<GRAD>(rows, layers, self.supports.balls.len());
        outcomes.iter_mut().enumerate().for_each(|(q, of)| of.neighbours = rows.range(q).len() as u32);
        Ok(())
    }

    /// Computes the rows of the cloud's own functions.
    fn fill_own<const GRAD: bool>(&self, points: &[Point3], chunk: &mut Chunk) -> Result<(), EfgError> {
        match GRAD {
            true => fill_gradients(LanePath::best(), self, points, chunk),
            false => fill_values(LanePath::best(), self, points, chunk),
        }
    }

    #[inline(always)]
    pub(super) fn fill_plain<const GRAD: bool>(
        &self,
        points: &[Point3],
        chunk: &mut Chunk,
    ) -> Result<(), EfgError> {
        let Chunk { rows, outcomes, order, group, layers, cells, detours, .. } = chunk;
        rows.offsets.truncate(1);
        rows.nodes.clear();
        detours.clear();
        let full = |q: usize| layers.get(q).is_some_and(Layer::is_full);
        for (q, x) in points.iter().enumerate() {
            if full(q) {
                rows.close();
            } else {
                self.find(x, layers.get(q), rows);
                if let Some(gaps) = &self.gaps {
                    gaps.cut(x, cells[q], |node| self.relative(node, x), rows, detours);
                }
            }
        }
        // Old values are overwritten.
        rows.values.resize(rows.nodes.len(), 0.0);
        rows.grads.resize(if GRAD { rows.nodes.len() } else { 0 }, Vector3::zeros());
        let fit = match &self.functions {
            Functions::MovingLeastSquares(fit) => *fit,
            Functions::MaximumEntropy(beta) => {
                return self.fill_by_entropy::<GRAD>(points, beta, chunk);
            }
        };
        order.clear();
        order.extend(0..points.len() as u32);
        order.sort_unstable_by_key(|&q| (Reverse(rows.range(q as usize).len()), q));
        outcomes.clear();
        outcomes.resize(points.len(), Outcome::default());
        let mut failed = false;
        for together in order.chunks(LANES) {
            let nodes = |q: usize| &rows.nodes[rows.range(q)];
            let together_with = together.iter().map(|&q| (&points[q as usize], nodes(q as usize)));
            group.load(together_with, &self.supports.balls, &self.supports.ellipsoids, 1.0);
            if !detours.is_empty() {
                group.bend(together.iter().map(|&q| &detours[rows.range(q as usize)]));
            }
            for (lane, &q) in together.iter().enumerate() {
                layers.get(q as usize).into_iter().for_each(|layer| group.aim(lane, &layer.moments));
            }
            let conditions = self.fit::<GRAD>(&fit, group);
            for (lane, &q) in together.iter().enumerate() {
                let range = rows.range(q as usize);
                let outcome = &mut outcomes[q as usize];
                outcome.neighbours = range.len() as u32;
                // An infinite condition marks a point for the remedies.
                let condition = match layers.get(q as usize) {
                    Some(layer) if layer.is_full() => Some(1.0),
                    Some(layer) if !layer.is_empty() => conditions[lane].filter(|&c| c < MOST_CONDITION),
                    _ => conditions[lane],
                };
                outcome.condition = condition.unwrap_or(f64::INFINITY);
                failed |= condition.is_none();
                let grads = if GRAD { &mut rows.grads[range.clone()] } else { &mut [] };
                group.store(lane, &mut rows.values[range], grads);
            }
        }
        if failed { self.mend::<GRAD>(points, &fit, chunk) } else { Ok(()) }
    }

    /// Computes rows of maximum entropy point by point.
    #[inline(always)]
    fn fill_by_entropy<const GRAD: bool>(
        &self,
        points: &[Point3],
        beta: &[f64],
        chunk: &mut Chunk,
    ) -> Result<(), EfgError> {
        let Chunk { rows, outcomes, neighbours, detours, .. } = chunk;
        outcomes.clear();
        for (q, x) in points.iter().enumerate() {
            let range = rows.range(q);
            let nodes = &rows.nodes[range.clone()];
            let near =
                nodes.iter().map(|&n| (Vector3::from(self.supports.balls[n as usize].at), beta[n as usize]));
            let grads = if GRAD { &mut rows.grads[range.clone()] } else { &mut [] };
            neighbours.bend(detours.get(range.clone()).unwrap_or_default(), |k| {
                self.supports.balls[nodes[k] as usize].radius
            });
            let condition = neighbours
                .evaluate::<GRAD>(x, near, &mut rows.values[range.clone()], grads)
                .map_err(|NoPoint { iterations, gap }| EfgError::OutsideHull {
                    point: *x,
                    found: range.len(),
                    gap,
                    iterations,
                })?;
            outcomes.push(Outcome { neighbours: range.len() as u32, condition, ..Outcome::default() });
        }
        Ok(())
    }

    /// Fits the shape functions of a group, which keeps them for [`Group::store`]. Returns the condition
    /// number of the moment matrix of each point, or `None` if the fit failed or has too few neighbours.
    #[inline(always)]
    pub(super) fn fit<const GRAD: bool>(
        &self,
        fit: &LeastSquares,
        group: &mut Group,
    ) -> [Option<f64>; LANES] {
        let &LeastSquares { kernel, basis, mu } = fit;
        let mut conditions = match basis {
            Basis::Linear => group.fit::<4, 10, 10, GRAD>(kernel, mu),
            Basis::Quadratic => group.fit::<10, 35, 20, GRAD>(kernel, mu),
        };
        for (lane, condition) in conditions.iter_mut().enumerate() {
            if mu == 0.0 && group.count(lane) < basis.terms() {
                *condition = None;
            }
        }
        conditions
    }
}

on_path! {
    /// Computes the chunk of values of the cloud's own functions (without finite elements) at some points, in
    /// wide registers.
    fn fill_values(of: &Approximation, points: &[Point3], chunk: &mut Chunk) -> Result<(), EfgError> = fill_values_in
}

#[inline(always)]
fn fill_values_in<const FMA: bool>(
    of: &Approximation,
    points: &[Point3],
    chunk: &mut Chunk,
) -> Result<(), EfgError> {
    of.fill_plain::<false>(points, chunk)
}

on_path! {
    /// Computes the chunk of values and gradients of the cloud's own functions (without finite elements) at
    /// some points, in wide registers.
    pub(super) fn fill_gradients(of: &Approximation, points: &[Point3], chunk: &mut Chunk) -> Result<(), EfgError> = fill_gradients_in
}

#[inline(always)]
fn fill_gradients_in<const FMA: bool>(
    of: &Approximation,
    points: &[Point3],
    chunk: &mut Chunk,
) -> Result<(), EfgError> {
    of.fill_plain::<true>(points, chunk)
}

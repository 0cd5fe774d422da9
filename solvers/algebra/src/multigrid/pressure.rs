//! Nearly incompressible stiffnesses: displacements and pressures, iterated together.
//!
//! With `B u` the volume changes of some groups, V their volumes and k what their bulk moduli have beyond a moderate one, the stiffness
//! is `K = A + B^T (k / V) B`. The pressures `p = (k / V) B u` as unknowns of their own give
//!
//! ```text
//! [ A   B^T   ] [u]   [f]
//! [ B  -V / k ] [p] = [0]
//! ```
//!
//! where k is no longer large, so that the number of iterations hardly grows with it. A is approximated by a cycle, the
//! Schur complement of the pressures by a diagonal, one after the other (Elman, Silvester and Wathen 2014, Finite Elements and Fast
//! Iterative Solvers, section 4.2); the iteration is GCR, its directions orthogonal to the last few (Eisenstat, Elman and Schultz 1983,
//! SIAM J. Numer. Anal. 20, 345).

use std::collections::VecDeque;

use shape::Vector3;

use super::Multigrid;
use super::conjugate::{Iterations, Precondition, dot, is_rounding, norm};
use super::level::Cycle;
use crate::{AlgebraError, Stiffness};

/// A group whose pressure is an unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct PressureGroup {
    /// Nodes and their part of the volume change `B u`, m^2.
    pub row: Vec<(u32, Vector3)>,
    /// Volume, m^3.
    pub volume: f64,
    /// Bulk modulus that the pressure stands for, Pa.
    pub excess: f64,
    /// Modulus of longitudinal strain that the stiffness has without it, Pa.
    pub rest: f64,
}

/// The groups, and the stiffness without what their pressures stand for.
pub(super) struct Pressures {
    without: Stiffness,
    offsets: Vec<usize>,
    /// Node and part of the volume change, zero where held.
    row: Vec<(u32, Vector3)>,
    /// `V / k`, m^3/Pa.
    compliance: Vec<f64>,
    /// The diagonal for the Schur complement: `V / k + V / rest`, m^3/Pa.
    schur: Vec<f64>,
    /// Forces (N) for volume changes (m^3), so that their residuals can be added: a tenth of `rest / h`. Whole ones take a half more
    /// iterations on hex8, a hundredth of them as many.
    force: Vec<f64>,
}

/// Cycles are taken times this. Those of a nearly incompressible body are too small on average; from 1 to 2 the iterations are
/// the same within a tenth.
const LARGER: f64 = 1.5;
/// Directions that a new one is made orthogonal to. With 10 a cube of hex8 of 105,000 unknowns never converges at nu = 0.495, with 16 in
/// 55 iterations.
const KEPT: usize = 20;
/// More iterations than this are no solution: a factor is faster.
const MOST: usize = 300;

/// Displacements, m (or forces, N), and pressures, Pa (or volume changes, m^3).
#[derive(Clone)]
struct Pair {
    u: Vec<Vector3>,
    p: Vec<f64>,
}

/// A direction, its image, and the square of that.
struct Direction {
    way: Pair,
    image: Pair,
    square: f64,
}

/// Entries of a vector that stay in the cache while all directions are gone through: with whole vectors they took longer than a cycle.
const CHUNK: usize = 1024;

impl Pressures {
    pub fn new(without: Stiffness, groups: &[PressureGroup], held: &[bool]) -> Pressures {
        let mut offsets = vec![0];
        let mut row = Vec::with_capacity(groups.iter().map(|group| group.row.len()).sum());
        for group in groups {
            row.extend(group.row.iter().map(|&(node, part)| {
                let free = |a, _| if held[3 * node as usize + a] { 0.0 } else { part[a] };
                (node, Vector3::from_fn(free))
            }));
            offsets.push(row.len());
        }
        Pressures {
            without,
            offsets,
            row,
            compliance: groups.iter().map(|g| g.volume / g.excess).collect(),
            schur: groups.iter().map(|g| g.volume / g.excess + g.volume / g.rest).collect(),
            force: groups.iter().map(|g| 0.1 * g.rest / g.volume.cbrt()).collect(),
        }
    }

    /// `B u` of every group.
    fn changes<'a>(&'a self, u: &'a [Vector3]) -> impl Iterator<Item = f64> + 'a {
        let rows = self.offsets.windows(2).map(|range| &self.row[range[0]..range[1]]);
        rows.map(|row| row.iter().map(|(node, part)| part.dot(&u[*node as usize])).sum())
    }

    /// `out += B^T p`.
    fn add_forces(&self, p: impl Iterator<Item = f64>, out: &mut [Vector3]) {
        for (range, p) in self.offsets.windows(2).zip(p) {
            self.row[range[0]..range[1]].iter().for_each(|(node, part)| out[*node as usize] += part * p);
        }
    }

    /// `|f - K u|` from the residual of the pair: `r_u + B^T (k / V) r_p`.
    fn of_displacements(&self, rest: &Pair, scratch: &mut [Vector3]) -> f64 {
        scratch.copy_from_slice(&rest.u);
        self.add_forces(rest.p.iter().zip(&self.compliance).map(|(r, c)| r / c), scratch);
        norm(scratch)
    }

    /// Product of two residuals or images.
    fn dot(&self, a: &Pair, b: &Pair) -> f64 {
        let p: f64 = a.p.iter().zip(&b.p).zip(&self.force).map(|((a, b), force)| a * b * force * force).sum();
        dot(&a.u, &b.u) + p
    }

    /// Solves `K x = b` in place to a residual of `tolerance |b|` or of rounding; a failure leaves `b` as it is. `b` is zero where held.
    pub fn solve(
        &self,
        multigrid: &Multigrid,
        stiffness: &Stiffness,
        b: &mut [Vector3],
        tolerance: f64,
    ) -> Result<Iterations, AlgebraError> {
        let size = norm(b);
        if size == 0.0 {
            return Ok(Iterations { count: 0, residual: 0.0 });
        }
        let nodes = b.len();
        let mut x = vec![Vector3::zeros(); nodes];
        let mut image = vec![Vector3::zeros(); nodes];
        let mut rest = Pair { u: b.to_vec(), p: vec![0.0; self.schur.len()] };
        let mut cycles = Precondition::new(nodes);
        let (mut count, mut residual, mut at_rounding) = (0, 1.0, false);
        // The recursion's residual drifts from the true one; begun anew from that, with the pressures of the displacements.
        for _ in 0..3 {
            self.descend(multigrid, &mut cycles, (&mut x, &mut rest), tolerance * size, &mut count);
            stiffness.multiply_into(&x, &mut image);
            multigrid.release(&mut image);
            for i in 0..nodes {
                rest.u[i] = b[i] - image[i];
            }
            rest.p.fill(0.0);
            residual = norm(&rest.u) / size;
            at_rounding = residual > tolerance && is_rounding(stiffness, &x, b, &rest.u);
            if residual <= tolerance || at_rounding || count >= MOST {
                break;
            }
        }
        if !(residual <= tolerance || at_rounding) {
            return Err(AlgebraError::Residual { residual, limit: tolerance });
        }
        b.copy_from_slice(&x);
        Ok(Iterations { count, residual })
    }

    /// Iterates until `|f - K u|` is at most `limit`, or as often as it may.
    fn descend(
        &self,
        multigrid: &Multigrid,
        cycles: &mut Precondition,
        (x, rest): (&mut [Vector3], &mut Pair),
        limit: f64,
        count: &mut usize,
    ) {
        let mut kept: VecDeque<Direction> = VecDeque::with_capacity(KEPT);
        let mut scratch = vec![Vector3::zeros(); x.len()];
        while *count < MOST {
            // The residual of the displacements alone is the larger one.
            if self.dot(rest, rest).sqrt() <= limit && self.of_displacements(rest, &mut scratch) <= limit {
                return;
            }
            let oldest = if kept.len() == KEPT { kept.pop_front() } else { None };
            // Of a new one every entry is set.
            let mut next =
                oldest.unwrap_or_else(|| Direction { way: rest.clone(), image: rest.clone(), square: 0.0 });
            self.direct(multigrid, cycles, rest, &mut next);
            let mut parts = self.dots(&next.image, &kept);
            parts.iter_mut().zip(&kept).for_each(|(part, before)| *part /= -before.square);
            next.way.add(&parts, kept.iter().map(|before| &before.way));
            next.image.add(&parts, kept.iter().map(|before| &before.image));
            next.square = self.dot(&next.image, &next.image);
            let step = self.dot(rest, &next.image) / next.square;
            *count += 1;
            if !step.is_finite() {
                return;
            }
            x.iter_mut().zip(&next.way.u).for_each(|(x, way)| *x += way * step);
            rest.add(&[-step], std::iter::once(&next.image));
            kept.push_back(next);
        }
    }

    /// A direction for a residual: `u = C r_u` by a cycle C, `p = (B u - r_p) / schur`, and its image `[A u + B^T p, B u - (V / k) p]`.
    fn direct(&self, multigrid: &Multigrid, cycles: &mut Precondition, rest: &Pair, out: &mut Direction) {
        let Direction { way, image, .. } = out;
        let cycle = cycles.apply(multigrid, &rest.u, Cycle::V);
        let larger = LARGER * multigrid.scale;
        way.u.iter_mut().zip(cycle).for_each(|(u, cycle)| *u = cycle * larger);
        for (g, change) in self.changes(&way.u).enumerate() {
            way.p[g] = (change - rest.p[g]) / self.schur[g];
            image.p[g] = change - self.compliance[g] * way.p[g];
        }
        self.without.multiply_into(&way.u, &mut image.u);
        self.add_forces(way.p.iter().copied(), &mut image.u);
        multigrid.release(&mut image.u);
    }

    /// Products of a vector with the images of all directions.
    fn dots(&self, x: &Pair, kept: &VecDeque<Direction>) -> Vec<f64> {
        let mut sums = vec![0.0; kept.len()];
        for (c, u) in x.u.chunks(CHUNK).enumerate() {
            for (sum, of) in sums.iter_mut().zip(kept) {
                let other = &of.image.u[c * CHUNK..][..u.len()];
                *sum += u.iter().zip(other).map(|(a, b)| a.dot(b)).sum::<f64>();
            }
        }
        for (c, (p, force)) in x.p.chunks(CHUNK).zip(self.force.chunks(CHUNK)).enumerate() {
            for (sum, of) in sums.iter_mut().zip(kept) {
                let other = &of.image.p[c * CHUNK..][..p.len()];
                *sum += p.iter().zip(other).zip(force).map(|((a, b), f)| a * b * f * f).sum::<f64>();
            }
        }
        sums
    }
}

impl Pair {
    /// `self += sum of factor other`.
    fn add<'a>(&mut self, factors: &[f64], others: impl Iterator<Item = &'a Pair> + Clone) {
        for (c, u) in self.u.chunks_mut(CHUNK).enumerate() {
            for (factor, other) in factors.iter().zip(others.clone()) {
                u.iter_mut().zip(&other.u[c * CHUNK..]).for_each(|(u, other)| *u += other * *factor);
            }
        }
        for (c, p) in self.p.chunks_mut(CHUNK).enumerate() {
            for (factor, other) in factors.iter().zip(others.clone()) {
                p.iter_mut().zip(&other.p[c * CHUNK..]).for_each(|(p, other)| *p += other * *factor);
            }
        }
    }
}

//! Nearly incompressible stiffnesses: displacements and pressures, iterated together.
//!
//! Let `B u` be the volume changes of some groups, V their volumes, and k the part of their bulk moduli
//! beyond a moderate value. The stiffness is then `K = A + B^T (k / V) B`. With the pressures
//! `p = (k / V) B u` as unknowns, the system is
//!
//! ```text
//! [ A   B^T   ] [u]   [f]
//! [ B  -V / k ] [p] = [0]
//! ```
//!
//! The coefficients are no longer large in k, so that the number of iterations hardly grows with k. The
//! preconditioner approximates A by a cycle, then the Schur complement of the pressures by a diagonal (Elman,
//! Silvester and Wathen 2014, Finite Elements and Fast Iterative Solvers, section 4.2). The iteration is GCR,
//! with directions orthogonal to the last few (Eisenstat, Elman and Schultz 1983, SIAM J. Numer. Anal. 20,
//! 345).

use std::collections::VecDeque;

use rayon::prelude::*;
use shape::Vector3;

use super::conjugate::{Iterations, Precondition, is_rounding};
use super::hierarchy::Hierarchy;
use super::level::Cycle;
use crate::error::AlgebraError;
use crate::pattern::{Connectivity, Incidence};
use crate::stiffness::Stiffness;
use crate::vectors::{CHUNK, GRAIN, dot, norm, of_chunk, subtract, sums};

/// Group of elements whose pressure is an unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct PressureGroup {
    /// Nodes and their coefficients in the volume change `B u`, m^2.
    pub row: Vec<(u32, Vector3)>,
    /// Volume, m^3.
    pub volume: f64,
    /// Part of the bulk modulus that the pressure carries instead of the stiffness, Pa.
    pub excess: f64,
    /// Longitudinal (P-wave) modulus of the stiffness without the part `excess`, Pa.
    pub rest: f64,
}

/// Groups whose pressures are unknowns; without groups the iteration has displacements alone.
pub(super) struct Pressures {
    offsets: Vec<usize>,
    /// Node and coefficient in the volume change; zero for constrained degrees of freedom.
    row: Vec<(u32, Vector3)>,
    /// Groups of each node.
    of_node: Incidence,
    /// `V / k`, m^3/Pa.
    compliance: Vec<f64>,
    /// Diagonal approximation of the Schur complement: `V / k + V / rest`, m^3/Pa.
    schur: Vec<f64>,
    /// Forces per volume change, N/m^3, with which the residuals of displacements and pressures are added: a
    /// tenth of `rest / h`. The full `rest / h` takes half as many iterations again on hex8; a hundredth
    /// takes as many as a tenth.
    force: Vec<f64>,
}

/// Factor on every cycle. The cycles of a nearly incompressible body are too small on average. For factors
/// from 1 to 2 the number of iterations is the same within a tenth.
const LARGER: f64 = 1.5;
/// Number of earlier directions to which a new direction is made orthogonal. With 10, a cube of hex8 of
/// 105,000 unknowns never converges at nu = 0.495; with 16, it converges in 55 iterations.
const KEPT: usize = 20;
/// Largest number of iterations; beyond it a factor is faster.
const MOST: usize = 300;

/// Displacements, m (or forces, N), and pressures, Pa (or volume changes, m^3).
#[derive(Clone)]
struct Pair {
    u: Vec<Vector3>,
    p: Vec<f64>,
}

/// Levels, the product with A, and the largest number of iterations.
pub(super) struct Inner<'a> {
    pub hierarchy: &'a Hierarchy,
    pub product: &'a (dyn Fn(&[Vector3], &mut [Vector3]) + Sync),
    pub most: usize,
}

/// Direction, its image, and the square of the image.
struct Direction {
    way: Pair,
    image: Pair,
    square: f64,
}

impl Pressures {
    pub fn new(groups: &[PressureGroup], held: &[bool]) -> Pressures {
        let mut offsets = vec![0];
        let mut row = Vec::with_capacity(groups.iter().map(|group| group.row.len()).sum());
        for group in groups {
            row.extend(group.row.iter().map(|&(node, part)| {
                let free = |a, _| if held[3 * node as usize + a] { 0.0 } else { part[a] };
                (node, Vector3::from_fn(free))
            }));
            offsets.push(row.len());
        }
        let nodes: Vec<u32> = row.iter().map(|(node, _)| *node).collect();
        let table = Connectivity { offsets: &offsets, nodes: &nodes, seen_by: &[] };
        Pressures {
            of_node: Incidence::new(held.len() / 3, table, 0..groups.len()),
            offsets,
            row,
            compliance: groups.iter().map(|g| g.volume / g.excess).collect(),
            schur: groups.iter().map(|g| g.volume / g.excess + g.volume / g.rest).collect(),
            force: groups.iter().map(|g| 0.1 * g.rest / g.volume.cbrt()).collect(),
        }
    }

    pub fn is_empty(&self) -> bool {
        self.schur.is_empty()
    }

    /// Returns `B u`, the volume change of every group.
    fn changes(&self, u: &[Vector3]) -> impl IndexedParallelIterator<Item = f64> {
        let rows = self.offsets.par_windows(2).with_min_len(GRAIN / 8);
        rows.map(|range| {
            self.row[range[0]..range[1]].iter().map(|(node, part)| part.dot(&u[*node as usize])).sum()
        })
    }

    /// Computes `out += B^T p` with the pressure `p` of every group.
    fn add_forces(&self, p: impl Fn(usize) -> f64 + Sync, out: &mut [Vector3]) {
        let nodes = out.par_iter_mut().enumerate().with_min_len(GRAIN / 8);
        nodes.for_each(|(node, out)| {
            for &(group, k) in self.of_node.of(node) {
                *out += self.row[k as usize].1 * p(group as usize);
            }
        });
    }

    /// Returns `|f - K u|`, from the residual of the pair: `r_u + B^T (k / V) r_p`.
    fn of_displacements(&self, rest: &Pair, scratch: &mut [Vector3]) -> f64 {
        scratch.copy_from_slice(&rest.u);
        self.add_forces(|g| rest.p[g] / self.compliance[g], scratch);
        norm(scratch)
    }

    /// Returns the product of two residuals or images.
    fn dot(&self, a: &Pair, b: &Pair) -> f64 {
        let chunks = a.p.par_chunks(CHUNK).zip(b.p.par_chunks(CHUNK)).zip(self.force.par_chunks(CHUNK));
        let [p] = sums(chunks.map(|((a, b), force)| [weighted(a, b, force)]));
        dot(&a.u, &b.u) + p
    }

    /// Solves `K x = b` in place to a residual of `tolerance |b|` or of rounding. `without` is the stiffness
    /// A, `stiffness` is K. `b` must be zero at constrained degrees of freedom. A failure leaves `b` as it
    /// is.
    ///
    /// # Errors
    ///
    /// [`AlgebraError::Residual`] if the iteration does not reach the tolerance.
    pub fn solve(
        &self,
        hierarchy: &Hierarchy,
        (without, stiffness): (&Stiffness, &Stiffness),
        b: &mut [Vector3],
        tolerance: f64,
    ) -> Result<Iterations, AlgebraError> {
        let size = norm(b);
        if size == 0.0 {
            return Ok(Iterations { count: 0, residual: 0.0 });
        }
        let product = |x: &[Vector3], out: &mut [Vector3]| without.multiply_into(x, out);
        let inner = Inner { hierarchy, product: &product, most: MOST };
        let nodes = b.len();
        let mut x = vec![Vector3::zeros(); nodes];
        let mut image = vec![Vector3::zeros(); nodes];
        let mut rest = Pair { u: b.to_vec(), p: vec![0.0; self.schur.len()] };
        let mut cycles = Precondition::new(nodes);
        let (mut count, mut residual, mut at_rounding) = (0, 1.0, false);
        // The recursive residual drifts from the true residual. A restart takes the true residual, with the
        // pressures that belong to the displacements.
        for _ in 0..3 {
            self.descend(&inner, &mut cycles, (&mut x, &mut rest), tolerance * size, &mut count);
            stiffness.multiply_into(&x, &mut image);
            hierarchy.release(&mut image);
            subtract(b, &image, &mut rest.u);
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

    /// Solves a system roughly, in place: to a recursive residual `|b - K x|` of `goal |b|`, or as far as
    /// `inner.most` iterations lead. Returns the number of iterations and whether the goal is reached. `b`
    /// must be zero at constrained degrees of freedom.
    pub fn solve_roughly(&self, inner: &Inner, b: &mut [Vector3], goal: f64) -> (usize, bool) {
        let mut x = vec![Vector3::zeros(); b.len()];
        let mut rest = Pair { u: b.to_vec(), p: vec![0.0; self.schur.len()] };
        let (limit, mut count) = (goal * norm(b), 0);
        if limit > 0.0 {
            self.descend(inner, &mut Precondition::new(b.len()), (&mut x, &mut rest), limit, &mut count);
        }
        let solved = self.of_displacements(&rest, &mut vec![Vector3::zeros(); b.len()]) <= limit;
        b.copy_from_slice(&x);
        (count, solved)
    }

    /// Iterates until `|f - K u|` is at most `limit`, or up to the largest number of iterations.
    fn descend(
        &self,
        inner: &Inner,
        cycles: &mut Precondition,
        (x, rest): (&mut [Vector3], &mut Pair),
        limit: f64,
        count: &mut usize,
    ) {
        let mut kept: VecDeque<Direction> = VecDeque::with_capacity(KEPT);
        let mut scratch = vec![Vector3::zeros(); x.len()];
        while *count < inner.most {
            // The residual of the displacements alone is larger, so it is computed only when the pair's is
            // small.
            if self.dot(rest, rest).sqrt() <= limit && self.of_displacements(rest, &mut scratch) <= limit {
                return;
            }
            let oldest = if kept.len() == KEPT { kept.pop_front() } else { None };
            // Every entry of a new direction is overwritten.
            let mut next =
                oldest.unwrap_or_else(|| Direction { way: rest.clone(), image: rest.clone(), square: 0.0 });
            self.direct(inner, cycles, rest, &mut next);
            let mut parts = self.dots(&next.image, &kept);
            parts.iter_mut().zip(&kept).for_each(|(part, before)| *part /= -before.square);
            next.way.add(&parts, &kept.iter().map(|before| &before.way).collect::<Vec<_>>());
            next.image.add(&parts, &kept.iter().map(|before| &before.image).collect::<Vec<_>>());
            next.square = self.dot(&next.image, &next.image);
            let step = self.dot(rest, &next.image) / next.square;
            *count += 1;
            if !step.is_finite() {
                return;
            }
            x.par_iter_mut().zip(&next.way.u).with_min_len(GRAIN).for_each(|(x, way)| *x += way * step);
            rest.add(&[-step], &[&next.image]);
            kept.push_back(next);
        }
    }

    /// Computes a direction for a residual, `u = C r_u` by a cycle C and `p = (B u - r_p) / schur`, and its
    /// image `[A u + B^T p, B u - (V / k) p]`.
    fn direct(&self, inner: &Inner, cycles: &mut Precondition, rest: &Pair, out: &mut Direction) {
        let Direction { way, image, .. } = out;
        let hierarchy = inner.hierarchy;
        let cycle = cycles.apply(hierarchy, &rest.u, Cycle::V);
        let larger = LARGER * hierarchy.scale;
        way.u.par_iter_mut().zip(cycle).with_min_len(GRAIN).for_each(|(u, cycle)| *u = cycle * larger);
        let pressures = way.p.par_iter_mut().zip(&mut image.p).enumerate();
        pressures.zip(self.changes(&way.u)).for_each(|((g, (p, image)), change)| {
            *p = (change - rest.p[g]) / self.schur[g];
            *image = change - self.compliance[g] * *p;
        });
        (inner.product)(&way.u, &mut image.u);
        self.add_forces(|g| way.p[g], &mut image.u);
        hierarchy.release(&mut image.u);
    }

    /// Returns the products of a vector with the images of all kept directions. A chunk of the vector stays
    /// in the cache for all of them: with whole vectors this took longer than a cycle.
    fn dots(&self, x: &Pair, kept: &VecDeque<Direction>) -> Vec<f64> {
        let with_all = |product: &dyn Fn(&Pair) -> f64| {
            let mut products = [0.0; KEPT];
            products.iter_mut().zip(kept).for_each(|(sum, of)| *sum = product(&of.image));
            products
        };
        let of_u = sums(
            x.u.par_chunks(CHUNK)
                .enumerate()
                .map(|(c, u)| with_all(&|image| of_chunk(u, &image.u[c * CHUNK..]))),
        );
        let of_p = sums(
            x.p.par_chunks(CHUNK)
                .zip(self.force.par_chunks(CHUNK))
                .enumerate()
                .map(|(c, (p, force))| with_all(&|image| weighted(p, &image.p[c * CHUNK..], force))),
        );
        (0..kept.len()).map(|k| of_u[k] + of_p[k]).collect()
    }
}

/// Returns the product of the volume changes of a chunk of the groups, as forces.
fn weighted(a: &[f64], b: &[f64], force: &[f64]) -> f64 {
    a.iter().zip(b).zip(force).map(|((a, b), force)| a * b * force * force).sum()
}

impl Pair {
    /// Adds `factor * other` for all factors and pairs.
    fn add(&mut self, factors: &[f64], others: &[&Pair]) {
        let task = GRAIN / CHUNK;
        self.u.par_chunks_mut(CHUNK).enumerate().with_min_len(task).for_each(|(c, u)| {
            for (factor, other) in factors.iter().zip(others) {
                u.iter_mut().zip(&other.u[c * CHUNK..]).for_each(|(u, other)| *u += other * *factor);
            }
        });
        self.p.par_chunks_mut(CHUNK).enumerate().with_min_len(task).for_each(|(c, p)| {
            for (factor, other) in factors.iter().zip(others) {
                p.iter_mut().zip(&other.p[c * CHUNK..]).for_each(|(p, other)| *p += other * *factor);
            }
        });
    }
}

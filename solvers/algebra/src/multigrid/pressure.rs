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
//! preconditioner P approximates A by a cycle C, then the Schur complement of the pressures by a diagonal S
//! (Elman, Silvester and Wathen 2014, Finite Elements and Fast Iterative Solvers, section 4.2). The iteration
//! is GCR, with directions orthogonal to the last few (Eisenstat, Elman and Schultz 1983, SIAM J. Numer.
//! Anal. 20, 345).
//!
//! It minimises the preconditioned residual `z = P r` in the norm of `diag(C^-1, S)`, in which the product
//! with P K has a positive real part for every vector (Klawonn and Starke 1999, Numer. Math. 81, 577). In the
//! Euclidean norm of r it has none: the iteration then stands still on curved and on long bodies (a kidney
//! of hex8 with 6,669 unknowns at nu = 0.495: residual 1.06 after 300 iterations).

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
}

/// Factor on every cycle. The cycles of a nearly incompressible body are too small on average. For factors
/// from 1 to 2 the number of iterations is the same within a tenth.
const LARGER: f64 = 1.5;
/// Number of earlier directions to which a new direction is made orthogonal. On 20 bodies, 10 take the least
/// time: 6 leave cubes at nu = 0.4999 unsolved, and 20 take 0.8 of the iterations, each 1.3 times as long.
const KEPT: usize = 10;
/// Number of iterations after which the rest is estimated from the last ones.
const PATIENCE: usize = 20;
/// Fall of the square of the preconditioned residual after which it is computed anew: its updates are exact
/// to about 1e-6.
const DRIFT: f64 = 1e-6;

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

/// Direction `way`, its image `K way`, the preconditioned image `P K way`, and the square of the last.
struct Direction {
    way: Pair,
    image: Pair,
    ahead: Pair,
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

    /// Returns the product of two preconditioned vectors. Of the second, `C^-1` times its displacements is
    /// `forces`.
    fn dot(&self, a: &Pair, forces: &[Vector3], p: &[f64]) -> f64 {
        let chunks = a.p.par_chunks(CHUNK).zip(p.par_chunks(CHUNK)).zip(self.schur.par_chunks(CHUNK));
        let [of_p] = sums(chunks.map(|((a, b), schur)| [weighted(a, b, schur)]));
        dot(&a.u, forces) + of_p
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
        (tolerance, most): (f64, usize),
    ) -> Result<Iterations, AlgebraError> {
        let size = norm(b);
        if size == 0.0 {
            return Ok(Iterations { count: 0, residual: 0.0 });
        }
        let product = |x: &[Vector3], out: &mut [Vector3]| without.multiply_into(x, out);
        let inner = Inner { hierarchy, product: &product, most };
        let nodes = b.len();
        let mut x = vec![Vector3::zeros(); nodes];
        let mut image = vec![Vector3::zeros(); nodes];
        let mut rest = Pair { u: b.to_vec(), p: vec![0.0; self.schur.len()] };
        let mut cycles = Precondition::new(nodes);
        let (mut count, mut residual, mut at_rounding) = (0, 1.0, false);
        // The recursive residual drifts from the true residual. A restart takes the true residual, with the
        // pressures that belong to the displacements.
        for _ in 0..3 {
            let limit = tolerance * size;
            let reached = self.descend(&inner, &mut cycles, (&mut x, &mut rest), limit, &mut count);
            stiffness.multiply_into(&x, &mut image);
            hierarchy.release(&mut image);
            subtract(b, &image, &mut rest.u);
            rest.p.fill(0.0);
            residual = norm(&rest.u) / size;
            at_rounding = residual > tolerance && is_rounding(stiffness, &x, b, &rest.u);
            if residual <= tolerance || at_rounding || !reached {
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
        let mut cycles = Precondition::new(b.len());
        let reached =
            limit == 0.0 || self.descend(inner, &mut cycles, (&mut x, &mut rest), limit, &mut count);
        b.copy_from_slice(&x);
        (count, reached)
    }

    /// Iterates until `|f - K u|` is at most `limit`, and returns whether this was reached. Iterations that
    /// would need more than the largest number at the rate of the last ones are given up.
    fn descend(
        &self,
        inner: &Inner,
        cycles: &mut Precondition,
        (x, rest): (&mut [Vector3], &mut Pair),
        limit: f64,
        count: &mut usize,
    ) -> bool {
        let mut kept: VecDeque<Direction> = VecDeque::with_capacity(KEPT);
        let mut scratch = vec![Vector3::zeros(); x.len()];
        let mut ahead = rest.clone();
        // Squares of the preconditioned residual where it was computed, and `PATIENCE` iterations ago.
        let (mut computed, mut before) = (f64::INFINITY, f64::INFINITY);
        let first = *count;
        while *count < inner.most {
            if norm(&rest.u) <= limit && self.of_displacements(rest, &mut scratch) <= limit {
                return true;
            }
            let mut square = self.dot(&ahead, &rest.u, &ahead.p);
            // Updates round to single precision, as cycles do.
            if *count == first || square < DRIFT * computed {
                self.precondition(inner, cycles, rest, &mut ahead);
                square = self.dot(&ahead, &rest.u, &ahead.p);
                computed = square;
            }
            if (*count - first).is_multiple_of(PATIENCE) {
                let missing = (self.of_displacements(rest, &mut scratch) / limit).ln().max(0.0);
                let gained = 0.5 * (before / square).ln();
                if missing * PATIENCE as f64 > gained * (inner.most - *count) as f64 {
                    return false;
                }
                before = square;
            }
            let oldest = if kept.len() == KEPT { kept.pop_front() } else { None };
            // Every entry of a new direction is overwritten.
            let mut next = oldest.unwrap_or_else(|| {
                let [way, image, ahead] = [ahead.clone(), ahead.clone(), ahead.clone()];
                Direction { way, image, ahead, square: 0.0 }
            });
            next.way.u.copy_from_slice(&ahead.u);
            next.way.p.copy_from_slice(&ahead.p);
            self.image(inner, &next.way, &mut next.image);
            self.precondition(inner, cycles, &next.image, &mut next.ahead);
            let mut parts = self.dots(&next.ahead, &kept);
            parts.iter_mut().zip(&kept).for_each(|(part, before)| *part /= -before.square);
            next.way.add(&parts, &kept.iter().map(|before| &before.way).collect::<Vec<_>>());
            next.image.add(&parts, &kept.iter().map(|before| &before.image).collect::<Vec<_>>());
            next.ahead.add(&parts, &kept.iter().map(|before| &before.ahead).collect::<Vec<_>>());
            next.square = self.dot(&next.ahead, &next.image.u, &next.ahead.p);
            let step = self.dot(&next.ahead, &rest.u, &ahead.p) / next.square;
            *count += 1;
            if !step.is_finite() || next.square < 0.0 {
                return false;
            }
            x.par_iter_mut().zip(&next.way.u).with_min_len(GRAIN).for_each(|(x, way)| *x += way * step);
            rest.add(&[-step], &[&next.image]);
            ahead.add(&[-step], &[&next.ahead]);
            kept.push_back(next);
        }
        false
    }

    /// Computes `P r`: displacements `u = C r_u` by a cycle, and pressures `p = (B u - r_p) / S`.
    fn precondition(&self, inner: &Inner, cycles: &mut Precondition, rest: &Pair, out: &mut Pair) {
        let cycle = cycles.apply(inner.hierarchy, &rest.u, Cycle::V);
        let larger = LARGER * inner.hierarchy.scale;
        out.u.par_iter_mut().zip(cycle).with_min_len(GRAIN).for_each(|(u, cycle)| *u = cycle * larger);
        let Pair { u, p } = out;
        let pressures = p.par_iter_mut().zip(rest.p.par_iter().zip(&self.schur)).zip(self.changes(u));
        pressures.for_each(|((p, (rest, schur)), change)| *p = (change - rest) / schur);
    }

    /// Computes the image `[A u + B^T p, B u - (V / k) p]`.
    fn image(&self, inner: &Inner, way: &Pair, out: &mut Pair) {
        let pressures =
            out.p.par_iter_mut().zip(way.p.par_iter().zip(&self.compliance)).zip(self.changes(&way.u));
        pressures.for_each(|((image, (p, compliance)), change)| *image = change - compliance * p);
        (inner.product)(&way.u, &mut out.u);
        self.add_forces(|g| way.p[g], &mut out.u);
        inner.hierarchy.release(&mut out.u);
    }

    /// Returns the products of a preconditioned vector with those of all kept directions. A chunk of the
    /// vector stays in the cache for all of them: with whole vectors this took longer than a cycle.
    fn dots(&self, x: &Pair, kept: &VecDeque<Direction>) -> Vec<f64> {
        let with_all = |product: &dyn Fn(&Direction) -> f64| {
            let mut products = [0.0; KEPT];
            products.iter_mut().zip(kept).for_each(|(sum, of)| *sum = product(of));
            products
        };
        let of_u = sums(
            x.u.par_chunks(CHUNK)
                .enumerate()
                .map(|(c, u)| with_all(&|of| of_chunk(u, &of.image.u[c * CHUNK..]))),
        );
        let of_p = sums(
            x.p.par_chunks(CHUNK)
                .zip(self.schur.par_chunks(CHUNK))
                .enumerate()
                .map(|(c, (p, schur))| with_all(&|of| weighted(p, &of.ahead.p[c * CHUNK..], schur))),
        );
        (0..kept.len()).map(|k| of_u[k] + of_p[k]).collect()
    }
}

/// Returns the product of the pressures of a chunk of the groups.
fn weighted(a: &[f64], b: &[f64], schur: &[f64]) -> f64 {
    a.iter().zip(b).zip(schur).map(|((a, b), schur)| a * b * schur).sum()
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

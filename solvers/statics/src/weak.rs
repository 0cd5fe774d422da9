#![allow(non_snake_case)] // Ni, Nj as in the formulas
//! Weak supports: prescribed displacements by Nitsche's method or by penalty, for bases whose parameters are
//! not displacements. Axes can be constrained individually (rollers).

use algebra::{Connectivity, Incidence, Stiffness};
use rayon::prelude::*;
use shape::{FluxRows, Matrix3, TraceRows, Vector3};

use crate::body::{LinearBody, check_len, check_regions, region_of};
use crate::dilation::Projected;
use crate::error::SolveError;

/// Method of a weak support.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Weak {
    /// Symmetric Nitsche method with `beta = gamma (lambda + 2 mu) / h`: consistent, and definite if gamma is
    /// large enough. About 10 suits moving least squares with h the node spacing (Griebel & Schweitzer 2003;
    /// Fernandez-Mendez & Huerta 2004).
    Nitsche {
        /// Stabilisation factor, dimensionless.
        gamma: f64,
    },
    /// Penalty with `beta = factor E / h`: always definite, with an error of order `1 / factor`.
    Penalty {
        /// Penalty factor, dimensionless.
        factor: f64,
    },
    /// Springs to the prescribed position, `beta = stiffness` (an elastic foundation).
    Spring {
        /// Stiffness per area, Pa/m.
        stiffness: f64,
        /// Whether the springs resist displacements along the surface normal only.
        along_normal: bool,
    },
}

/// A weakly constrained surface.
#[derive(Clone, Debug)]
pub struct WeakSupport<'a> {
    /// Values, gradients, weights and normals on the surface.
    pub flux: &'a FluxRows,
    /// Constrained axes x, y, z. For each of them the traction component `t_a = (sigma n)_a` enters Nitsche's
    /// terms.
    pub axes: [bool; 3],
    /// Prescribed displacement at each surface point, m; components along unconstrained axes are ignored.
    pub values: Vec<Vector3>,
    /// Region of each surface point (index into the body's materials); empty if all points are in region 0.
    pub region: &'a [u16],
    /// Nitsche's method or penalty.
    pub method: Weak,
    /// Length scale `h` of the discretisation at the surface, m. With a `trace`, Nitsche's method uses the
    /// trace's length at each point instead.
    pub h: f64,
    /// Trace that gives Nitsche's method the stress on the surface as a combination of the stresses at the
    /// body's quadrature points, projected dilation included. `None` computes the stress from the gradients
    /// of `flux`, without a projection.
    ///
    /// With a trace the matrix is definite for every `gamma > 1` and any Poisson's ratio. There are two
    /// reasons: `|sigma n|^2 <= (lambda + 2 mu) sigma : eps` holds at every point, and the lengths `h_s`
    /// of [`TraceRows::lengths`] satisfy `sum_s w_s h_s f(x_s)^2 <= sum_q w_q f(x_q)^2`. The surface
    /// integral of `h_s |sigma n|^2 / (lambda + 2 mu)` is therefore at most `sum_q w_q sigma : eps`.
    pub trace: Option<&'a TraceRows>,
}

impl WeakSupport<'_> {
    pub(crate) fn check(&self, support: usize, body: &LinearBody) -> Result<(), SolveError> {
        let points = self.flux.weights().len();
        check_len("values of a weak support", self.values.len(), points)?;
        check_len("nodes of a weak support", self.flux.at().rows().node_count(), body.nodes.len())?;
        check_regions(self.region, points, body.materials)?;
        if let Some(trace) = self.trace {
            check_len("trace of a weak support", trace.len(), points)?;
            check_len("volume points of a trace", trace.point_count(), body.volume.weights().len())?;
        }
        let (what, value) = match self.method {
            Weak::Nitsche { gamma } => ("gamma", gamma),
            Weak::Penalty { factor } => ("factor", factor),
            Weak::Spring { stiffness, .. } => ("stiffness", stiffness),
        };
        for (what, value) in [(what, value), ("h", self.h)] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(SolveError::BadWeak { support, what, value });
            }
        }
        match self.values.iter().position(|v| (0..3).any(|a| self.axes[a] && !v[a].is_finite())) {
            Some(index) => {
                Err(SolveError::NotFinite { what: "displacement of weak support at point", index })
            }
            None => Ok(()),
        }
    }

    /// Returns the projection on the constrained directions at each point.
    fn projections(&self) -> Vec<Matrix3> {
        let normals = self.flux.normals();
        match self.method {
            Weak::Spring { along_normal: true, .. } => normals.iter().map(|n| n * n.transpose()).collect(),
            _ => {
                let along = Vector3::from_fn(|a, _| f64::from(u8::from(self.axes[a])));
                vec![Matrix3::from_diagonal(&along); normals.len()]
            }
        }
    }
}

/// Rows of a support prepared for assembly, with ascending nodes in each row.
pub(crate) struct WeakTable {
    offsets: Vec<usize>,
    nodes: Vec<u32>,
    /// Shape values.
    phi: Vec<f64>,
    /// `P T_I` (3, 3), Pa/m: constrained components of the traction due to unit displacements of node I; zero
    /// for a penalty.
    traction: Vec<Matrix3>,
    weights: Vec<f64>,
    /// Stabilisation, Pa/m.
    beta: Vec<f64>,
    /// Prescribed displacement, m; zero along unconstrained axes.
    target: Vec<Vector3>,
    /// `P` of each point: `diag(axes)`, or `n n^T` for springs along the normal.
    constrained: Vec<Matrix3>,
}

/// Contribution of a node at a surface point.
#[derive(Clone, Copy)]
struct Entry {
    phi: f64,
    /// Gradient of the traction's strain, 1/m.
    grad: Vector3,
    /// Gradient of the traction's projected dilation, 1/m.
    dilation: Vector3,
}

impl WeakTable {
    pub fn new(support: &WeakSupport, body: &LinearBody, projected: Option<&Projected>) -> WeakTable {
        let at = support.flux.at();
        let points = support.flux.weights().len();
        let constrained = support.projections();
        let nitsche = matches!(support.method, Weak::Nitsche { .. });
        let trace = support.trace.filter(|_| nitsche);
        let mut offsets = vec![0];
        let (mut nodes, mut phi, mut traction) = (Vec::new(), Vec::new(), Vec::new());
        let mut beta = Vec::with_capacity(points);
        let none = Entry { phi: 0.0, grad: Vector3::zeros(), dilation: Vector3::zeros() };
        let (mut row, mut seen) = (vec![none; body.nodes.len()], vec![false; body.nodes.len()]);
        let mut touched: Vec<u32> = Vec::new();
        for q in 0..points {
            let law = &body.materials[region_of(support.region, q)];
            let (lambda, mu) = (law.lambda(), law.mu());
            let n = support.flux.normals()[q];
            let mut add = |node: u32, phi: f64, grad: Vector3, dilation: Vector3| {
                let i = node as usize;
                if !std::mem::replace(&mut seen[i], true) {
                    touched.push(node);
                }
                row[i].phi += phi;
                row[i].grad += grad;
                row[i].dilation += dilation;
            };
            let (row_nodes, values) = at.rows().row(q);
            for ((&node, &value), &g) in row_nodes.iter().zip(values).zip(at.row(q).1) {
                add(node, value, if trace.is_some() { Vector3::zeros() } else { g }, Vector3::zeros());
            }
            if let Some(trace) = trace {
                for (&p, &c) in trace.row(q).0.iter().zip(trace.row(q).1) {
                    let (nodes, grads) = body.volume.row(p as usize);
                    nodes.iter().zip(grads).for_each(|(&i, g)| add(i, 0.0, g * c, Vector3::zeros()));
                    let dilation = projected.map_or(&[][..], |d| d.row(p as usize));
                    dilation.iter().for_each(|&(i, b)| add(i, 0.0, Vector3::zeros(), b * c));
                }
            }
            // With a projection the mean stress is kappa times the projected dilation, as in the energy.
            let (shear, bulk) = match (trace, projected) {
                (Some(_), Some(_)) => (-2.0 / 3.0 * mu, law.bulk()),
                _ => (lambda, 0.0),
            };
            touched.sort_unstable();
            for &node in &touched {
                let Entry { phi: value, grad: g, dilation: b } =
                    std::mem::replace(&mut row[node as usize], none);
                seen[node as usize] = false;
                nodes.push(node);
                phi.push(value);
                // t_a for a unit displacement along c: lambda n_a g_c + mu (g . n delta_ac + g_a n_c).
                traction.push(if nitsche {
                    constrained[q]
                        * (n * (g * shear + b * bulk).transpose()
                            + (Matrix3::identity() * g.dot(&n) + g * n.transpose()) * mu)
                } else {
                    Matrix3::zeros()
                });
            }
            touched.clear();
            offsets.push(nodes.len());
            beta.push(match support.method {
                Weak::Nitsche { gamma } => {
                    gamma * (lambda + 2.0 * mu) / trace.map_or(support.h, |t| t.lengths()[q])
                }
                Weak::Penalty { factor } => factor * law.young() / support.h,
                Weak::Spring { stiffness, .. } => stiffness,
            });
        }
        // Components are selected because `constrained * v` would spread an ignored NaN.
        let target =
            support.values.iter().map(|v| Vector3::from_fn(|a, _| if support.axes[a] { v[a] } else { 0.0 }));
        let weights = support.flux.weights().to_vec();
        let target = target.collect();
        WeakTable { offsets, nodes, phi, traction, weights, beta, target, constrained }
    }

    pub fn connectivity(&self) -> Connectivity<'_> {
        Connectivity { offsets: &self.offsets, nodes: &self.nodes, seen_by: &[] }
    }

    pub fn incidence(&self, node_count: usize) -> Incidence {
        Incidence::new(node_count, self.connectivity(), 0..self.weights.len())
    }

    /// Adds the bilinear form
    /// `sum over constrained axes of integral of (beta u_a v_a - t_a(u) v_a - u_a t_a(v))`.
    pub fn add_stiffness(&self, stiffness: &mut Stiffness, incidence: &Incidence) {
        stiffness.for_each_row(|i, slot, row| {
            for &(q, k) in incidence.of(i) {
                let (q, k) = (q as usize, k as usize);
                let w = self.weights[q];
                let (Ni, ti) = (self.phi[k], self.traction[k].transpose());
                let stabilised = self.constrained[q] * (self.beta[q] * Ni);
                for j in self.offsets[q]..=k {
                    let (Nj, tj) = (self.phi[j], &self.traction[j]);
                    row[slot[self.nodes[j] as usize] as usize] += (stabilised * Nj - tj * Ni - ti * Nj) * w;
                }
            }
        });
    }

    /// Adds the trace of `integral of beta u_a v_a` over the constrained axes at each node, N/m.
    pub fn add_penalties(&self, sums: &mut [f64]) {
        for (q, range) in self.offsets.windows(2).enumerate() {
            let spring = self.constrained[q].trace() * self.weights[q] * self.beta[q];
            for k in range[0]..range[1] {
                sums[self.nodes[k] as usize] += spring * self.phi[k].powi(2);
            }
        }
    }

    /// Adds the linear form `sum over constrained axes of integral of g_a (beta v_a - t_a(v))` to the nodal
    /// forces.
    pub fn add_force(&self, incidence: &Incidence, force: &mut [Vector3]) {
        force.par_iter_mut().enumerate().for_each(|(i, force)| {
            for &(q, k) in incidence.of(i) {
                let (q, k) = (q as usize, k as usize);
                let g = self.target[q];
                *force += (g * (self.beta[q] * self.phi[k]) - self.traction[k].tr_mul(&g)) * self.weights[q];
            }
        });
    }

    /// Adds to `force` (N) the consistency terms of Nitsche's method at nodal parameters `u` (m),
    /// `integral of (t_a(u) v_a + u_a t_a(v))`, with the positive sign. [`WeakTable::add_stiffness`]
    /// subtracts these terms, so the sum of both is the positive part of the form.
    pub fn add_consistency(&self, incidence: &Incidence, u: &[Vector3], force: &mut [Vector3]) {
        let at = |q: usize| {
            let range = self.offsets[q]..self.offsets[q + 1];
            range.fold((Vector3::zeros(), Vector3::zeros()), |(value, traction), k| {
                let u = u[self.nodes[k] as usize];
                (value + self.constrained[q] * u * self.phi[k], traction + self.traction[k] * u)
            })
        };
        let at_points: Vec<(Vector3, Vector3)> = (0..self.weights.len()).map(at).collect();
        force.iter_mut().enumerate().for_each(|(i, force)| {
            for &(q, k) in incidence.of(i) {
                let (q, k) = (q as usize, k as usize);
                let (value, traction) = at_points[q];
                *force += (traction * self.phi[k] + self.traction[k].tr_mul(&value)) * self.weights[q];
            }
        });
    }

    /// Subtracts both forms at `u` and `factor` times the prescribed displacement `g` from `residual`:
    /// `integral of (beta (u_a - g_a) v_a - t_a(u) v_a - (u_a - g_a) t_a(v))`.
    pub fn subtract_residual(
        &self,
        incidence: &Incidence,
        u: &[Vector3],
        factor: f64,
        residual: &mut [Vector3],
    ) {
        let at_points: Vec<(Vector3, Vector3)> = (0..self.weights.len())
            .into_par_iter()
            .with_min_len(64)
            .map(|q| {
                let range = self.offsets[q]..self.offsets[q + 1];
                let base = u[self.nodes[range.start] as usize];
                let (mut gap, mut traction) =
                    (self.constrained[q] * base - self.target[q] * factor, Vector3::zeros());
                for k in range {
                    let difference = u[self.nodes[k] as usize] - base;
                    gap += self.constrained[q] * difference * self.phi[k];
                    traction += self.traction[k] * difference;
                }
                (gap, traction)
            })
            .collect();
        residual.par_iter_mut().with_min_len(32).enumerate().for_each(|(i, residual)| {
            for &(q, k) in incidence.of(i) {
                let (q, k) = (q as usize, k as usize);
                let (gap, traction) = &at_points[q];
                let stiff = (gap * self.beta[q] - traction) * self.phi[k];
                *residual -= (stiff - self.traction[k].tr_mul(gap)) * self.weights[q];
            }
        });
    }
}

#[cfg(test)]
mod tests;

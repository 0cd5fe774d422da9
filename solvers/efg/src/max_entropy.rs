//! Local maximum-entropy shape functions: a convex approximant.
//!
//! The functions are `p_a(x) = exp(-beta_a |r_a|^2 + lambda . r_a) / Z` with `r_a = x - x_a`, and `lambda` is
//! such that `sum_a p_a r_a = 0`. Of all positive functions that reproduce linear fields these are the least
//! biased for a given locality `beta_a = gamma / h_a^2`. `lambda` minimises `log Z`, which is convex, by
//! Newton's method with the Hessian `J = sum_a p_a r_a r_a^T` and a line search. With `s_a = -2 beta_a r_a`
//! and `M = sum_a p_a r_a s_a^T` the gradients are
//! `grad p_a = p_a (s_a - sum_b p_b s_b - (I + M)^T J^-1 r_a)`; for a uniform `beta` this is the published
//! `-p_a J^-1 r_a`. Source: Arroyo and Ortiz (2006), International Journal for Numerical Methods in
//! Engineering 65, 2167.
//!
//! On a face of the convex hull of the neighbours `lambda` is infinite across the face, and only the nodes in
//! the face contribute (the weak Kronecker property). The same problem is then solved in the plane, line or
//! point of the face. Gradients are one-sided there: they are evaluated at a point [`INWARD`] inside.

use lanes::{LANES, Lanes};
use shape::{Matrix3, Point3, Vector3};

use crate::detour::Detour;
use crate::exp::exp;

/// Value of `exp(-beta r^2)` below which a node does not contribute: 2.8 spacings with `gamma = 1.8`.
pub(crate) const CUT: f64 = 1e-6;
/// Tolerance of `sum_a p_a r_a`, in units of the mean `1/sqrt(beta)`; rounding leaves 1e-16.
const TOLERANCE: f64 = 1e-14;
/// Largest number of Newton steps. Inside the hull a few steps suffice; each factor e closer to a face takes
/// about one more.
const ITERATIONS: usize = 60;
/// Step from which the point is tested for lying on a face.
const PATIENCE: usize = 6;
/// Distance, in the same unit, below which a node lies in a plane through the point.
const IN_FACE: f64 = 1e-9;
/// Relative weight (to the largest) below which a node is ignored in the search for a face.
const SIGNIFICANT: f64 = 1e-3;
/// Relative distance, from a face to the mean of the neighbours, at which gradients on the face are
/// evaluated: `J` loses six digits there, but sixteen on the face.
const INWARD: f64 = 1e-6;

/// Exponent of a node that does not contribute.
const NEVER: f64 = f64::NEG_INFINITY;

/// Neighbours of a point, eight per entry, with the quantities derived from them. The buffers are reused from
/// point to point.
#[derive(Default)]
pub(crate) struct Neighbours {
    count: usize,
    /// `r_a` in units of `scale`, by axis.
    offset: Vec<[Lanes; 3]>,
    /// `beta_a` times the unit squared.
    beta: Vec<Lanes>,
    /// `-beta_a |r_a|^2`, or [`NEVER`].
    prior: Vec<Lanes>,
    /// `p_a Z`, with `Z` such that the largest value is one.
    weight: Vec<Lanes>,
    /// Unit of length, m.
    scale: f64,
    /// Nodes with a detour: index, length of the detour (m), and its gradient with respect to the point.
    bent: Vec<(usize, f64, Vector3)>,
}

/// `lambda` with the corresponding moments.
struct State {
    lambda: Vector3,
    log_z: f64,
    /// `sum_a p_a` before normalisation.
    total: f64,
    /// `sum_a p_a r_a`.
    gap: Vector3,
    /// `J`.
    spread: Matrix3,
}

/// Failure of the search for `lambda`, usually because the point lies outside the convex hull of its
/// neighbours.
#[derive(Debug)]
pub(crate) struct NoPoint {
    /// Largest number of Newton steps, after which the search is given up.
    pub iterations: usize,
    /// Smallest distance (m), over all steps, between the point and the weighted mean of its neighbours. The
    /// distance is zero if the values were found but `J` was too singular for gradients.
    pub gap: f64,
}

impl Neighbours {
    /// Sets the detours of the nodes of the next point, relative to their support radii: none, or one for
    /// each node.
    pub(crate) fn bend(&mut self, detours: &[Detour], radius: impl Fn(usize) -> f64) {
        self.bent.clear();
        let bent = detours.iter().enumerate().filter(|(_, detour)| detour.longer > 0.0);
        self.bent.extend(bent.map(|(k, detour)| (k, detour.longer * radius(k), detour.slope * radius(k))));
    }

    /// Computes values, and gradients (1/m) if `grads` has room, of the nodes at `x`; returns the condition
    /// number of `J` in the 1-norm.
    #[inline(always)]
    pub(crate) fn evaluate<const GRAD: bool>(
        &mut self,
        x: &Point3,
        nodes: impl Iterator<Item = (Vector3, f64)> + Clone,
        values: &mut [f64],
        grads: &mut [Vector3],
    ) -> Result<f64, NoPoint> {
        self.load(x, nodes.clone());
        let (state, span) = self.solve()?;
        for (k, value) in values.iter_mut().enumerate() {
            *value = self.weight[k / LANES][k % LANES] / state.total;
        }
        // For a point on a face, the condition number is that of `J` in the face.
        let across = Matrix3::identity() - span;
        let trace = state.spread.trace();
        let size = if trace > IN_FACE { trace } else { 1.0 };
        let mut condition = condition(&(span * state.spread * span + across * size));
        if GRAD {
            let state = match across == Matrix3::zeros() {
                true => state,
                false => {
                    let mean = nodes.clone().map(|(at, _)| at).sum::<Vector3>() / self.count as f64;
                    self.load(&(x + (mean - x.coords) * INWARD), nodes);
                    let (inside, _) = self.solve()?;
                    condition = self::condition(&inside.spread);
                    inside
                }
            };
            self.gradients(&state, grads).ok_or(NoPoint { iterations: ITERATIONS, gap: 0.0 })?;
        }
        Ok(condition)
    }

    #[inline(always)]
    fn load(&mut self, x: &Point3, nodes: impl Iterator<Item = (Vector3, f64)> + Clone) {
        self.count = nodes.clone().count();
        let groups = self.count.div_ceil(LANES);
        self.offset.resize(groups, [[0.0; LANES]; 3]);
        for list in [&mut self.beta, &mut self.prior, &mut self.weight] {
            list.resize(groups, [0.0; LANES]);
        }
        let mean = nodes.clone().map(|(_, beta)| beta).sum::<f64>() / self.count.max(1) as f64;
        self.scale = 1.0 / mean.sqrt();
        let inverse = mean.sqrt();
        for (k, (at, beta)) in nodes.enumerate() {
            let (g, l) = (k / LANES, k % LANES);
            let r = (x.coords - at) * inverse;
            (0..3).for_each(|axis| self.offset[g][axis][l] = r[axis]);
            self.beta[g][l] = beta / mean;
            self.prior[g][l] = -self.beta[g][l] * r.norm_squared();
        }
        for &(k, longer, _) in &self.bent {
            let (g, l) = (k / LANES, k % LANES);
            let distance = self.distance(k) + longer * inverse;
            self.prior[g][l] = -self.beta[g][l] * distance * distance;
        }
        for k in self.count..groups * LANES {
            let (g, l) = (k / LANES, k % LANES);
            (0..3).for_each(|axis| self.offset[g][axis][l] = 0.0);
            (self.beta[g][l], self.prior[g][l]) = (0.0, NEVER);
        }
    }

    /// Returns the straight distance of a node, in units of `scale`.
    fn distance(&self, node: usize) -> f64 {
        self.vector(node).norm()
    }

    /// Returns `r_a` of a node, in units of `scale`.
    fn vector(&self, node: usize) -> Vector3 {
        Vector3::from_fn(|axis, _| self.offset[node / LANES][axis][node % LANES])
    }

    /// Computes weights and moments at `lambda`.
    #[inline(always)]
    fn moments(&mut self, lambda: Vector3) -> State {
        let mut largest = [NEVER; LANES];
        for ((r, prior), weight) in self.offset.iter().zip(&self.prior).zip(&mut self.weight) {
            for l in 0..LANES {
                let e = prior[l] + (lambda[0] * r[0][l] + lambda[1] * r[1][l] + lambda[2] * r[2][l]);
                weight[l] = e;
                largest[l] = if e > largest[l] { e } else { largest[l] };
            }
        }
        let largest = largest.into_iter().fold(NEVER, f64::max);
        // One loop over the lanes for each sum: a single loop for all ten is not vectorised.
        let mut sums = [[0.0; LANES]; 10];
        for ([x, y, z], weight) in self.offset.iter().zip(&mut self.weight) {
            let mut w = [0.0; LANES];
            for l in 0..LANES {
                w[l] = exp(weight[l] - largest);
            }
            *weight = w;
            let (wx, wy, wz) = (product(&w, x), product(&w, y), product(&w, z));
            add(&mut sums[0], &w);
            add(&mut sums[1], &wx);
            add(&mut sums[2], &wy);
            add(&mut sums[3], &wz);
            add(&mut sums[4], &product(&wx, x));
            add(&mut sums[5], &product(&wx, y));
            add(&mut sums[6], &product(&wx, z));
            add(&mut sums[7], &product(&wy, y));
            add(&mut sums[8], &product(&wy, z));
            add(&mut sums[9], &product(&wz, z));
        }
        let [total, x, y, z, xx, xy, xz, yy, yz, zz] = sums.map(|s| s.iter().sum::<f64>());
        State {
            lambda,
            log_z: largest + total.ln(),
            total,
            gap: Vector3::new(x, y, z) / total,
            spread: Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz) / total,
        }
    }

    /// Solves for `lambda`, and returns the projection on the face that contains the point, or the identity
    /// if there is no such face.
    #[inline(always)]
    fn solve(&mut self) -> Result<(State, Matrix3), NoPoint> {
        let mut state = self.moments(Vector3::zeros());
        // Projection on the face that contains the point; the identity until a face is found.
        let mut span = Matrix3::identity();
        let mut nearest = f64::INFINITY;
        for iteration in 0..ITERATIONS {
            let gap = span * state.gap;
            if gap.norm() < TOLERANCE {
                return Ok((state, span));
            }
            nearest = nearest.min(state.gap.norm());
            if iteration >= PATIENCE
                && let Some(face) = self.face(&state, &span)
            {
                span = face;
                state = self.moments(span * state.lambda);
                continue;
            }
            // The Hessian within the span, and an arbitrary definite part across the span.
            let across = (Matrix3::identity() - span) * state.spread.trace().max(f64::MIN_POSITIVE);
            let hessian = span * (state.spread - state.gap * state.gap.transpose()) * span + across;
            let Some(step) = hessian.cholesky().map(|c| span * c.solve(&gap)) else { break };
            let expected = step.dot(&gap);
            let mut part = 1.0;
            let mut next = self.moments(state.lambda - step);
            // Below 1e-10 the decrease of log Z is lost in its rounding, and the full step is appropriate.
            while expected > 1e-10 && !(next.log_z < state.log_z - 1e-4 * part * expected) && part > 1e-6 {
                part /= 2.0;
                next = self.moments(state.lambda - step * part);
            }
            // Only rounding is left.
            if gap.norm() < 1e3 * TOLERANCE && !((span * next.gap).norm() < 0.5 * gap.norm()) {
                let state = self.moments(state.lambda);
                return Ok((state, span));
            }
            state = next;
        }
        Err(NoPoint { iterations: ITERATIONS, gap: nearest * self.scale })
    }

    /// Returns the projection on the plane, line or point of the nodes with significant weight, provided this
    /// face contains the point and all other nodes lie on one side of it. The direction of `lambda` must be
    /// such that `exp(lambda . r)` tends to zero for the other nodes, which no longer contribute.
    #[cold]
    fn face(&mut self, state: &State, span: &Matrix3) -> Option<Matrix3> {
        let offset = |k: usize| self.vector(k);
        let weight = |k: usize| self.weight[k / LANES][k % LANES];
        let mut spread = Matrix3::zeros();
        for k in (0..self.count).filter(|&k| weight(k) >= SIGNIFICANT) {
            spread += offset(k) * offset(k).transpose();
        }
        let eigen = spread.symmetric_eigen();
        let mut face = Matrix3::zeros();
        for k in (0..3).filter(|&k| eigen.eigenvalues[k] > 1e-14) {
            let v = eigen.eigenvectors.column(k);
            face += v * v.transpose();
        }
        let across = span * state.lambda - face * state.lambda;
        if !(across.norm() > 1.0) || (face - span).norm() < 1e-3 {
            return None;
        }
        let across = across.normalize();
        let counts = |k: usize| self.prior[k / LANES][k % LANES] > NEVER;
        let apart = |k: usize| (offset(k) - face * offset(k)).norm() > IN_FACE;
        let others: Vec<usize> = (0..self.count).filter(|&k| counts(k) && apart(k)).collect();
        if others.iter().any(|&k| weight(k) >= SIGNIFICANT || offset(k).dot(&across) > -IN_FACE) {
            return None;
        }
        others.into_iter().for_each(|k| self.prior[k / LANES][k % LANES] = NEVER);
        Some(face)
    }

    /// Computes the gradients, 1/m; `None` if `J` is singular.
    #[inline(always)]
    fn gradients(&self, state: &State, grads: &mut [Vector3]) -> Option<()> {
        let inverse = state.spread.try_inverse()?;
        if !self.bent.is_empty() {
            self.bent_gradients(state, &inverse, grads);
            return Some(());
        }
        // sum w beta r and sum w beta r r^T.
        let mut sums = [[0.0; LANES]; 9];
        for (([x, y, z], weight), beta) in self.offset.iter().zip(&self.weight).zip(&self.beta) {
            let w = product(weight, beta);
            let (wx, wy, wz) = (product(&w, x), product(&w, y), product(&w, z));
            add(&mut sums[0], &wx);
            add(&mut sums[1], &wy);
            add(&mut sums[2], &wz);
            add(&mut sums[3], &product(&wx, x));
            add(&mut sums[4], &product(&wx, y));
            add(&mut sums[5], &product(&wx, z));
            add(&mut sums[6], &product(&wy, y));
            add(&mut sums[7], &product(&wy, z));
            add(&mut sums[8], &product(&wz, z));
        }
        let [x, y, z, xx, xy, xz, yy, yz, zz] = sums.map(|s| s.iter().sum::<f64>() * (-2.0 / state.total));
        let mean = Vector3::new(x, y, z);
        let moment = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        let slope = (Matrix3::identity() + moment).transpose() * inverse;
        let part = 1.0 / (state.total * self.scale);
        for (g, grads) in grads.chunks_mut(LANES).enumerate() {
            let ([x, y, z], weight, beta) = (&self.offset[g], &self.weight[g], &self.beta[g]);
            let mut along = [[0.0; LANES]; 3];
            for (axis, along) in along.iter_mut().enumerate() {
                let own = &self.offset[g][axis];
                let (a, b, c, m) = (slope[(axis, 0)], slope[(axis, 1)], slope[(axis, 2)], mean[axis]);
                for l in 0..LANES {
                    let s = -2.0 * beta[l] * own[l] - m;
                    along[l] = (s - (a * x[l] + b * y[l] + c * z[l])) * (weight[l] * part);
                }
            }
            for (l, grad) in grads.iter_mut().enumerate() {
                *grad = Vector3::new(along[0][l], along[1][l], along[2][l]);
            }
        }
        Some(())
    }

    /// Computes the gradients if `s_a` is not parallel to `r_a`: with a detour `d_a`,
    /// `s_a = -2 beta_a (|r_a| + d_a) grad (|r_a| + d_a)`.
    #[cold]
    #[inline(never)]
    fn bent_gradients(&self, state: &State, inverse: &Matrix3, grads: &mut [Vector3]) {
        let mut slopes: Vec<Vector3> =
            (0..self.count).map(|k| self.vector(k) * (-2.0 * self.beta[k / LANES][k % LANES])).collect();
        for &(k, longer, slope) in &self.bent {
            let distance = self.distance(k) + longer / self.scale;
            let along = self.vector(k).try_normalize(0.0).unwrap_or_default() + slope;
            slopes[k] = along * (-2.0 * self.beta[k / LANES][k % LANES] * distance);
        }
        let part = |k: usize| self.weight[k / LANES][k % LANES] / state.total;
        let mean: Vector3 = (0..self.count).map(|k| slopes[k] * part(k)).sum();
        let change: Matrix3 = (0..self.count).map(|k| self.vector(k) * slopes[k].transpose() * part(k)).sum();
        let turned = (Matrix3::identity() + change).transpose() * inverse;
        for (k, grad) in grads.iter_mut().enumerate() {
            *grad = (slopes[k] - mean - turned * self.vector(k)) * (part(k) / self.scale);
        }
    }
}

#[inline(always)]
fn product(a: &Lanes, b: &Lanes) -> Lanes {
    let mut out = [0.0; LANES];
    for l in 0..LANES {
        out[l] = a[l] * b[l];
    }
    out
}

#[inline(always)]
fn add(sum: &mut Lanes, term: &Lanes) {
    for l in 0..LANES {
        sum[l] += term[l];
    }
}

/// Returns the condition number in the 1-norm; infinite if the matrix is singular.
fn condition(m: &Matrix3) -> f64 {
    let norm = |m: &Matrix3| m.column_iter().map(|c| c.abs().sum()).fold(0.0, f64::max);
    m.try_inverse().map_or(f64::INFINITY, |inverse| norm(m) * norm(&inverse))
}

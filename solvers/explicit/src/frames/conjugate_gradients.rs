//! Implicit Euler with one linearisation in each time step, solved by a limited number of conjugate-gradient
//! iterations.

use material::{Material as _, Tangent};
use shape::{Matrix3, Vector3};

use super::equations::{Equations, Sweeper};
use super::parallel::fill;
use super::touch::Spring;
use crate::body::ExplicitBody;
use crate::error::ExplicitError;
use crate::lists::Lists;

/// Points or nodes per task.
const CHUNK: usize = 256;

/// Conjugate gradients for `(w + (1 + beta / h) K + K_contact) (u - u_n) = f_ext + f_contact - f_int + w (y -
/// u_n)`, with forces and stiffness at `u_n` and the start `u = y`.
///
/// These are the steps of SOFA's implicit Euler solver. Source: Baraff and Witkin, SIGGRAPH (1998).
pub(super) struct ConjugateGradients<'a> {
    body: ExplicitBody<'a>,
    /// Entries of the table at each node: its points, and where each point's row has the node.
    points: Lists,
    entries: Lists,
    /// Weight of the stiffness, `1 + beta / h`.
    stiff: f64,
    iterations: usize,
    tolerance: f64,
    /// Stress and tangent of each point.
    linear: Vec<(Matrix3, Tangent)>,
}

impl<'a> ConjugateGradients<'a> {
    /// Prepares the solver for at most some number of iterations down to a relative residual.
    pub fn new(
        body: ExplicitBody<'a>,
        [stiff, tolerance]: [f64; 2],
        iterations: usize,
    ) -> Result<ConjugateGradients<'a>, ExplicitError> {
        body.check()?;
        if body.groups.is_some() || body.volume.hourglass().is_some() {
            return Err(ExplicitError::NotStandard);
        }
        let rows = body.volume.rows();
        let pairs = |of: fn(usize, usize) -> u32| {
            (0..rows.len())
                .flat_map(move |q| rows.row(q).0.iter().enumerate().map(move |(a, &node)| (node, of(q, a))))
        };
        let points = Lists::new(rows.node_count(), pairs(|q, _| q as u32));
        let entries = Lists::new(rows.node_count(), pairs(|_, a| a as u32));
        let linear = vec![(Matrix3::zeros(), Tangent::zeros()); rows.len()];
        Ok(ConjugateGradients { body, points, entries, stiff, iterations, tolerance, linear })
    }

    /// Evaluates stress and tangent of every point.
    fn linearise(&mut self, u: &[Vector3]) {
        let body = self.body;
        let at = body.volume.at();
        fill(&mut self.linear, CHUNK, |q| body.law(q).stress_and_tangent(&at.displacement_gradient(q, u)));
    }

    /// Adds `scale` times the nodal forces of the stresses of all points to `f`.
    fn add_forces(&self, stresses: impl Fn(usize) -> Matrix3 + Sync, scale: f64, f: &mut [Vector3]) {
        let volume = self.body.volume;
        let mut forces = vec![Vector3::zeros(); f.len()];
        fill(&mut forces, CHUNK, |i| {
            let each = self.points.of(i).iter().zip(self.entries.of(i));
            let of_point = |(&q, &a): (&u32, &u32)| {
                let q = q as usize;
                stresses(q) * volume.row(q).1[a as usize] * (scale * volume.weights()[q])
            };
            each.map(of_point).sum()
        });
        f.iter_mut().zip(&forces).for_each(|(f, force)| *f += force);
    }

    /// Product of the matrix and a vector (N), zero along prescribed axes.
    fn product(&self, equations: &Equations, springs: &[Spring], p: &[Vector3]) -> Vec<Vector3> {
        let at = self.body.volume.at();
        let mut stresses = vec![Matrix3::zeros(); self.linear.len()];
        fill(&mut stresses, CHUNK, |q| {
            let change = at.displacement_gradient(q, p);
            let tangent = &self.linear[q].1;
            let mut stress = Matrix3::zeros();
            for l in 0..9 {
                (0..9).for_each(|k| stress[k] += tangent[(k, l)] * change[l]);
            }
            stress
        });
        let mut product: Vec<Vector3> = p.iter().zip(equations.weights).map(|(p, w)| p * *w).collect();
        self.add_forces(|q| stresses[q], self.stiff, &mut product);
        if let Some(touch) = equations.touch {
            touch.add_springs(springs, p, &mut product);
        }
        free(equations, &mut product);
        product
    }
}

/// Sets the components along prescribed axes to zero.
fn free(equations: &Equations, f: &mut [Vector3]) {
    for (f, held) in f.iter_mut().zip(equations.constrained) {
        (0..3).filter(|&axis| held[axis]).for_each(|axis| f[axis] = 0.0);
    }
}

fn dot(a: &[Vector3], b: &[Vector3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}

impl Sweeper for ConjugateGradients<'_> {
    fn solve(&mut self, equations: &Equations, u: &mut [Vector3]) {
        let before = equations.before;
        self.linearise(before);
        let mut right: Vec<Vector3> = (0..u.len())
            .map(|i| equations.load[i] + (equations.inertial[i] - before[i]) * equations.weights[i])
            .collect();
        self.add_forces(|q| self.linear[q].0, -1.0, &mut right);
        let springs = equations.touch.map_or_else(Vec::new, |touch| touch.springs(before, &mut right));
        free(equations, &mut right);
        let start: Vec<Vector3> = u.iter().zip(before).map(|(u, before)| u - before).collect();
        let product = self.product(equations, &springs, &start);
        let mut residual: Vec<Vector3> = right.iter().zip(&product).map(|(r, p)| r - p).collect();
        let mut direction = residual.clone();
        let mut square = dot(&residual, &residual);
        let least = self.tolerance * self.tolerance * dot(&right, &right).max(square);
        for _ in 0..self.iterations {
            // Written so that a NaN ends the iterations; the caller finds it.
            if !(square > least) {
                break;
            }
            let product = self.product(equations, &springs, &direction);
            let curvature = dot(&direction, &product);
            if !(curvature > 0.0) {
                break;
            }
            let length = square / curvature;
            for i in 0..u.len() {
                u[i] += direction[i] * length;
                residual[i] -= product[i] * length;
            }
            let next = dot(&residual, &residual);
            let keeps = next / square;
            square = next;
            direction.iter_mut().zip(&residual).for_each(|(d, r)| *d = r + *d * keeps);
        }
        if !square.is_finite() {
            u.fill(Vector3::repeat(f64::NAN));
        }
    }
}

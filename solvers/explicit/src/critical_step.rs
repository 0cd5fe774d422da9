//! Critical time step, from the largest eigenvalue of `M^-1 K` by Lanczos.

use shape::{Matrix3, SurfaceRows, Vector3};

use crate::error::ExplicitError;
use crate::force::InternalForce;

/// Parameters for the estimate of the critical step by the Lanczos method.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LanczosParams {
    /// Number of Lanczos steps; 15 find the largest eigenvalue to a few per cent, from below.
    pub steps: usize,
    /// Factor on the time step that covers the error of the estimate, such as 0.95.
    pub safety: f64,
}

/// Estimate of the critical step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CriticalStep {
    /// Critical time step `safety * 2 / omega_max`, s.
    pub dt: f64,
    /// Largest angular frequency found, rad/s.
    pub omega_max: f64,
    /// Largest sum of a row of `M^-1 C` of dampers, 1/s.
    pub damping: f64,
    /// Number of Lanczos steps made: fewer than requested if the space is exhausted.
    pub steps: usize,
}

impl CriticalStep {
    /// Returns the critical step of a body that also has the damping `beta K`, `beta` in s. Its largest rate is
    /// `beta omega_max^2`, and its forces lag by half a step, as those of dampers do.
    pub fn with_stiffness_damping(self, beta: f64) -> CriticalStep {
        let damping = self.damping + beta * self.omega_max * self.omega_max;
        let dt = self.dt * longest(damping, self.omega_max) / longest(self.damping, self.omega_max);
        CriticalStep { dt, damping, ..self }
    }
}

/// Longest stable step (s) of a mode with the angular frequency `omega` and the damping `gamma` of `M^-1 C`, both
/// in 1/s.
fn longest(gamma: f64, omega: f64) -> f64 {
    4.0 / (gamma + (gamma * gamma + 4.0 * omega * omega).sqrt())
}

/// Change of shape `|dF F^-1|` at any point since an estimate up to which the estimate is kept. Moduli are
/// products of two or four `F^-1` times a constant or `ln J`. In the neo-Hookean law they change by at most
/// five times the change of shape, and the frequency by half of that, 5 %, which the factor of 0.9 on the
/// step covers.
const KEPT: f64 = 0.02;

/// Estimate, with the displacement gradients for which it was made.
pub(super) struct Estimate {
    pub critical: CriticalStep,
    pub gradients: Vec<Matrix3>,
}

impl Estimate {
    /// Whether the estimate is valid for a body with these gradients.
    pub fn serves(&self, gradients: &[Matrix3]) -> bool {
        self.gradients.iter().zip(gradients).all(|(then, now)| {
            let inverse = (Matrix3::identity() + then).try_inverse();
            inverse.is_some_and(|inverse| ((now - then) * inverse).norm() <= KEPT)
        })
    }
}

/// Ground springs and dampers on a whole surface, equal in every direction: `sum_q w k N_I N_J 1`. With the
/// penalty of tools as modulus, the springs are at least as stiff as the contact tangent, whichever points touch. A
/// step that is stable with them stays stable in contact. They bound springs along the normal in the same way.
#[derive(Clone, Copy, Debug)]
pub struct Springs<'a> {
    /// Surface that carries the springs.
    pub surface: &'a SurfaceRows,
    /// Stiffness per undeformed area, Pa/m.
    pub modulus: f64,
    /// Damping per undeformed area, Pa s/m.
    pub damping: f64,
}

impl Springs<'_> {
    /// Adds the largest sum of a row of `C` (N s/m), an upper bound of its forces, to each node.
    fn add_damping(&self, sums: &mut [f64]) {
        let rows = self.surface.rows();
        for (q, weight) in self.surface.weights().iter().enumerate() {
            let (nodes, values) = rows.row(q);
            let all: f64 = values.iter().map(|n| n.abs()).sum();
            for (&i, n) in nodes.iter().zip(values) {
                sums[i as usize] += weight * self.damping * n.abs() * all;
            }
        }
    }

    fn add(&self, v: &[f64], w: &mut [f64]) {
        let rows = self.surface.rows();
        for (q, weight) in self.surface.weights().iter().enumerate() {
            let (nodes, values) = rows.row(q);
            for axis in 0..3 {
                let at: f64 = nodes.iter().zip(values).map(|(&i, n)| n * v[3 * i as usize + axis]).sum();
                for (&i, n) in nodes.iter().zip(values) {
                    w[3 * i as usize + axis] += weight * self.modulus * n * at;
                }
            }
        }
    }
}

/// Estimates the critical step of central differences at the displacements `u` (m) with lumped `mass` (kg). A
/// degree of freedom `3 node + axis` is constrained if `free` returns false for it.
///
/// The method is Lanczos with full reorthogonalisation on `A = M^-1/2 K M^-1/2`. `K v` is a central
/// difference of internal forces, at a displacement of 1e-6 of the smallest spacing (3e-3 for forces in
/// single precision). The start vector is fixed pseudo-random noise, so the same body gives the same step.
///
/// # Errors
///
/// [`ExplicitError::BadParameter`] for invalid `params`, [`ExplicitError::Inverted`] if a point is inverted.
pub fn critical_step(
    force: &mut InternalForce,
    mass: &[f64],
    u: &[Vector3],
    free: impl Fn(usize) -> bool,
    params: LanczosParams,
) -> Result<CriticalStep, ExplicitError> {
    critical_step_touching(force, mass, u, free, &[], params)
}

/// Estimates the critical step as [`critical_step`], for the body with ground `springs` on its surface, which
/// stand for possible contact or for a foundation.
///
/// Forces of dampers lag by half a step, so a mode of frequency `omega` and damping `gamma` of `M^-1 C` is stable
/// for `omega^2 dt^2 + 2 gamma dt <= 4`. The largest `omega` and the largest sum of a row of `M^-1 C` give a lower
/// bound of this step: `4 / (gamma + sqrt(gamma^2 + 4 omega^2))`.
///
/// # Errors
///
/// As [`critical_step`].
pub fn critical_step_touching(
    force: &mut InternalForce,
    mass: &[f64],
    u: &[Vector3],
    free: impl Fn(usize) -> bool,
    springs: &[Springs],
    params: LanczosParams,
) -> Result<CriticalStep, ExplicitError> {
    let LanczosParams { steps, safety } = params;
    if steps == 0 {
        let what = "Lanczos steps";
        return Err(ExplicitError::BadParameter { what, value: 0.0, allowed: "at least 1" });
    }
    if !(safety > 0.0 && safety <= 1.0) {
        let what = "safety factor of the time step";
        return Err(ExplicitError::BadParameter { what, value: safety, allowed: "in (0, 1]" });
    }
    let n = 3 * mass.len();
    let root: Vec<f64> = (0..n).map(|k| mass[k / 3].sqrt()).collect();
    let constrained: Vec<bool> = (0..n).map(|k| !free(k)).collect();
    let reach = force.precision().reach() * force.body().spacing();
    let mut product = Difference {
        force,
        u,
        reach,
        ends: [vec![Vector3::zeros(); u.len()], vec![Vector3::zeros(); u.len()]],
    };
    let mut basis: Vec<Vec<f64>> = vec![noise(n, &constrained)];
    let (mut alpha, mut beta) = (Vec::new(), Vec::new());
    for k in 0..steps {
        let v = &basis[k];
        let scaled: Vec<f64> = v.iter().zip(&root).map(|(v, m)| v / m).collect();
        let mut w = product.stiffness(&scaled)?;
        springs.iter().for_each(|springs| springs.add(&scaled, &mut w));
        for i in 0..n {
            w[i] = if constrained[i] { 0.0 } else { w[i] / root[i] };
        }
        alpha.push(dot(&w, v));
        // Two passes are enough (Parlett): the basis stays orthogonal to rounding.
        for _ in 0..2 {
            for q in &basis {
                let c = dot(&w, q);
                w.iter_mut().zip(q).for_each(|(w, q)| *w -= c * q);
            }
        }
        let length = dot(&w, &w).sqrt();
        let largest = alpha.iter().chain(&beta).fold(0.0f64, |a: f64, b: &f64| a.max(b.abs()));
        if k + 1 == steps || !(length > 1e-9 * largest) {
            break;
        }
        beta.push(length);
        w.iter_mut().for_each(|w| *w /= length);
        basis.push(w);
    }
    let omega_max = largest_eigenvalue(&alpha, &beta).max(0.0).sqrt();
    let mut rates = vec![0.0; mass.len()];
    springs
        .iter()
        .filter(|springs| springs.damping > 0.0)
        .for_each(|springs| springs.add_damping(&mut rates));
    let gamma = rates.iter().zip(mass).map(|(rate, mass)| rate / mass).fold(0.0, f64::max);
    let dt = match gamma > 0.0 {
        true => safety * longest(gamma, omega_max),
        false => safety * 2.0 / omega_max,
    };
    Ok(CriticalStep { dt, omega_max, damping: gamma, steps: alpha.len() })
}

/// Product `K v` by `(f(u + h v) - f(u - h v)) / 2 h`.
struct Difference<'a, 'b> {
    force: &'a mut InternalForce<'b>,
    u: &'a [Vector3],
    reach: f64,
    ends: [Vec<Vector3>; 2],
}

impl Difference<'_, '_> {
    fn stiffness(&mut self, v: &[f64]) -> Result<Vec<f64>, ExplicitError> {
        let largest = v.iter().fold(0.0f64, |a, b| a.max(b.abs()));
        let h = self.reach / largest;
        for (sign, f) in [1.0, -1.0].into_iter().zip(&mut self.ends) {
            let moved: Vec<Vector3> = self
                .u
                .iter()
                .enumerate()
                .map(|(i, u)| u + Vector3::new(v[3 * i], v[3 * i + 1], v[3 * i + 2]) * (sign * h))
                .collect();
            self.force.evaluate(&moved, f)?;
        }
        let [plus, minus] = &self.ends;
        Ok((0..v.len()).map(|k| (plus[k / 3][k % 3] - minus[k / 3][k % 3]) / (2.0 * h)).collect())
    }
}

/// Returns a unit vector of numbers in (-1, 1) by a 64-bit linear congruence (Knuth's MMIX constants), zero
/// at constrained degrees of freedom.
fn noise(n: usize, constrained: &[bool]) -> Vec<f64> {
    let mut state = 1u64;
    let mut v: Vec<f64> = (0..n)
        .map(|k| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            if constrained[k] { 0.0 } else { (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0 }
        })
        .collect();
    let length = dot(&v, &v).sqrt().max(f64::MIN_POSITIVE);
    v.iter_mut().for_each(|v| *v /= length);
    v
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Returns the largest eigenvalue of a symmetric tridiagonal matrix by bisection on the number of negative
/// pivots.
fn largest_eigenvalue(alpha: &[f64], beta: &[f64]) -> f64 {
    let radius = |i: usize| {
        let left = if i > 0 { beta[i - 1].abs() } else { 0.0 };
        left + beta.get(i).filter(|_| i + 1 < alpha.len()).map_or(0.0, |b| b.abs())
    };
    let bounds = |sign: f64| {
        (0..alpha.len()).map(move |i| sign * alpha[i] + radius(i)).fold(f64::NEG_INFINITY, f64::max)
    };
    let (mut low, mut high) = (-bounds(-1.0), bounds(1.0));
    for _ in 0..100 {
        let x = 0.5 * (low + high);
        // All pivots of T - x negative: every eigenvalue lies below x.
        let mut pivot = alpha[0] - x;
        let mut below = pivot < 0.0;
        for i in 1..alpha.len() {
            pivot = alpha[i] - x - beta[i - 1] * beta[i - 1] / pivot;
            below &= pivot < 0.0;
        }
        if below { high = x } else { low = x }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bisection_finds_the_largest_of_a_known_spectrum() {
        // Second differences: 2 - 2 cos(k pi / (n + 1)).
        for n in [1, 2, 7, 20] {
            let found = largest_eigenvalue(&vec![2.0; n], &vec![-1.0; n.saturating_sub(1)]);
            let exact = 2.0 - 2.0 * (n as f64 * std::f64::consts::PI / (n as f64 + 1.0)).cos();
            assert!((found - exact).abs() < 1e-13, "{n}: {found} {exact}");
        }
    }
}

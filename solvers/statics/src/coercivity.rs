//! Distance of Nitsche's form from the loss of positive definiteness.
//!
//! ```text
//! K = M - N,   M(v, v) = a(v, v) + beta |v|^2,   N(v, v) = 2 t(v) . v   on the supports
//! ```
//!
//! With `t(v) . t(v) <= C beta / gamma a(v, v)` the smallest `alpha` of `K v = alpha M v` is
//! `1 - sqrt(C / gamma)`. A Cholesky factor exists for every `alpha > 0`, but errors grow as `1 / alpha`.
//! (Griebel & Schweitzer 2003, A particle-partition of unity method part V; Fritz, Hüeber & Wohlmuth 2004,
//! Calcolo 41, 115.)

use shape::Vector3;

use crate::error::SolveError;
use crate::problem::Pointwise;
use crate::solve::Factored;

/// Steps of the power iteration with `K^-1 M`, whose largest eigenvalue is `1 / alpha`. In critical cases
/// this eigenvalue is well separated from the others.
const STEPS: usize = 12;

impl Factored<'_> {
    /// Returns the smallest stabilisation factor `gamma` of Nitsche's method for which the stiffness is
    /// positive definite (dimensionless, at most the `gamma` in use). The result is `None` without Nitsche
    /// supports, or if all parameters are constrained.
    ///
    /// The factor is `C = gamma (1 - alpha)^2`, where `alpha` is the smallest eigenvalue of `K v = alpha M v`
    /// and `M` is `K` without Nitsche's consistency terms.
    ///
    /// # Errors
    /// The same errors as those of a solution.
    pub fn needed_nitsche_factor(&self) -> Result<Option<f64>, SolveError> {
        let (Some(gamma), Some(forms)) = (self.gamma(), self.forms()) else { return Ok(None) };
        // The start vector is irregular, so that it has a component along every eigenvector.
        let mut v: Vec<Vector3> = (0..self.node_count())
            .map(|i| Vector3::from_fn(|a, _| (12.9898 * i as f64 + 78.233 * a as f64).sin()))
            .collect();
        let mut alpha = 1.0;
        let mut kv = stiff(forms, &v);
        let mut mv = mass(forms, kv.clone(), &v);
        for _ in 0..STEPS {
            // The iterate stays in the space that the supports leave free; the start vector need not lie in
            // this space.
            v = self.inverse_step(v, &kv, &mv, alpha)?;
            let size = v.iter().fold(0.0f64, |l, v| l.max(v.amax()));
            if size == 0.0 {
                return Ok(None);
            }
            v.iter_mut().for_each(|v| *v /= size);
            kv = stiff(forms, &v);
            let over = dot(&v, &kv);
            mv = mass(forms, kv.clone(), &v);
            alpha = over / dot(&v, &mv);
        }
        Ok(Some(gamma * (1.0 - alpha.clamp(0.0, 1.0)).powi(2)))
    }
}

/// Returns `K v`.
fn stiff(forms: &Pointwise, v: &[Vector3]) -> Vec<Vector3> {
    let mut out = vec![Vector3::zeros(); v.len()];
    forms.subtract(v, 0.0, &mut out);
    out.iter_mut().for_each(|f| *f = -*f);
    out
}

/// Returns `M v`, given `K v`.
fn mass(forms: &Pointwise, mut kv: Vec<Vector3>, v: &[Vector3]) -> Vec<Vector3> {
    forms.add_consistency(v, &mut kv);
    kv
}

fn dot(a: &[Vector3], b: &[Vector3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.dot(b)).sum()
}

//! Small free vibrations: `K v = omega^2 M v`.
//!
//! ```text
//! LinearProblem, Mass --modes, lowest_modes--> Modes
//! ```
//!
//! Loads and prescribed values have no effect on the modes. Constraint rows are eliminated, and weak supports
//! act through their stiffness. The body may be free: its rigid motions are modes of frequency zero.

use std::f64::consts::PI;

use algebra::{AlgebraError, FactorError, Symmetric, eigen};
use shape::Vector3;

use crate::body::check_len;
use crate::error::SolveError;
use crate::implicit::Mass;
use crate::problem::{Assembled, LinearProblem, assemble_free};
use crate::reduction::Reduction;

/// Number of unknowns up to which a dense decomposition finds all modes (8 s at this limit). Larger systems
/// are solved for the lowest modes only.
pub const ALL_MODES_LIMIT: usize = 2000;
/// Relative residual of a mode above which the mode is refused. Below, the relative error of its frequency is
/// less than the square of this limit.
const RESIDUAL_LIMIT: f64 = 1e-4;
/// Ratio of `1 / (omega^2 + shift)` to its largest value below which only rounding is left: the motion has no
/// mass.
const MASSLESS: f64 = 1e-11;
/// Ratio of a negative `omega^2` to the shift that rounding does not explain. Rounding left 1e-10 for rigid
/// motions.
const UNSTABLE: f64 = 1e-4;

/// Modes of a body: all of them, or the lowest.
#[derive(Clone, Debug, PartialEq)]
pub struct Modes {
    /// `omega^2` of each mode, ascending, (rad/s)^2. For rigid motions the value is zero to rounding, with
    /// either sign.
    pub squared: Vec<f64>,
    /// Nodal parameters of each mode, with `v^T M v = 1`.
    pub shapes: Vec<Vec<Vector3>>,
    /// `s = mu / rho (pi / L)^2` with the diagonal `L` of the nodes' box, (rad/s)^2: the squared frequency
    /// of a shear wave across the body.
    pub scale: f64,
    /// Largest relative residual `|K v - omega^2 M v| / ((omega^2 + s) |M v|)` of all modes, with `s` from
    /// `scale`.
    pub residual: f64,
    /// Number of unknowns that have stiffness but no mass. Their modes have infinite frequency and are not
    /// among `squared` and `shapes`. The number is 0 if only the lowest modes were computed.
    pub massless: usize,
    /// Number of unknowns of the body.
    pub dofs: usize,
}

impl Modes {
    /// Returns the name of the eigensolver used in records.
    pub fn solver(&self) -> &'static str {
        if self.dofs <= ALL_MODES_LIMIT { "dense-eigen" } else { "block-lanczos" }
    }

    /// Whether these are all modes of the body rather than the lowest only.
    pub fn are_all(&self) -> bool {
        self.squared.len() + self.massless == self.dofs
    }
}

/// Computes all modes of a body by a dense decomposition. No mode is missed; the time grows with the cube of
/// the number of unknowns.
///
/// With `A = K + s M` the problem is written as `M v = theta A v`, `omega^2 = 1 / theta - s`. Neither `M` nor
/// `K` needs to be regular, and the lowest modes are the most exact (the spectral transformation of Ericsson
/// & Ruhe, Math. Comp. 35 (1980) 1251-1268). `s` ([`Modes::scale`]) affects only rounding.
///
/// # Errors
/// Errors of assembly, a stiffness with a negative `omega^2`, or a motion with neither stiffness nor mass.
pub fn modes(problem: &LinearProblem, mass: &Mass) -> Result<Modes, SolveError> {
    found(problem, mass, None)
}

/// Computes at least the `count` lowest modes.
///
/// Up to [`ALL_MODES_LIMIT`] unknowns all modes are computed. Larger systems use block Lanczos
/// ([`eigen::largest`]) with the sparse factor of `A = K + s M`; the time grows as that of one factorisation.
/// Of modes with the same frequency at most eight are found.
///
/// # Errors
/// The errors of [`modes`].
pub fn lowest_modes(problem: &LinearProblem, mass: &Mass, count: usize) -> Result<Modes, SolveError> {
    found(problem, mass, Some(count))
}

fn found(problem: &LinearProblem, mass: &Mass, count: Option<usize>) -> Result<Modes, SolveError> {
    check_len("nodes of the mass", mass.node_count(), problem.body.nodes.len())?;
    let assembled = assemble_free(problem)?;
    let constrained: Vec<Option<f64>> = assembled.prescribed.iter().map(|value| value.map(|_| 0.0)).collect();
    let reduction = Reduction::new(&constrained, &assembled.rows)?;
    let (k, m) = (reduction.matrix(&assembled.stiffness), reduction.matrix(&mass.matrix()));
    let shift = shift(problem, mass);
    let eigen = match count {
        Some(count) if k.dim() > ALL_MODES_LIMIT => eigen::largest(&k, &m, shift, count),
        _ => eigen::shifted(&k, &m, shift),
    };
    let eigen = eigen.map_err(|error| match error {
        FactorError::NotDefinite | FactorError::Other(AlgebraError::NearlySingular { .. }) => {
            indefinite(&assembled, SolveError::NoFrequency)
        }
        FactorError::Other(error) => error.into(),
    })?;
    let least = MASSLESS * eigen.values.first().copied().unwrap_or(0.0);
    let seen = eigen.values.iter().take_while(|&&theta| theta > least);
    let squared: Vec<f64> = seen.map(|theta| 1.0 / theta - shift).collect();
    if squared.first().is_some_and(|&lowest| lowest < -UNSTABLE * shift) {
        return Err(indefinite(&assembled, SolveError::NotPositiveDefinite));
    }
    let mut residual = 0.0f64;
    let mut shapes = Vec::with_capacity(squared.len());
    for (x, &lambda) in eigen.vectors.iter().zip(&squared) {
        let left = left_over(&k, &m, x, lambda, shift);
        // `!(r <= limit)` also rejects NaN.
        if !(left <= RESIDUAL_LIMIT) {
            return Err(AlgebraError::Residual { residual: left, limit: RESIDUAL_LIMIT }.into());
        }
        residual = residual.max(left);
        // x^T (K + s M) x = 1 implies x^T M x = theta.
        let scale = (lambda + shift).sqrt();
        let mut shape = vec![Vector3::zeros(); mass.node_count()];
        reduction.expand(&x.iter().map(|x| x * scale).collect::<Vec<_>>(), &mut shape);
        shapes.push(shape);
    }
    let massless = eigen.values.len() - squared.len();
    Ok(Modes { squared, shapes, scale: shift, residual, massless, dofs: k.dim() })
}

/// Returns the error of an indefinite stiffness, which with Nitsche supports is attributed to their
/// stabilisation.
fn indefinite(assembled: &Assembled, otherwise: SolveError) -> SolveError {
    assembled.gamma.map_or(otherwise, |gamma| SolveError::NotCoercive { gamma })
}

/// Returns the shift `mu / rho (pi / L)^2`, (rad/s)^2.
fn shift(problem: &LinearProblem, mass: &Mass) -> f64 {
    let body = &problem.body;
    let axes = [0, 1, 2].map(|a| body.nodes.iter().map(move |x| x[a]));
    let extent = axes.map(|x| x.clone().fold(f64::MIN, f64::max) - x.fold(f64::MAX, f64::min));
    let square: f64 = extent.iter().map(|e| e * e).sum();
    let volume: f64 = body.volume.weights().iter().sum();
    let total: f64 = mass.times(&vec![Vector3::x(); body.nodes.len()]).iter().map(|p| p.x).sum();
    let mu = body.materials.iter().map(|law| law.mu()).fold(0.0, f64::max);
    mu * volume / total * PI * PI / square
}

fn left_over(k: &Symmetric, m: &Symmetric, x: &[f64], lambda: f64, shift: f64) -> f64 {
    let product = |matrix: &Symmetric| {
        let mut y = vec![0.0; x.len()];
        matrix.subtract_product(x, &mut y);
        y
    };
    let (force, inertia) = (product(k), product(m));
    let rest: f64 = force.iter().zip(&inertia).map(|(f, i)| (f - lambda * i).powi(2)).sum();
    let size: f64 = inertia.iter().map(|i| i * i).sum();
    (rest / size).sqrt() / (lambda + shift)
}

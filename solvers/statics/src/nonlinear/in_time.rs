//! Terms that implicit dynamics adds to the balance of forces: inertia and relaxation.

use shape::{Matrix3, Vector3};

use super::penalty::Rate;
use super::relaxing::Relaxing;
use super::system::SurfaceTable;

/// Terms added by a time step.
#[derive(Clone, Debug)]
pub(crate) struct TimeTerms {
    pub inertia: Option<InertiaTerms>,
    pub relaxing: Option<Relaxing>,
    /// Velocities at the end of the step, for dampers; `None` without dampers.
    pub rate: Option<Rate>,
    /// Stiffness-proportional damping; `None` without.
    pub damping: Option<StiffnessDamping>,
}

/// Stiffness-proportional damping of one step: the force `factor (f(u) - from)` beside the internal force `f(u)`.
///
/// The damping `beta K v` with the tangent `K` of the current state is the rate of the internal forces times
/// `beta`, and their change over a step is `dt` times the mean of this rate.
#[derive(Clone, Debug)]
pub(crate) struct StiffnessDamping {
    /// `beta / dt`, divided as the balance is.
    pub factor: f64,
    /// Internal forces at the start of the step, N.
    pub from: Vec<Vector3>,
}

impl TimeTerms {
    /// Factor by which all terms but the internal forces are multiplied: the balance is divided by the factor of
    /// the internal forces, so that their tangent stays that of statics.
    pub fn beside_internal(terms: Option<&TimeTerms>) -> Option<f64> {
        let damping = terms?.damping.as_ref()?;
        Some(1.0 / (1.0 + damping.factor))
    }
}

/// Inertia and damping of one step of an implicit scheme: the force `carried - M r`. In free degrees of
/// freedom `r = factor (u - from) + settled`, in constrained degrees of freedom `r = settled`, m/s^2.
#[derive(Clone, Debug)]
pub(crate) struct InertiaTerms {
    /// Derivative of `r` with respect to `u`, 1/s^2.
    pub factor: f64,
    /// Displacement at the start of the step, m.
    pub from: Vec<Vector3>,
    /// Value of `r` at the displacement `from`, m/s^2.
    pub settled: Vec<Vector3>,
    /// Contribution of the forces at the start of the step to the balance, N.
    pub carried: Vec<Vector3>,
    /// First guess of the displacement at the end, m.
    pub guess: Vec<Vector3>,
}

/// Nodal forces at the end of a step, N, and the relaxing stresses.
#[derive(Clone, Debug)]
pub(crate) struct Ended {
    /// Forces of loads, of surfaces constrained by penalty or on springs and dampers, and of contact.
    pub external: Vec<Vector3>,
    pub internal: Vec<Vector3>,
    /// Instantaneous deviatoric stress of each point, Pa, to which the Prony series applies; empty for an
    /// elastic body.
    pub deviator: Vec<Matrix3>,
}

impl Ended {
    /// Returns the norm of the external or internal forces, whichever is larger, N.
    pub fn size(&self) -> f64 {
        let norm = |f: &[Vector3]| f.iter().map(Vector3::norm_squared).sum::<f64>().sqrt();
        norm(&self.external).max(norm(&self.internal))
    }
}

impl InertiaTerms {
    /// Adds the force of inertia and damping to `out`: `carried - M r` (N, see [`InertiaTerms`]) at the nodal
    /// parameters `u` (m). A degree of freedom `3 node + axis` is constrained if its entry of `prescribed` is
    /// `Some`; the value is not used.
    ///
    /// Returns the norm of `M settled`, N, as a scale for residuals. `M r` itself is not a scale, because
    /// the two terms of `r` cancel in free flight.
    pub fn add_force(
        &self,
        mass: &SurfaceTable,
        prescribed: &[Option<f64>],
        u: &[Vector3],
        out: &mut [Vector3],
    ) -> f64 {
        let rate: Vec<Vector3> = (0..u.len())
            .map(|i| {
                Vector3::from_fn(|a, _| match prescribed[3 * i + a] {
                    Some(_) => self.settled[i][a],
                    None => self.factor * (u[i][a] - self.from[i][a]) + self.settled[i][a],
                })
            })
            .collect();
        let forces = mass.product(&rate);
        for ((out, force), carried) in out.iter_mut().zip(forces).zip(&self.carried) {
            *out += carried - force;
        }
        mass.product(&self.settled).iter().map(Vector3::norm_squared).sum::<f64>().sqrt()
    }

    /// Returns the tangent `factor w I` of the inertia, N/m, for every point of the mass table.
    pub fn blocks(&self, mass: &SurfaceTable) -> Vec<Matrix3> {
        mass.weights.iter().map(|w| Matrix3::identity() * (self.factor * w)).collect()
    }

    /// Adds the force `factor M moves` (N) of the displacement increments `moves` (m) to `right`.
    pub fn give_back(&self, mass: &SurfaceTable, moves: &[Vector3], right: &mut [Vector3]) {
        for (right, product) in right.iter_mut().zip(mass.product(moves)) {
            *right += product * self.factor;
        }
    }
}

impl SurfaceTable {
    /// Returns `M v` with `M_IJ = sum_q w N_I N_J`.
    pub fn product(&self, v: &[Vector3]) -> Vec<Vector3> {
        let mut out = vec![Vector3::zeros(); v.len()];
        self.add_force(&self.displacement(v), &mut out);
        out
    }
}

//! Tetrahedra of a body whose law is stable neo-Hookean.

use material::{Law, Material as _};
use shape::{Layout, Matrix3, Vector3};

use crate::body::ExplicitBody;
use crate::error::ExplicitError;

/// Tetrahedron with four nodes, one point and the stable neo-Hookean law.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tetrahedron {
    /// The corners.
    pub nodes: [u32; 4],
    /// Gradient of each corner's shape function, 1/m.
    pub grads: [Vector3; 4],
    /// Undeformed volume, m^3.
    pub volume: f64,
    /// Shear modulus, Pa.
    pub mu: f64,
    /// Modulus of the volume change in the energy, Pa.
    pub bulk: f64,
}

impl Tetrahedron {
    /// Displacement gradient `H` (3, 3) at the corners' displacements (m).
    pub fn gradient(&self, u: &[Vector3; 4]) -> Matrix3 {
        (1..4).fold(Matrix3::zeros(), |sum, a| sum + (u[a] - u[0]) * self.grads[a].transpose())
    }
}

/// Cofactors of the deformation gradient `F = I + H`, and its volume change `J - 1`, without cancellation at
/// small strain.
pub(super) fn cofactor(h: &Matrix3) -> (Matrix3, f64) {
    let (a, b, c) = (h.column(0), h.column(1), h.column(2));
    let cof = Matrix3::from_columns(&[b.cross(&c), c.cross(&a), a.cross(&b)]);
    let trace = h.trace();
    let j_minus_1 = trace + cof.trace() + a.dot(&cof.column(0));
    (Matrix3::identity() * (1.0 + trace) - h.transpose() + cof, j_minus_1)
}

/// Returns the tetrahedra of a body.
///
/// # Errors
///
/// [`ExplicitError::NotTetrahedra`] for another table, and [`ExplicitError::OtherLaw`] for another law.
pub(super) fn tetrahedra(body: &ExplicitBody) -> Result<Vec<Tetrahedron>, ExplicitError> {
    body.check()?;
    let volume = body.volume;
    let is_plain = body.groups.is_none() && volume.hourglass().is_none();
    if !matches!(volume.layout(), Layout::LinearTetrahedra) || !is_plain {
        return Err(ExplicitError::NotTetrahedra);
    }
    let of_point = |q: usize| {
        let region = usize::from(body.region(q));
        let Law::StableNeoHookean(law) = &body.laws[region] else {
            return Err(ExplicitError::OtherLaw { region, law: body.laws[region].name() });
        };
        let (nodes, grads) = volume.row(q);
        match (<[u32; 4]>::try_from(nodes), <[Vector3; 4]>::try_from(grads)) {
            (Ok(nodes), Ok(grads)) => {
                let (mu, bulk) = (law.mu(), law.volumetric());
                Ok(Tetrahedron { nodes, grads, volume: volume.weights()[q], mu, bulk })
            }
            _ => Err(ExplicitError::NotTetrahedra),
        }
    };
    (0..volume.weights().len()).map(of_point).collect()
}

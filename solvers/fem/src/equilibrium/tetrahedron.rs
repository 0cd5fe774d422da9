//! Stiffness and stress of one tetrahedron in equilibrium.

use nalgebra::{DMatrix, DVector};
use shape::{Matrix3, Point3, Vector3};

use super::reference::{ENTRIES, FIELDS, REFERENCE, linear_moments};
use crate::error::FemError;

/// Tetrahedron with stress of degree 1 in four parts. Its unknowns are the displacements of the corners of
/// each face, m, by node `3 face + corner`, with faces and corners in ascending order of their corners.
pub struct EquilibriumTet {
    /// Field to square root of the energy: `energy = |root s|^2 / 2`.
    root: DMatrix<f64>,
    /// Upper factor of the flexibility: `upper^T upper = root^T root`, by QR of `root`, which keeps the
    /// digits that the product would lose at a Poisson's ratio near 1/2.
    upper: DMatrix<f64>,
    /// Field to moments of the tractions, N, (36, 30).
    moments: DMatrix<f64>,
}

/// Stress of a cell for given displacements of its faces.
pub struct Response {
    /// Complementary energy of the stress, J.
    pub energy: f64,
    /// Integrals of the traction times the linear function of each corner of each face, N.
    pub moments: [Vector3; 12],
}

/// Integrals of a linear traction times the linear functions of a triangle's corners, N, from its values at
/// the corners (Pa) and the area (m^2).
pub fn face_moments(tractions: &[Vector3; 3], area: f64) -> [Vector3; 3] {
    linear_moments(tractions).map(|moment| moment * area)
}

impl EquilibriumTet {
    /// Creates the element from the corners (m), and the bulk and shear modulus (Pa) of an isotropic
    /// material.
    ///
    /// # Errors
    /// A cell without volume; `element` is its number, for the message.
    pub fn new(
        element: usize,
        corners: &[Point3; 4],
        bulk: f64,
        shear: f64,
    ) -> Result<EquilibriumTet, FemError> {
        let [a, b, c, d] = corners;
        let map = Matrix3::from_columns(&[b - a, c - a, d - a]);
        let det_j = map.determinant().abs();
        let flat = || FemError::InvertedElement { element, det_j };
        // Volume of a part of the reference tetrahedron: 1/24.
        let scale = (1.0 / (24.0 * det_j)).sqrt();
        if !scale.is_finite() {
            return Err(flat());
        }
        let (deviatoric, volumetric) = (scale / (2.0 * shear).sqrt(), scale / (9.0 * bulk).sqrt());
        let mut root = DMatrix::zeros(7 * 16, FIELDS);
        for field in 0..FIELDS {
            for at in 0..16 {
                let of = |i: usize| REFERENCE.stress[(6 * at + i, field)];
                let [xx, yy, zz, yz, xz, xy] = [0, 1, 2, 3, 4, 5].map(of);
                let stress = map * Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz) * map.transpose();
                let mean = stress.trace() / 3.0;
                for (k, (i, j)) in ENTRIES.into_iter().enumerate() {
                    let entry = if i == j { stress[(i, i)] - mean } else { stress[(i, j)] * 2f64.sqrt() };
                    root[(7 * at + k, field)] = deviatoric * entry;
                }
                root[(7 * at + 6, field)] = volumetric * stress.trace();
            }
        }
        let mut moments = REFERENCE.moments.clone();
        for field in 0..FIELDS {
            for node in 0..12 {
                let mut moment = moments.fixed_view_mut::<3, 1>(3 * node, field);
                moment.copy_from(&(map * &moment));
            }
        }
        let upper = root.clone().qr().r();
        if upper.diagonal().iter().any(|&pivot| pivot == 0.0 || !pivot.is_finite()) {
            return Err(flat());
        }
        Ok(EquilibriumTet { root, upper, moments })
    }

    /// Stiffness (36, 36), N/m: moments of the tractions for displacements of the faces.
    pub fn stiffness(&self) -> DMatrix<f64> {
        let half = self.upper.tr_solve_upper_triangular(&self.moments.transpose());
        let half = half.expect("no pivot is zero");
        half.tr_mul(&half)
    }

    /// Stress for displacements of the faces, m.
    pub fn respond(&self, faces: &[Vector3; 12]) -> Response {
        let u = DVector::from_fn(36, |i, _| faces[i / 3][i % 3]);
        let half = self.upper.tr_solve_upper_triangular(&self.moments.tr_mul(&u)).expect("no pivot is zero");
        let field = self.upper.solve_upper_triangular(&half).expect("no pivot is zero");
        let moments = &self.moments * &field;
        Response {
            energy: (&self.root * &field).norm_squared() / 2.0,
            moments: std::array::from_fn(|i| moments.fixed_rows::<3>(3 * i).into_owned()),
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::reference::FACES;
    use super::*;

    fn tetrahedra() -> impl Strategy<Value = [Point3; 4]> {
        let corner = || prop::array::uniform3(-1.0..1.0f64).prop_map(Point3::from);
        let volume = |[a, b, c, d]: &[Point3; 4]| (b - a).cross(&(c - a)).dot(&(d - a)).abs();
        [corner(), corner(), corner(), corner()].prop_filter("has a volume", move |x| volume(x) > 0.05)
    }

    /// Values of a field at the corners of the faces.
    fn on_faces(x: &[Point3; 4], u: impl Fn(&Point3) -> Vector3) -> [Vector3; 12] {
        std::array::from_fn(|i| u(&x[FACES[i / 3][i % 3]]))
    }

    proptest! {
        #[test]
        fn only_rigid_motions_are_free_of_stress(x in tetrahedra(), nu in 0.0..0.4999f64) {
            let (bulk, shear) = (1.0 / (3.0 * (1.0 - 2.0 * nu)), 0.5 / (1.0 + nu));
            let tet = EquilibriumTet::new(0, &x, bulk, shear).unwrap();
            let stiffness = tet.stiffness();
            let scale = stiffness.amax();
            prop_assert!((&stiffness - stiffness.transpose()).amax() <= 1e-12 * scale);
            let values = stiffness.symmetric_eigenvalues();
            prop_assert!(values.iter().all(|value| *value > -1e-12 * scale));
            prop_assert_eq!(values.iter().filter(|value| value.abs() < 1e-9 * shear).count(), 6);
            let turned = on_faces(&x, |x| Vector3::new(0.3, -0.2, 0.5) + Vector3::new(1.0, 2.0, -1.0).cross(&x.coords));
            prop_assert!(tet.respond(&turned).energy < 1e-20 * scale);
        }

        #[test]
        fn tractions_balance_and_a_uniform_strain_has_its_energy(x in tetrahedra(), nu in 0.0..0.4999f64,
            u in prop::array::uniform12(prop::array::uniform3(-1.0..1.0f64)),
        ) {
            let (bulk, shear) = (1.0 / (3.0 * (1.0 - 2.0 * nu)), 0.5 / (1.0 + nu));
            let tet = EquilibriumTet::new(0, &x, bulk, shear).unwrap();
            let Response { moments, .. } = tet.respond(&u.map(Vector3::from));
            let size: f64 = moments.iter().map(|m| m.norm()).sum();
            let force: Vector3 = moments.iter().sum();
            let moment: Vector3 = (0..12).map(|i| x[FACES[i / 3][i % 3]].coords.cross(&moments[i])).sum();
            prop_assert!(force.norm() <= 1e-12 * size && moment.norm() <= 1e-12 * size);
            let h = Matrix3::new(1.0, 0.5, 0.0, 0.5, -0.3, 0.2, 0.0, 0.2, 0.4);
            let volume = (x[1] - x[0]).cross(&(x[2] - x[0])).dot(&(x[3] - x[0])).abs() / 6.0;
            let deviator = h - Matrix3::identity() * (h.trace() / 3.0);
            let energy = volume * (shear * deviator.norm_squared() + bulk * h.trace().powi(2) / 2.0);
            let found = tet.respond(&on_faces(&x, |x| h * x.coords)).energy;
            prop_assert!((found - energy).abs() <= 1e-9 * energy, "{} {}", found, energy);
        }
    }
}

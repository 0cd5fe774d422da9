//! Hourglass control: the energy of deformations that the single point of a hexahedron does not see.
//!
//! A hexahedron with the mean of its strain alone has twelve motions besides those with constant strain: four
//! alternating patterns for each component. With the base vectors `Gamma_m` of the patterns and the mean
//! gradients `b_a`, their amplitudes are
//!
//! ```text
//! q_m = sum_a gamma_ma u_a,   gamma_ma = Gamma_ma - X_m . b_a,   X_m = sum_a Gamma_ma x_a
//!     = sum_a Gamma_ma u_a - H X_m,   H = sum_a u_a b_a^T
//! ```
//!
//! so no linear displacement has an amplitude, whatever the shape of the cell (Flanagan & Belytschko, Int. J.
//! Numer. Meth. Engng 17 (1981) 679-706). The energy `k / 2 sum_m |q_m|^2` in the reference configuration is
//! quadratic: its forces are linear and its stiffness is constant (Joldes, Wittek & Miller, Commun. Numer. Meth.
//! Engng 24 (2008) 1315-1323). A rotation leaves `q_m` of the undeformed cell at zero, because it is a linear
//! displacement.

use crate::rows::ShapeError;
use crate::{Matrix3, Vector3};

/// Number of patterns of a hexahedron.
pub const HOURGLASS_MODES: usize = 4;

/// Base vectors `Gamma_m` of the patterns, (mode, node): `xi eta`, `eta zeta`, `xi zeta` and `xi eta zeta` at
/// the corners of the cube `[-1, 1]^3`, in the node order of the hexahedron.
pub const HOURGLASS: [[f64; 8]; HOURGLASS_MODES] = [
    [1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0],
    [1.0, 1.0, -1.0, -1.0, -1.0, -1.0, 1.0, 1.0],
    [1.0, -1.0, -1.0, 1.0, -1.0, 1.0, 1.0, -1.0],
    [-1.0, 1.0, -1.0, 1.0, 1.0, -1.0, 1.0, -1.0],
];

/// Modulus of the undeformed material that the stiffness of hourglass control is proportional to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HourglassModulus {
    /// The P-wave modulus `lambda + 2 mu`: a fraction of the largest stiffness of the cell.
    PWave,
    /// The shear modulus `mu`, which does not grow with the bulk modulus.
    Shear,
}

/// Hourglass control of hexahedra with one point each.
#[derive(Clone, Debug, PartialEq)]
pub struct Hourglass {
    modulus: HourglassModulus,
    moments: Vec<[Vector3; HOURGLASS_MODES]>,
    lengths: Vec<f64>,
}

impl Hourglass {
    /// Builds the control of cells from their `moments` `X_m` (m) and the stiffness per `modulus`, `lengths` (m),
    /// one entry per cell.
    ///
    /// # Errors
    /// Lists of unequal length, a moment that is not finite, or a length that is negative or not finite.
    pub fn new(
        modulus: HourglassModulus,
        moments: Vec<[Vector3; HOURGLASS_MODES]>,
        lengths: Vec<f64>,
    ) -> Result<Hourglass, ShapeError> {
        if lengths.len() != moments.len() {
            let (found, expected) = (lengths.len(), moments.len());
            return Err(ShapeError::Length { what: "stiffnesses of hourglass control", found, expected });
        }
        let finite = |moments: &[Vector3; HOURGLASS_MODES]| moments.iter().flatten().all(|x| x.is_finite());
        if let Some(row) = moments.iter().position(|moments| !finite(moments)) {
            return Err(ShapeError::NotFinite { what: "hourglass moment", row });
        }
        match lengths.iter().position(|&length| !(length >= 0.0 && length.is_finite())) {
            Some(row) => Err(ShapeError::BadWeight { row, weight: lengths[row] }),
            None => Ok(Hourglass { modulus, moments, lengths }),
        }
    }

    /// Moments `X_m` of a cell, m.
    pub fn moments(&self, cell: usize) -> &[Vector3; HOURGLASS_MODES] {
        &self.moments[cell]
    }

    /// Returns the stiffness `k` of a cell (N/m), whose material has the Lame moduli `lambda` and `mu`, Pa.
    pub fn stiffness(&self, cell: usize, [lambda, mu]: [f64; 2]) -> f64 {
        self.lengths[cell]
            * match self.modulus {
                HourglassModulus::PWave => lambda + 2.0 * mu,
                HourglassModulus::Shear => mu,
            }
    }

    /// Number of cells.
    pub fn len(&self) -> usize {
        self.lengths.len()
    }

    /// Whether there are no cells.
    pub fn is_empty(&self) -> bool {
        self.lengths.is_empty()
    }

    /// Returns the rows `gamma_m` of a cell, (mode, node), from its mean gradients (1/m).
    pub(crate) fn vectors(&self, cell: usize, grads: &[Vector3]) -> [[f64; 8]; HOURGLASS_MODES] {
        std::array::from_fn(|m| {
            std::array::from_fn(|a| HOURGLASS[m][a] - self.moments[cell][m].dot(&grads[a]))
        })
    }

    /// Returns the amplitudes `q_m` of a cell, m. Displacements count relative to those of the first node, so
    /// that a large translation leaves no rounding.
    pub(crate) fn amplitudes(
        &self,
        cell: usize,
        (nodes, grads): (&[u32], &[Vector3]),
        u: &[Vector3],
    ) -> [Vector3; HOURGLASS_MODES] {
        let first = u[nodes[0] as usize];
        let mut h = Matrix3::zeros();
        let mut q = [Vector3::zeros(); HOURGLASS_MODES];
        for (a, (&node, g)) in nodes.iter().zip(grads).enumerate() {
            let d = u[node as usize] - first;
            h += d * g.transpose();
            q.iter_mut().zip(&HOURGLASS).for_each(|(q, base)| *q += d * base[a]);
        }
        std::array::from_fn(|m| q[m] - h * self.moments[cell][m])
    }
}

#[cfg(test)]
mod tests {
    use geometry::element::HEX_CORNERS;

    use super::*;

    #[test]
    fn patterns_are_products_of_the_corners_and_orthogonal_to_linear_fields() {
        for (a, [x, y, z]) in HEX_CORNERS.into_iter().enumerate() {
            assert_eq!(HOURGLASS.map(|base| base[a]), [x * y, y * z, x * z, x * y * z]);
        }
        for base in HOURGLASS {
            assert_eq!(base.iter().sum::<f64>(), 0.0);
            for axis in 0..3 {
                assert_eq!(base.iter().zip(HEX_CORNERS).map(|(g, x)| g * x[axis]).sum::<f64>(), 0.0);
            }
        }
    }

    #[test]
    fn unsound_numbers_are_refused() {
        let sound = [Vector3::x(); HOURGLASS_MODES];
        let mut broken = sound;
        broken[2].y = f64::NAN;
        assert!(matches!(
            Hourglass::new(HourglassModulus::Shear, vec![sound], vec![]),
            Err(ShapeError::Length { .. })
        ));
        assert!(matches!(
            Hourglass::new(HourglassModulus::Shear, vec![broken], vec![1.0]),
            Err(ShapeError::NotFinite { row: 0, .. })
        ));
        for length in [-1.0, f64::NAN, f64::INFINITY] {
            let found = Hourglass::new(HourglassModulus::Shear, vec![sound], vec![length]);
            assert!(matches!(found, Err(ShapeError::BadWeight { row: 0, .. })), "{found:?}");
        }
        let control = Hourglass::new(HourglassModulus::Shear, vec![sound], vec![0.5]).unwrap();
        assert_eq!((control.len(), control.stiffness(0, [100.0, 8.0])), (1, 4.0));
        let control = Hourglass { modulus: HourglassModulus::PWave, ..control };
        assert_eq!(control.stiffness(0, [100.0, 8.0]), 58.0);
    }
}

//! Homogeneous states at finite strain: free-slip compression, confined compression, simple shear.
//!
//! ```text
//! Source      Ogden, Non-linear Elastic Deformations (1984), ch. 2.2 and 4.4.
//!
//!    free slip                confined              simple shear
//!   === plate ===          |=== plate ===|              .-------.
//!     |       |            |             |             /       /  -> g h
//!     |       | h l        |             | h l        /       /  h
//!   ===       ===          |=============|           '-------'
//!   F = diag(m, m, l)      F = diag(1, 1, l)        F = I + g e_x e_y^T
//!   P_xx(m, m, l) = 0
//!
//! Conditions  plates without friction; sides free or on frictionless walls; for shear the displacement or
//!             the tractions P N of all faces, whose normal parts are unequal (Poynting's effect).
//! Must hold   every consistent method returns F and P to rounding on any mesh; the plate's force is P_zz
//!             times the undeformed area.
//! ```

use catalogue::{Dimension, Entry, Parameter, Problem, Range};

use super::hyperelastic::Hyperelastic;
use super::solution::{Exact, SolutionEntry};
use super::vectors::{Matrix3, Point3, Vector3};

/// A state with one deformation gradient everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Homogeneous {
    /// `F` (3, 3), dimensionless.
    pub deformation: Matrix3,
    /// First Piola-Kirchhoff stress `P` (3, 3), Pa.
    pub stress: Matrix3,
}

impl Homogeneous {
    /// Compression or extension by the axial stretch `l > 0` along z between frictionless plates, with free
    /// sides. The lateral stretch `m` makes the stress of the sides vanish; it is bracketed between 1/16 and
    /// 16 and bisected to the last digit. `None` if there is no such stretch: Saint Venant-Kirchhoff bars
    /// have no width from `l^2 = 1 + 1 / nu` on.
    pub fn free_slip(law: &Hyperelastic, stretch: f64) -> Option<Homogeneous> {
        let side = |m: f64| law.principal_stress([m, m, stretch])[0];
        let (mut low, mut high) = (0.0625, 16.0);
        if !(side(low) < 0.0 && side(high) > 0.0) {
            return None;
        }
        while {
            let middle = 0.5 * (low + high);
            middle > low && middle < high
        } {
            let middle = 0.5 * (low + high);
            if side(middle) < 0.0 { low = middle } else { high = middle }
        }
        let stress = Vector3::new(0.0, 0.0, law.principal_stress([low, low, stretch])[2]);
        Some(Homogeneous {
            deformation: Matrix3::from_diagonal(&Vector3::new(low, low, stretch)),
            stress: Matrix3::from_diagonal(&stress),
        })
    }

    /// Compression or extension by the axial stretch `l > 0` along z between walls that fix x and y.
    pub fn confined(law: &Hyperelastic, stretch: f64) -> Homogeneous {
        Homogeneous {
            deformation: Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, stretch)),
            stress: Matrix3::from_diagonal(&law.principal_stress([1.0, 1.0, stretch]).into()),
        }
    }

    /// Simple shear `g` of planes of constant y along x.
    pub fn simple_shear(law: &Hyperelastic, shear: f64) -> Homogeneous {
        let mut deformation = Matrix3::identity();
        deformation[(0, 1)] = shear;
        Homogeneous { deformation, stress: law.stress(&deformation) }
    }
}

impl Exact for Homogeneous {
    fn displacement(&self, x: &Point3) -> Vector3 {
        self.gradient(x) * x.coords
    }

    fn gradient(&self, _x: &Point3) -> Matrix3 {
        self.deformation - Matrix3::identity()
    }

    /// Cauchy stress `P F^T / J`, Pa.
    fn stress(&self, _x: &Point3) -> Matrix3 {
        self.stress * self.deformation.transpose() / self.deformation.determinant()
    }

    fn traction(&self, _x: &Point3, normal: &Vector3) -> Vector3 {
        self.stress * normal
    }

    fn is_large_strain(&self) -> bool {
        true
    }
}

const STRETCH: Parameter =
    Parameter::required("stretch", Dimension::None, "ratio of deformed to undeformed length along z")
        .within(Range::Within(0.1, 10.0));

pub(super) const FREE_SLIP: SolutionEntry = Entry {
    name: "free-slip-stretch",
    meaning: "a prism compressed or stretched along z at large strain, with free sides",
    source: "Ogden, Non-linear Elastic Deformations (1984), ch. 2.2 and 4.4",
    parameters: &[STRETCH],
    build: |medium, values| {
        let state = Homogeneous::free_slip(medium.hyperelastic()?, values.number("stretch")?);
        let none = || Problem::new("leaves the bar with no positive width under this law").of("stretch");
        Ok(Box::new(state.ok_or_else(none)?))
    },
};

pub(super) const CONFINED: SolutionEntry = Entry {
    name: "confined-stretch",
    meaning: "a prism compressed or stretched along z at large strain, constrained along x and y",
    source: "Ogden, Non-linear Elastic Deformations (1984), ch. 2.2 and 4.4",
    parameters: &[STRETCH],
    build: |medium, values| {
        Ok(Box::new(Homogeneous::confined(medium.hyperelastic()?, values.number("stretch")?)))
    },
};

pub(super) const SIMPLE_SHEAR: SolutionEntry = Entry {
    name: "simple-shear",
    meaning: "planes of constant y sheared along x at large strain",
    source: "Ogden, Non-linear Elastic Deformations (1984), ch. 2.2 and 4.4",
    parameters: &[Parameter::required("shear", Dimension::None, "displacement along x per length along y")
        .within(Range::Within(-10.0, 10.0))],
    build: |medium, values| {
        Ok(Box::new(Homogeneous::simple_shear(medium.hyperelastic()?, values.number("shear")?)))
    },
};

//! End-loaded cantilever as plane strain between two symmetry planes: an exact cubic in three dimensions.
//!
//! ```text
//! Source      Timoshenko & Goodier, Theory of Elasticity, bending of a cantilever loaded at the end;
//!             displacement in the form of Augarde & Deeks (2008), with E' = E / (1 - nu^2) and
//!             nu' = nu / (1 - nu) for plane strain.
//!
//!   y                                        ^ P (N per metre of width), parabolic shear
//!   |//+-------------------------------------+
//!   +//|- - - - - - - - - - - - - - - - - - -|--- x        depth D, length L, I = D^3 / 12
//!    //+-------------------------------------+
//!      x = 0                               x = L           u_z = 0 on the two planes of constant z
//!
//! Field       u_x = -P y / (6 E' I) ((6 L - 3 x) x + (2 + nu') (y^2 - D^2/4)),
//!             u_y =  P / (6 E' I) (3 nu' y^2 (L - x) + (4 + 5 nu') D^2 x / 4 + (3 L - x) x^2),   u_z = 0,
//!             sigma_xx = -P (L - x) y / I,  sigma_xy = P (D^2/4 - y^2) / (2 I),  sigma_zz = nu sigma_xx.
//! Conditions  exact displacement on x = 0; exact shear on x = L; y = +-D/2 free; u_z = 0 (free slip) on both
//!             z faces.
//! Must hold   zero traction on y = +-D/2, end shear of resultant P and no moment; any width; nu < 0.5. At
//!             the root the displacement is not zero but given by the formula: clamping it instead adds a
//!             singular corner.
//! ```

use catalogue::{Dimension, Entry, Parameter};

use super::elastic::Elastic;
use super::error::ExactError;
use super::solution::{Exact, SolutionEntry, numbers};
use super::vectors::{Matrix3, Point3, Vector3};

/// Timoshenko's cantilever, bending in the x-y plane, plane strain in z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CantileverPlaneStrain {
    elastic: Elastic,
    load: f64,
    length: f64,
    depth: f64,
}

impl CantileverPlaneStrain {
    /// A cantilever under the tip load `P` along +y (N per metre of width), with length `L` and depth `D`
    /// (m).
    ///
    /// # Errors
    ///
    /// A length or depth that is not positive.
    pub fn new(elastic: Elastic, load: f64, length: f64, depth: f64) -> Result<Self, ExactError> {
        for (name, value) in [("length", length), ("depth", depth)] {
            if !(value > 0.0 && value.is_finite()) {
                let need = "above zero".into();
                return Err(ExactError::BadParameter { solution: ENTRY.name, name, value, need });
            }
        }
        Ok(CantileverPlaneStrain { elastic, load, length, depth })
    }

    /// `D^3 / 12`, m^3: second moment of area per metre of width.
    fn inertia(&self) -> f64 {
        self.depth.powi(3) / 12.0
    }

    /// `P / (6 E' I)` (1/m^2) and `nu'`.
    fn plane_strain(&self) -> (f64, f64) {
        let nu = self.elastic.poisson();
        let young = self.elastic.young() / (1.0 - nu * nu);
        (self.load / (6.0 * young * self.inertia()), nu / (1.0 - nu))
    }
}

impl Exact for CantileverPlaneStrain {
    fn displacement(&self, p: &Point3) -> Vector3 {
        let x = p.x;
        let y = p.y;
        let l = self.length;
        let quarter = 0.25 * self.depth * self.depth;
        let (scale, nu) = self.plane_strain();
        let ux = -y * ((6.0 * l - 3.0 * x) * x + (2.0 + nu) * (y * y - quarter));
        let uy = 3.0 * nu * y * y * (l - x) + (4.0 + 5.0 * nu) * quarter * x + (3.0 * l - x) * x * x;
        scale * Vector3::new(ux, uy, 0.0)
    }

    fn gradient(&self, p: &Point3) -> Matrix3 {
        let x = p.x;
        let y = p.y;
        let l = self.length;
        let quarter = 0.25 * self.depth * self.depth;
        let (scale, nu) = self.plane_strain();
        let mut h = Matrix3::zeros();
        h[(0, 0)] = -6.0 * y * (l - x);
        h[(0, 1)] = -((6.0 * l - 3.0 * x) * x + (2.0 + nu) * (3.0 * y * y - quarter));
        h[(1, 0)] = -3.0 * nu * y * y + (4.0 + 5.0 * nu) * quarter + 6.0 * l * x - 3.0 * x * x;
        h[(1, 1)] = 6.0 * nu * y * (l - x);
        scale * h
    }

    /// Cauchy stress, Pa, in closed form: Hooke's law loses digits as nu nears 0.5.
    fn stress(&self, p: &Point3) -> Matrix3 {
        let inertia = self.inertia();
        let axial = -self.load * (self.length - p.x) * p.y / inertia;
        let shear = self.load * (0.25 * self.depth * self.depth - p.y * p.y) / (2.0 * inertia);
        let lateral = self.elastic.poisson() * axial;
        Matrix3::new(axial, shear, 0.0, shear, 0.0, 0.0, 0.0, 0.0, lateral)
    }
}

pub(super) const ENTRY: SolutionEntry = Entry {
    name: "cantilever-plane-strain",
    meaning: "a cantilever under an end load along y, in plane strain",
    source: "Timoshenko and Goodier, Theory of Elasticity, article 21",
    parameters: &[
        Parameter::required("load", Dimension::LineForce, "end load along y per metre of width"),
        Parameter::required("length", Dimension::Length, "length along x, from 0"),
        Parameter::required("depth", Dimension::Length, "depth along y, centred on 0"),
    ],
    build: |medium, values| {
        let [load, length, depth] = numbers(values, ["load", "length", "depth"])?;
        Ok(Box::new(CantileverPlaneStrain::new(medium.elastic, load, length, depth)?))
    },
};

//! Saint-Venant's torsion of a rectangular bar.
//!
//! ```text
//! Source      Saint-Venant (1855); Timoshenko & Goodier, Theory of Elasticity, torsion of rectangular bars.
//!
//!   y                                               y
//!   +-----------------------------------------+   +--|--+  2a = depth
//!   |- - - - - - - - - - - - - - - - - - - - -|x  |  +--|-- z   the section at x turns by k x about the axis
//!   +-----------------------------------------+   +-----+
//!   x = 0                                          2b = width
//!
//! Field       u_x = k (psi(y, z) - y z),  u_y = -k x z,  u_z = k x y;
//!             sigma_xy = mu k (psi_y - 2 z),  sigma_xz = mu k psi_z,  all others 0.
//! Warping     lap psi = 0  with  psi_y = 2 z on y = +-a  and  psi_z = 0 on z = +-b:
//!             psi = 32 b^2/pi^3 sum_m i^(m-1)/m^3 sinh(m pi y/2b) / cosh(m pi a/2b) sin(m pi z/2b),
//!             m = 1, 3, 5, ...
//! Conditions  exact displacement on x = 0, exact shear traction on the other end (a torque alone), the four
//!             sides free, no body force.
//! Must hold   lateral tractions vanish, the volume stays, any nu; a square has the torque 0.1406 mu k
//!             (2a)^4.
//! ```
//!
//! The series is not truncated. With `1 / cosh` expanded in images of the section, each image is a
//! polylogarithm in closed form, as in [`super::SaintVenantFlexure`].

use std::f64::consts::{FRAC_PI_2, PI};

use catalogue::{Dimension, Entry, Parameter};

use super::elastic::Elastic;
use super::error::ExactError;
use super::polylog::{Complex, alternating_2, alternating_3};
use super::solution::{Exact, SolutionEntry, numbers};
use super::vectors::{Matrix3, Point3, Vector3};

/// Smallest depth to width ratio: the number of images grows as `12 width / depth`, so that 1/50 needs about
/// 600.
const FLATTEST: f64 = 0.02;

/// A bar along x, its axis through the origin, whose sections turn in proportion to x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torsion {
    elastic: Elastic,
    /// Angle per length, rad/m.
    twist: f64,
    /// Half depth (y) and half width (z), m.
    half: [f64; 2],
    images: u32,
}

impl Torsion {
    /// A bar with the given angle per length (rad/m), full depth along y and full width along z (m).
    ///
    /// # Errors
    ///
    /// A size that is not positive, or a depth below 0.02 of the width.
    pub fn new(elastic: Elastic, twist: f64, [depth, width]: [f64; 2]) -> Result<Torsion, ExactError> {
        for (name, value) in [("depth", depth), ("width", width)] {
            if !(value > 0.0 && value.is_finite()) {
                let need = "above zero".into();
                return Err(ExactError::BadParameter { solution: ENTRY.name, name, value, need });
            }
        }
        if depth < FLATTEST * width {
            let need = format!("at least {FLATTEST} of the width of {width} m");
            return Err(ExactError::BadParameter { solution: ENTRY.name, name: "depth", value: depth, need });
        }
        let images = (38.0 * width / (PI * depth)).ceil() as u32;
        Ok(Torsion { elastic, twist, half: [0.5 * depth, 0.5 * width], images })
    }

    /// `sum_j (-1)^j S(s_j, t)` over the images above and below the section, with `s_j = pi (a (2j + 1) -+ y)
    /// / 2b` and `t = pi z / 2b`. `S(s, t) = sum_m i^(m-1) m^-p e^(-m s) e^(i m t)` is the odd part of the
    /// alternating sum over all m.
    fn images(&self, y: f64, z: f64, alternating: impl Fn(f64, f64) -> Complex) -> (Complex, Complex) {
        let [a, b] = self.half;
        let t = FRAC_PI_2 * z / b;
        let image = |distance: f64| {
            let s = FRAC_PI_2 * distance / b;
            (alternating(s, t - FRAC_PI_2) - alternating(s, t + FRAC_PI_2)) / Complex::new(0.0, 2.0)
        };
        (0..=self.images).rev().fold((Complex::ZERO, Complex::ZERO), |(above, below), j| {
            let centre = a * f64::from(2 * j + 1);
            (image(centre - y) - above, image(centre + y) - below)
        })
    }

    /// Warping `psi`, m^2.
    fn warping(&self, y: f64, z: f64) -> f64 {
        let (above, below) = self.images(y, z, alternating_3);
        32.0 * self.half[1] * self.half[1] / (PI * PI * PI) * (above - below).im
    }

    /// Slopes of the warping, `(d psi/dy, d psi/dz)`, m.
    fn warping_slope(&self, y: f64, z: f64) -> (f64, f64) {
        let (above, below) = self.images(y, z, alternating_2);
        let factor = 16.0 * self.half[1] / (PI * PI);
        (factor * (above + below).im, factor * (above - below).re)
    }
}

impl Exact for Torsion {
    fn displacement(&self, p: &Point3) -> Vector3 {
        self.twist * Vector3::new(self.warping(p.y, p.z) - p.y * p.z, -p.x * p.z, p.x * p.y)
    }

    fn gradient(&self, p: &Point3) -> Matrix3 {
        let (psi_y, psi_z) = self.warping_slope(p.y, p.z);
        #[rustfmt::skip]
        let h = Matrix3::new(
             0.0, psi_y - p.z, psi_z - p.y,
            -p.z, 0.0,        -p.x,
             p.y, p.x,         0.0,
        );
        self.twist * h
    }

    fn stress(&self, p: &Point3) -> Matrix3 {
        let (psi_y, psi_z) = self.warping_slope(p.y, p.z);
        let shear = self.elastic.mu() * self.twist;
        let (xy, xz) = (shear * (psi_y - 2.0 * p.z), shear * psi_z);
        Matrix3::new(0.0, xy, xz, xy, 0.0, 0.0, xz, 0.0, 0.0)
    }
}

pub(super) const ENTRY: SolutionEntry = Entry {
    name: "torsion",
    meaning: "torsion of a bar of rectangular section along x, with free warping",
    source: "Timoshenko and Goodier, Theory of Elasticity, torsion of rectangular bars",
    parameters: &[
        Parameter::required("twist", Dimension::Curvature, "angle of twist (rad) per unit length"),
        Parameter::required("depth", Dimension::Length, "depth of the section along y, centred on 0"),
        Parameter::required("width", Dimension::Length, "width of the section along z, centred on 0"),
    ],
    build: |medium, values| {
        let [twist, depth, width] = numbers(values, ["twist", "depth", "width"])?;
        Ok(Box::new(Torsion::new(medium.elastic, twist, [depth, width])?))
    },
};

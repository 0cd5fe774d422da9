//! Saint-Venant's flexure of a rectangular bar: the true three-dimensional end-loaded cantilever.
//!
//! ```text
//! Source      Saint-Venant (1856); Love, A Treatise on the Mathematical Theory of Elasticity, ch. XV;
//!             Timoshenko & Goodier, Theory of Elasticity, bending of bars, rectangular cross-section.
//!
//!   y                                            ^ P          y
//!   |//+-----------------------------------------+         +--|--+  2a = depth
//!   +//|- - - - - - - - - - - - - - - - - - - - -|--- x    |  +--|-- z
//!    //+-----------------------------------------+         +-----+
//!      x = 0                                   x = L        2b = width,  I = 2b (2a)^3 / 12,  k = P / (E I)
//!
//! Field       u_x = -k y (L x - x^2/2) + k chi(y, z),
//!             u_y =  k (nu/2 (L - x)(y^2 - z^2) + L x^2/2 - x^3/6),
//!             u_z =  k nu (L - x) y z;
//!             sigma_xx = -P (L - x) y / I,  sigma_yy = sigma_zz = sigma_yz = 0,
//!             sigma_xy = mu k (chi_y - nu/2 (y^2 - z^2)),  sigma_xz = mu k (chi_z - nu y z).
//! Warping     lap chi = -2 y  with  chi_y = nu/2 (y^2 - z^2) on y = +-a  and  chi_z = nu y z on z = +-b:
//!             chi = ((1 + nu) a^2 - nu b^2/3) y - (2 + nu) y^3/6 + nu y z^2/2
//!                   - 4 nu b^3/pi^3 sum_n (-1)^n/n^3 sinh(n pi y/b) / cosh(n pi a/b) cos(n pi z/b).
//! Conditions  exact displacement on x = 0, exact shear traction on x = L (resultant P along +y, no moment,
//!             zero normal part), the four sides free, no body force.
//! Rigid part  u = 0, d(u_y)/dx = 0 and no twist at the centroid of the root: the axis leaves the root
//!             horizontally. The section there still turns by shear, d(u_x)/dy = k chi_y(0, 0), and warps.
//! Must hold   lateral tractions vanish; strains obey Hooke's law with three normal stresses, of which two
//!             are zero; any nu. At the four corner lines of the bar the second derivatives of chi have a
//!             logarithmic singularity.
//! ```
//!
//! The series is not truncated. With `1 / cosh` expanded in images of the section, each image is a
//! polylogarithm in closed form, and each further image is smaller by `exp(-2 pi a/b)`. Displacement,
//! gradient and stress are exact to rounding up to and on faces, edges and corners.

use std::f64::consts::PI;

use catalogue::{Dimension, Entry, Parameter};

use super::elastic::Elastic;
use super::error::ExactError;
use super::polylog::{Complex, alternating_2, alternating_3};
use super::solution::{Exact, SolutionEntry, numbers};
use super::vectors::{Matrix3, Point3, Vector3};

/// Smallest depth to width ratio: the number of images grows as `6 width / depth`, so that 1/50 needs about
/// 300.
const FLATTEST: f64 = 0.02;

/// Cantilever of rectangular section along x, root at x = 0, axis through the origin, loaded along y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SaintVenantFlexure {
    elastic: Elastic,
    length: f64,
    /// Half depth (y) and half width (z), m.
    half: [f64; 2],
    /// `k = P / (E I)`, 1/m^2.
    scale: f64,
    images: u32,
}

impl SaintVenantFlexure {
    /// A bar under the end load `P` along +y (N), with length along x, full depth along y and full width
    /// along z (m).
    ///
    /// # Errors
    ///
    /// A size that is not positive, or a depth below 0.02 of the width.
    pub fn new(
        elastic: Elastic,
        load: f64,
        length: f64,
        [depth, width]: [f64; 2],
    ) -> Result<SaintVenantFlexure, ExactError> {
        for (name, value) in [("length", length), ("depth", depth), ("width", width)] {
            if !(value > 0.0 && value.is_finite()) {
                let need = "above zero".into();
                return Err(ExactError::BadParameter { solution: ENTRY.name, name, value, need });
            }
        }
        if depth < FLATTEST * width {
            let need = format!("at least {FLATTEST} of the width of {width} m");
            return Err(ExactError::BadParameter { solution: ENTRY.name, name: "depth", value: depth, need });
        }
        let inertia = width * depth.powi(3) / 12.0;
        let images = (38.0 * width / (2.0 * PI * depth)).ceil() as u32;
        let half = [0.5 * depth, 0.5 * width];
        Ok(SaintVenantFlexure { elastic, length, half, scale: load / (elastic.young() * inertia), images })
    }

    /// `sum_m (-1)^m L(s_m, t)` over the images above (`s_m = pi (a (2m + 1) - y) / b`) and below (`+ y`) the
    /// section, with `t = pi z / b`. Their difference is the series of `sinh / cosh`, their sum the series of
    /// `cosh / cosh`.
    fn images(&self, y: f64, z: f64, term: impl Fn(f64, f64) -> Complex) -> (Complex, Complex) {
        let [a, b] = self.half;
        (0..=self.images).rev().fold((Complex::ZERO, Complex::ZERO), |(above, below), m| {
            let centre = a * f64::from(2 * m + 1);
            let image = |distance: f64| term(PI * distance / b, PI * z / b);
            (image(centre - y) - above, image(centre + y) - below)
        })
    }

    /// Warping `chi`, m^3.
    fn warping(&self, y: f64, z: f64) -> f64 {
        let [a, b] = self.half;
        let nu = self.elastic.poisson();
        let (above, below) = self.images(y, z, alternating_3);
        let series = (above - below).re;
        y * ((1.0 + nu) * a * a - nu * b * b / 3.0 - (2.0 + nu) * y * y / 6.0 + 0.5 * nu * z * z)
            - 4.0 * nu * (b / PI).powi(3) * series
    }

    /// `(d chi/dy, d chi/dz)`, m^2.
    fn warping_slope(&self, y: f64, z: f64) -> (f64, f64) {
        let [a, b] = self.half;
        let nu = self.elastic.poisson();
        let factor = 4.0 * nu * (b / PI).powi(2);
        let (above, below) = self.images(y, z, alternating_2);
        let even = (above + below).re;
        let odd = (above - below).im;
        let along_y = (1.0 + nu) * a * a - nu * b * b / 3.0 - 0.5 * (2.0 + nu) * y * y + 0.5 * nu * z * z;
        (along_y - factor * even, nu * y * z + factor * odd)
    }
}

impl Exact for SaintVenantFlexure {
    fn displacement(&self, p: &Point3) -> Vector3 {
        let (x, y, z, nu, l) = (p.x, p.y, p.z, self.elastic.poisson(), self.length);
        let ux = -y * x * (l - 0.5 * x) + self.warping(y, z);
        let uy = 0.5 * nu * (l - x) * (y * y - z * z) + x * x * (0.5 * l - x / 6.0);
        self.scale * Vector3::new(ux, uy, nu * (l - x) * y * z)
    }

    fn gradient(&self, p: &Point3) -> Matrix3 {
        let (x, y, z, nu, rest) = (p.x, p.y, p.z, self.elastic.poisson(), self.length - p.x);
        let turn = x * (self.length - 0.5 * x);
        let (chi_y, chi_z) = self.warping_slope(y, z);
        #[rustfmt::skip]
        let h = Matrix3::new(
            -rest * y,                              chi_y - turn,   chi_z,
            turn - 0.5 * nu * (y * y - z * z),      nu * rest * y, -nu * rest * z,
            -nu * y * z,                            nu * rest * z,  nu * rest * y,
        );
        self.scale * h
    }

    /// Cauchy stress, Pa, in closed form: Hooke's law loses digits as nu nears 0.5.
    fn stress(&self, p: &Point3) -> Matrix3 {
        let (y, z, nu) = (p.y, p.z, self.elastic.poisson());
        let (chi_y, chi_z) = self.warping_slope(y, z);
        let axial = -self.elastic.young() * self.scale * (self.length - p.x) * y;
        let shear = self.elastic.mu() * self.scale;
        let (xy, xz) = (shear * (chi_y - 0.5 * nu * (y * y - z * z)), shear * (chi_z - nu * y * z));
        Matrix3::new(axial, xy, xz, xy, 0.0, 0.0, xz, 0.0, 0.0)
    }
}

pub(super) const ENTRY: SolutionEntry = Entry {
    name: "saint-venant-flexure",
    meaning: "a bar of rectangular section under an end load along y",
    source: "Timoshenko and Goodier, Theory of Elasticity, bending of bars: rectangular section",
    parameters: &[
        Parameter::required("load", Dimension::Force, "end load along y"),
        Parameter::required("length", Dimension::Length, "length along x, from 0"),
        Parameter::required("depth", Dimension::Length, "depth of the section along y, centred on 0"),
        Parameter::required("width", Dimension::Length, "width of the section along z, centred on 0"),
    ],
    build: |medium, values| {
        let [load, length, depth, width] = numbers(values, ["load", "length", "depth", "width"])?;
        Ok(Box::new(SaintVenantFlexure::new(medium.elastic, load, length, [depth, width])?))
    },
};

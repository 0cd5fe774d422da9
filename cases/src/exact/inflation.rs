//! Inflation: a hollow sphere or tube under a pressure on its deformed inner wall.
//!
//! ```text
//! Source      Green & Zerna, Theoretical Elasticity (1954), ch. 3; Ogden, Non-linear Elastic Deformations
//!             (1984), ch. 5.3. A compressible law leads to one ordinary differential equation.
//!
//!        .-"""-.
//!      .'  .-.  '.        undeformed radii A < R < B, about the origin or the z axis
//!     |   ( p )   |       p pushes on the deformed inner wall, the outer wall is free
//!      '.  '-'  .'
//!        '-...-'
//!
//! Field       x = r(R) X / R; stretches r', r / R, and r / R (sphere) or 1 (tube, plane strain).
//! Equations   dP_r / dR = -m / R (P_r - P_t), m = 2 (sphere) or 1 (tube); P_r(A) = -p (r(A) / A)^m,
//!             P_r(B) = 0. Of the equilibria the one on the path from the undeformed state.
//! Conditions  the pressure, which follows the wall; symmetry planes; for a tube also planes of constant z.
//! Must hold   displacements converge; a dead pressure of the same value gives much less.
//! ```

use catalogue::{Dimension, Entry, Parameter, Problem, Values};

use super::error::ExactError;
use super::hyperelastic::Hyperelastic;
use super::medium::Medium;
use super::radial::Wall;
use super::solution::{Exact, SolutionEntry, numbers};
use super::vectors::{Matrix3, Point3, Vector3};

/// Ratios of the deformed to the undeformed inner radius that are searched for the equilibrium.
const STRETCHES: std::ops::Range<u32> = 0..300;
const STRETCH: f64 = 0.01;
/// Largest stress at the free outer wall, relative to the pressure.
const BALANCED: f64 = 1e-6;

/// An inflated sphere about the origin, or a tube about the z axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Inflation {
    law: Hyperelastic,
    sphere: bool,
    wall: Wall,
}

impl Inflation {
    /// A sphere, or a tube in plane strain, with the undeformed radii `0 < inner < outer` (m), under a
    /// pressure (Pa, positive) on the deformed inner wall.
    ///
    /// # Errors
    ///
    /// Radii out of order, or a pressure that is not positive, exceeds the limit point, or compresses the wall
    /// more than the law can carry.
    pub fn new(
        law: &Hyperelastic,
        sphere: bool,
        [inner, outer]: [f64; 2],
        pressure: f64,
    ) -> Result<Inflation, ExactError> {
        let solution = if sphere { SPHERE.name } else { TUBE.name };
        let bad = |name, value, need| Err(ExactError::BadParameter { solution, name, value, need });
        if !(inner > 0.0 && inner.is_finite()) {
            return bad("inner", inner, "above zero".into());
        }
        if !(outer > inner && outer.is_finite()) {
            return bad("outer", outer, format!("above the inner radius of {inner} m"));
        }
        if !(pressure > 0.0 && pressure.is_finite()) {
            return bad("pressure", pressure, "above zero".into());
        }
        let exponent = if sphere { 2 } else { 1 };
        let shoot = |stretch: f64| {
            let across = |x: f64, r: f64| [r / x, if sphere { r / x } else { 1.0 }];
            let balance = |x: f64, p: [f64; 3]| -f64::from(exponent) / x * (p[0] - p[1]);
            let start = (inner * stretch, -pressure * stretch.powi(exponent));
            Wall::integrate(law, [inner, outer - inner], start, across, balance)
        };
        // Below the equilibrium the outer wall would have to be pressed inwards.
        let mut bracket = None;
        for step in STRETCHES {
            let low = 1.0 + STRETCH * f64::from(step);
            if shoot(low + STRETCH).is_some_and(|(_, pressed)| pressed >= 0.0) {
                bracket = Some([low, low + STRETCH]);
                break;
            }
        }
        let Some([mut low, mut high]) = bracket else {
            return bad("pressure", pressure, "below the limit point, beyond which there is no equilibrium".into());
        };
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if shoot(middle).is_none_or(|(_, pressed)| pressed < 0.0) { low = middle } else { high = middle }
        }
        let balanced = shoot(0.5 * (low + high)).filter(|(_, left)| left.abs() < BALANCED * pressure);
        match balanced {
            Some((wall, _)) => Ok(Inflation { law: law.clone(), sphere, wall }),
            None => bad("pressure", pressure, "below the largest that the law can carry across the wall".into()),
        }
    }

    /// Deformed radius of the undeformed radius (m), m.
    pub fn radius(&self, undeformed: f64) -> f64 {
        self.wall.at(undeformed).0
    }

    /// Stretches along the radius, the circumference and the third direction, and the radial direction.
    fn state(&self, x: &Point3) -> ([f64; 3], Vector3) {
        let from_axis = if self.sphere { x.coords } else { Vector3::new(x.x, x.y, 0.0) };
        let undeformed = from_axis.norm();
        let (r, slope) = self.wall.at(undeformed);
        let hoop = r / undeformed;
        ([slope, hoop, if self.sphere { hoop } else { 1.0 }], from_axis / undeformed)
    }

    /// Symmetric tensor with these values along the radius, the circumference and the third direction.
    fn tensor(&self, values: [f64; 3], out: &Vector3) -> Matrix3 {
        let third = if self.sphere { Matrix3::zeros() } else { Vector3::z() * Vector3::z().transpose() };
        let radial = out * out.transpose();
        radial * values[0] + (Matrix3::identity() - radial - third) * values[1] + third * values[2]
    }
}

impl Exact for Inflation {
    /// Displacement, m; the point has to lie within the wall.
    fn displacement(&self, x: &Point3) -> Vector3 {
        let ([_, hoop, _], out) = self.state(x);
        out * ((hoop - 1.0) * out.dot(&x.coords))
    }

    fn gradient(&self, x: &Point3) -> Matrix3 {
        let (stretch, out) = self.state(x);
        self.tensor(stretch, &out) - Matrix3::identity()
    }

    fn stress(&self, x: &Point3) -> Matrix3 {
        let (stretch, out) = self.state(x);
        let volume = stretch[0] * stretch[1] * stretch[2];
        let principal = self.law.principal_stress(stretch);
        self.tensor(std::array::from_fn(|a| principal[a] * stretch[a] / volume), &out)
    }

    fn traction(&self, x: &Point3, normal: &Vector3) -> Vector3 {
        let (stretch, out) = self.state(x);
        self.tensor(self.law.principal_stress(stretch), &out) * normal
    }

    fn is_large_strain(&self) -> bool {
        true
    }
}

const PARAMETERS: &[Parameter] = &[
    Parameter::required("inner", Dimension::Length, "undeformed inner radius"),
    Parameter::required("outer", Dimension::Length, "undeformed outer radius"),
    Parameter::required("pressure", Dimension::Pressure, "pressure on the deformed inner wall"),
];

fn build(medium: &Medium, values: &Values, sphere: bool) -> Result<Box<dyn Exact>, Problem> {
    let radii = numbers(values, ["inner", "outer"])?;
    Ok(Box::new(Inflation::new(medium.hyperelastic()?, sphere, radii, values.number("pressure")?)?))
}

pub(super) const SPHERE: SolutionEntry = Entry {
    name: "inflated-sphere",
    meaning: "a hollow sphere about the origin under a pressure that follows its inner wall",
    source: "Green & Zerna, Theoretical Elasticity (1954), ch. 3; Ogden (1984), ch. 5.3",
    parameters: PARAMETERS,
    build: |medium, values| build(medium, values, true),
};

pub(super) const TUBE: SolutionEntry = Entry {
    name: "inflated-tube",
    meaning: "a tube about the z axis in plane strain under a pressure that follows its inner wall",
    source: "Green & Zerna, Theoretical Elasticity (1954), ch. 3; Ogden (1984), ch. 5.3",
    parameters: PARAMETERS,
    build: |medium, values| build(medium, values, false),
};

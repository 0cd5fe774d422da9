//! The interface of all solutions.

use catalogue::{Entry, Problem, Values};

use super::medium::Medium;
use super::vectors::{Matrix3, Point3, Vector3};

/// A solution that scene files can name.
pub type SolutionEntry = Entry<fn(&Medium, &Values) -> Result<Box<dyn Exact>, Problem>>;

/// A displacement field that solves the equations of its material exactly.
pub trait Exact: Send + Sync {
    /// Displacement `u`, m.
    fn displacement(&self, x: &Point3) -> Vector3;

    /// Displacement gradient `H_ij = du_i / dX_j`, (3, 3), dimensionless.
    fn gradient(&self, x: &Point3) -> Matrix3;

    /// Cauchy stress at the material point, (3, 3), Pa.
    fn stress(&self, x: &Point3) -> Matrix3;

    /// Body force per reference volume, `b = -Div P`, N/m^3; zero by default. For a motion this is the
    /// inertia force, `-rho u''`.
    fn body_force(&self, _x: &Point3) -> Vector3 {
        Vector3::zeros()
    }

    /// Traction on a surface with outward unit normal `n`, Pa: `P N` per reference area; at small strain
    /// `sigma n`.
    fn traction(&self, x: &Point3, normal: &Vector3) -> Vector3 {
        self.stress(x) * normal
    }

    /// Whether the field is at large strain and uses the body's own law. Otherwise it uses Hooke's law, the
    /// small-strain limit of every law.
    fn is_large_strain(&self) -> bool {
        false
    }

    /// Contact quantities of a solution that gives only these. Its field is then the far field, and no error
    /// of the field is computed.
    fn contact(&self) -> Option<Contact> {
        None
    }

    /// The field at another time (s) after the start, for a solution that moves or relaxes; `exact_by_name`
    /// gives time 0.
    fn at(&self, _time: f64) -> Option<Box<dyn Exact>> {
        None
    }

    /// Free vibrations, if the solution describes any.
    fn vibrations(&self) -> Option<&dyn Vibrations> {
        None
    }
}

/// Free vibrations of a body.
pub trait Vibrations {
    /// Angular frequency of the solution's own field, rad/s.
    fn omega(&self) -> f64;

    /// All modes of that frequency at a point: linearly independent vectors of arbitrary scale.
    fn shapes(&self, x: &Point3) -> Vec<Vector3>;

    /// The lowest `count` angular frequencies of the body, rad/s, ascending and repeated by multiplicity;
    /// `None` if not all are known.
    fn lowest(&self, count: usize) -> Option<Vec<f64>>;
}

/// Force and area of the contact of a tool pressed into a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Force on the tool opposite to its motion, N.
    pub force: f64,
    /// Contact area, m^2.
    pub area: f64,
}

/// The numbers with the given names.
pub(super) fn numbers<const N: usize>(
    values: &Values,
    names: [&'static str; N],
) -> Result<[f64; N], Problem> {
    let mut numbers = [0.0; N];
    for (number, name) in numbers.iter_mut().zip(names) {
        *number = values.number(name)?;
    }
    Ok(numbers)
}

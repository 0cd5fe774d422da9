//! Exact solutions, each a closed form in three dimensions, by which the solvers are judged.
//!
//! Every solution is a file and a line of the list below. The file has a card, a field (displacement,
//! displacement gradient, stress and body force at a point), and the [`SolutionEntry`] by which scenes name
//! the solution. Stresses follow from laws that are implemented here ([`Elastic`], [`Hyperelastic`]), so that
//! a solver's material is never judged by itself.
//!
//! A solution may move ([`BarWave`]), vibrate ([`LameCube`], [`RollerBox`]) or relax
//! ([`RelaxingCompression`]). It is then the field at one time and gives the field at any other time. It may
//! be at large strain ([`Homogeneous`], [`FiniteBending`]), or describe only a contact ([`Hertz`]).
//! [`VibratingCantilever`] is a period, not a field.

mod elastic;
mod error;
mod hyperelastic;
mod medium;
mod polylog;
mod vibrating_cantilever;

pub use elastic::Elastic;
pub use error::ExactError;
pub use hyperelastic::Hyperelastic;
pub use medium::Medium;
pub use vibrating_cantilever::VibratingCantilever;

use catalogue::{Dimension, Entry, Parameter, Problem, Range, Value, Values, find};

/// A solution that scene files can name.
pub type SolutionEntry = Entry<fn(&Medium, &Values) -> Result<Box<dyn Exact>, Problem>>;

/// Declares the files of the solutions, and the slice of their entries.
macro_rules! solutions {
    ($($file:ident::$solution:ident [$($entry:ident),*],)*) => {
        $(
            mod $file;
            pub use $file::$solution;
        )*

        /// Every solution, in the order of tables.
        pub static SOLUTIONS: &[SolutionEntry] = &[$($($file::$entry),*),*];
    };
}

solutions! {
    affine::Affine [ENTRY],
    quadratic_patch::QuadraticPatch [ENTRY],
    pure_bending::PureBending [ENTRY],
    cantilever::CantileverPlaneStrain [ENTRY],
    saint_venant::SaintVenantFlexure [ENTRY],
    torsion::Torsion [ENTRY],
    uniaxial_compression::UniaxialCompression [ENTRY],
    thick_sphere::ThickSphere [ENTRY],
    rigid::Rigid [ENTRY],
    bar_wave::BarWave [ENTRY],
    relaxing_compression::RelaxingCompression [ENTRY],
    lame_cube::LameCube [ENTRY],
    roller_box::RollerBox [ENTRY],
    homogeneous::Homogeneous [FREE_SLIP, CONFINED, SIMPLE_SHEAR],
    finite_bending::FiniteBending [ENTRY],
    hertz::Hertz [ENTRY],
}

/// A position in the reference configuration, in metres.
pub type Point3 = nalgebra::Point3<f64>;
/// A displacement (m), a normal (-), a traction (Pa) or a body force (N/m^3).
pub type Vector3 = nalgebra::Vector3<f64>;
/// A displacement gradient (-) or a stress (Pa).
pub type Matrix3 = nalgebra::Matrix3<f64>;

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

/// The solution with the given name for a material; parameters in SI.
pub fn exact_by_name(name: &str, medium: &Medium, given: &[(&str, f64)]) -> Result<Box<dyn Exact>, Problem> {
    let entry = find(SOLUTIONS, name)?;
    let mut values = Values::new(entry.parameters);
    // A scene keeps its values as text. Here the message is built from the number.
    let with_value = |bad: Problem, name: &str| match given.iter().find(|(given, _)| *given == name) {
        Some((name, value)) if bad.found.is_none() => bad.found(format!("{name} = {value}")),
        _ => bad,
    };
    for (name, value) in given {
        values.give(name, Value::Number(*value)).map_err(|bad| with_value(bad, name))?;
    }
    match values.missing() {
        Some(p) => {
            let needs = format!("needs {}: {} [{}]", p.name, p.meaning, p.dimension.si_unit());
            Err(Problem::new(needs).found(entry.name))
        }
        None => (entry.build)(medium, &values).map_err(|bad| {
            let name = bad.parameter.unwrap_or_default();
            with_value(bad, name)
        }),
    }
}

/// The numbers with the given names.
fn numbers<const N: usize>(values: &Values, names: [&'static str; N]) -> Result<[f64; N], Problem> {
    let mut numbers = [0.0; N];
    for (number, name) in numbers.iter_mut().zip(names) {
        *number = values.number(name)?;
    }
    Ok(numbers)
}

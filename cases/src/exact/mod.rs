//! Exact solutions, each a closed form in three dimensions, by which the solvers are judged.
//!
//! Every solution is a file and a line of the list below. The file has a card, a field (displacement,
//! displacement gradient, stress and body force at a point), and the [`SolutionEntry`] by which scenes name
//! the solution. Stresses follow from laws that are implemented here ([`Elastic`], [`Hyperelastic`]), so that
//! a solver's material is never judged by itself.
//!
//! A solution may move ([`BarWave`]), vibrate ([`LameCube`], [`RollerBox`]) or relax
//! ([`RelaxingCompression`]). It is then the field at one time and gives the field at any other time. It may
//! be at large strain ([`Homogeneous`], [`FiniteBending`], [`Inflation`]), or describe only a contact ([`Hertz`]).
//! [`VibratingCantilever`] is a period and [`PressedStrip`] the place of an end, not a field.

mod elastic;
mod error;
mod hyperelastic;
mod medium;
mod polylog;
mod pressed_strip;
mod radial;
mod solution;
mod vectors;
mod vibrating_cantilever;

pub use elastic::Elastic;
pub use error::ExactError;
pub use hyperelastic::Hyperelastic;
pub use medium::Medium;
pub use pressed_strip::PressedStrip;
pub use solution::{Contact, Exact, SolutionEntry, Vibrations};
pub use vectors::{Matrix3, Point3, Vector3};
pub use vibrating_cantilever::VibratingCantilever;

use catalogue::{Problem, Value, Values, find};

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
    inflation::Inflation [SPHERE, TUBE],
    hertz::Hertz [ENTRY],
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

//! Properties and closed forms of every law.

mod closed_forms;
mod lane;
mod others;
mod properties;
mod viscoelastic;

use crate::kinematics::volume_change;
use crate::law::*;
use crate::material::Material;
use crate::prony::Prony;
use crate::viscoelastic::{deviator, relaxed_stress_and_tangent};
use crate::volumetric::VolumetricForm;

/// Returns every law of the catalogue with a Young's modulus of 20 kPa, in every form of its volumetric
/// energy.
fn laws(poisson: f64) -> Vec<Law> {
    let laws = Law::all(20e3, poisson).unwrap();
    let others: Vec<Law> = laws.iter().flat_map(other_volumes).collect();
    laws.into_iter().chain(others).collect()
}

/// Returns a law with volumetric energies of the forms other than its own; none if it has no such energy.
fn other_volumes(law: &Law) -> Vec<Law> {
    let forms = [VolumetricForm::Quadratic, VolumetricForm::Logarithmic, VolumetricForm::SimoTaylor];
    let other = |form| law.clone().with_volumetric(form).filter(|other| other != law);
    forms.into_iter().filter_map(other).collect()
}

/// Returns `lambda + 2 mu`, Pa, the scale of stresses and tangents.
fn stiffness(law: &Law) -> f64 {
    law.lambda().abs() + 2.0 * law.mu()
}

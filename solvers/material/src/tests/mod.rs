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

/// Returns every law of the catalogue with a Young's modulus of 20 kPa.
fn laws(poisson: f64) -> Vec<Law> {
    Law::all(20e3, poisson).unwrap()
}

/// Returns `lambda + 2 mu`, Pa, the scale of stresses and tangents.
fn stiffness(law: &Law) -> f64 {
    law.lambda().abs() + 2.0 * law.mu()
}

//! One list of properties and one of closed forms, over every law.

mod closed_forms;
mod lane;
mod properties;
mod viscoelastic;

use super::*;
use crate::law::{OGDEN, SECOND};

/// Every law of the catalogue, of a Young's modulus of 20 kPa.
fn laws(poisson: f64) -> Vec<Law> {
    Law::all(20e3, poisson).unwrap()
}

/// `lambda + 2 mu`, Pa: the size that stresses and tangents are measured against.
fn stiffness(law: &Law) -> f64 {
    law.lambda().abs() + 2.0 * law.mu()
}

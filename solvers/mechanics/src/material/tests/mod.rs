//! One list of properties and one of closed forms, over every law.

mod closed_forms;
mod properties;

use super::*;

/// Every law with Young's modulus 20 kPa.
fn laws(poisson: f64) -> Vec<Law> {
    let young = 20e3;
    vec![
        Law::Linear(LinearElastic::new(young, poisson).unwrap()),
        Law::SaintVenantKirchhoff(SaintVenantKirchhoff::new(young, poisson).unwrap()),
        Law::NeoHookean(NeoHookean::new(young, poisson).unwrap()),
        Law::NeoHookeanIsochoric(NeoHookeanIsochoric::new(young, poisson).unwrap()),
    ]
}

/// `lambda + 2 mu`, Pa: the size that stresses and tangents are measured against.
fn stiffness(law: &Law) -> f64 {
    law.lambda().abs() + 2.0 * law.mu()
}

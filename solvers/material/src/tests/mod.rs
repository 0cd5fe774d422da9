//! One list of properties and one of closed forms, over every law.

mod closed_forms;
mod lane;
mod properties;
mod viscoelastic;

use super::*;

/// `C01 / (C10 + C01)` of the Mooney-Rivlin law.
const SECOND: f64 = 0.3;

/// Share of `mu` and exponent of the Ogden terms.
const OGDEN: [(f64, f64); 3] = [(0.7, 1.3), (0.1, 5.0), (0.2, -2.0)];

/// Every law with Young's modulus 20 kPa; Ogden's with the exponents of his rubber.
fn laws(poisson: f64) -> Vec<Law> {
    let young = 20e3;
    let hooke = LinearElastic::new(young, poisson).unwrap();
    let ogden: Vec<_> = OGDEN.map(|(share, alpha)| (2.0 * share * hooke.mu() / alpha, alpha)).into();
    vec![
        Law::Linear(LinearElastic::new(young, poisson).unwrap()),
        Law::SaintVenantKirchhoff(SaintVenantKirchhoff::new(young, poisson).unwrap()),
        Law::NeoHookean(NeoHookean::new(young, poisson).unwrap()),
        Law::NeoHookeanIsochoric(NeoHookeanIsochoric::new(young, poisson).unwrap()),
        Law::Hencky(Hencky::new(young, poisson).unwrap()),
        Law::MooneyRivlin(MooneyRivlin::from_young(young, poisson, SECOND).unwrap()),
        Law::Ogden(Ogden::new(&ogden, hooke.bulk()).unwrap()),
    ]
}

/// `lambda + 2 mu`, Pa: the size that stresses and tangents are measured against.
fn stiffness(law: &Law) -> f64 {
    law.lambda().abs() + 2.0 * law.mu()
}

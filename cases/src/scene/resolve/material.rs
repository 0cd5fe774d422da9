//! Materials.

use crate::scene::keys::{MaterialKeys, PronyKeys};
use crate::scene::material::{Material, Relaxation};
use crate::scene::report::Report;
use crate::scene::vocabulary::{build, settings};

use super::positive;

/// A law with its constants, density and relaxation.
pub(super) fn material(keys: MaterialKeys, key: &str, report: &mut Report) -> Option<Material> {
    let density = keys.beside.density.map(|d| positive(d.0, &format!("{key}.density"), report));
    let prony = prony(keys.beside.prony, key, report);
    let entry = keys.law.0;
    let values = settings(&keys.law, keys.settings, key, report)?;
    let law = build(entry, &values, (key, &format!("{key}.law")), report)?;
    Some(Material::new(entry, values, law, density, prony))
}

fn prony(terms: Vec<PronyKeys>, key: &str, report: &mut Report) -> Vec<Relaxation> {
    let mut sum = 0.0;
    for (i, term) in terms.iter().enumerate() {
        positive(term.g, &format!("{key}.prony[{i}].g"), report);
        positive(term.tau.0, &format!("{key}.prony[{i}].tau"), report);
        sum += term.g;
    }
    let help = "the shares must leave something that does not relax: their sum is below 1";
    report.require(sum < 1.0, &format!("{key}.prony"), "relaxes everything", help);
    terms.into_iter().map(|t| Relaxation { g: t.g, tau: t.tau.0 }).collect()
}

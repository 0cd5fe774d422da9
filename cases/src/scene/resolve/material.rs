//! Materials.

use crate::scene::keys::{ElasticKeys, MaterialKeys, MooneyRivlinKeys, OgdenKeys, PronyKeys};
use crate::scene::model::{Elastic, Material, Relaxation};
use crate::scene::report::Report;
use crate::scene::units::{Density, Q};
use catalogue::Problem;

use super::positive;

/// A law and its relaxation.
pub(super) fn material(keys: MaterialKeys, key: &str, report: &mut Report) -> (Material, Vec<Relaxation>) {
    type E = MaterialKeys;
    let mut with = |keys: ElasticKeys, law: fn(Elastic) -> Material| {
        let prony = prony(keys.prony, key, report);
        let density = density(keys.density, key, report);
        (law(elastic(keys.young.0, keys.poisson, density, key, report)), prony)
    };
    match keys {
        E::Linear(keys) => with(keys, Material::Linear),
        E::SaintVenantKirchhoff(keys) => with(keys, Material::SaintVenantKirchhoff),
        E::NeoHookean(keys) => with(keys, Material::NeoHookean),
        E::NeoHookeanIsochoric(keys) => with(keys, Material::NeoHookeanIsochoric),
        E::Hencky(keys) => with(keys, Material::Hencky),
        E::MooneyRivlin(keys) => mooney_rivlin(keys, key, report),
        E::Ogden(OgdenKeys { mu, alpha, bulk, density, prony }) => {
            let at = |name: &str| format!("{key}.{name}");
            let holds = mu.len() == alpha.len() && !mu.is_empty();
            report.require(holds, &at("alpha"), "does not match mu", "give one alpha for each mu");
            let terms: Vec<(f64, f64)> = mu.iter().map(|m| m.0).zip(alpha).collect();
            let sound = terms.iter().all(|t| t.1 != 0.0);
            report.require(sound, &at("alpha"), "holds a zero", "give exponents other than 0");
            // Where the lists don't match that alone is said.
            let shear: f64 = terms.iter().map(|(mu, alpha)| 0.5 * mu * alpha).sum();
            let help = "the sum of mu times alpha must be positive: twice the shear modulus";
            report.require(!holds || shear > 0.0, &at("mu"), "gives no shear modulus above zero", help);
            let bulk = positive(bulk.0, &at("bulk"), report);
            let density = self::density(density, key, report);
            (Material::Ogden { terms, bulk, density }, self::prony(prony, key, report))
        }
    }
}

fn elastic(young: f64, poisson: f64, density: Option<f64>, key: &str, report: &mut Report) -> Elastic {
    report.require(young > 0.0, &format!("{key}.young"), "is not positive", "soft tissue has 1 to 100 kPa");
    let help = "give a ratio above -1 and below 0.5; for nearly incompressible tissue 0.49 to 0.4999";
    let holds = poisson > -1.0 && poisson < 0.5;
    report.require(
        holds,
        &format!("{key}.poisson"),
        "is not a Poisson's ratio of a compressible solid",
        help,
    );
    Elastic { young, poisson, density }
}

/// From c10, c01 and bulk, or from young, poisson and share: `mu = 2 (c10 + c01)`, `bulk = E / (3 - 6 nu)`.
fn mooney_rivlin(keys: MooneyRivlinKeys, key: &str, report: &mut Report) -> (Material, Vec<Relaxation>) {
    let at = |name: &str| format!("{key}.{name}");
    let density = density(keys.density, key, report);
    let prony = prony(keys.prony, key, report);
    let constants = (keys.c10, keys.c01, keys.bulk);
    let (c10, c01, bulk) = match (constants, (keys.young, keys.poisson, keys.share)) {
        ((Some(c10), Some(c01), Some(bulk)), (None, None, None)) => {
            let help = "c10 + c01 is half the shear modulus";
            let holds = c10.0 + c01.0 > 0.0;
            report.require(holds, &at("c10"), "gives no shear modulus above zero", help);
            (c10.0, c01.0, positive(bulk.0, &at("bulk"), report))
        }
        ((None, None, None), (Some(young), Some(poisson), Some(share))) => {
            let e = elastic(young.0, poisson, None, key, report);
            let sound = (0.0..=1.0).contains(&share);
            report.require(sound, &at("share"), "is no share", "give 0 (all in c10) to 1 (all in c01)");
            let half = 0.25 * e.young / (1.0 + e.poisson);
            (half * (1.0 - share), half * share, e.young / (3.0 - 6.0 * e.poisson))
        }
        _ => {
            let help = "give c10, c01 and bulk, or young, poisson and share; nothing else";
            report.add(&at("law"), Problem::new("has not the constants it needs").help(help));
            (1.0, 0.0, 1.0)
        }
    };
    (Material::MooneyRivlin { c10, c01, bulk, density }, prony)
}

fn density(density: Option<Q<Density>>, key: &str, report: &mut Report) -> Option<f64> {
    density.map(|d| positive(d.0, &format!("{key}.density"), report))
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

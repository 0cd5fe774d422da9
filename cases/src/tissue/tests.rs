//! Every tissue of the catalogue is read as a scene reads it and evaluated over its range.

use std::collections::BTreeSet;

use catalogue::Dimension;
use material::{Law, Material as _};
use nalgebra::Matrix3;

use toml::de::DeValue;

use super::{DeTable, TEXT, Tissue, all};
use crate::scene::{Scene, parse};

/// A scene of a block of the tissue, with directions for a law that depends on them.
fn scene(tissue: &Tissue) -> Scene {
    let fibers = match tissue.law.as_str() {
        "holzapfel-ogden" | "holzapfel-gasser-ogden" => ", fibers = [1, 0, 0], sheets = [0, 1, 0]",
        "guccione" | "trans-iso-mooney-rivlin" => ", fibers = [1, 0, 0]",
        _ => "",
    };
    let text = format!(
        "title = \"A block\"\n\
         body = {{ shape = \"box\", size = [\"1 mm\", \"1 mm\", \"1 mm\"] }}\n\
         material = {{ tissue = \"{}\"{fibers} }}\n\
         procedure = {{ kind = \"static\", steps = 1 }}\n\
         support = [{{ on = \"z-min\", fix = \"xyz\" }}]\n\
         load = [{{ on = \"z-max\", pressure = \"1 Pa\" }}]\n\
         method = [{{ id = \"hex8\", family = \"fem\", element = \"hex8\", size = {{ level = 1 }} }}]\n",
        tissue.name
    );
    parse(&text, "block.toml").unwrap_or_else(|bad| panic!("{}: {}", tissue.name, bad[0]))
}

fn law(tissue: &Tissue) -> Law {
    scene(tissue).material.law().clone()
}

/// Displacement gradient of a stretch along the first axis at constant volume.
fn stretched(stretch: f64) -> Matrix3<f64> {
    let across = 1.0 / stretch.sqrt();
    Matrix3::from_diagonal(&nalgebra::Vector3::new(stretch - 1.0, across - 1.0, across - 1.0))
}

#[test]
fn names_say_organ_species_author_and_year() {
    let names: BTreeSet<&str> = all().iter().map(|tissue| tissue.name.as_str()).collect();
    assert_eq!((names.len(), all().len()), (30, 30));
    for tissue in all() {
        let (_, rest) = tissue.name.split_once('/').unwrap_or_else(|| panic!("{}", tissue.name));
        let year = rest.rsplit('-').next().unwrap();
        assert!(rest.starts_with(&format!("{}-", tissue.species)), "{}", tissue.name);
        assert!(tissue.source.contains(year) && year.len() == 4, "{}: {}", tissue.name, tissue.source);
        assert!(tissue.doi.iter().all(|doi| doi.starts_with("10.")), "{}", tissue.name);
        let is_unlike = tissue.assumed.keys().all(|key| !tissue.constants.contains_key(key));
        assert!(!tissue.constants.is_empty() && is_unlike, "{}", tissue.name);
    }
}

/// Whether a value of the file of tissues is text, a number or a list of them, as constants are.
fn is_plain(value: &DeValue<'_>) -> bool {
    match value {
        DeValue::Array(items) => items.iter().all(|item| is_plain(item.get_ref())),
        value => value.is_str() || value.is_float() || value.is_integer(),
    }
}

#[test]
fn constants_are_scalars_and_lists() {
    let root = DeTable::parse(TEXT).unwrap();
    for entry in root.get_ref()["tissue"].get_ref().as_array().unwrap().iter() {
        for key in ["constants", "assumed"] {
            let table = entry.get_ref().get(key).unwrap().get_ref().as_table().unwrap();
            assert!(table.iter().all(|(_, value)| is_plain(value.get_ref())), "{entry:?}");
        }
    }
}

#[test]
fn every_tissue_is_free_of_stress_at_rest_and_stiffens_or_keeps_its_stiffness() {
    for tissue in all() {
        let law = law(tissue);
        let rest = law.stress(&Matrix3::zeros());
        assert!(rest.norm() <= 1e-9 * law.mu(), "{}: {rest}", tissue.name);
        assert!(law.mu() > 0.0 && law.bulk() > 10.0 * law.mu(), "{}: {}", tissue.name, law.mu());
        let [low, high] = tissue.stretch;
        assert!(low < 1.0 && high > 1.0 && low > 0.5 && high < 2.0, "{}", tissue.name);
        // dW/dl along the isochoric path, W(1) = 0: negative below rest, positive above, and growing.
        let stretches: Vec<f64> = (0..=40).map(|k| low + (high - low) * f64::from(k) / 40.0).collect();
        let energy = |l: f64| law.energy(&stretched(l));
        let slope = |l: f64| (energy(l + 1e-5) - energy(l - 1e-5)) / 2e-5;
        assert!(energy(1.0).abs() < 1e-12 * law.mu(), "{}", tissue.name);
        let slopes: Vec<f64> = stretches.iter().map(|&l| slope(l)).collect();
        assert!(slopes.iter().all(|slope| slope.is_finite()), "{}: {slopes:?}", tissue.name);
        let grows = slopes.windows(2).all(|pair| pair[1] > pair[0]);
        assert!(grows && slopes[0] < 0.0 && slopes[40] > 0.0, "{}: {slopes:?}", tissue.name);
    }
}

/// The tangent at rest is positive for every strain: `H : A : H > 0` for a symmetric `H`.
#[test]
fn every_tissue_resists_every_small_strain() {
    for tissue in all() {
        let law = law(tissue);
        let tangent = law.tangent(&Matrix3::zeros());
        for (i, j) in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)] {
            let mut h = Matrix3::<f64>::zeros();
            h[(i, j)] += 0.5;
            h[(j, i)] += 0.5;
            let h = nalgebra::SVector::<f64, 9>::from_column_slice(h.as_slice());
            let stiffness = (h.transpose() * tangent * h)[0];
            assert!(stiffness > 0.0, "{}: {stiffness} at {i}{j}", tissue.name);
        }
    }
}

#[test]
fn shear_moduli_are_those_that_the_sources_state() {
    let stated = all().iter().filter_map(|tissue| Some((tissue, tissue.shear.as_ref()?)));
    let mut count = 0;
    for (tissue, shear) in stated {
        let (of_law, stated) = (law(tissue).mu(), Dimension::Pressure.read(shear).unwrap());
        // With a Poisson's ratio of 0.495 instead of 0.5, E = 3 mu gives a modulus that is 0.33 % larger.
        assert!((of_law / stated - 1.0).abs() < 4e-3, "{}: {of_law} for {stated}", tissue.name);
        count += 1;
    }
    assert_eq!(count, 8);
}

/// Figures of the sources' abstracts that follow from the constants.
#[test]
fn ratios_and_wave_speeds_are_those_of_the_abstracts() {
    let young = |name: &str| {
        let scene = scene(super::find(name).unwrap());
        scene.material.constant("young").unwrap()
    };
    // Samani et al.: fat and gland alike, fibroadenomas about twice as stiff, high-grade carcinomas up to 13 times.
    let gland = young("breast/human-fibroglandular-samani-2007");
    for (name, ratio) in [("fat", 1.0), ("fibroadenoma", 2.0), ("carcinoma", 13.0)] {
        let found = young(&format!("breast/human-{name}-samani-2007")) / gland;
        assert!((found / ratio - 1.0).abs() < 0.02, "{name}: {found}");
    }
    // Rouviere et al.: shear waves of 2.21 m/s, mu = rho c^2.
    let mu = young("kidney/human-rouviere-2011") / 3.0;
    assert!((mu / (1000.0 * 2.21 * 2.21) - 1.0).abs() < 0.01, "{mu}");
}

#[test]
fn an_unknown_tissue_gets_the_names_of_its_organ() {
    let help = super::find("liver/sheep").unwrap_err().help.unwrap();
    assert!(help.contains("liver/human-venkatesh-2008") && !help.contains("heart"), "{help}");
    let help = super::find("womb").unwrap_err().help.unwrap();
    assert!(help.contains("heart, artery, aneurysm, brain"), "{help}");
}

//! Materials of a deck. (CalculiX CrunchiX manual, 6.8 and 7; Abaqus keywords reference.)

use mesh_files::DeckCard;

use super::sets::real;
use crate::import::document::{Part, list, quoted};
use crate::import::finding::Findings;
use crate::import::units::{Units, number};

/// A material with the keys of its law.
#[derive(Clone)]
pub(super) struct Material {
    pub name: String,
    pub line: usize,
    /// Mass per volume, in the units of the deck.
    pub density: Option<f64>,
    /// Factors of the mass and of the stiffness in the damping of `*DYNAMIC`.
    pub damping: [f64; 2],
    /// Whether it expands with its temperature.
    pub expands: bool,
    law: Option<Law>,
}

#[derive(Clone)]
enum Law {
    /// Young's modulus and Poisson's ratio of `*ELASTIC`.
    Elastic([f64; 2]),
    Hyperelastic(Vec<(&'static str, String)>),
}

impl Material {
    pub fn new(card: &DeckCard) -> Material {
        let name = card.get("NAME").unwrap_or_default().to_string();
        Material { name, line: card.line, density: None, damping: [0.0; 2], expands: false, law: None }
    }

    /// Reads a card below `*MATERIAL`.
    pub fn card(&mut self, card: &DeckCard, units: Units, findings: &Findings) {
        let values: Option<Vec<f64>> =
            card.data.iter().flat_map(|(_, words)| words).map(|word| real(word)).collect();
        let Some(values) = values else {
            findings.refuse(card.line, format!("*{} has a word that is no number", card.keyword), "");
            return;
        };
        match card.keyword.as_str() {
            "DAMPING" => self.damping(card, findings),
            "DENSITY" => self.density = values.first().copied(),
            "ELASTIC" => self.elastic(card, &values, findings),
            "HYPERELASTIC" => self.law = hyperelastic(card, &values, units, findings).map(Law::Hyperelastic),
            "HYPERFOAM" => self.law = hyperfoam(card, &values, units, findings).map(Law::Hyperelastic),
            // Without temperatures these have no effect.
            "CONDUCTIVITY" | "SPECIFIC HEAT" | "EXPANSION" => {
                self.expands |= card.keyword == "EXPANSION";
                findings.leave_out(card.line, format!("*{} without temperatures", card.keyword));
            }
            keyword => findings.refuse(card.line, format!("*{keyword} can't be expressed"), ""),
        }
    }

    fn damping(&mut self, card: &DeckCard, findings: &Findings) {
        for (key, value) in &card.parameters {
            match (key.as_str(), real(value)) {
                ("ALPHA", Some(alpha)) => self.damping[0] = alpha,
                ("BETA", Some(beta)) => self.damping[1] = beta,
                _ => findings.refuse(card.line, format!("{key}={value} of *DAMPING can't be expressed"), ""),
            }
        }
    }

    fn elastic(&mut self, card: &DeckCard, values: &[f64], findings: &Findings) {
        let kind = card.get("TYPE").unwrap_or("ISO").to_ascii_uppercase();
        if !kind.starts_with("ISO") || card.data.len() > 1 {
            let help = "isotropic constants at one temperature are read";
            findings.refuse(
                card.line,
                format!("*ELASTIC of type {kind} with {} lines", card.data.len()),
                help,
            );
            return;
        }
        match values {
            [young, poisson, ..] => self.law = Some(Law::Elastic([*young, *poisson])),
            _ => findings.refuse(card.line, "*ELASTIC has no two constants", ""),
        }
    }

    /// Adds the keys of the law; `large` is geometric nonlinearity.
    pub fn keys(&self, part: Part, large: bool, units: Units) -> Option<Part> {
        let part = match self.law.as_ref()? {
            Law::Elastic([young, poisson]) => {
                let law = if large { "saint-venant-kirchhoff" } else { "linear" };
                part.key("law", quoted(law))
                    .key("young", units.pressures(*young))
                    .key("poisson", number(*poisson))
            }
            Law::Hyperelastic(keys) => {
                keys.iter().fold(part, |part, (name, value)| part.key(name, value.clone()))
            }
        };
        Some(part.maybe("density", self.density.map(|density| units.densities(density))))
    }

    /// Whether the law needs geometric nonlinearity.
    pub fn is_hyperelastic(&self) -> bool {
        matches!(self.law, Some(Law::Hyperelastic(_)))
    }
}

type Keys = Vec<(&'static str, String)>;

/// Bulk modulus `2 / D1`.
fn bulk(card: &DeckCard, d: &[f64], units: Units, findings: &Findings) -> Option<String> {
    match d {
        [d1, rest @ ..] if *d1 > 0.0 && rest.iter().all(|d| *d == 0.0) => Some(units.pressures(2.0 / d1)),
        _ => {
            let help = "give D1 above 0 and the others 0";
            findings.refuse(card.line, "the constants D of *HYPERELASTIC", help);
            None
        }
    }
}

fn hyperelastic(card: &DeckCard, values: &[f64], units: Units, findings: &Findings) -> Option<Keys> {
    let has = |key: &str| card.get(key).is_some();
    let order: usize = card.get("N").map_or(Some(1), |n| n.parse().ok()).unwrap_or(0);
    let pressure = |value: f64| units.pressures(value);
    let at = |index: usize| values.get(index).copied().unwrap_or(0.0);
    let needs = |count: usize| {
        let enough = values.len() >= count && (1..=3).contains(&order);
        if !enough {
            findings.refuse(card.line, format!("*HYPERELASTIC has {} constants", values.len()), "");
        }
        enough
    };
    if has("NEO HOOKE") || has("NEOHOOKE") {
        let d = needs(2).then(|| bulk(card, &values[1..2], units, findings))??;
        // C10 (I1 - 3) alone.
        return Some(vec![
            ("law", quoted("mooney-rivlin")),
            ("c10", pressure(at(0))),
            ("c01", pressure(0.0)),
            ("bulk", d),
        ]);
    }
    if has("MOONEY-RIVLIN") || has("MOONEYRIVLIN") {
        let d = needs(3).then(|| bulk(card, &values[2..3], units, findings))??;
        let (c10, c01) = (pressure(at(0)), pressure(at(1)));
        return Some(vec![("law", quoted("mooney-rivlin")), ("c10", c10), ("c01", c01), ("bulk", d)]);
    }
    if has("YEOH") {
        let d = needs(6).then(|| bulk(card, &values[3..6], units, findings))??;
        let c = list((0..3).map(|power| pressure(at(power))));
        return Some(vec![("law", quoted("yeoh")), ("c", c), ("bulk", d)]);
    }
    if has("OGDEN") {
        let d = needs(3 * order).then(|| bulk(card, &values[2 * order..3 * order], units, findings))??;
        // 2 mu / alpha^2 of Abaqus is mu / alpha of Ogden.
        let mu = list((0..order).map(|term| pressure(2.0 * at(2 * term) / at(2 * term + 1))));
        let alpha = list((0..order).map(|term| number(at(2 * term + 1))));
        return Some(vec![("law", quoted("ogden")), ("mu", mu), ("alpha", alpha), ("bulk", d)]);
    }
    let help = "NEO HOOKE, MOONEY-RIVLIN, YEOH and OGDEN are read";
    findings.refuse(card.line, "the form of *HYPERELASTIC", help);
    None
}

fn hyperfoam(card: &DeckCard, values: &[f64], units: Units, findings: &Findings) -> Option<Keys> {
    let order: usize = card.get("N").map_or(Some(1), |n| n.parse().ok()).unwrap_or(0);
    if !(1..=3).contains(&order) || values.len() < 3 * order {
        findings.refuse(card.line, format!("*HYPERFOAM has {} constants", values.len()), "");
        return None;
    }
    let terms = || (0..order).map(|term| 2 * term);
    let mu = list(terms().map(|at| units.pressures(values[at])));
    let alpha = list(terms().map(|at| number(values[at + 1])));
    let nu = list((0..order).map(|term| number(values[2 * order + term])));
    Some(vec![("law", quoted("hyperfoam")), ("mu", mu), ("alpha", alpha), ("nu", nu)])
}

//! The body of a scene: the mesh of the deck, its materials and its elements.

use std::collections::{BTreeMap, BTreeSet};

use geometry::CellKind;
use mesh_files::DeckCard;

use super::material::Material;
use super::procedure::Procedure;
use super::sets::{Sets, solid};
use crate::import::document::{Part, quoted};
use crate::import::finding::Findings;
use crate::import::model::Model;

/// Keywords of the model that a material has below it.
const OF_MATERIAL: [&str; 20] = [
    "DENSITY",
    "ELASTIC",
    "HYPERELASTIC",
    "HYPERFOAM",
    "CONDUCTIVITY",
    "SPECIFIC HEAT",
    "EXPANSION",
    "PLASTIC",
    "CREEP",
    "DEPVAR",
    "USER MATERIAL",
    "CYCLIC HARDENING",
    "VISCOELASTIC",
    "DAMPING",
    "FLUID CONSTANTS",
    "DEFORMATION PLASTICITY",
    "MOHR COULOMB",
    "MAGNETIC PERMEABILITY",
    "ELECTRICAL CONDUCTIVITY",
    "VISCO",
];

/// Materials and sections of a deck.
pub(super) struct Materials {
    /// By their names in upper case.
    all: BTreeMap<String, Material>,
    /// Name of the material, in upper case, and line of each element set.
    sections: BTreeMap<String, (String, usize)>,
}

impl Materials {
    /// Takes the materials and the sections out of the cards.
    pub fn take(cards: &mut Vec<&DeckCard>, model: &Model, findings: &Findings) -> Materials {
        let (mut all, mut sections) = (BTreeMap::new(), BTreeMap::new());
        let mut open: Option<String> = None;
        cards.retain(|card| {
            let keyword = card.keyword.as_str();
            match keyword {
                "MATERIAL" => {
                    let material = Material::new(card);
                    let name = material.name.to_ascii_uppercase();
                    all.insert(name.clone(), material);
                    open = Some(name);
                    false
                }
                "SOLID SECTION" => {
                    let get = |key: &str| card.get(key).unwrap_or_default();
                    if card.get("ORIENTATION").is_some() {
                        findings.leave_out(card.line, "ORIENTATION of an isotropic section");
                    }
                    let name = get("MATERIAL").to_ascii_uppercase();
                    sections.insert(get("ELSET").to_string(), (name, card.line));
                    false
                }
                _ if OF_MATERIAL.contains(&keyword) => {
                    match open.as_ref().and_then(|name| all.get_mut(name)) {
                        Some(material) => material.card(card, model.units, findings),
                        None => {
                            findings.refuse(card.line, format!("*{keyword} belongs to no material"), "");
                        }
                    }
                    false
                }
                _ => true,
            }
        });
        Materials { all, sections }
    }

    fn used(&self) -> impl Iterator<Item = &Material> {
        self.sections.values().filter_map(|(name, _)| self.all.get(name))
    }

    /// Mass per volume, if all materials have the same.
    pub fn density(&self) -> Option<f64> {
        let density = self.used().next()?.density?;
        self.used().all(|material| material.density == Some(density)).then_some(density)
    }

    /// Factors of `*DAMPING`, if all materials have the same.
    pub fn damping(&self) -> Option<[f64; 2]> {
        let damping = self.used().next()?.damping;
        self.used().all(|material| material.damping == damping).then_some(damping)
    }

    /// Whether a material expands with its temperature.
    pub fn expand(&self) -> bool {
        self.used().any(|material| material.expands)
    }

    /// Whether a law needs geometric nonlinearity.
    pub fn are_large(&self) -> bool {
        self.used().any(Material::is_hyperelastic)
    }

    /// The body and its materials.
    pub fn parts(&self, large: bool, model: &Model, findings: &Findings) -> Option<Vec<Part>> {
        let mut parts = vec![
            Part::new("[body]")
                .note("The deck itself is the mesh: its sets and surfaces keep their names.")
                .key("shape", quoted("file"))
                .key("path", quoted(model.path))
                .key("unit", quoted(model.units.length())),
        ];
        let origin = |material: &Material| format!("*MATERIAL {} (line {})", material.name, material.line);
        let mut of_sets: Vec<(&str, &Material)> = Vec::new();
        for (set, (name, line)) in &self.sections {
            match self.all.get(name) {
                Some(material) => of_sets.push((set, material)),
                None => findings.refuse(*line, format!("material '{name}' is not in the deck"), ""),
            }
        }
        let ((_, first), others) = of_sets.split_first()?;
        parts.push(first.keys(Part::new("[material]").note(origin(first)), large, model.units)?);
        for (set, material) in others.iter().filter(|(_, material)| material.name != first.name) {
            let part = Part::new("[[region]]").note(origin(material)).key("name", quoted(set));
            parts.push(part.key("on", quoted(set)));
            parts.push(material.keys(Part::new("[region.material]"), large, model.units)?);
        }
        Some(parts)
    }
}

/// The elements of the deck as the method.
pub(super) fn method(
    sets: &Sets,
    procedure: Option<&Procedure>,
    model: &Model,
    findings: &Findings,
) -> Option<Part> {
    let kinds: BTreeSet<&str> = sets.elements.values().map(|(kind, _)| kind.as_str()).collect();
    let line = |kind: &str| sets.kinds.get(kind).copied().unwrap_or(1);
    // C3D15 has nine points in CalculiX, which reduced integration has here. (e_c3d.f)
    let fewer = kinds.iter().find(|kind| ["C3D15", "C3D20R"].contains(kind)).copied();
    if let Some(fewer) = fewer.filter(|_| kinds.contains("C3D20")) {
        let help = "a method of a scene has one integration: full for C3D20, reduced for C3D15 and C3D20R";
        findings.refuse(line(fewer), format!("C3D20 and {fewer} in one deck"), help);
    }
    if kinds.contains("C3D6") {
        findings.leave_out(line("C3D6"), "the two points of C3D6: wedge6 has six");
    }
    let known = ["C3D4", "C3D6", "C3D8", "C3D10", "C3D15", "C3D20", "C3D20R"];
    let mut all_known = true;
    for other in kinds.iter().filter(|kind| !known.contains(kind)) {
        let help = format!("read are {}", known.join(", "));
        findings.refuse(line(other), format!("elements {other} can't be expressed"), &help);
        all_known = false;
    }
    all_known.then_some(())?;
    let reduced = fewer.is_some();
    let mut solids: Vec<CellKind> = kinds.iter().filter_map(|kind| solid(kind)).collect();
    solids.dedup();
    let linear = |kind: &CellKind| kind.node_count() == kind.entry().cell.corners;
    let element = match &solids[..] {
        [one] => one.name(),
        all if all.iter().all(linear) && !all.is_empty() => "mixed-linear",
        all if !all.iter().any(linear) && !all.is_empty() => "mixed-quadratic",
        [] => {
            if !findings.refuses() {
                findings.refuse(1, "the deck has no elements", "");
            }
            return None;
        }
        _ => {
            let last = kinds.iter().map(|kind| line(kind)).max().unwrap_or(1);
            findings.refuse(last, "linear and quadratic elements in one body", "");
            return None;
        }
    };
    let id = if reduced { format!("{element}-reduced") } else { element.to_string() };
    let part = Part::new("[[method]]").note("The elements of the deck.").key("id", quoted(&id));
    let part = part.key("family", quoted("fem")).key("element", quoted(element));
    let part = part.maybe("reduced", reduced.then(|| "true".into()));
    // CalculiX integrates the mass at the points of the stiffness.
    let part = part.maybe("mass", procedure.is_some_and(Procedure::vibrates).then(|| quoted("at-points")));
    Some(part.key("size", model.size()))
}

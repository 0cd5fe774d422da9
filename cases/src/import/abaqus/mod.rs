//! Decks of CalculiX, whose keywords are those of Abaqus. (CalculiX CrunchiX manual, 7.)

mod material;
mod sets;
mod step;

use std::collections::{BTreeMap, BTreeSet, HashMap};

use geometry::CellKind;
use mesh_files::DeckCard;

use self::material::Material;
use self::sets::{Sets, solid};
use self::step::{Kind, Step, amplitude};
use super::document::{Part, print, quoted};
use super::finding::{Finding, Findings};
use super::model::{Imported, Model, head};

/// Keywords that steer the output or the solver.
const PASSED: [&str; 22] = [
    "HEADING",
    "PREPRINT",
    "OUTPUT",
    "NODE OUTPUT",
    "ELEMENT OUTPUT",
    "ENERGY OUTPUT",
    "NODE FILE",
    "EL FILE",
    "EL PRINT",
    "ENERGY PRINT",
    "SECTION PRINT",
    "RESTART",
    "MONITOR",
    "FILE FORMAT",
    "CONTROLS",
    "TIME POINTS",
    "CONTACT OUTPUT",
    "CONTACT FILE",
    "CONTACT PRINT",
    "ASSEMBLY",
    "END ASSEMBLY",
    "END STEP",
];
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

/// Makes a scene of a deck.
pub(super) fn import(bytes: &[u8], model: &Model) -> Result<Imported, Vec<Finding>> {
    let fault = |(line, what)| vec![Finding { file: model.file.into(), line, what, help: None }];
    let cards = mesh_files::deck_cards(bytes).map_err(fault)?;
    let findings = Findings::of(model.file);
    let scene = scene(&cards, model, &findings);
    let left_out = findings.close()?;
    match scene {
        Some(parts) => {
            let head = head(model, "deck", &left_out);
            let parts: Vec<Part> = std::iter::once(head).chain(parts).collect();
            Ok(Imported { scene: print(&parts), left_out })
        }
        None => Err(fault((1, "has no step, or no material of all its elements".into()))),
    }
}

fn scene(cards: &[DeckCard], model: &Model, findings: &Findings) -> Option<Vec<Part>> {
    let mut sets = Sets::default();
    let mut others: Vec<&DeckCard> = cards.iter().filter(|card| !sets.card(card, findings)).collect();
    let (materials, sections) = materials(&mut others, model, findings);
    let step_at = others.iter().position(|card| card.keyword == "STEP");
    let mut surfaces = HashMap::new();
    others.retain(|card| {
        let is_surface = card.keyword == "SURFACE";
        if let Some(name) = card.get("NAME").filter(|_| is_surface) {
            surfaces.insert(name.to_ascii_uppercase(), name.to_string());
        }
        !is_surface
    });
    let amplitudes: HashMap<String, Vec<[f64; 2]>> = others
        .iter()
        .filter(|card| card.keyword == "AMPLITUDE")
        .filter_map(|card| amplitude(card, findings))
        .collect();
    let used: Vec<&Material> = sections.values().filter_map(|name| materials.get(name)).collect();
    let density = used.first().and_then(|first| first.density);
    let mut step = Step {
        sets: &sets,
        findings,
        units: model.units,
        surfaces,
        density: density.filter(|density| used.iter().all(|material| material.density == Some(*density))),
        amplitudes,
        large: used.iter().any(|material| material.is_hyperelastic()),
        kind: None,
        supports: Vec::new(),
        loads: Vec::new(),
        printed: BTreeSet::new(),
    };
    step_at?;
    let mut line = 0;
    // The kind of the step is known before its amplitudes are read.
    let kinds = ["STATIC", "FREQUENCY"];
    let first: Vec<&&DeckCard> =
        others.iter().filter(|card| kinds.contains(&card.keyword.as_str())).collect();
    if let [one] = first[..] {
        step.card(one);
    }
    for card in others.iter().filter(|card| !kinds.contains(&card.keyword.as_str())) {
        match card.keyword.as_str() {
            "STEP" if line > 0 => findings.refuse(card.line, "a second *STEP", "a scene has one step"),
            "STEP" => line = step_card(card, &mut step),
            "AMPLITUDE" => {}
            _ if step.card(card) => {}
            keyword if PASSED.contains(&keyword) => findings.leave_out(card.line, format!("*{keyword}")),
            keyword => findings.refuse(card.line, format!("*{keyword} can't be expressed"), ""),
        }
    }
    if step.kind.is_none() && !findings.refuses() {
        findings.refuse(line, "the step is no *STATIC or *FREQUENCY", "");
    }
    let mut parts = body(&sets, &materials, &sections, &step, model)?;
    parts.append(&mut step.supports);
    parts.append(&mut step.loads);
    parts.push(step.procedure(line)?);
    parts.extend(step.output());
    Some(parts)
}

/// Reads `*STEP` and returns its line.
fn step_card(card: &DeckCard, step: &mut Step) -> usize {
    step.large |= card.get("NLGEOM").is_some_and(|value| !value.eq_ignore_ascii_case("NO"));
    if card.get("PERTURBATION").is_some() {
        step.findings.refuse(card.line, "*STEP, PERTURBATION can't be expressed", "");
    }
    card.line
}

/// Takes the materials and the sections out of the cards.
fn materials(
    cards: &mut Vec<&DeckCard>,
    model: &Model,
    findings: &Findings,
) -> (BTreeMap<String, Material>, BTreeMap<String, String>) {
    let (mut materials, mut sections) = (BTreeMap::new(), BTreeMap::new());
    let mut open: Option<String> = None;
    cards.retain(|card| {
        let keyword = card.keyword.as_str();
        match keyword {
            "MATERIAL" => {
                let material = Material::new(card);
                let name = material.name.to_ascii_uppercase();
                materials.insert(name.clone(), material);
                open = Some(name);
                false
            }
            "SOLID SECTION" => {
                let get = |key: &str| card.get(key).unwrap_or_default();
                if card.get("ORIENTATION").is_some() {
                    findings.leave_out(card.line, "ORIENTATION of an isotropic section");
                }
                sections.insert(get("ELSET").to_string(), get("MATERIAL").to_ascii_uppercase());
                false
            }
            _ if OF_MATERIAL.contains(&keyword) => {
                match open.as_ref().and_then(|name| materials.get_mut(name)) {
                    Some(material) => material.card(card, model.units, findings),
                    None => findings.refuse(card.line, format!("*{keyword} belongs to no material"), ""),
                }
                false
            }
            _ => true,
        }
    });
    (materials, sections)
}

/// The body, its materials and the method.
fn body(
    sets: &Sets,
    materials: &BTreeMap<String, Material>,
    sections: &BTreeMap<String, String>,
    step: &Step,
    model: &Model,
) -> Option<Vec<Part>> {
    let findings = step.findings;
    let mut kinds: BTreeSet<&str> = sets.elements.values().map(|(kind, _)| kind.as_str()).collect();
    if kinds.contains("C3D20R") && kinds.contains("C3D20") {
        findings.refuse(1, "C3D20 and C3D20R in one deck", "a method of a scene has one integration");
    }
    let known = ["C3D4", "C3D6", "C3D8", "C3D10", "C3D15", "C3D20", "C3D20R"];
    if let Some(other) = kinds.iter().find(|kind| !known.contains(kind)) {
        let help = format!("read are {}", known.join(", "));
        findings.refuse(1, format!("elements {other} can't be expressed"), &help);
        return None;
    }
    let mut parts = vec![
        Part::new("[body]")
            .note("The deck itself is the mesh: its sets and surfaces keep their names.")
            .key("shape", quoted("file"))
            .key("path", quoted(model.path))
            .key("unit", quoted(model.units.length())),
    ];
    let origin = |material: &Material| format!("*MATERIAL {} (line {})", material.name, material.line);
    let mut of_sets: Vec<(&str, &Material)> = Vec::new();
    for (set, name) in sections {
        match materials.get(name) {
            Some(material) => of_sets.push((set, material)),
            None => findings.refuse(1, format!("material '{name}' is not in the deck"), ""),
        }
    }
    let ((_, first), others) = of_sets.split_first()?;
    parts.push(first.keys(Part::new("[material]").note(origin(first)), step.large, model.units)?);
    for (set, material) in others.iter().filter(|(_, material)| material.name != first.name) {
        let part = Part::new("[[region]]").note(origin(material)).key("name", quoted(set));
        parts.push(part.key("on", quoted(set)));
        parts.push(material.keys(Part::new("[region.material]"), step.large, model.units)?);
    }
    let reduced = kinds.remove("C3D20R");
    let mut solids: Vec<CellKind> = kinds.iter().filter_map(|kind| solid(kind)).collect();
    solids.extend(reduced.then_some(solid("C3D20")).flatten());
    let linear = |kind: &CellKind| kind.node_count() == kind.entry().cell.corners;
    let element = match &solids[..] {
        [one] => one.name(),
        all if all.iter().all(linear) && !all.is_empty() => "mixed-linear",
        all if !all.iter().any(linear) && !all.is_empty() => "mixed-quadratic",
        _ => {
            findings.refuse(1, "linear and quadratic elements in one body", "");
            return None;
        }
    };
    let id = if reduced { format!("{element}-reduced") } else { element.to_string() };
    let part = Part::new("[[method]]").note("The elements of the deck.").key("id", quoted(&id));
    let part = part.key("family", quoted("fem")).key("element", quoted(element));
    let part = part.maybe("reduced", reduced.then(|| "true".into()));
    let vibrates = matches!(step.kind, Some(Kind::Modes { .. }));
    let part = part.maybe("mass", vibrates.then(|| quoted("consistent")));
    parts.push(part.key("size", model.size()));
    Some(parts)
}

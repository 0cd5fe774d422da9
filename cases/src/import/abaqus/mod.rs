//! Decks of CalculiX, whose keywords are those of Abaqus. (CalculiX CrunchiX manual, 7.)

mod amplitude;
mod body;
mod deck;
mod loads;
mod material;
mod nodal;
mod procedure;
mod sets;
mod steps;

use std::collections::BTreeSet;

use mesh_files::DeckCard;

use self::amplitude::Amplitude;
use self::body::{Materials, method};
use self::deck::Deck;
use self::sets::Sets;
use self::steps::Steps;
use super::document::{Part, print};
use super::finding::{Finding, Findings};
use super::model::{Imported, Model, head};

/// Makes a scene of a step of a deck.
pub(super) fn import(bytes: &[u8], model: &Model) -> Result<Imported, Vec<Finding>> {
    let fault = |(line, what)| vec![Finding { file: model.file.into(), line, what, help: None }];
    let cards = mesh_files::deck_cards(bytes).map_err(fault)?;
    let steps: Vec<usize> =
        cards.iter().filter(|card| card.keyword == "STEP").map(|card| card.line).collect();
    let step = model.step.unwrap_or(steps.len());
    if step == 0 || step > steps.len() {
        return Err(fault((0, format!("has {} steps, so no step {step}", steps.len()))));
    }
    let findings = Findings::of(model.file);
    let (first, later) = match steps.get(step) {
        Some(line) => cards.split_at(cards.partition_point(|card| card.line < *line)),
        None => cards.split_at(cards.len()),
    };
    for card in later.iter().filter(|card| card.keyword == "STEP") {
        findings.leave_out(card.line, format!("a *STEP after *STEP {step}"));
    }
    let scene = scene(first, model, &findings);
    let left_out = findings.close()?;
    match scene {
        Some(parts) => {
            let what = if steps.len() > 1 { format!("step {step} of the deck") } else { "the deck".into() };
            let head = head(model, &what, &left_out);
            let parts: Vec<Part> = std::iter::once(head).chain(parts).collect();
            Ok(Imported { scene: print(&parts), left_out })
        }
        None => Err(fault((1, "has no material of all its elements".into()))),
    }
}

/// The scene of the last step of these cards.
fn scene(cards: &[DeckCard], model: &Model, findings: &Findings) -> Option<Vec<Part>> {
    let mut sets = Sets::default();
    let mut others: Vec<&DeckCard> = cards.iter().filter(|card| !sets.card(card, findings)).collect();
    sets.leave_out_unused(findings);
    let materials = Materials::take(&mut others, model, findings);
    let of = |keyword: &'static str| others.iter().filter(move |card| card.keyword == keyword);
    let named = |name: &str| (name.to_ascii_uppercase(), name.to_string());
    let amplitudes = of("AMPLITUDE").filter_map(|card| Amplitude::read(card, findings));
    let turned: Vec<BTreeSet<u64>> =
        of("TRANSFORM").filter_map(|card| sets.members(true, card.get("NSET").unwrap_or_default())).collect();
    let deck = Deck {
        sets: &sets,
        findings,
        units: model.units,
        surfaces: of("SURFACE").filter_map(|card| card.get("NAME").map(named)).collect(),
        amplitudes: amplitudes.map(|amplitude| (amplitude.name().to_ascii_uppercase(), amplitude)).collect(),
        turned: turned.into_iter().flatten().collect(),
        density: materials.density(),
    };
    let mut steps = Steps::of(&deck, materials.damping(), materials.expand(), materials.are_large());
    others.iter().filter(|card| card.keyword != "SURFACE").for_each(|card| steps.card(card));
    let conditions = steps.parts();
    let element = method(&sets, conditions.as_ref().map(|(procedure, _)| *procedure), model, findings);
    let mut parts = materials.parts(steps.large, model, findings)?;
    parts.push(element?);
    parts.extend(conditions?.1);
    Some(parts)
}

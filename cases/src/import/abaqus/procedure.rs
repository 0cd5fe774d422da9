//! Procedures of steps. (CalculiX CrunchiX manual, 7.)

use mesh_files::DeckCard;

use super::deck::Deck;
use super::sets::real;
use crate::import::document::{Part, quoted};
use crate::import::finding::Findings;
use crate::import::units::{Units, number};

/// Largest number of steps in time.
const MOST_STEPS: f64 = 1e6;
/// Steps of the scene for a step of `*MODAL DYNAMIC`, which follows the loads between its times exactly, and
/// the number up to which the scene takes so many.
const OF_MODAL: f64 = 10.0;
const MOST_OF_MODAL: f64 = 1000.0;

/// Procedure of a step.
pub(super) struct Procedure {
    /// Number of the step, from 1.
    pub step: usize,
    /// Line of `*STEP`.
    pub line: usize,
    kind: Kind,
    /// Duration, s.
    pub duration: f64,
    /// End of the earlier steps, s.
    pub start: f64,
    /// Factors of the mass and of the stiffness in the damping.
    pub damping: [f64; 2],
    /// Whether loads without an amplitude grow over the step.
    pub ramp: bool,
    /// Whether it is a perturbation of the state of an earlier step.
    pub perturbs: bool,
    /// Lines with what the scene leaves out of them.
    pub left_out: Vec<(usize, String)>,
}

enum Kind {
    Static {
        steps: usize,
    },
    Modes {
        count: usize,
    },
    /// Without alpha nothing is dissipated.
    Implicit {
        steps: usize,
        alpha: Option<f64>,
    },
    Explicit,
}

/// Reads the card of a procedure; `None` for another card.
pub(super) fn read(card: &DeckCard, step: [usize; 2], start: f64, findings: &Findings) -> Option<Procedure> {
    let words = card.data.first().map(|(_, words)| words.as_slice()).unwrap_or_default();
    let value = |at: usize| words.get(at).and_then(|word| real(word)).filter(|value| *value > 0.0);
    let (first, time) = (value(0).unwrap_or(1.0), value(1).unwrap_or(1.0));
    let mut left_out = Vec::new();
    let mut leave_out = |what: String| left_out.push((card.line, what));
    let equal = |most: f64| (time / first).round().clamp(1.0, most);
    let kind = match card.keyword.as_str() {
        "STATIC" => Kind::Static { steps: equal(1000.0) as usize },
        "FREQUENCY" => {
            let count = words.first().and_then(|word| word.parse().ok()).unwrap_or(1);
            if let Some(least) = value(1) {
                leave_out(format!("the lowest frequency of *FREQUENCY, {least}"));
            }
            Kind::Modes { count }
        }
        "DYNAMIC" if card.get("EXPLICIT").is_some() => {
            leave_out("the time step and the lumped masses of CalculiX: the scene has its own".into());
            Kind::Explicit
        }
        "DYNAMIC" => {
            let alpha = card.get("ALPHA").map_or(Some(-0.05), real);
            let Some(alpha) = alpha.filter(|alpha| (-1.0 / 3.0..=0.0).contains(alpha)) else {
                findings.refuse(card.line, "ALPHA of *DYNAMIC is no number from -1/3 to 0", "");
                return None;
            };
            if card.get("DIRECT").is_none() {
                leave_out("increments that CalculiX chooses: the scene has equal steps".into());
            }
            Kind::Implicit { steps: equal(MOST_STEPS) as usize, alpha: Some(alpha) }
        }
        "MODAL DYNAMIC" => {
            leave_out("the sum of modes: the scene integrates all of them in time".into());
            let steps = equal(MOST_STEPS);
            Kind::Implicit { steps: steps.max((OF_MODAL * steps).min(MOST_OF_MODAL)) as usize, alpha: None }
        }
        _ => return None,
    };
    if let Some((key, _)) = card.parameters.iter().find(|(key, _)| {
        ["RIKS", "STEADY STATE", "RELATIVE TO ABSOLUTE", "CYCMPC", "GLOBAL"].contains(&key.as_str())
    }) {
        findings.refuse(card.line, format!("{key} of *{} can't be expressed", card.keyword), "");
    }
    let duration = if matches!(kind, Kind::Modes { .. }) { 0.0 } else { time };
    let ramp = matches!(kind, Kind::Static { .. });
    let [step, line] = step;
    Some(Procedure { step, line, kind, duration, start, damping: [0.0; 2], ramp, perturbs: false, left_out })
}

impl Procedure {
    /// Whether these are modes, on which loads and displacements have no effect.
    pub fn vibrates(&self) -> bool {
        matches!(self.kind, Kind::Modes { .. })
    }

    pub fn in_time(&self) -> bool {
        matches!(self.kind, Kind::Implicit { .. } | Kind::Explicit)
    }

    /// A value at the end of the step; in time, the value with the curve that it follows.
    pub fn value(
        &self,
        value: f64,
        amplitude: Option<&String>,
        line: usize,
        deck: &Deck,
    ) -> Option<(f64, Option<String>)> {
        let Some(name) = amplitude else { return Some((value, None)) };
        let Some(amplitude) = deck.amplitudes.get(name) else {
            let help = "give a table of times that rise";
            deck.findings.refuse(line, format!("amplitude '{name}' is not read"), help);
            return None;
        };
        Some(match self.in_time() {
            true => (value, Some(quoted(amplitude.name()))),
            false => (value * amplitude.at(self.duration, self.start), None),
        })
    }

    /// The procedure of the scene.
    pub fn part(&self, large: bool, units: Units) -> Part {
        let part = Part::new("[procedure]").note(format!("*STEP {} (line {})", self.step, self.line));
        let text = |kind| quoted(kind);
        let part = match self.kind {
            Kind::Modes { count } => return part.key("kind", text("modes")).key("modes", count.to_string()),
            Kind::Static { .. } if !large => return part.key("kind", text("linear")),
            Kind::Static { steps } => {
                return part.key("kind", text("static")).key("steps", steps.to_string());
            }
            Kind::Explicit => part.key("kind", text("explicit")),
            Kind::Implicit { .. } => part.key("kind", text("implicit-dynamic")),
        };
        let over = if self.ramp { self.duration } else { 0.0 };
        let part = part.key("duration", units.times(self.duration)).key("over", units.times(over));
        let part = match self.kind {
            Kind::Implicit { steps, alpha } => {
                let (key, value) = alpha.map_or(("spectral_radius", 1.0), |alpha| ("alpha", alpha));
                part.key("steps", steps.to_string()).key(key, number(value))
            }
            _ => part,
        };
        let [mass, stiffness] = self.damping;
        part.maybe("damping", (mass != 0.0).then(|| units.rates(mass)))
            .maybe("stiffness_damping", (stiffness != 0.0).then(|| units.times(stiffness)))
    }
}

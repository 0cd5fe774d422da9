//! The cards of the steps up to the one that is imported. Supports and loads of earlier steps hold until a
//! later step replaces them; their procedures leave nothing else behind, because the laws have no memory.
//! (CalculiX CrunchiX manual, 7.)

use std::collections::BTreeSet;

use mesh_files::DeckCard;

use super::deck::Deck;
use super::loads::{Load, Loads, Target, has_face};
use super::nodal::{Entry, Nodal, axes};
use super::procedure::{self, Procedure};
use super::sets::{bare, real};
use crate::import::document::{Part, list};

/// Keywords that steer the output or the solver, or that describe what the deck does not use.
const PASSED: [&str; 23] = [
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
    "PHYSICAL CONSTANTS",
    "DESIGN VARIABLES",
];

/// Conditions of a deck at a step.
pub(super) struct Steps<'d> {
    deck: &'d Deck<'d>,
    supports: Nodal,
    forces: Nodal,
    loads: Loads,
    printed: BTreeSet<u64>,
    /// Step and line of the last `*NODE PRINT`.
    printed_at: [usize; 2],
    procedures: Vec<Procedure>,
    /// Number and line of the current step.
    current: [usize; 2],
    /// Factors of the mass and of the stiffness in the damping of `*DYNAMIC`, if all materials have the same.
    damping: Option<[f64; 2]>,
    /// Whether a material expands with its temperature.
    expands: bool,
    /// Whether displacements are large.
    pub large: bool,
    /// `AMPLITUDE` of the current `*STEP`.
    ramp: Option<bool>,
    perturbation: bool,
}

impl<'d> Steps<'d> {
    pub fn of(deck: &'d Deck, damping: Option<[f64; 2]>, expands: bool, large: bool) -> Steps<'d> {
        Steps {
            deck,
            supports: Nodal::default(),
            forces: Nodal::forces(),
            loads: Loads::default(),
            printed: BTreeSet::new(),
            printed_at: [0; 2],
            procedures: Vec::new(),
            current: [0; 2],
            damping,
            expands,
            large,
            ramp: None,
            perturbation: false,
        }
    }

    fn refuse(&self, line: usize, what: impl Into<String>, help: &str) {
        self.deck.findings.refuse(line, what, help);
    }

    fn leave_out(&self, line: usize, what: impl Into<String>) {
        self.deck.findings.leave_out(line, what);
    }

    /// Reads a card of the steps, or one before them that is no part of the mesh or of a material.
    pub fn card(&mut self, card: &DeckCard) {
        let is =
            |key: &str, value: &str| card.get(key).is_some_and(|found| found.eq_ignore_ascii_case(value));
        match card.keyword.as_str() {
            "STEP" => self.step(card),
            "BOUNDARY" => self.boundary(card),
            "CLOAD" => self.concentrated(card),
            "DLOAD" | "DSLOAD" => self.distributed(card),
            "NODE PRINT" => self.print(card),
            "MODAL DAMPING" => self.modal_damping(card),
            "AMPLITUDE" | "TRANSFORM" => {}
            "ORIENTATION" => self.leave_out(card.line, "*ORIENTATION of isotropic materials"),
            "RESTART" if card.get("READ").is_none() => self.leave_out(card.line, "*RESTART"),
            "INITIAL CONDITIONS" if is("TYPE", "TEMPERATURE") => {
                self.leave_out(card.line, "initial temperatures, from which a material expands");
            }
            "TEMPERATURE" if !self.expands => self.leave_out(card.line, "*TEMPERATURE without *EXPANSION"),
            keyword if PASSED.contains(&keyword) => self.leave_out(card.line, format!("*{keyword}")),
            keyword => {
                let start = self.procedures.iter().map(|procedure| procedure.duration).sum();
                match procedure::read(card, self.current, start, self.deck.findings) {
                    Some(read) => self.procedures.push(self.begun(card, read)),
                    None => self.refuse(card.line, format!("*{keyword} can't be expressed"), ""),
                }
            }
        }
    }

    fn step(&mut self, card: &DeckCard) {
        self.current = [self.current[0] + 1, card.line];
        // Once set, it holds for all later steps.
        self.large |= card.get("NLGEOM").is_some_and(|value| !value.eq_ignore_ascii_case("NO"));
        self.perturbation = card.get("PERTURBATION").is_some();
        self.ramp = card.get("AMPLITUDE").map(|value| value.eq_ignore_ascii_case("RAMP"));
    }

    /// A procedure with what its step and the materials add to it.
    fn begun(&self, card: &DeckCard, mut read: Procedure) -> Procedure {
        read.ramp = self.ramp.unwrap_or(read.ramp);
        read.perturbs = self.perturbation;
        if card.keyword == "DYNAMIC" {
            if self.damping.is_some_and(|[_, stiffness]| stiffness != 0.0) {
                let what = "damping by the speed at the end of a step: the scene takes the mean of the step";
                read.left_out.push((card.line, what.into()));
            }
            match self.damping {
                Some(damping) => read.damping = damping,
                None => self.refuse(card.line, "materials with different *DAMPING", "a scene has one"),
            }
        }
        read
    }

    /// Whether a card of conditions holds no parameter that changes its meaning.
    fn plain(&self, card: &DeckCard) -> bool {
        let op = |value: &str| ["NEW", "MOD"].contains(&value.to_ascii_uppercase().as_str());
        let known = |key: &str, value: &str| key == "AMPLITUDE" || (key == "OP" && op(value));
        let other = card.parameters.iter().find(|(key, value)| !known(key, value));
        if let Some((key, value)) = other {
            self.refuse(card.line, format!("{key}={value} of *{} can't be expressed", card.keyword), "");
        }
        other.is_none()
    }

    /// Whether a card of conditions can be read. `OP=NEW` removes the conditions of earlier steps; CalculiX
    /// ignores it unless the card is the first of its kind in a step.
    fn opens(&mut self, card: &DeckCard) -> bool {
        let readable = self.plain(card);
        let new = card.get("OP").is_some_and(|value| value.eq_ignore_ascii_case("NEW"));
        let step = self.current[0];
        let renewed = match card.keyword.as_str() {
            _ if !readable || !new => true,
            "BOUNDARY" => self.supports.renew(step),
            "CLOAD" => self.forces.renew(step),
            _ => self.loads.renew(step),
        };
        if !renewed {
            self.leave_out(
                card.line,
                format!("OP=NEW of a *{} that is not the first of its step", card.keyword),
            );
        }
        readable
    }

    fn boundary(&mut self, card: &DeckCard) {
        if !self.opens(card) {
            return;
        }
        for (line, words) in &card.data {
            let name = bare(words.first().map_or("", String::as_str));
            let value = words.get(3).map_or(Some(0.0), |word| real(word));
            let (Some((first, last)), Some(value)) = (axes(words), value) else {
                self.refuse(*line, "no degrees of freedom with their value", "");
                continue;
            };
            if first > 3 {
                self.leave_out(*line, format!("degrees of freedom {first} to {last}, which solids lack"));
                continue;
            }
            let Some(nodes) = self.deck.nodes(name, *line) else { continue };
            for axis in first..=last.min(3) {
                self.supports.add(self.entry(card, *line, name, nodes.clone(), axis as usize - 1, value));
            }
        }
    }

    fn concentrated(&mut self, card: &DeckCard) {
        if !self.opens(card) {
            return;
        }
        for (line, words) in &card.data {
            let name = bare(words.first().map_or("", String::as_str));
            let axis = words.get(1).and_then(|word| word.parse::<usize>().ok());
            let value = words.get(2).map_or(Some(0.0), |word| real(word));
            let (Some(axis), Some(value)) = (axis.filter(|axis| (1..=3).contains(axis)), value) else {
                self.refuse(*line, "no force along 1, 2 or 3", "");
                continue;
            };
            let Some(nodes) = self.deck.nodes(name, *line) else { continue };
            self.forces.add(self.entry(card, *line, name, nodes, axis - 1, value));
        }
    }

    fn entry(
        &self,
        card: &DeckCard,
        line: usize,
        name: &str,
        nodes: BTreeSet<u64>,
        axis: usize,
        value: f64,
    ) -> Entry {
        let amplitude = card.get("AMPLITUDE").map(str::to_ascii_uppercase);
        Entry { line, step: self.current[0], name: name.into(), nodes, axis, value, amplitude }
    }

    fn distributed(&mut self, card: &DeckCard) {
        if !self.opens(card) {
            return;
        }
        for (line, words) in &card.data {
            let name = bare(words.first().map_or("", String::as_str));
            let label = words.get(1).map(|label| label.to_ascii_uppercase()).unwrap_or_default();
            let values: Option<Vec<f64>> = words.iter().skip(2).map(|word| real(word)).collect();
            let Some(values) = values else {
                self.refuse(*line, "a word that is no number", "");
                continue;
            };
            let Some(target) = self.target(&card.keyword, name, &label, &values) else {
                let help = "pressures on faces of solids (P1 to P6, P), GRAV and CENTRIF are read";
                self.refuse(*line, format!("load {label} on '{name}' can't be expressed"), help);
                continue;
            };
            let value = values.first().copied().unwrap_or(0.0);
            // The pressure of a node of a network, in place of a value.
            let node = label.ends_with("NP").then_some(value as u64);
            let load = Load {
                line: *line,
                step: self.current[0],
                keyword: card.keyword.clone(),
                name: name.into(),
                label,
                target,
                value,
                node,
                amplitude: card.get("AMPLITUDE").map(str::to_ascii_uppercase),
            };
            self.loads.add(load, self.deck);
        }
    }

    fn target(&self, keyword: &str, name: &str, label: &str, values: &[f64]) -> Option<Target> {
        let unit = |axis: [f64; 3]| {
            let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
            (length > 0.0).then(|| axis.map(|x| x / length))
        };
        match (keyword, label, values) {
            ("DSLOAD", "P", _) => {
                self.deck.surfaces.get(&name.to_ascii_uppercase()).cloned().map(Target::Surface)
            }
            ("DLOAD", "GRAV", &[_, x, y, z]) => unit([x, y, z]).map(Target::Gravity),
            ("DLOAD", "CENTRIF", &[_, a, b, c, x, y, z]) => {
                unit([x, y, z]).map(|axis| Target::Rotation { point: [a, b, c], axis })
            }
            ("DLOAD", _, _) => {
                let cells = self.deck.sets.members(false, name)?;
                let label = label.strip_suffix("NP").unwrap_or(label).to_string();
                has_face(self.deck, &cells, &label).then_some(Target::Faces { label, cells })
            }
            _ => None,
        }
    }

    fn print(&mut self, card: &DeckCard) {
        let printed =
            card.data.iter().flat_map(|(_, words)| words).any(|word| word.eq_ignore_ascii_case("U"));
        let nodes = self.deck.sets.members(true, card.get("NSET").unwrap_or_default());
        let (true, Some(nodes)) = (printed, nodes) else {
            self.leave_out(card.line, "*NODE PRINT of other values than U");
            return;
        };
        // The first card of a step ends the output of earlier steps.
        if self.printed_at[0] < self.current[0] {
            self.printed.clear();
        }
        self.printed_at = [self.current[0], card.line];
        self.printed.extend(nodes);
    }

    fn modal_damping(&mut self, card: &DeckCard) {
        let words: Vec<&str> = card.data.iter().flat_map(|(_, words)| words).map(|word| bare(word)).collect();
        let numbers = |word: &&str| real(word);
        match (&words[..], self.procedures.last_mut()) {
            ([_, _, alpha, beta, rest @ ..], Some(procedure))
                if card.get("RAYLEIGH").is_some() && rest.iter().all(|word| word.is_empty()) =>
            {
                if let [Some(alpha), Some(beta)] = [alpha, beta].map(numbers) {
                    procedure.damping = [alpha, beta];
                    return;
                }
            }
            _ => {}
        }
        self.refuse(card.line, "*MODAL DAMPING of single modes can't be expressed", "RAYLEIGH is read");
    }

    /// The procedure of the last step that was read, checked against the steps before it.
    fn last(&self) -> Option<&Procedure> {
        let [step, line] = self.current;
        let Some(last) = self.procedures.last().filter(|procedure| procedure.step == step) else {
            if !self.deck.findings.refuses() {
                self.refuse(line, format!("*STEP {step} has no procedure that can be expressed"), "");
            }
            return None;
        };
        let moved = |earlier: &&Procedure| earlier.step < step && !earlier.vibrates();
        if let Some(earlier) = self.procedures.iter().find(moved) {
            if last.in_time() {
                let what = format!("*STEP {step} begins with the state of *STEP {}", earlier.step);
                self.refuse(line, what, "a scene begins at rest and undeformed");
            }
            if last.perturbs || earlier.perturbs {
                let what =
                    format!("PERTURBATION: *STEP {step} begins with the stress of *STEP {}", earlier.step);
                self.refuse(line, what, "a scene begins without stress");
            }
        }
        Some(last)
    }

    /// The conditions, the procedure and the output of the last step that was read.
    pub fn parts(&self) -> Option<(&Procedure, Vec<Part>)> {
        let (deck, procedure) = (self.deck, self.last()?);
        let earlier = self.procedures.iter().filter(|earlier| earlier.step < procedure.step);
        for Procedure { step, line, .. } in earlier {
            self.leave_out(*line, format!("the end of *STEP {step}, whose supports and loads hold on"));
        }
        procedure.left_out.iter().for_each(|(line, what)| self.leave_out(*line, what));
        let mut parts = Vec::new();
        if procedure.in_time() {
            let of_nodes = self.supports.amplitudes().chain(self.forces.amplitudes());
            let names: BTreeSet<&String> = of_nodes.chain(self.loads.amplitudes()).collect();
            let curves = names.into_iter().filter_map(|name| deck.amplitudes.get(name));
            parts.extend(curves.map(|amplitude| amplitude.curve(procedure.start, deck.units)));
        }
        parts.extend(self.supports.supports(deck, procedure));
        if !procedure.vibrates() {
            parts.extend(self.forces.loads(deck, procedure));
            parts.extend(self.loads.parts(deck, procedure, self.large, &self.supports));
        } else if !self.forces.are_zero() || !self.loads.are_zero() {
            self.leave_out(procedure.line, "loads, which have no effect on modes");
        }
        parts.push(procedure.part(self.large, deck.units));
        parts.extend(self.output(procedure));
        Some((procedure, parts))
    }

    /// The displacements that the deck prints, as probes.
    fn output(&self, procedure: &Procedure) -> Option<Part> {
        let (deck, line) = (self.deck, self.printed_at[1]);
        if procedure.vibrates() && !self.printed.is_empty() {
            self.leave_out(line, "*NODE PRINT of modes");
            return None;
        }
        let (nodes, others): (BTreeSet<u64>, BTreeSet<u64>) =
            self.printed.iter().partition(|node| deck.sets.used(**node));
        let shown = |nodes: &BTreeSet<u64>| nodes.iter().map(u64::to_string).collect::<Vec<_>>().join(", ");
        if !others.is_empty() {
            self.leave_out(line, format!("*NODE PRINT of nodes without elements: {}", shown(&others)));
        }
        let part = Part::new("[output]").note(format!("*NODE PRINT: nodes {}", shown(&nodes)));
        (!nodes.is_empty()).then(|| part.key("probes", list([deck.places(&nodes)])))
    }
}

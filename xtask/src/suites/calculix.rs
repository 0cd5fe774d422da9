//! CalculiX's test suite: the displacements and the frequencies that `.dat.ref` has for each step of a deck.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, Result};
use serde_json::Value;

use super::call::{call, import};
use super::outcome::{Verdict, unfinished};

/// Difference that agrees with seven printed digits, relative to the largest number.
const CLOSE: f64 = 1e-6;

/// Difference below which two ways to step in time, or to end Newton's method, explain it.
const OF_METHODS: f64 = 0.1;

/// Numbers that the suite stores for a step.
#[derive(Default)]
struct Stored {
    /// Displacement of each node at the last time.
    nodes: BTreeMap<u64, [f64; 3]>,
    /// Frequencies, Hz.
    frequencies: Vec<f64>,
}

/// Judges each step of a deck; a deck of one step has no number.
pub(super) fn verdicts(root: &Path, deck: &Path, limit: u64) -> Result<Vec<(Option<usize>, Verdict)>> {
    let read =
        |file: &Path| std::fs::read(file).with_context(|| format!("could not read {}", file.display()));
    let text = String::from_utf8_lossy(&read(deck)?).to_ascii_uppercase();
    let file = deck.with_extension("dat.ref");
    let mut stored = match file.is_file() {
        true => stored(&String::from_utf8_lossy(&read(&file)?)),
        false => BTreeMap::new(),
    };
    let steps = text.lines().filter(|line| line.starts_with("*STEP")).count().max(1);
    let scene = root.join("target/suites.toml");
    let mut all = Vec::new();
    for step in 1..=steps {
        let imported = import(root, deck, step, &scene)?;
        let verdict = match imported.code {
            Some(0) => {
                verdict(&scene, &call(root, &scene, limit)?, stored.remove(&step).unwrap_or_default())?
            }
            _ => unfinished(deck, &imported).err().unwrap_or(Verdict::Runs),
        };
        all.push(((steps > 1).then_some(step), verdict));
    }
    Ok(all)
}

/// Judges the run of the scene of a step.
fn verdict(scene: &Path, run: &super::call::Run, mut stored: Stored) -> Result<Verdict> {
    let object = match unfinished(scene, run) {
        Ok(object) => object,
        Err(verdict) => return Ok(verdict),
    };
    let text = std::fs::read_to_string(scene)?;
    // Nodes without elements are no probes.
    let probed = probed(&text);
    stored.nodes.retain(|node, _| probed.contains(node));
    let numbers = |values: &Value| -> Vec<f64> {
        values.as_array().into_iter().flatten().filter_map(Value::as_f64).collect()
    };
    let list = |key: &str| object[key].as_array().cloned().unwrap_or_default();
    let (ours, theirs): (Vec<f64>, Vec<f64>) = if !stored.frequencies.is_empty() {
        let ours = list("modes").into_iter().filter_map(|mode| mode["frequency"]["value"].as_f64());
        (ours.take(stored.frequencies.len()).collect(), stored.frequencies)
    } else {
        let ours = list("probes").iter().flat_map(|probe| numbers(&probe["u"])).collect();
        (ours, stored.nodes.into_values().flatten().collect())
    };
    if theirs.is_empty() {
        return Ok(Verdict::Runs);
    }
    if ours.len() != theirs.len() {
        let reason = format!("{} numbers for {} stored ones", ours.len(), theirs.len());
        return Ok(Verdict::Fails { reason });
    }
    let most = theirs.iter().fold(f64::MIN_POSITIVE, |most, value| most.max(value.abs()));
    let difference = ours.iter().zip(&theirs).fold(0.0, |worst: f64, (a, b)| worst.max((a - b).abs())) / most;
    Ok(match difference <= CLOSE {
        true => Verdict::Agrees { difference, within: "the printed digits".into() },
        false => Verdict::Differs { difference, reason: reason(&text, difference).into() },
    })
}

/// The reason of a difference, from what the scene says of the step.
fn reason(scene: &str, difference: f64) -> &'static str {
    let says = |text: &str| difference < OF_METHODS && scene.contains(text);
    match () {
        () if says("the sum of modes") => "a sum of modes, where the scene integrates all of them",
        () if says("the two points of C3D6") => "other integration points of C3D6",
        () if says("takes the mean of the step") => "another damping of a time step",
        () if says("increments that CalculiX chooses") => "other increments of time",
        () if says("kind = \"explicit\"") => "another step and other lumped masses",
        () => "unexplained",
    }
}

/// Numbers of the nodes that are the probes of a scene, from its comment.
fn probed(scene: &str) -> Vec<u64> {
    let line = scene.lines().find_map(|line| line.strip_prefix("# *NODE PRINT: nodes "));
    line.into_iter().flat_map(|line| line.split(", ")).filter_map(|node| node.parse().ok()).collect()
}

/// Reads `.dat.ref`, by step.
fn stored(text: &str) -> BTreeMap<usize, Stored> {
    let mut steps: BTreeMap<usize, Stored> = BTreeMap::new();
    let (mut step, mut displacements, mut frequencies) = (1, false, false);
    for line in text.lines() {
        // Letters after the numbers of a node name the local axes of its `*TRANSFORM`.
        let words: Vec<&str> = line.trim_end().trim_end_matches(" L").split_whitespace().collect();
        let values: Vec<f64> = words.iter().filter_map(|word| word.parse().ok()).collect();
        let all_numbers = values.len() == words.len();
        let stored = steps.entry(step).or_default();
        if let ["S", "T", "E", "P", number] = words[..] {
            step = number.parse().unwrap_or(step);
            (displacements, frequencies) = (false, false);
        } else if line.contains("displacements (vx,vy,vz)") {
            (displacements, frequencies) = (true, false);
        } else if line.contains("E I G E N V A L U E   O U T P U T") {
            // A second table replaces the first.
            (displacements, frequencies) = (false, true);
            stored.frequencies.clear();
        } else if words.is_empty() || (!all_numbers && frequencies && stored.frequencies.is_empty()) {
        } else if !all_numbers {
            (displacements, frequencies) = (false, false);
        } else if let (true, [node, x, y, z]) = (displacements, &values[..]) {
            stored.nodes.insert(*node as u64, [*x, *y, *z]);
        } else if let (true, [_, _, _, hertz, _]) = (frequencies, &values[..]) {
            stored.frequencies.push(*hertz);
        }
    }
    steps
}

//! CalculiX's test suite: the displacements and the frequencies that `.dat.ref` has for a deck.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context, Result};

use super::call::Run;
use super::outcome::{Verdict, unfinished};

/// Difference that agrees with seven printed digits, relative to the largest number.
const CLOSE: f64 = 1e-6;

/// Numbers that the suite stores for a deck.
#[derive(Default)]
struct Stored {
    /// Displacement of each node in the last block of a set.
    nodes: BTreeMap<u64, [f64; 3]>,
    /// Frequencies, Hz.
    frequencies: Vec<f64>,
}

/// Judges the run of a deck.
pub(super) fn verdict(deck: &Path, run: &Run) -> Result<Verdict> {
    let object = match unfinished(deck, run) {
        Ok(object) => object,
        Err(verdict) => return Ok(verdict),
    };
    let file = deck.with_extension("dat.ref");
    if !file.is_file() {
        return Ok(Verdict::Runs);
    }
    let text = std::fs::read(&file).with_context(|| format!("could not read {}", file.display()))?;
    let stored = stored(&String::from_utf8_lossy(&text));
    let number = |value: &serde_json::Value| value.as_f64();
    let probes = object["probes"].as_array().map(Vec::as_slice).unwrap_or_default();
    let modes = object["modes"].as_array().map(Vec::as_slice).unwrap_or_default();
    let (ours, theirs): (Vec<f64>, Vec<f64>) = if !stored.frequencies.is_empty() {
        let ours = modes.iter().filter_map(|mode| number(&mode["frequency"]["value"]));
        (ours.take(stored.frequencies.len()).collect(), stored.frequencies)
    } else {
        let ours = probes.iter().flat_map(|probe| probe["u"].as_array().cloned().unwrap_or_default());
        (ours.filter_map(|u| number(&u)).collect(), stored.nodes.into_values().flatten().collect())
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
        false => Verdict::Differs { difference, reason: "unexplained".into() },
    })
}

/// Reads `.dat.ref`.
fn stored(text: &str) -> Stored {
    let mut stored = Stored::default();
    let (mut displacements, mut frequencies) = (false, false);
    for line in text.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        let values: Vec<f64> = words.iter().filter_map(|word| word.parse().ok()).collect();
        let all_numbers = values.len() == words.len();
        if line.contains("displacements (vx,vy,vz)") {
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
    stored
}

//! Comparison with published numbers, and the stability of the published case.

use std::collections::BTreeMap;

use catalogue::metric;
use records::Family;
use records::text::{duration, percent, significant};

use crate::claims::{Pair, Split, pairs, reproduced, splits};
use crate::select::Run;

/// Sentences on ours and the published numbers, on RMS differences, and on stability.
pub(super) fn published(runs: &[Run]) -> Vec<String> {
    let mut by_method: BTreeMap<(&str, &str), Vec<String>> = BTreeMap::new();
    for pair in pairs(runs).iter().filter(|pair| pair.run.whole()) {
        by_method.entry((&pair.run.is.case, &pair.run.is.method)).or_default().extend(compared(pair));
    }
    by_method.retain(|_, parts| !parts.is_empty());
    let numbers = by_method.iter().map(|((case, method), parts)| {
        format!("{case}, {method} (published, ours, published over ours): {}.", parts.join("; "))
    });
    let mut out: Vec<String> = numbers.collect();
    out.extend(splits(runs).iter().filter_map(largest_part));
    out.extend(limits(runs));
    out.extend(ramps(runs));
    if !out.is_empty() {
        let mut caveats: Vec<&String> =
            runs.iter().filter_map(|r| reproduced(r.is)?.caveat.as_ref()).collect();
        caveats.dedup();
        out.extend(caveats.into_iter().cloned());
    }
    out
}

/// A published number, ours, and their ratio.
fn compared(pair: &Pair) -> Option<String> {
    let ours = pair.ours?;
    let published = &pair.number.published;
    let shown = match published.unit() {
        "1" => significant(ours, 4),
        "s" => duration(ours),
        unit => format!("{} {unit}", significant(ours / published.unit, 3)),
    };
    let ratio = significant(pair.ratio()?, 2);
    Some(format!("{} {}, {shown}, {ratio}", pair.number.what, published.text))
}

fn mm(value: f64) -> String {
    significant(value * 1e3, 3)
}

fn three(values: [f64; 3]) -> String {
    let [x, y, z] = values.map(mm);
    format!("{x}, {y} and {z} mm")
}

fn largest_displacements(run: &Run) -> Option<[f64; 3]> {
    let [x, y, z] = metric::MAX.components().map(|of| run.value(of));
    Some([x?, y?, z?])
}

/// Sentence on the largest component of the RMS difference between cloud and elements.
fn largest_part(split: &Split) -> Option<String> {
    let [whole, _, components @ ..] = split.parts();
    let (what, largest) = components
        .into_iter()
        .filter_map(|(what, [.., magnitude])| Some((what, magnitude?)))
        .max_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(format!(
        "{}: RMS difference of {}: {} mm in magnitude. Its largest component is {} mm ({what}).",
        split.cloud.is.case,
        whole.0,
        mm(whole.1[3]?),
        mm(largest)
    ))
}

/// Sentences on the load up to which a static path was stable, the time it took, and its continuation.
fn limits(runs: &[Run]) -> Vec<String> {
    let mut out = Vec::new();
    for run in runs.iter().filter(|r| reproduced(r.is).is_some()) {
        let (Some(load), Some(force), Some(closure)) = (
            run.value(&metric::LIMIT_LOAD),
            run.value(&metric::LIMIT_TOOL_FORCE),
            run.value(&metric::LIMIT_CLOSURE),
        ) else {
            continue;
        };
        let on = match (run.value(&metric::RELAXATION_STEPS), run.value(&metric::LOAD_CARRIED)) {
            (Some(steps), Some(reached)) if reached > load => {
                format!(
                    " Dynamic relaxation then reaches {} of the load in {steps:.0} steps.",
                    percent(reached)
                )
            }
            (None, Some(reached)) if reached > load => {
                format!(
                    " The body then loses stability; the solver finds another equilibrium and reaches {} of the load.",
                    percent(reached)
                )
            }
            _ => String::new(),
        };
        let within = run
            .time("solve-to-limit", "median")
            .map_or(String::new(), |s| format!(", computed in {}", duration(s)));
        out.push(format!(
            "{}, {}: the body is stable up to {} of the load ({} N at a closure of {} mm{within}).{on}",
            run.is.case,
            run.is.method,
            percent(load),
            significant(force, 3),
            mm(closure)
        ));
    }
    out
}

/// Sentences that compare a method at the same force in a quasi-static run and at the end of a ramp.
fn ramps(runs: &[Run]) -> Vec<String> {
    let reading = |r: &&Run| reproduced(r.is).is_some() && r.is.family == Family::Fem && r.whole();
    let readings = || runs.iter().filter(reading);
    let mut out = Vec::new();
    for ramp in readings().filter(|r| r.value(&metric::TIME_STEPS).is_some()) {
        let still =
            |r: &Run| r.value(&metric::NEWTON_ITERATIONS).is_some() && r.value(&metric::TIME_STEPS).is_none();
        let same = |r: &&Run| r.is.method == ramp.is.method && still(r);
        let (Some(still), Some(seconds)) = (readings().find(same), ramp.value(&metric::TIME_REACHED)) else {
            continue;
        };
        let (Some(moved), Some(rest)) = (largest_displacements(ramp), largest_displacements(still)) else {
            continue;
        };
        let change = (0..3).map(|a| (moved[a] / rest[a] - 1.0).abs()).fold(0.0, f64::max);
        out.push(format!(
            "{}: at the end of a ramp of {} the largest displacements are {} in x, y and z. The quasi-static solution \
             has {}. They differ by at most {}.",
            ramp.is.method,
            duration(seconds),
            three(moved),
            three(rest),
            percent(change)
        ));
    }
    out
}

//! Comparison with published numbers.

use std::collections::BTreeMap;

use records::Family;
use records::text::{duration, percent, significant};

use crate::published::read_as;
use crate::select::Run;
use crate::tables::{PublishedPair as Pair, PublishedSplit as Split, published_pairs, published_splits};

/// Sentences on speed-ups and RMS differences compared with the publication.
pub(super) fn published(runs: &[Run]) -> Vec<String> {
    let pairs = published_pairs(runs);
    let mut out = Vec::new();
    for family in [Family::Fem, Family::Efg] {
        let mut by_method: BTreeMap<(&str, &str), Vec<String>> = BTreeMap::new();
        for pair in pairs.iter().filter(|p| p.paper.family == family) {
            if let (Some(speed), Some(ours)) = (pair.speed_up(), pair.ours) {
                by_method.entry((&pair.run.is.case, &pair.run.is.method)).or_default().push(format!(
                    "{} takes {} here and {} in the publication, {} times as long",
                    pair.paper.what,
                    duration(ours),
                    duration(pair.paper.value),
                    significant(speed, 2)
                ));
            }
        }
        for ((case, method), parts) in by_method {
            out.push(format!("{case}, {method}: {}.", parts.join("; ")));
        }
    }
    out.extend(maxima(&pairs));
    out.extend(published_splits(runs).iter().filter_map(parts));
    out.extend(limits(runs));
    out.extend(ramps(runs));
    let mut caveats: Vec<&str> = runs.iter().filter_map(|r| read_as(r.is)).map(|p| p.caveat).collect();
    caveats.dedup();
    if !out.is_empty() {
        out.extend(caveats.into_iter().map(String::from));
    }
    out
}

fn mm(value: f64) -> String {
    significant(value * 1e3, 3)
}

fn directions(run: &Run, quantity: &str) -> Option<[f64; 3]> {
    let [x, y, z] = ["x", "y", "z"].map(|axis| run.value(&format!("{quantity}-{axis}")));
    Some([x?, y?, z?])
}

/// Sentences on the largest displacements at the whole load, with their ratio to the published ones.
fn maxima(pairs: &[Pair]) -> Vec<String> {
    let mut out = Vec::new();
    for pair in pairs.iter().filter(|p| p.paper.quantity == "max-x" && p.run.whole()) {
        let of = |axis: &str| {
            let quantity = format!("max-{axis}");
            pairs.iter().find(|p| {
                p.paper.quantity == quantity
                    && p.paper.family == pair.paper.family
                    && std::ptr::eq(p.run, pair.run)
            })
        };
        let (Some([x, y, z]), Some(y_theirs), Some(z_theirs)) =
            (directions(pair.run, "max"), of("y"), of("z"))
        else {
            continue;
        };
        let theirs = [pair.paper.value, y_theirs.paper.value, z_theirs.paper.value];
        let [a, b, c] = [x / theirs[0], y / theirs[1], z / theirs[2]].map(percent);
        out.push(format!(
            "{}, {}: the largest displacements are {}, {} and {} mm in x, y and z. The published displacements are \
             {}, {} and {} mm; ours are {a}, {b} and {c} of the published values.",
            pair.run.is.case,
            pair.run.is.method,
            mm(x),
            mm(y),
            mm(z),
            mm(theirs[0]),
            mm(theirs[1]),
            mm(theirs[2]),
        ));
    }
    out
}

/// Sentence on the components of the RMS difference between cloud and elements.
fn parts(split: &Split) -> Option<String> {
    let numbers = split.parts().map(|(_, [x, y, z, all])| Some([x?, y?, z?, all?]));
    let [total, own, transfer, cloud, elements] = numbers;
    let (total, own, transfer, cloud, elements) = (total?, own?, transfer?, cloud?, elements?);
    let three = |v: [f64; 4]| format!("{}, {} and {} mm", mm(v[0]), mm(v[1]), mm(v[2]));
    let largest = [
        ("the transfer", transfer),
        ("the discretisation of the cloud", cloud),
        ("the error of the elements", elements),
    ]
    .into_iter()
    .max_by(|a, b| a.1[3].total_cmp(&b.1[3]))?;
    let publication = read_as(split.cloud.is)?;
    let published = |q: &str| publication.number(Family::Efg, q);
    let theirs = [published("rms-x")?, published("rms-y")?, published("rms-z")?, 0.0];
    let (low, high) = (published("rms-least")?, published("rms-most")?);
    let (name, fe) = (&split.cloud.is.method, &split.elements.is.method);
    let reference = split.reference.unwrap_or("the case's reference");
    Some(format!(
        "{}: {name}, transferred by inverse distance, differs from {fe} by an RMS of {} in x, y and z. The publication gives {} in its text and {} \
         to {} mm in its abstract. Without the transfer the difference is {}. By itself, the transfer contributes {}, the discretisation of the \
         cloud {} (against {reference}) and the error of {fe} {}. The largest part is {}, {} mm in magnitude; the whole difference is {} mm.",
        split.cloud.is.case,
        three(total),
        three(theirs),
        mm(low),
        mm(high),
        three(own),
        three(transfer),
        three(cloud),
        three(elements),
        largest.0,
        mm(largest.1[3]),
        mm(total[3]),
    ))
}

/// Sentences on the load up to which a static path was stable, the time it took, and its continuation.
fn limits(runs: &[Run]) -> Vec<String> {
    let mut out = Vec::new();
    for run in runs.iter().filter(|r| read_as(r.is).is_some()) {
        let (Some(load), Some(force), Some(closure)) =
            (run.value("limit-load"), run.value("limit-tool-force"), run.value("limit-closure"))
        else {
            continue;
        };
        let on = match (run.value("relaxation-steps"), run.value("load-carried")) {
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
    let reading = |r: &&Run| read_as(r.is).is_some() && r.is.family == Family::Fem && r.whole();
    let readings = || runs.iter().filter(reading);
    let mut out = Vec::new();
    for ramp in readings().filter(|r| r.value("time-steps").is_some()) {
        let still = |r: &Run| r.value("newton-iterations").is_some() && r.value("time-steps").is_none();
        let same = |r: &&Run| r.is.method == ramp.is.method && still(r);
        let (Some(still), Some(seconds)) = (readings().find(same), ramp.value("time-reached")) else {
            continue;
        };
        let (Some(moved), Some(rest)) = (directions(ramp, "max"), directions(still, "max")) else { continue };
        let change = (0..3).map(|a| (moved[a] / rest[a] - 1.0).abs()).fold(0.0, f64::max);
        out.push(format!(
            "{}: at the end of a ramp of {} the largest displacements are {}, {} and {} mm in x, y and z. The quasi-static solution has {}, {} and {} \
             mm. They differ by at most {}.",
            ramp.is.method,
            duration(seconds),
            mm(moved[0]),
            mm(moved[1]),
            mm(moved[2]),
            mm(rest[0]),
            mm(rest[1]),
            mm(rest[2]),
            percent(change)
        ));
    }
    out
}

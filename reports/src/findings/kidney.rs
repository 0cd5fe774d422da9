//! Our kidney numbers against the published ones, and what a transfer adds.

use std::collections::BTreeMap;

use crate::select::{Run, groups};
use crate::tables::kidney_pairs;
use crate::text::{duration, significant};

/// Speed-ups and RMS differences beside the publication.
pub(super) fn kidney(runs: &[Run]) -> Vec<String> {
    let pairs = kidney_pairs(runs);
    let mut out = Vec::new();
    for family in ["fem", "efg"] {
        let mut by_method: BTreeMap<&str, Vec<String>> = BTreeMap::new();
        for pair in pairs.iter().filter(|p| p.paper.family == family) {
            if let (Some(speed), Some(ours)) = (pair.speed_up(), pair.ours) {
                by_method.entry(&pair.run.is.method).or_default().push(format!(
                    "{} takes {} here, {} in the publication, {} times as long",
                    pair.paper.what,
                    duration(ours),
                    duration(pair.paper.value),
                    significant(speed, 2)
                ));
            }
        }
        for (method, parts) in by_method {
            out.push(format!("{method}: {}.", parts.join("; ")));
        }
    }
    let mut seen: Vec<&str> = Vec::new();
    for pair in &pairs {
        let run = pair.run;
        let method = run.is.method.as_str();
        let (Some(x), Some(y), Some(z)) = (run.value("rms-x"), run.value("rms-y"), run.value("rms-z")) else {
            continue;
        };
        if seen.contains(&method) {
            continue;
        }
        seen.push(method);
        let mm = |v: f64| significant(v * 1e3, 2);
        let published: Vec<&_> = pairs
            .iter()
            .filter(|p| {
                let direction = ["rms-x", "rms-y", "rms-z"].contains(&p.paper.quantity);
                p.run.is.method == method && direction
            })
            .collect();
        let theirs = match published.as_slice() {
            [a, b, c] => {
                format!(
                    "; the publication gives {}, {} and {} mm between its EFG and its FE",
                    mm(a.paper.value),
                    mm(b.paper.value),
                    mm(c.paper.value)
                )
            }
            _ => String::new(),
        };
        out.push(format!(
            "{method}, {} nodes: RMS difference from the reference {}, {} and {} mm in x, y and z{theirs}.",
            run.is.nodes,
            mm(x),
            mm(y),
            mm(z)
        ));
    }
    if !out.is_empty() {
        out.push("Ours is linear elastic on a fitted geometry, so only times and orders of magnitude compare with the publication.".into());
    }
    out
}

/// Best, worst and published transfer scheme for every field carried over.
pub(super) fn transfer(runs: &[Run]) -> Vec<String> {
    let mut out = Vec::new();
    let schemes: Vec<Run> = runs.iter().filter(|r| r.is.family == "interp").cloned().collect();
    for case in groups(&schemes, |r| r.is.case.clone()) {
        let mut sources: Vec<String> = case.iter().map(source).collect();
        sources.sort();
        sources.dedup();
        for from in sources {
            let own: Vec<(&Run, f64)> = case
                .iter()
                .filter(|r| source(r) == from)
                .filter_map(|r| r.value("rms").map(|v| (r, v)))
                .collect();
            let (Some(best), Some(worst)) = (
                own.iter().min_by(|a, b| a.1.total_cmp(&b.1)),
                own.iter().max_by(|a, b| a.1.total_cmp(&b.1)),
            ) else {
                continue;
            };
            let mm = |v: f64| {
                if v < 1e-13 {
                    "rounding only".to_string()
                } else {
                    format!("{} mm RMS", significant(v * 1e3, 2))
                }
            };
            let mut text = format!(
                "{}, {from}: least error after {} ({}), most after {} ({})",
                best.0.is.case,
                best.0.is.variant,
                mm(best.1),
                worst.0.is.variant,
                mm(worst.1)
            );
            let of = |variant: &str| own.iter().find(|(r, _)| r.is.variant == variant).map(|o| o.1);
            if let Some(v) = of("inverse-distance") {
                text += &format!("; after inverse distance, the published scheme, {}", mm(v));
            }
            if let Some(v) = of("own-rows") {
                text += &format!("; with the method's own shape functions {}", mm(v));
            }
            out.push(text + ".");
        }
    }
    out
}

fn source(run: &Run) -> String {
    let field = run.is.parameter("field").map(|f| format!("{f} field"));
    field.or(run.is.parameter("from").map(|f| format!("from {f}"))).unwrap_or_else(|| "transfer".into())
}

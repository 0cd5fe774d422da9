//! How far a result depends on where the nodes of a cloud happen to stand.

use crate::clouds::{Clouds, Spread};
use crate::record::Family;
use crate::text::{list, significant};

/// What a sentence tells of a method, the first that it has an error by, with words, unit and factor.
const ERRORS: [(&str, &str, &str, f64); 2] =
    [("rms", "an RMS error", " mm", 1e3), ("l2", "a relative L2 error", " %", 1e2)];

/// A sentence for every method that ran on many clouds.
pub(super) fn placement(clouds: &[Clouds]) -> Vec<String> {
    let mut out = Vec::new();
    for group in clouds.iter().filter(|g| g[0].is.family != Family::Interp) {
        let is = group[0].is;
        let error = ERRORS.iter().find_map(|(quantity, words, unit, scale)| {
            let spread = Spread::of(group, quantity)?;
            Some((spread.count, phrase(spread, words, unit, *scale)))
        });
        let Some((whole, error)) = error else { continue };
        let mut parts = vec![error];
        if let Some(force) = Spread::of(group, "tool-force").filter(|f| f.quantiles[0] != f.quantiles[4]) {
            parts.push(phrase(force, "a tool force", " N", 1.0));
        }
        let failed = match group.len() - whole {
            0 => String::new(),
            failed => format!("; {failed} of them don't carry the whole load"),
        };
        out.push(format!(
            "{}, {} on {} clouds of {} nodes: {}{failed}.",
            is.case,
            group[0].name(),
            group.len(),
            is.nodes,
            list(&parts)
        ));
    }
    out
}

fn phrase(spread: Spread, words: &str, unit: &str, scale: f64) -> String {
    let [least, _, median, _, most] = spread.quantiles.map(|q| significant(q * scale, 3));
    format!("{words} of {median}{unit} in the median, {least} to {most}{unit} in all")
}

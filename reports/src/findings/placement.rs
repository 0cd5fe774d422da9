//! Findings on the sensitivity of results to node placement.

use catalogue::metric::{self, Metric};
use records::Family;
use records::text::significant;

use crate::clouds::{Clouds, Spread};

/// Candidate errors, of which a method's first is reported, each with its words, unit and scale factor.
const ERRORS: [(&Metric, &str, &str, f64); 2] =
    [(&metric::RMS, "the RMS error", " mm", 1e3), (&metric::L2, "the relative L2 error", " %", 1e2)];

/// One sentence for every method that ran on many clouds.
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
        if let Some(force) =
            Spread::of(group, &metric::TOOL_FORCE).filter(|f| f.quantiles[0] != f.quantiles[4])
        {
            parts.push(phrase(force, "the tool force", " N", 1.0));
        }
        let failed = match group.len() - whole {
            0 => String::new(),
            failed => format!("; {failed} of these runs do not reach the full load"),
        };
        out.push(format!(
            "{}, {}, {} clouds of {} nodes: {}{failed}.",
            is.case,
            group[0].name(),
            group.len(),
            is.nodes,
            parts.join(", ")
        ));
    }
    out
}

fn phrase(spread: Spread, words: &str, unit: &str, scale: f64) -> String {
    let [least, _, median, _, most] = spread.quantiles.map(|q| significant(q * scale, 3));
    format!("{words} has a median of {median}{unit} and ranges from {least} to {most}{unit}")
}

//! Findings on the error added by each transfer scheme.

use catalogue::metric;
use records::Family;
use records::text::significant;

use crate::select::{Run, by_case};

/// Sentences on the best, worst and published transfer scheme for every transferred field.
pub(super) fn transfer(runs: &[Run]) -> Vec<String> {
    let mut out = Vec::new();
    let schemes: Vec<Run> = runs.iter().filter(|r| r.is.family == Family::Interp).cloned().collect();
    for case in by_case(&schemes) {
        let mut sources: Vec<String> = case.iter().map(source).collect();
        sources.sort();
        sources.dedup();
        for from in sources {
            let own: Vec<(&Run, f64)> = case
                .iter()
                .filter(|r| source(r) == from)
                .filter_map(|r| r.value(&metric::RMS).map(|v| (r, v)))
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
                "{}, {from}: {} has the smallest error ({}), {} the largest ({})",
                best.0.is.case,
                best.0.is.variant,
                mm(best.1),
                worst.0.is.variant,
                mm(worst.1)
            );
            let of = |variant: &str| own.iter().find(|(r, _)| r.is.variant == variant).map(|o| o.1);
            if let Some(v) = of("inverse-distance") {
                text += &format!("; inverse distance, the published scheme, has {}", mm(v));
            }
            if let Some(v) = of("own-rows") {
                text += &format!("; the method's own shape functions have {}", mm(v));
            }
            out.push(text + ".");
        }
    }
    out
}

/// Name of the transferred field, in words.
pub(crate) fn source(run: &Run) -> String {
    run.is.from.as_ref().map_or_else(|| "transfer".into(), |method| format!("from {method}"))
}

//! Findings on the effect of the mass matrix on frequencies.

use catalogue::metric;
use records::Family;
use records::text::{list, significant};

use crate::select::{Run, labels, named_cases, series};

/// Sentences for every case with modes: the error of the first frequency by family and mass, and the methods
/// with spurious modes.
pub(super) fn vibrations(runs: &[Run]) -> Vec<String> {
    let mut out = Vec::new();
    for (case, runs) in named_cases(runs) {
        // The finest run of each method.
        let all = series(runs);
        let finest: Vec<&Run> = all.iter().map(|s| s.finest()).collect();
        for (family, called) in [(Family::Fem, "elements"), (Family::Efg, "clouds")] {
            let mut parts = Vec::new();
            for mass in ["consistent", "at-points", "lumped", "transformed"] {
                let mut errors: Vec<f64> = finest
                    .iter()
                    .filter(|r| r.is.family == family && r.is.mass.as_deref() == Some(mass))
                    .filter_map(|r| Some((r.value(&metric::FREQUENCY_RATIO)? - 1.0) * 1e2))
                    .collect();
                errors.sort_by(f64::total_cmp);
                if let (Some(low), Some(high)) = (errors.first(), errors.last()) {
                    parts.push(format!("{} % with {mass} mass", range(*low, *high)));
                }
            }
            if !parts.is_empty() {
                out.push(format!(
                    "{case}: the first frequency of {called} differs from the exact frequency by {}.",
                    list(&parts)
                ));
            }
        }
        let names = labels(finest.iter().map(|r| r.is));
        let slow: Vec<String> = finest
            .iter()
            .zip(names)
            .filter_map(|(r, name)| Some((name, r.value(&metric::SLOW_MODES).filter(|count| *count > 0.0)?)))
            .map(|(name, count)| format!("{name} has {count}"))
            .collect();
        if !slow.is_empty() {
            out.push(format!(
                "{case}: some methods have spurious modes below the first frequency of the body: {}.",
                list(&slow)
            ));
        } else if finest.iter().any(|r| r.value(&metric::SLOW_MODES).is_some()) {
            out.push(format!("{case}: no method has spurious modes below the first frequency of the body."));
        }
    }
    out
}

fn range(low: f64, high: f64) -> String {
    let [a, b] =
        [low, high].map(|v| if v > 0.0 { format!("+{}", significant(v, 2)) } else { significant(v, 2) });
    if a == b { a } else { format!("{a} to {b}") }
}

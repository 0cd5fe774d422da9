//! Which method reaches one percent in the least time.

use super::cases;
use crate::select::{Run, labels};
use crate::text::{duration, list, percent, significant};

/// One sentence for each case that at least two timed methods solved.
pub(super) fn cheapest(runs: &[Run]) -> Vec<String> {
    let mut out = Vec::new();
    for (name, group) in cases(runs) {
        let named: Vec<_> = group.iter().map(|r| (r.name(), r.is)).collect();
        let labels = labels(&named);
        let mut timed: Vec<(f64, f64, &str, u64)> = Vec::new();
        for (run, label) in group.iter().zip(&labels) {
            if let (Some(t), Some(e)) = (run.total(), run.value("l2")) {
                timed.push((t, e, label, run.is.nodes));
            }
        }
        let tried: Vec<&str> = timed.iter().fold(Vec::new(), |mut seen, t| {
            if !seen.contains(&t.2) {
                seen.push(t.2);
            }
            seen
        });
        if tried.len() < 2 {
            continue;
        }
        timed.sort_by(|a, b| a.0.total_cmp(&b.0));
        let good: Vec<_> = timed.iter().filter(|t| t.1 <= 0.01).collect();
        let Some(best) = good.first() else {
            let closest = timed.iter().min_by(|a, b| a.1.total_cmp(&b.1));
            out.extend(closest.map(|c| {
                format!(
                    "{name}: no run reaches a relative L2 error of 1 %; the closest is {} with {} in {} ({} nodes).",
                    c.2,
                    percent(c.1),
                    duration(c.0),
                    c.3
                )
            }));
            continue;
        };
        let mut text = format!(
            "{name}: {} reaches a relative L2 error of 1 % cheapest, {} in {} ({} nodes)",
            best.2,
            percent(best.1),
            duration(best.0),
            best.3
        );
        if let Some(next) = good.iter().find(|t| t.2 != best.2) {
            text += &format!("; next is {}, {} times slower", next.2, significant(next.0 / best.0, 2));
        }
        let missed = tried
            .iter()
            .filter(|l| good.iter().all(|g| g.2 != **l))
            .map(|l| l.to_string())
            .collect::<Vec<_>>();
        if !missed.is_empty() && missed.len() <= 6 {
            text += &format!("; not reached by {} at the sizes run", list(&missed));
        } else if !missed.is_empty() {
            text += &format!("; not reached by {} of {} methods at the sizes run", missed.len(), tried.len());
        }
        out.push(text + ".");
    }
    out
}

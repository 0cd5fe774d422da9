//! Findings on clouds whose integration error exceeds their discretisation error.

use records::text::{list, ratio, significant};

use crate::select::{Run, groups};
use crate::tables::{ErrorParts, error_parts};

/// One sentence for every case whose clouds were also solved with a fine rule.
pub(super) fn integration(runs: &[Run]) -> Vec<String> {
    let parts = error_parts(runs);
    let mut out = Vec::new();
    for case in groups(&parts, |p| (&p.run.is.case, p.run.is.poisson.to_bits())) {
        let worse: Vec<_> = case.iter().filter(|p| p.badly_integrated()).collect();
        let share = |p: &ErrorParts| p.integration / p.discretisation;
        let Some(most) = case.iter().max_by(|a, b| share(a).total_cmp(&share(b))) else { continue };
        let places = match worse.len() {
            0 => String::new(),
            _ => {
                let methods = groups(&worse, |p| p.label.as_str());
                let phrases: Vec<String> = methods
                    .iter()
                    .map(|m| {
                        let nodes: Vec<String> = m.iter().map(|p| p.run.is.nodes.to_string()).collect();
                        format!("{} with {} nodes", m[0].label, list(&nodes))
                    })
                    .collect();
                format!(": {}", phrases.join("; "))
            }
        };
        out.push(format!(
            "{} at ν = {}: in {} of {} clouds the integration error is larger than the discretisation error{places}. \
             {} with {} nodes and {} cells per node has the largest ratio, {}.",
            most.run.is.case,
            ratio(most.run.is.poisson),
            worse.len(),
            case.len(),
            most.label,
            most.run.is.nodes,
            significant(most.cells(), 2),
            significant(share(most), 2),
        ));
    }
    out
}

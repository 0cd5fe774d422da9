//! Checks and failed runs.

use std::collections::{BTreeMap, BTreeSet};

use crate::run_set::{RunSet, Status};
use crate::text::{percent, significant};

/// How many checks passed, and every one that did not with its reason.
pub(super) fn checks(set: &RunSet) -> Vec<String> {
    let mut out = Vec::new();
    if set.checks.is_empty() && set.failures.is_empty() && set.warnings.is_empty() {
        return out;
    }
    let with = |status: Status| set.checks.iter().filter(move |c| c.status == status);
    if !set.checks.is_empty() {
        out.push(format!("{} of {} checks passed.", with(Status::Pass).count(), set.checks.len()));
    }
    for c in with(Status::Fail) {
        let value = c.value.map(|v| format!(" is {} and", significant(v, 3))).unwrap_or_default();
        out.push(format!(
            "Failed: {}, {}: {}{value} must be {}. {}",
            c.case,
            c.method,
            c.metric,
            c.bound,
            sentence(&c.reason)
        ));
    }
    for (status, word) in [(Status::KnownFailure, "Known failure"), (Status::NotRun, "Not run")] {
        let mut by_reason: BTreeMap<&str, Vec<String>> = BTreeMap::new();
        for c in with(status) {
            by_reason.entry(&c.reason).or_default().push(format!("{}, {}: {}", c.case, c.method, c.metric));
        }
        for (reason, mut which) in by_reason {
            let more = which.len().saturating_sub(4);
            which.truncate(4);
            let tail = if more > 0 { format!("; and {more} more") } else { String::new() };
            out.push(format!("{word}: {}{tail}. {}", which.join("; "), sentence(reason)));
        }
    }
    let mut by_code: BTreeMap<&str, BTreeSet<(&str, &str)>> = BTreeMap::new();
    for w in &set.warnings {
        by_code.entry(&w.code).or_default().insert((&w.case, &w.method));
    }
    for (code, which) in by_code {
        let named: Vec<String> =
            which.iter().take(4).map(|(case, method)| format!("{case}, {method}")).collect();
        let more = which.len().saturating_sub(4);
        let tail = if more > 0 { format!("; and {more} more") } else { String::new() };
        out.push(format!("Warning {code}: {}{tail}.", named.join("; ")));
    }
    for f in &set.failures {
        let reason = f.reason.trim_end_matches('.');
        out.push(match f.carried {
            None => format!("No result for {}, {}: {reason}.", f.case, f.method),
            Some(load) => {
                format!(
                    "Partial result for {}, {}, up to {} of the load: {reason}.",
                    f.case,
                    f.method,
                    percent(load)
                )
            }
        });
    }
    out
}

/// Begins with a capital and ends with a stop; a file and line that it begins with stays as it is.
fn sentence(reason: &str) -> String {
    let reason = reason.trim_end_matches('.');
    if reason.split_whitespace().next().is_some_and(|word| word.contains(['.', '/']) && word.ends_with(':')) {
        return format!("{reason}.");
    }
    let mut letters = reason.chars();
    match letters.next() {
        Some(first) => format!("{}{}.", first.to_uppercase(), letters.as_str()),
        None => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_of_a_file_keeps_its_letters() {
        assert_eq!(sentence("sphere.toml:13: key 'body': bad."), "sphere.toml:13: key 'body': bad.");
        assert_eq!(sentence("scenes/a.toml: bad"), "scenes/a.toml: bad.");
        assert_eq!(sentence("1 is not at least 2"), "1 is not at least 2.");
        assert_eq!(sentence("inverted: cell 3"), "Inverted: cell 3.");
    }
}

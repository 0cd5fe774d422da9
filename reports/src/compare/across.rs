//! Pairing of runs that differ in given settings, which are removed from their names.

use std::collections::BTreeMap;

use records::{Record, RunSet};

/// Removes a setting from a record.
type Clear = fn(&mut Record);

/// Settings that can be given, by the keys of scenes and records.
const SETTINGS: [(&str, Clear); 24] = [
    ("adapter", |r| r.adapter = None),
    ("basis", |r| r.basis = None),
    ("case", |r| r.case.clear()),
    ("dilation", |r| r.dilation = None),
    ("essential", |r| r.essential = None),
    ("from", |r| r.from = None),
    ("gamma", |r| r.gamma = None),
    ("integration", |r| r.integration = None),
    ("kernel", |r| r.kernel = None),
    ("law", |r| r.law = None),
    ("mass", |r| r.mass = None),
    ("method", |r| r.method.clear()),
    ("neighbour_factor", |r| r.neighbour_factor = None),
    ("neighbourhood", |r| r.neighbourhood = None),
    ("neighbours", |r| r.neighbours = None),
    ("poisson", |r| r.poisson = 0.0),
    ("polynomial", |r| r.polynomial = None),
    ("power", |r| r.power = None),
    ("refine", |r| r.refine = None),
    ("seed", |r| r.seed = 0),
    ("shape", |r| r.shape = None),
    ("size", |r| (r.level, r.nodes) = (0, 0)),
    ("support_scale", |r| r.support_scale = None),
    ("variant", |r| r.variant.clear()),
];

/// Names the runs of both results by all but these settings.
///
/// # Errors
/// An unknown setting, or two runs of the same results that differ in nothing else.
pub fn across(pair: &mut (RunSet, RunSet), settings: &[String]) -> Result<(), String> {
    let clears = settings.iter().map(|word| {
        SETTINGS.iter().find(|(name, _)| name == word).map(|(_, clear)| *clear).ok_or_else(|| {
            let known: Vec<&str> = SETTINGS.iter().map(|(name, _)| *name).collect();
            format!("--across {word}: is not a setting of a run; give one of {}", known.join(", "))
        })
    });
    let clears: Vec<Clear> = clears.collect::<Result<_, _>>()?;
    if clears.is_empty() {
        return Ok(());
    }
    for set in [&mut pair.0, &mut pair.1] {
        let mut owners: BTreeMap<String, (String, String)> = BTreeMap::new();
        for record in &mut set.records {
            let own = std::mem::take(&mut record.run);
            let name = record.run_name();
            clears.iter().for_each(|clear| clear(record));
            record.run = record.run_name();
            let first = owners.entry(record.run.clone()).or_insert_with(|| (own.clone(), name.clone()));
            if first.0 != own {
                return Err(format!(
                    "--across {}: '{}' and '{name}' belong to the same results and differ in no other setting; leave \
                     one of the two out",
                    settings.join(" --across "),
                    first.1
                ));
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::blank::Blank as _;
    use crate::compare::Comparison;

    fn set(runs: &[(&str, &str, f64)]) -> RunSet {
        let record = |&(method, dilation, value): &(&str, &str, f64)| {
            let case = "block".into();
            let method = method.into();
            let dilation = Some(dilation.into());
            Record { case, method, dilation, value, ..Record::blank() }.named("rms").of_its_run()
        };
        RunSet { records: runs.iter().map(record).collect(), ..RunSet::default() }
    }

    #[test]
    fn runs_that_differ_in_the_stated_setting_are_pairs() {
        let pair = || (set(&[("a", "standard", 1.0)]), set(&[("a", "nodal-mean", 2.0)]));
        let plain = Comparison::of(&[pair()], 1e-6, false).numbers;
        assert_eq!((plain.compared, plain.only_before.len(), plain.only_after.len()), (0, 1, 1));
        let mut stated = pair();
        across(&mut stated, &["dilation".into()]).unwrap();
        let found = Comparison::of(&[stated], 1e-6, false).numbers;
        assert_eq!((found.compared, found.changes.len()), (1, 1), "{found:?}");
        assert!(found.only_before.is_empty() && found.only_after.is_empty());
    }

    #[test]
    fn a_word_that_is_no_setting_and_runs_that_nothing_else_tells_apart_are_refused() {
        let mut pair = (set(&[("a", "standard", 1.0), ("a", "nodal-mean", 2.0)]), set(&[]));
        let bad = across(&mut pair, &["dilatation".into()]).unwrap_err();
        assert!(bad.contains("is not a setting") && bad.contains("dilation"), "{bad}");
        let bad = across(&mut pair, &["dilation".into()]).unwrap_err();
        assert!(bad.contains("differ in no other setting"), "{bad}");
    }
}

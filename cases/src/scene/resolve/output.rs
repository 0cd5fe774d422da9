//! What a scene reports, compares with and checks.

use crate::scene::error::{Problem, suggest};
use crate::scene::keys::*;
use crate::scene::metric::Metric;
use crate::scene::output::{Bound, Check, Output, Parameter, Reference, Target, Transfer};
use crate::scene::report::Report;
use crate::scene::units::{Dimension, Quantity};

use super::method::size;
use super::{mesh_file, names, raw};

pub(super) fn output(keys: Option<OutputKeys>, report: &mut Report) -> Output {
    let Some(keys) = keys else { return Output { probes: Vec::new(), transfers: Vec::new() } };
    if let Some(probes) = &keys.probes {
        let help = "name a point, or leave the key out";
        report.require(!probes.is_empty(), "output.probes", "is empty", help);
    }
    let list = match keys.transfer {
        None => Vec::new(),
        Some(TransfersKeys::One(one)) => vec![one],
        Some(TransfersKeys::Several(several)) => several,
    };
    let transfers = list.into_iter().map(|t| Transfer {
        to: match t.to {
            TargetKeys::Name(TargetName::ReferenceNodes) => Target::ReferenceNodes,
            TargetKeys::Name(TargetName::Probes) => Target::Probes,
            TargetKeys::File(f) => {
                Target::File(mesh_file(&f.file, f.unit.map_or(1e-3, |u| u.0), "output.transfer", report))
            }
        },
        scheme: t.scheme,
        neighbours: t.neighbours.map(|n| n as usize),
        power: t.power,
        dilatation: t.dilatation,
    });
    Output {
        transfers: transfers.collect(),
        probes: keys.probes.unwrap_or_default().into_iter().map(raw).collect(),
    }
}

pub(super) fn reference(keys: ReferenceKeys, report: &mut Report) -> Option<Reference> {
    let stray = |report: &mut Report| {
        for name in keys.parameters.keys() {
            let help = suggest(name, &["exact", "method", "record", "size"]);
            report.add(&format!("reference.{name}"), Problem::new("is not known").help(help));
        }
    };
    match (&keys.exact, &keys.method, &keys.record) {
        (Some(_), None, None) => {}
        (None, Some(id), None) => {
            stray(report);
            let (id, given) = (id.clone(), keys.size.is_some());
            let size = keys.size.and_then(|s| size(s, "reference.size", report));
            return (size.is_some() || !given).then_some(Reference::Method { id, size });
        }
        (None, None, Some(record)) => {
            stray(report);
            return Some(Reference::Record(report.path(record)));
        }
        _ => {
            let help = "give one of exact = \"...\", method = \"...\" and record = \"...\"";
            report.add("reference", Problem::new("is not one reference").help(help));
            return None;
        }
    }
    let mut parameters = std::collections::BTreeMap::new();
    for (name, value) in keys.parameters {
        match parameter(value) {
            Ok(value) => {
                parameters.insert(name, value);
            }
            Err(bad) => report.add(&format!("reference.{name}"), bad),
        }
    }
    keys.exact.map(|name| Reference::Exact { name, parameters })
}

fn parameter(keys: ParameterKeys) -> Result<Parameter, Problem> {
    let text = |text: String| -> Result<Parameter, Problem> {
        if text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)) {
            Quantity::read(&text).map(Parameter::Quantity)
        } else {
            Ok(Parameter::Text(text))
        }
    };
    Ok(match keys {
        ParameterKeys::Truth(value) => Parameter::Truth(value),
        ParameterKeys::Number(value) => Parameter::Number(value),
        ParameterKeys::Text(value) => text(value)?,
        ParameterKeys::List(items) => Parameter::List(
            items
                .into_iter()
                .map(|item| match item {
                    ParameterItem::Number(value) => Ok(Parameter::Number(value)),
                    ParameterItem::Text(value) => text(value),
                    ParameterItem::List(leaves) => leaves
                        .into_iter()
                        .map(|leaf| match leaf {
                            ParameterLeaf::Number(value) => Ok(Parameter::Number(value)),
                            ParameterLeaf::Text(value) => text(value),
                        })
                        .collect::<Result<_, _>>()
                        .map(Parameter::List),
                })
                .collect::<Result<_, _>>()?,
        ),
    })
}

/// Checks of a scene or of a run of a study; `key` is the path of their list.
pub(crate) fn checks(keys: Vec<CheckKeys>, key: &str, report: &mut Report) -> Vec<Check> {
    keys.into_iter().enumerate().filter_map(|(i, c)| check(c, &format!("{key}[{i}]"), report)).collect()
}

fn check(keys: CheckKeys, key: &str, report: &mut Report) -> Option<Check> {
    let metric = match Metric::find(&keys.metric) {
        Ok(metric) => metric,
        Err(bad) => {
            report.add(&format!("{key}.metric"), bad);
            return None;
        }
    };
    let bound = |value: BoundKeys, name: &str, report: &mut Report| match limit(value, metric.dimension) {
        Ok(value) => Some(value),
        Err(bad) => {
            report.add(&format!("{key}.{name}"), bad);
            None
        }
    };
    let bound = match (keys.at_least, keys.at_most, keys.known_band) {
        (None, None, None) => {
            report.missing(key, "give at_most, at_least or known_band");
            return None;
        }
        (None, None, Some([low, high])) => {
            let (low, high) = (bound(low, "known_band", report)?, bound(high, "known_band", report)?);
            report.require(low < high, &format!("{key}.known_band"), "is no band", "give the low end first");
            match keys.reason {
                Some(reason) => Bound::KnownBand { low, high, reason },
                None => {
                    report.missing(&format!("{key}.reason"), "say why the method can't do better");
                    return None;
                }
            }
        }
        (_, _, Some(_)) => {
            let help = "give a band or bounds, not both";
            report.add(&format!("{key}.known_band"), Problem::new("stands beside a bound").help(help));
            return None;
        }
        (low, high, None) => Bound::Within {
            at_least: match low {
                Some(low) => Some(bound(low, "at_least", report)?),
                None => None,
            },
            at_most: match high {
                Some(high) => Some(bound(high, "at_most", report)?),
                None => None,
            },
        },
    };
    Some(Check { metric, methods: keys.method.map(names).unwrap_or_default(), bound })
}

fn limit(keys: BoundKeys, dimension: Dimension) -> Result<f64, Problem> {
    match (keys, dimension) {
        (BoundKeys::Number(value), Dimension::None) => Ok(value),
        (BoundKeys::Number(value), _) => {
            Err(Problem::new("has no unit").help(dimension.fix(&value.to_string())))
        }
        (BoundKeys::Text(text), _) => dimension.read(&text),
    }
}

//! Conversion of output, reference and checks.

use crate::scene::error::ErrorKind;
use crate::scene::keys::*;
use crate::scene::output::{Bound, Check, Output, Reference, Repeated, Target, Transfer};
use crate::scene::report::Report;
use crate::scene::vocabulary::{build, settings};
use catalogue::Dimension;
use catalogue::Problem;
use catalogue::metric;
use catalogue::suggest;

use super::condition::place;
use super::method::size;
use super::{MILLIMETRE, mesh_file, names, positive, raw};

pub(super) fn output(keys: Option<OutputKeys>, report: &mut Report) -> Output {
    let Some(keys) = keys else {
        let (probes, means, transfers) = (Vec::new(), Vec::new(), Vec::new());
        return Output { probes, means, transfers, beside: None, repeated: None };
    };
    if let Some(probes) = &keys.probes {
        let help = "name a point, or leave the key out";
        report.require(!probes.is_empty(), "output.probes", "is empty", help);
    }
    if let Some(means) = &keys.means {
        let help = "name a face, such as { on = \"z-max\" }, or leave the key out";
        report.require(!means.is_empty(), "output.means", "is empty", help);
    }
    let means = keys.means.unwrap_or_default().into_iter().enumerate();
    let means =
        means.map(|(i, of)| place(of.on, of.place, &format!("output.means[{i}]"), report, true)).collect();
    let transfers = match keys.transfer {
        None => Vec::new(),
        Some(TransfersKeys::One(one)) => transfer(one, "output.transfer", report).into_iter().collect(),
        Some(TransfersKeys::Several(several)) => {
            let each = several.into_iter().enumerate();
            each.filter_map(|(i, t)| transfer(t, &format!("output.transfer[{i}]"), report)).collect()
        }
    };
    let probes = keys.probes.unwrap_or_default().into_iter().map(raw).collect();
    let repeated = keys.repeated.map(|keys| repeated(keys, report));
    Output { transfers, probes, means, beside: keys.beside, repeated }
}

/// Largest number of frames: nine hours at 30 Hz, with the time of each frame stored.
const MOST_FRAMES: usize = 1_000_000;

fn repeated(keys: RepeatedKeys, report: &mut Report) -> Repeated {
    let (frames, cycle) = (keys.frames as usize, keys.cycle.unwrap_or(120) as usize);
    report.require(
        (1..=MOST_FRAMES).contains(&frames),
        "output.repeated.frames",
        "is no number of frames",
        "give 1 to 1000000; a percentile of 99.9 needs 1000",
    );
    let help = "give an even number of frames, half of them for the way up";
    report.require(cycle >= 2 && cycle % 2 == 0, "output.repeated.cycle", "is no way up and down", help);
    let within = keys.within.map_or(10.0, |q| positive(q.0, "output.repeated.within", report));
    if let Some(tolerance) = keys.tolerance {
        positive(tolerance, "output.repeated.tolerance", report);
    }
    Repeated { frames, cycle, within, tolerance: keys.tolerance }
}

fn transfer(keys: TransferKeys, key: &str, report: &mut Report) -> Option<Transfer> {
    let at = |name: &str| format!("{key}.{name}");
    let to = match keys.to {
        TargetKeys::Name(TargetName::ReferenceNodes) => Target::ReferenceNodes,
        TargetKeys::Name(TargetName::Probes) => Target::Probes,
        TargetKeys::File(f) => {
            Target::File(mesh_file(&f.file, f.unit.map_or(MILLIMETRE, |u| u.0), &at("to.file"), report))
        }
    };
    let scheme = match keys.scheme {
        SchemeKeys::Own(OwnWord::Own) => None,
        SchemeKeys::Scheme(word) => {
            let values = settings(&word, keys.settings, key, report)?;
            let made = build(word.0, &values, (key, &at("scheme")), report)?;
            Some((made, values))
        }
    };
    Some(Transfer { to, scheme })
}

pub(super) fn reference(keys: ReferenceKeys, report: &mut Report) -> Option<Reference> {
    let given = keys.size.is_some();
    let size = keys.size.and_then(|s| size(s, "reference.size", report));
    if keys.method.is_none() {
        report.require(!given, "reference.size", "goes with method only", "leave it out");
    }
    if keys.exact.is_none() {
        for name in keys.settings.names() {
            let help = suggest(name, &["exact", "method", "record", "size"]);
            report.add(&format!("reference.{name}"), Problem::new("is not a known key").help(help));
        }
    }
    match (keys.exact, keys.method, keys.record) {
        (Some(word), None, None) => {
            let values = settings(&word, keys.settings, "reference", report)?;
            Some(Reference::Exact { entry: word.0, values })
        }
        (None, Some(id), None) => (size.is_some() || !given).then_some(Reference::Method { id, size }),
        (None, None, Some(record)) => Some(Reference::Record(report.path(&record, "reference.record"))),
        _ => {
            let help = "give one of exact = \"...\", method = \"...\" and record = \"...\"";
            report.add("reference", Problem::new("is not one reference").help(help));
            None
        }
    }
}

/// Converts the checks of a scene or of a run of a study; `key` is the path of their list.
pub(crate) fn checks(keys: Vec<CheckKeys>, key: &str, report: &mut Report) -> Vec<Check> {
    keys.into_iter().enumerate().filter_map(|(i, c)| check(c, &format!("{key}[{i}]"), report)).collect()
}

fn check(keys: CheckKeys, key: &str, report: &mut Report) -> Option<Check> {
    let metric = match metric::named(&keys.metric) {
        Ok(metric) => metric,
        Err(bad) => {
            report.add(&format!("{key}.metric"), bad);
            return None;
        }
    };
    let bound = |value: NumberKeys, name: &str, report: &mut Report| match limit(value, metric.dimension) {
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
        (low, high, None) => {
            let at_least = low.map(|low| bound(low, "at_least", report));
            let at_most = high.map(|high| bound(high, "at_most", report));
            let stray = keys.reason.is_some();
            report.require(!stray, &format!("{key}.reason"), "goes with known_band only", "leave it out");
            // A bound that could not be read is already reported; the check is dropped.
            let (at_least, at_most) =
                (at_least.map_or(Some(None), |b| b.map(Some))?, at_most.map_or(Some(None), |b| b.map(Some))?);
            if let (Some(low), Some(high)) = (at_least, at_most) {
                let help = "at_least must not be above at_most";
                report.require(low <= high, &format!("{key}.at_most"), "leaves no value to pass", help);
            }
            Bound::Within { at_least, at_most }
        }
    };
    let place = report.origin().error(ErrorKind::Invalid, key, Problem::new(""));
    let at = format!("{}:{}", place.file, place.line);
    Some(Check { metric, methods: keys.method.map(names).unwrap_or_default(), bound, at })
}

fn limit(keys: NumberKeys, dimension: Dimension) -> Result<f64, Problem> {
    match (keys, dimension) {
        (NumberKeys::Number(value), dimension) if dimension.is_plain() => Ok(value),
        (NumberKeys::Number(value), _) => {
            Err(Problem::new("has no unit").help(dimension.fix(&value.to_string())))
        }
        (NumberKeys::Quantity(text), _) => dimension.read(&text),
    }
}

//! What the records say, in sentences. A sentence whose numbers aren't there isn't written.

use std::collections::BTreeMap;

use crate::figures::sweeps;
use crate::order;
use crate::record::{RunSet, Status};
use crate::select::{Run, groups, labels, series};
use crate::tables::kidney_pairs;
use crate::text::{duration, list, percent, plural, significant};

/// Findings under one heading.
pub(crate) struct Topic {
    pub(crate) title: &'static str,
    pub(crate) sentences: Vec<String>,
}

/// Every topic with something to say.
pub(crate) fn all(set: &RunSet, runs: &[Run]) -> Vec<Topic> {
    let solved: Vec<Run> = runs.iter().filter(|r| r.is.family != "interp").cloned().collect();
    let topics = [
        Topic { title: "Cheapest way to one percent", sentences: cheapest(&solved) },
        Topic { title: "Locking", sentences: locking(&solved) },
        Topic { title: "Kidney and grasper", sentences: kidney(runs) },
        Topic { title: "Transfer", sentences: transfer(runs) },
        Topic { title: "Patch tests", sentences: patch(&solved) },
        Topic { title: "Order of convergence", sentences: orders(&solved) },
        Topic { title: "Checks", sentences: checks(set) },
    ];
    topics.into_iter().filter(|t| !t.sentences.is_empty()).collect()
}

/// `case` or `case at ν = 0.3`, with its runs; patch tests left out.
fn cases<'a, 'r>(runs: &'a [Run<'r>]) -> Vec<(String, &'a [Run<'r>])> {
    let mut out = Vec::new();
    for case in groups(runs, |r| r.is.case.clone()).into_iter().filter(|c| !c[0].is.case.contains("patch")) {
        let by_ratio = groups(case, |r| r.is.poisson.to_bits());
        for group in &by_ratio {
            let is = group[0].is;
            let name = if by_ratio.len() > 1 {
                format!("{} at ν = {}", is.case, is.poisson)
            } else {
                is.case.clone()
            };
            out.push((name, *group));
        }
    }
    out
}

fn cheapest(runs: &[Run]) -> Vec<String> {
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

/// An error that grows more than this from the most compressible to the least compressible material counts as locking.
const LOCKS: f64 = 2.0;

fn locking(runs: &[Run]) -> Vec<String> {
    let mut out = Vec::new();
    for case in groups(runs, |r| r.is.case.clone()).into_iter().filter(|c| !c[0].is.case.contains("patch")) {
        let (mut locked, mut free) = (Vec::new(), Vec::new());
        let mut span = None;
        for (label, _, sweep) in sweeps(case) {
            // 0.495 is tissue; beyond it is a stress test.
            let usable: Vec<&Run> =
                sweep.iter().filter(|r| r.is.poisson <= 0.4951 && r.value("l2").is_some()).collect();
            let [first, .., last] = usable.as_slice() else { continue };
            let (Some(before), Some(after)) = (first.value("l2"), last.value("l2")) else { continue };
            span = Some((first.is.poisson, last.is.poisson));
            if after > LOCKS * before && after > 1e-3 {
                let tip = last
                    .value("tip")
                    .map(|t| format!(", tip at {} of exact", percent(t)))
                    .unwrap_or_default();
                let pressure = last
                    .value("pressure")
                    .map(|p| format!(", pressure error {}", percent(p)))
                    .unwrap_or_default();
                locked.push(format!("{label} ({} to {}{tip}{pressure})", percent(before), percent(after)));
            } else {
                free.push(label);
            }
        }
        let Some((from, to)) = span else { continue };
        let name = &case[0].is.case;
        if !locked.is_empty() {
            out.push(format!(
                "{name}: from ν = {from} to {to} the relative L2 error more than doubles for {}.",
                list(&locked)
            ));
        }
        if !free.is_empty() {
            let many = free.len() > 8;
            let who = if many { format!("{} methods", free.len()) } else { list(&free) };
            out.push(format!("{name}: from ν = {from} to {to} it doesn't for {who}."));
        }
    }
    out
}

fn kidney(runs: &[Run]) -> Vec<String> {
    let pairs = kidney_pairs(runs);
    let mut out = Vec::new();
    for family in ["fem", "efg"] {
        let mut by_method: BTreeMap<&str, Vec<String>> = BTreeMap::new();
        for pair in pairs.iter().filter(|p| p.paper.family == family) {
            if let (Some(speed), Some(ours)) = (pair.speed_up(), pair.ours) {
                by_method.entry(&pair.run.is.method).or_default().push(format!(
                    "{}: {} here, {} published, {} times faster",
                    pair.paper.what,
                    duration(ours),
                    duration(pair.paper.value),
                    significant(speed, 2)
                ));
            }
        }
        for (method, parts) in by_method {
            out.push(format!("{method}: {}.", parts.join("; ")));
        }
    }
    let mut seen: Vec<&str> = Vec::new();
    for pair in &pairs {
        let run = pair.run;
        let method = run.is.method.as_str();
        let (Some(x), Some(y), Some(z)) = (run.value("rms-x"), run.value("rms-y"), run.value("rms-z")) else {
            continue;
        };
        if seen.contains(&method) {
            continue;
        }
        seen.push(method);
        let mm = |v: f64| significant(v * 1e3, 2);
        let published: Vec<&_> = pairs
            .iter()
            .filter(|p| p.run.is.method == method && p.paper.quantity.starts_with("rms"))
            .collect();
        let theirs = match published.as_slice() {
            [a, b, c] => {
                format!(
                    "; published {} / {} / {} mm",
                    mm(a.paper.value),
                    mm(b.paper.value),
                    mm(c.paper.value)
                )
            }
            _ => String::new(),
        };
        out.push(format!(
            "{method}, {} nodes: RMS difference from the reference {} / {} / {} mm in x / y / z{theirs}.",
            run.is.nodes,
            mm(x),
            mm(y),
            mm(z)
        ));
    }
    if !out.is_empty() {
        out.push("Ours is linear elastic on a fitted geometry, so only times and orders of magnitude compare with the publication.".into());
    }
    out
}

fn transfer(runs: &[Run]) -> Vec<String> {
    let mut out = Vec::new();
    let schemes: Vec<Run> = runs.iter().filter(|r| r.is.family == "interp").cloned().collect();
    for case in groups(&schemes, |r| r.is.case.clone()) {
        let mut sources: Vec<String> = case.iter().map(source).collect();
        sources.sort();
        sources.dedup();
        for from in sources {
            let own: Vec<(&Run, f64)> = case
                .iter()
                .filter(|r| source(r) == from)
                .filter_map(|r| r.value("rms").map(|v| (r, v)))
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
                "{}, {from}: best {} ({}), worst {} ({})",
                best.0.is.case,
                best.0.is.variant,
                mm(best.1),
                worst.0.is.variant,
                mm(worst.1)
            );
            let distance = own.iter().find(|(r, _)| r.is.variant == "inverse-distance");
            if let Some((_, v)) = distance.filter(|(r, _)| r.is.variant != worst.0.is.variant) {
                text += &format!("; inverse distance, the published scheme, adds {}", mm(*v));
            } else if distance.is_some() {
                text += ", the published scheme";
            }
            out.push(text + ".");
        }
    }
    out
}

fn source(run: &Run) -> String {
    let field = run.is.parameter("field").map(|f| format!("{f} field"));
    field.or(run.is.parameter("from").map(|f| format!("from {f}"))).unwrap_or_else(|| "transfer".into())
}

/// Rounding in a patch test, relative.
const EXACT: f64 = 1e-12;

fn patch(runs: &[Run]) -> Vec<String> {
    let mut out = Vec::new();
    for case in groups(runs, |r| r.is.case.clone()).into_iter().filter(|c| c[0].is.case.contains("patch")) {
        let named: Vec<_> = case.iter().map(|r| (r.is.method.as_str(), r.is)).collect();
        let mut worst: BTreeMap<String, f64> = BTreeMap::new();
        for (label, run) in labels(&named).into_iter().zip(case) {
            if let Some(error) = run.value("l2") {
                let entry = worst.entry(label).or_insert(error);
                *entry = entry.max(error);
            }
        }
        if worst.is_empty() {
            continue;
        }
        let missed: Vec<_> = worst.iter().filter(|(_, e)| **e > EXACT).collect();
        let mut text = format!(
            "{}: {} of {} methods within 10⁻¹²",
            case[0].is.case,
            worst.len() - missed.len(),
            worst.len()
        );
        if !missed.is_empty() {
            let low = missed.iter().map(|m| *m.1).fold(f64::MAX, f64::min);
            let high = missed.iter().map(|m| *m.1).fold(0.0, f64::max);
            let names: Vec<String> = missed.iter().take(6).map(|m| m.0.clone()).collect();
            let more =
                if missed.len() > 6 { format!(" and {} more", missed.len() - 6) } else { String::new() };
            let who = if more.is_empty() { list(&names) } else { names.join(", ") + &more };
            text += &format!(
                "; not passing: {who}, relative error {}",
                if low < high {
                    format!("{} to {}", significant(low, 2), significant(high, 2))
                } else {
                    significant(high, 2)
                }
            );
        }
        out.push(text + ".");
    }
    out
}

/// An order this far below theory is worth a sentence.
const SLACK: f64 = 0.15;

fn orders(runs: &[Run]) -> Vec<String> {
    let (mut held, mut below, mut short) = (0, Vec::new(), 0);
    for (name, group) in cases(runs) {
        let all = series(group);
        let named: Vec<_> = all.iter().map(|s| (s.name, s.is())).collect();
        for (label, s) in labels(&named).into_iter().zip(&all) {
            for quantity in ["l2", "energy"] {
                let (Some(order), Some(theory)) = (order::observed(&s.points(quantity)), s.theory(quantity))
                else {
                    continue;
                };
                let Some(finest) = order.pairs.last().copied() else { continue };
                if order.pairs.len() < 2 {
                    short += 1;
                } else if finest >= theory - SLACK {
                    held += 1;
                } else {
                    below.push(format!(
                        "{label} in {name} ({quantity} {} of {theory})",
                        significant(finest, 2)
                    ));
                }
            }
        }
    }
    let mut out = Vec::new();
    if held + below.len() > 0 {
        out.push(format!(
            "Between the two finest levels {held} of {} observed orders are no more than {SLACK} below theory.",
            held + below.len()
        ));
    }
    if !below.is_empty() {
        let more = below.len().saturating_sub(10);
        below.truncate(10);
        let tail = if more > 0 { format!(", and {more} more in the table") } else { String::new() };
        out.push(format!("Below theory: {}{tail}.", below.join("; ")));
    }
    if short > 0 {
        out.push(format!("{short} further pair{} of levels: too few to judge an order.", plural(short)));
    }
    out
}

fn checks(set: &RunSet) -> Vec<String> {
    let mut out = Vec::new();
    if set.checks.is_empty() && set.failures.is_empty() {
        return out;
    }
    let with = |status: Status| set.checks.iter().filter(move |c| c.status == status);
    if !set.checks.is_empty() {
        out.push(format!("{} of {} checks held.", with(Status::Pass).count(), set.checks.len()));
    }
    for c in with(Status::Fail) {
        let value = c.value.map(|v| format!(" is {}", significant(v, 3))).unwrap_or_default();
        out.push(format!(
            "Failed: {}, {}: {}{value}, bound {}. {}",
            c.case, c.method, c.metric, c.bound, c.reason
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
            out.push(format!("{word}: {}{tail}. {reason}", which.join("; ")));
        }
    }
    for f in &set.failures {
        out.push(format!("No result: {}, {}. {}", f.case, f.method, f.reason));
    }
    out
}

//! Findings on locking, patch tests and orders of convergence.

use std::collections::BTreeMap;

use catalogue::metric;
use records::Purpose;
use records::text::{list, percent, plural, significant};

use crate::figures::sweeps;
use crate::order;
use crate::select::{Run, by_case, competing, labels, named_cases, series};

/// Ratio of the errors of the least and the most compressible material above which a method locks.
const LOCKS: f64 = 2.0;

/// Sentences on the methods that lock, the worst first with their errors, and on the methods that do not
/// lock.
pub(super) fn locking(runs: &[Run]) -> Vec<String> {
    let mut out = Vec::new();
    for case in competing(runs) {
        let (mut locked, mut free) = (Vec::new(), Vec::new());
        let mut span = None;
        for (label, _, sweep) in sweeps(case) {
            // 0.495 represents tissue; larger ratios are a stress test.
            let usable: Vec<&Run> =
                sweep.iter().filter(|r| r.is.poisson <= 0.4951 && r.value(&metric::L2).is_some()).collect();
            let [first, .., last] = usable.as_slice() else { continue };
            let (Some(before), Some(after)) = (first.value(&metric::L2), last.value(&metric::L2)) else {
                continue;
            };
            span = Some((first.is.poisson, last.is.poisson));
            if after > LOCKS * before && after > 1e-3 {
                let tip = last
                    .value(&metric::TIP)
                    .map(|t| format!(", tip at {} of the exact deflection", percent(t)))
                    .unwrap_or_default();
                let pressure = last
                    .value(&metric::PRESSURE)
                    .map(|p| format!(", pressure error {}", percent(p)))
                    .unwrap_or_default();
                let text = format!("{label}, {} to {}{tip}{pressure}", percent(before), percent(after));
                locked.push((after, label, text));
            } else {
                free.push(label);
            }
        }
        let Some((from, to)) = span else { continue };
        let name = &case[0].is.case;
        if !locked.is_empty() {
            locked.sort_by(|a, b| b.0.total_cmp(&a.0));
            let labels: Vec<String> = locked.iter().map(|l| l.1.clone()).collect();
            out.push(format!(
                "{name}: from ν = {from} to {to}, at the middle size, the relative L2 error more than doubles with {}.",
                list(&labels)
            ));
            out.extend(locked.iter().map(|l| format!("{name}: {}.", l.2)));
        }
        if !free.is_empty() {
            let many = free.len() > 8;
            let who = if many { format!("{} methods", free.len()) } else { list(&free) };
            out.push(format!("{name}: from ν = {from} to {to} there is no locking with {who}."));
        }
    }
    out
}

/// Largest relative error in a passed patch test, due to rounding.
const EXACT: f64 = 1e-12;

/// Sentences on the number of methods that pass each patch test.
pub(super) fn patch(runs: &[Run]) -> Vec<String> {
    let mut out = Vec::new();
    let patches = by_case(runs).filter(|c| c[0].is.purpose == Purpose::Patch);
    for case in patches {
        let mut worst: BTreeMap<String, f64> = BTreeMap::new();
        for (label, run) in labels(case.iter().map(|r| r.is)).into_iter().zip(case) {
            if let Some(error) = run.value(&metric::L2) {
                let entry = worst.entry(label).or_insert(error);
                *entry = entry.max(error);
            }
        }
        if worst.is_empty() {
            continue;
        }
        let missed: Vec<_> = worst.iter().filter(|(_, e)| **e > EXACT).collect();
        let mut text = format!(
            "{}: {} of {} methods reproduce the displacement within 10⁻¹²",
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
            let (low, high) = (significant(low, 2), significant(high, 2));
            text += &match missed.len() {
                1 => format!(". {who} does not: its relative error is {high}"),
                _ => format!(". {who} do not: their relative errors are {low} to {high}"),
            };
        }
        out.push(text + ".");
    }
    out
}

/// Shortfall of an order from theory above which it is mentioned.
const SLACK: f64 = 0.15;

/// Sentences on the observed orders that agree with theory, and on the orders that do not agree.
pub(super) fn orders(runs: &[Run]) -> Vec<String> {
    let (mut held, mut below, mut short) = (0, Vec::new(), 0);
    for (name, group) in named_cases(runs) {
        let all = series(group);
        for (label, s) in labels(all.iter().map(|s| s.is())).into_iter().zip(&all) {
            for error in [&metric::L2, &metric::ENERGY] {
                let (Some(order), Some(theory)) = (order::observed(&s.points(error)), s.theory(error)) else {
                    continue;
                };
                let Some(finest) = order.pairs.last().copied() else { continue };
                if order.pairs.len() < 2 {
                    short += 1;
                } else if finest >= theory - SLACK {
                    held += 1;
                } else {
                    below.push(format!(
                        "{label} in {name} ({} {}, theory {theory})",
                        error.name,
                        significant(finest, 2)
                    ));
                }
            }
        }
    }
    let mut out = Vec::new();
    if held + below.len() > 0 {
        out.push(format!(
            "{held} of {} observed orders reach theory within {SLACK}, between the two finest levels.",
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
        out.push(format!("{short} more order{} can't be judged: two levels are too few.", plural(short)));
    }
    out
}

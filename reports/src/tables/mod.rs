//! Which tables there are, and what they are made of.

mod closure;
mod conditioning;
mod cost;
mod error_split;
mod errors;
mod kidney;
mod modes;
mod orders;
mod outcome;
mod placement;
mod repeated;
mod timing;
mod transfer;

pub(crate) use error_split::{Parts as ErrorParts, parts as error_parts};
pub(crate) use kidney::{
    Pair as KidneyPair, Split as KidneySplit, pairs as kidney_pairs, splits as kidney_splits,
};

use crate::clouds::Clouds;
use crate::record::RunSet;
use crate::select::{Run, groups, labels};
use crate::table::Table;

/// Every table with at least one row, in the order of the report.
pub(crate) fn all(set: &RunSet, runs: &[Run], clouds: &[Clouds]) -> Vec<Table> {
    let tables = [
        errors::relative(runs),
        errors::rms(runs),
        errors::maxima(runs),
        orders::observed(runs),
        orders::convergence_index(runs),
        modes::modes(runs),
        timing::phases(runs),
        repeated::repeated(runs),
        cost::cost(runs),
        transfer::schemes(runs),
        error_split::error_split(runs),
        conditioning::conditioning(runs),
        placement::placement(clouds),
        kidney::beside_the_paper(runs),
        kidney::rms_parts(runs),
        closure::force_closure(runs),
        outcome::checks(set),
        outcome::failures(set),
        outcome::plan(set),
    ];
    tables.into_iter().filter(|t| !t.is_empty()).collect()
}

/// Runs with a label each that tells them apart within their case and Poisson's ratio.
fn labelled<'a, 'r>(runs: &'a [Run<'r>]) -> Vec<(&'a Run<'r>, String)> {
    let mut out = Vec::new();
    for group in groups(runs, |r| (r.is.case.clone(), r.is.poisson.to_bits())) {
        let named: Vec<_> = group.iter().map(|r| (r.name(), r.is)).collect();
        out.extend(group.iter().zip(labels(&named)));
    }
    out
}

/// Millimetres from metres.
fn millimetres(value: Option<f64>) -> Option<f64> {
    value.map(|v| v * 1e3)
}

//! FEBio's test suite: `solution_norm` of every model, the 2-norm of the displacements of all free unknowns.

use std::collections::HashMap;
use std::path::Path;

use anyhow::{Context, Result};

use super::call::Run;
use super::outcome::{Verdict, unfinished};

/// Relative difference that agrees.
const CLOSE: f64 = 1e-6;

/// Norms of models of size 1 that are rounding: all unknowns rest.
const ROUNDING: f64 = 1e-13;

/// Norm relative to the stored one below which nothing is left of the displacement.
const NOTHING: f64 = 1e-3;

/// Stored `solution_norm` by the name of the model.
pub(super) fn stored(suite: &Path) -> Result<HashMap<String, f64>> {
    let file = suite.join("code/linuxGoldStandards.py");
    let text =
        std::fs::read_to_string(&file).with_context(|| format!("could not read {}", file.display()))?;
    // Lines such as 'bp04': ['Normal', 400, 668, 1068, 400, 596896, '0.493180213578'],
    let read = |line: &str| {
        let (name, values) = line.split_once("': [")?;
        let name = name.rsplit('\'').next()?;
        let norm = values.split(']').next()?.rsplit(',').next()?;
        Some((name.to_string(), norm.trim().trim_matches('\'').parse().ok()?))
    };
    Ok(text.lines().filter_map(read).collect())
}

/// Judges the run of a model.
pub(super) fn verdict(model: &Path, stored: Option<f64>, run: &Run) -> Result<Verdict> {
    let object = match unfinished(model, run) {
        Ok(object) => object,
        Err(verdict) => return Ok(verdict),
    };
    let Some(norm) = object["free_norm"].as_f64() else {
        return Ok(Verdict::Fails { reason: "the run has no displacement".into() });
    };
    let Some(stored) = stored else { return Ok(Verdict::Runs) };
    let difference = (norm - stored).abs() / stored.abs().max(f64::MIN_POSITIVE);
    if norm.max(stored) <= ROUNDING {
        return Ok(Verdict::Agrees { difference: norm, within: "rounding: no free unknown moves".into() });
    }
    if difference <= CLOSE {
        return Ok(Verdict::Agrees { difference, within: "1e-6".into() });
    }
    let text = String::from_utf8_lossy(&std::fs::read(model)?).into_owned();
    let dynamic = text.contains("<analysis>DYNAMIC");
    // Steps of time have errors beyond the tolerance of the iterations.
    let tolerance = own_tolerance(&text).filter(|_| !dynamic);
    Ok(match tolerance.filter(|tolerance| difference <= *tolerance) {
        Some(tolerance) => Verdict::Agrees { difference, within: format!("dtol = {tolerance:e}") },
        None => {
            let reason = match norm <= NOTHING * stored {
                true => "the end is without load, and the stored norm is what the iterations left",
                false if text.contains("<contact ") || text.contains("<constraint ") => {
                    "contact at other points of the faces"
                }
                // FEBio's steps, repeated with its stress and its tolerances, give the stored numbers.
                false if dynamic && text.contains("<rhoi>-2<") => "its iterations in each step end at dtol",
                false if dynamic => {
                    "it takes the stress of the mean deformation of each step, and its iterations end at dtol"
                }
                false => "unexplained",
            };
            Verdict::Differs { difference, reason: format!("{reason} ({norm:.9e} for {stored:.9e})") }
        }
    })
}

/// Relative tolerance on the displacement at which the model ends its iterations.
fn own_tolerance(text: &str) -> Option<f64> {
    let (_, rest) = text.split_once("<dtol>")?;
    rest.split('<').next()?.trim().parse().ok().filter(|tolerance| *tolerance > 0.0)
}

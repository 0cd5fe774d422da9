//! Curves of a scene: factors of loads, motions, drives and active stress over time.

use std::cell::Cell;
use std::sync::Arc;

use catalogue::Problem;
use schemars::JsonSchema;
use serde::Deserialize;
use shape::{Curve, CurveError};

use super::report::{Report, which};
use super::units::{Q, Time};

/// A curve: the factor of the loads, motions, drives and active stresses that name it. Between its points the
/// factor follows straight lines; before the first and after the last it is constant
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub(crate) struct CurveKeys {
    name: String,
    /// Fractions of the loading from 0 to 1, in a static procedure
    part: Option<Vec<f64>>,
    /// Times, in dynamics
    time: Option<Vec<Q<Time>>>,
    /// The factor at each of these
    factor: Vec<f64>,
    /// Whether the factor passes from point to point with zero speed and acceleration at both; false unless
    /// given
    smooth: Option<bool>,
}

/// A curve of a scene.
#[derive(Clone, Debug)]
pub struct NamedCurve {
    /// Name, unique within the scene.
    pub name: String,
    /// Factor over the fraction of the loading, or over the time in seconds.
    pub curve: Arc<Curve>,
    pub(crate) in_time: bool,
}

impl CurveKeys {
    fn read(self, report: &Report) -> Option<NamedCurve> {
        let CurveKeys { name, part, time, factor, smooth } = self;
        let (key, times) = match (part, time) {
            (Some(part), None) => ("part", part),
            (None, Some(time)) => ("time", time.into_iter().map(|q| q.0).collect()),
            (Some(_), Some(_)) => {
                let help = "give part in a static procedure, time in dynamics";
                report.add("time", Problem::new("can't be combined with part").help(help));
                return None;
            }
            (None, None) => {
                report.missing("part", "give the fractions of the loading (static), or the times (dynamics)");
                return None;
            }
        };
        if times.len() != factor.len() {
            let problem = format!("has {} numbers for the {} of '{key}'", factor.len(), times.len());
            report.add("factor", Problem::new(problem).help("give one factor for each"));
            return None;
        }
        let points = times.into_iter().zip(factor).map(Into::into).collect();
        match Curve::new(points, smooth.unwrap_or(false)) {
            Ok(curve) => Some(NamedCurve { name, curve: Arc::new(curve), in_time: key == "time" }),
            Err(bad @ CurveError::NotIncreasing { .. }) => {
                report.add(key, Problem::new(bad.to_string()).help("give each later than the one before it"));
                None
            }
            Err(bad) => {
                report.add(key, Problem::new(bad.to_string()).help("give two or more, with their factors"));
                None
            }
        }
    }
}

/// Reads the curves of a scene, and returns whether all are sound. A curve that is not has a constant factor, so
/// that conditions can name it.
pub(crate) fn curves(keys: Vec<CurveKeys>, report: &Report) -> (Vec<NamedCurve>, bool) {
    let sound = Cell::new(true);
    let read = |keys: CurveKeys, report: &Report| {
        let (name, in_time) = (keys.name.clone(), keys.time.is_some());
        let constant = || {
            sound.set(false);
            NamedCurve { name, curve: Arc::new(Curve::at_once()), in_time }
        };
        Some(keys.read(report).unwrap_or_else(constant))
    };
    let curves = report.each("curve", keys, read);
    (curves, sound.get())
}

/// Returns the curve that a key names.
pub(crate) fn named(
    name: Option<&String>,
    curves: &[NamedCurve],
    key: &str,
    report: &Report,
) -> Option<Arc<Curve>> {
    let name = name?;
    let found = curves.iter().find(|curve| curve.name == *name);
    if found.is_none() {
        let known = curves.iter().map(|curve| curve.name.as_str());
        let help = match curves.is_empty() {
            true => format!("add [[curve]] name = \"{name}\" with part or time, and factor"),
            false => which(name, known),
        };
        report.add(key, Problem::new("is no curve of the scene").found(name).help(&help));
    }
    found.map(|found| found.curve.clone())
}

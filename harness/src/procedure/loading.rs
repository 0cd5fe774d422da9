//! Loads and prescribed displacements of explicit dynamics and of frames over time.

use std::collections::BTreeMap;

use cases::scene::Ramp;
use geometry::Vector3;
use shape::Curve;
use statics::{Curves, nodal_forces_by_curve};

use super::problem::Problem;
use crate::error::Failure;
use crate::prepare::Prepared;
use crate::scenario::setup::Setup;

/// A prescribed degree of freedom.
#[derive(Clone, Copy)]
pub(super) struct Led {
    /// Full displacement, m.
    pub(super) value: f64,
    /// Number of the condition with its curve.
    index: usize,
    /// Time at which its supports let go, s; infinite if one of them never does.
    pub(super) until: f64,
}

/// Loads and prescribed displacements of the supports, with their curves over time.
pub(super) struct Loading<'a> {
    /// Nodal forces of each curve, N, in the nodes that have any.
    pub(super) loads: Vec<(Curve, Vec<(usize, Vector3)>)>,
    pub(super) led: BTreeMap<(u32, u8), Led>,
    pub(super) curves: Curves<'a>,
}

impl Loading<'_> {
    /// Displacement (m) of each prescribed degree of freedom over time (s).
    pub(super) fn motions(&self) -> Vec<Box<dyn Fn(f64) -> f64 + Sync + '_>> {
        let motion = |&Led { value, index, .. }: &Led| {
            let curve = self.curves.fixed.of(index);
            Box::new(move |t: f64| value * curve.value(t)) as Box<_>
        };
        self.led.values().map(motion).collect()
    }

    /// Prescribed degrees of freedom, and the time at which each is let go, s.
    pub(super) fn ends(&self) -> Vec<((u32, u8), f64)> {
        self.led.iter().map(|(&at, led)| (at, led.until)).collect()
    }

    /// Active stress of each region (Pa) at a time (s).
    pub(super) fn active(&self, setup: &Setup, time: f64) -> Vec<f64> {
        let curves = &self.curves.active;
        setup.active.iter().enumerate().map(|(k, full)| full * curves.of(k).value(time)).collect()
    }

    pub(super) fn new<'a>(problem: &Problem<'a>, ramp: &Ramp) -> Result<Loading<'a>, Failure> {
        let Problem { prepared, .. } = *problem;
        let over = ramp.growth();
        let growth = if over > 0.0 { Curve::growth(over) } else { Curve::at_once() };
        let curves = prepared.curves(Curves::all(growth));
        let loads = nodal_forces_by_curve(&prepared.volume.rows, &prepared.loads(), &curves.loads)?;
        let loaded = |forces: Vec<Vector3>| -> Vec<(usize, Vector3)> {
            forces.into_iter().enumerate().filter(|(_, force)| *force != Vector3::zeros()).collect()
        };
        let loads = loads.into_iter().map(|(curve, forces)| (curve, loaded(forces))).collect();
        Ok(Loading { loads, led: led(prepared), curves })
    }
}

/// Prescribed degrees of freedom. Supports at the same degree of freedom agree: `prepare` refuses others.
pub(super) fn led(prepared: &Prepared) -> BTreeMap<(u32, u8), Led> {
    let curves = prepared.curves(Curves::all(Curve::at_once()));
    let mut led = BTreeMap::new();
    for (index, fixed) in prepared.fixed().iter().enumerate() {
        let during = curves.fixed.during.get(index).copied().flatten();
        let until = during.map_or(f64::INFINITY, |[_, until]| until);
        let led = led.entry((fixed.node, fixed.axis)).or_insert(Led { value: fixed.value, index, until });
        *led = Led { value: fixed.value, index, until: until.max(led.until) };
    }
    led
}

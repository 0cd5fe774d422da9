//! Gives the prepared conditions the curves of the scene.

use shape::Curve;
use statics::{Curves, Timing};

use super::Prepared;
use super::own_curves::{OwnCurves, Timed};
use crate::scenario::setup::Setup;

/// Returns a list, or an empty one if all its entries are usual.
fn used<T>(list: Vec<Option<T>>) -> Vec<Option<T>> {
    if list.iter().any(Option::is_some) { list } else { Vec::new() }
}

impl Prepared {
    /// Gives all loads that were added last the curve of their load in the scene.
    pub(super) fn time_loads(&mut self, curve: &Timed) {
        let own = &mut self.own_curves;
        for (list, count) in [
            (&mut own.surfaces, self.surfaces.len()),
            (&mut own.body_force, self.body_force.len()),
            (&mut own.nodal, self.nodal.len()),
            (&mut own.following, self.following.len()),
        ] {
            list.resize(count, curve.clone());
        }
    }

    /// Gives all conditions that were added last the curve of their support in the scene, and the time in which it
    /// acts.
    pub(super) fn time_supports(&mut self, curve: &Timed, during: Option<[f64; 2]>) {
        self.own_curves.fixed.resize(self.fixed.len(), curve.clone());
        self.own_curves.weak.resize(self.weak.len(), curve.clone());
        self.own_curves.fixed_during.resize(self.fixed.len(), during);
        self.own_curves.weak_during.resize(self.weak.len(), during);
    }

    /// Completes the lists when all conditions are prepared.
    pub(super) fn time_all(&mut self, setup: &Setup) {
        let OwnCurves {
            surfaces, body_force, nodal, following, fixed, fixed_during, weak, weak_during, ..
        } = std::mem::take(&mut self.own_curves);
        let loads = surfaces.into_iter().chain(body_force).chain(nodal).collect();
        let tools = setup.tools.iter().map(|tool| tool.curve.clone()).collect();
        self.own_curves = OwnCurves {
            following: used(following),
            fixed: used(fixed),
            fixed_during: used(fixed_during),
            weak: used(weak),
            weak_during: used(weak_during),
            loads: used(loads),
            active: used(setup.active_curves.clone()),
            tools: used(tools),
            end: setup.procedure.duration().unwrap_or(1.0),
            ..OwnCurves::default()
        };
    }

    /// Active stress of each region (Pa) at a time: in dynamics in seconds, otherwise the fraction of the loading.
    /// Empty if nothing contracts.
    pub fn active(&self, setup: &Setup, time: f64) -> Vec<f64> {
        let usual = match setup.procedure.ramp().map(|ramp| ramp.growth()) {
            Some(over) if over > 0.0 => Curves::all(Curve::growth(over)),
            Some(_) => Curves::all(Curve::at_once()),
            None => Curves::proportional(),
        };
        let curves = self.curves(usual).active;
        setup.active.iter().enumerate().map(|(k, full)| full * curves.of(k).value(time)).collect()
    }

    /// Returns the curves of all conditions; `usual` gives those of the conditions without their own.
    pub fn curves(&self, usual: Curves<'static>) -> Curves<'_> {
        let OwnCurves { following, fixed, fixed_during, weak, weak_during, loads, active, tools, .. } =
            &self.own_curves;
        Curves {
            loads: Timing { usual: usual.loads.usual, own: loads, during: &[] },
            following: Timing { usual: usual.following.usual, own: following, during: &[] },
            active: Timing { usual: usual.active.usual, own: active, during: &[] },
            fixed: Timing { usual: usual.fixed.usual, own: fixed, during: fixed_during },
            penalties: Timing { usual: usual.penalties.usual, own: weak, during: weak_during },
            tools: Timing { usual: usual.tools.usual, own: tools, during: &[] },
        }
    }
}

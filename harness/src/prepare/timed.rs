//! Gives the prepared conditions the curves of the scene.

use statics::{Curves, Timing};

use super::Prepared;
use super::own_curves::{OwnCurves, Timed};
use crate::scenario::setup::Setup;

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

    /// Gives all conditions that were added last the curve of their support in the scene.
    pub(super) fn time_supports(&mut self, curve: &Timed) {
        self.own_curves.fixed.resize(self.fixed.len(), curve.clone());
        self.own_curves.weak.resize(self.weak.len(), curve.clone());
    }

    /// Completes the lists when all conditions are prepared.
    pub(super) fn time_all(&mut self, setup: &Setup) {
        let OwnCurves { surfaces, body_force, nodal, following, fixed, weak, .. } =
            std::mem::take(&mut self.own_curves);
        let loads = surfaces.into_iter().chain(body_force).chain(nodal).collect();
        let tools = setup.tools.iter().map(|tool| tool.curve.clone()).collect();
        let used = |list: Vec<Timed>| if list.iter().any(Option::is_some) { list } else { Vec::new() };
        self.own_curves = OwnCurves {
            following: used(following),
            fixed: used(fixed),
            weak: used(weak),
            loads: used(loads),
            active: used(setup.active_curves.clone()),
            tools: used(tools),
            end: setup.procedure.duration().unwrap_or(1.0),
            ..OwnCurves::default()
        };
    }

    /// Returns the curves of all conditions; `usual` gives those of the conditions without their own.
    pub fn curves(&self, usual: Curves<'static>) -> Curves<'_> {
        let OwnCurves { following, fixed, weak, loads, active, tools, .. } = &self.own_curves;
        Curves {
            loads: Timing { usual: usual.loads.usual, own: loads },
            following: Timing { usual: usual.following.usual, own: following },
            active: Timing { usual: usual.active.usual, own: active },
            fixed: Timing { usual: usual.fixed.usual, own: fixed },
            penalties: Timing { usual: usual.penalties.usual, own: weak },
            tools: Timing { usual: usual.tools.usual, own: tools },
        }
    }
}

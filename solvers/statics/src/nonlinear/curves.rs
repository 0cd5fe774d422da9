//! Curves of loads, supports and tools over time.

use std::sync::Arc;

use shape::Curve;

/// Curves of the conditions of one kind.
#[derive(Clone, Debug)]
pub struct Timing<'a> {
    /// Curve of the conditions without their own.
    pub usual: Curve,
    /// Curve of each condition; empty if none has its own.
    pub own: &'a [Option<Arc<Curve>>],
    /// Start and end of the time in which each condition acts, `None` for all of it; empty if all conditions act
    /// throughout. Supports alone may have it.
    pub during: &'a [Option<[f64; 2]>],
}

/// Curves of all conditions of a problem. Time is the fraction of the loading in statics, and in seconds in
/// dynamics.
#[derive(Clone, Debug)]
pub struct Curves<'a> {
    /// By dead load.
    pub loads: Timing<'a>,
    /// By pressure on the deformed surface.
    pub following: Timing<'a>,
    /// Of the active stress, by region.
    pub active: Timing<'a>,
    /// By prescribed nodal parameter.
    pub fixed: Timing<'a>,
    /// By surface constrained by penalty.
    pub penalties: Timing<'a>,
    /// By tool.
    pub tools: Timing<'a>,
}

impl Timing<'_> {
    /// Returns the curve of the condition `index`.
    pub fn of(&self, index: usize) -> &Curve {
        self.own.get(index).and_then(Option::as_deref).unwrap_or(&self.usual)
    }

    fn acts_at(&self, time: f64) -> bool {
        let own = self.own.iter().flatten().map(Arc::as_ref);
        own.chain([&self.usual]).any(|curve| curve.value(time) != 0.0)
    }
}

impl Curves<'static> {
    /// Uses one curve for all loads, one for all supports, and one for all tools.
    pub fn new(loads: Curve, supports: Curve, tools: Curve) -> Curves<'static> {
        let usual = |curve: &Curve| Timing { usual: curve.clone(), own: &[], during: &[] };
        Curves {
            loads: usual(&loads),
            following: usual(&loads),
            active: usual(&loads),
            fixed: usual(&supports),
            penalties: usual(&supports),
            tools: usual(&tools),
        }
    }

    /// Uses the same curve for everything.
    pub fn all(curve: Curve) -> Curves<'static> {
        Curves::new(curve.clone(), curve.clone(), curve)
    }

    /// Lets everything grow in proportion to the time from 0 to 1.
    pub fn proportional() -> Curves<'static> {
        Curves::all(Curve::growth(1.0))
    }
}

impl Curves<'_> {
    fn all_timings(&self) -> [&Timing<'_>; 6] {
        let Curves { loads, following, active, fixed, penalties, tools } = self;
        [loads, following, active, fixed, penalties, tools]
    }

    /// Returns the times of the points of all curves that a condition has of its own, and of the changes of
    /// supports, in order.
    pub(crate) fn points(&self) -> Vec<f64> {
        let own = self.all_timings().into_iter().flat_map(|timing| timing.own).flatten();
        let points = own.flat_map(|curve| curve.points()).map(|point| point[0]);
        in_order(points.chain(self.changes()).collect())
    }

    /// Returns the times at which supports begin or end to act, in order.
    pub(crate) fn changes(&self) -> Vec<f64> {
        let during = self.fixed.during.iter().chain(self.penalties.during);
        in_order(during.flatten().flatten().copied().collect())
    }

    /// Whether any condition acts at a time.
    pub(crate) fn act_at(&self, time: f64) -> bool {
        self.all_timings().iter().any(|timing| timing.acts_at(time))
    }
}

fn in_order(mut times: Vec<f64>) -> Vec<f64> {
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
}

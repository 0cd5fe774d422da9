//! Radial deformation of a wall, by its ordinary differential equation.

use super::hyperelastic::Hyperelastic;

/// Intervals across the wall: the error of fourth-order Runge-Kutta is below 1e-10 of the radius.
const INTERVALS: usize = 100;

/// Deformed radius across a wall.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Wall {
    /// Undeformed coordinate at the start, and length of an interval, m.
    start: f64,
    step: f64,
    /// Radius `r` (m) and slope `r'` at the ends of the intervals.
    radius: Vec<(f64, f64)>,
}

impl Wall {
    /// Integrates from the start of a wall of the given thickness (m), at which the radius is `r` (m) and the
    /// nominal stress `P_r` (Pa). `across` gives the other two stretches at an undeformed coordinate and a
    /// radius, `balance` the slope `dP_r/dX` (Pa/m) at a coordinate and principal stresses. Returns the wall
    /// and `P_r` at its end; `None` if the law can't carry the stress at some place in the wall.
    pub fn integrate(
        law: &Hyperelastic,
        [start, thickness]: [f64; 2],
        (r, pressed): (f64, f64),
        across: impl Fn(f64, f64) -> [f64; 2],
        balance: impl Fn(f64, [f64; 3]) -> f64,
    ) -> Option<(Wall, f64)> {
        let step = thickness / INTERVALS as f64;
        // (r', dP_r/dX) of a state (r, P_r).
        let slope = |x: f64, (r, pressed): (f64, f64)| {
            let across = across(x, r);
            let radial = radial_stretch(law, across, pressed)?;
            Some((radial, balance(x, law.principal_stress([radial, across[0], across[1]]))))
        };
        let shifted = |(r, p): (f64, f64), (dr, dp): (f64, f64), by: f64| (r + by * dr, p + by * dp);
        let mut state = (r, pressed);
        let mut radius = vec![(r, slope(start, state)?.0)];
        for k in 0..INTERVALS {
            let x = start + k as f64 * step;
            let k1 = slope(x, state)?;
            let k2 = slope(x + 0.5 * step, shifted(state, k1, 0.5 * step))?;
            let k3 = slope(x + 0.5 * step, shifted(state, k2, 0.5 * step))?;
            let k4 = slope(x + step, shifted(state, k3, step))?;
            let mean = |f: &dyn Fn((f64, f64)) -> f64| (f(k1) + 2.0 * (f(k2) + f(k3)) + f(k4)) / 6.0;
            state = shifted(state, (mean(&|k| k.0), mean(&|k| k.1)), step);
            radius.push((state.0, slope(x + step, state)?.0));
        }
        Some((Wall { start, step, radius }, state.1))
    }

    /// Radius (m) and slope at an undeformed coordinate (m), from the cubic through both ends of its
    /// interval.
    pub fn at(&self, x: f64) -> (f64, f64) {
        let step = self.step;
        let at = (x - self.start) / step;
        let k = (at.max(0.0) as usize).min(INTERVALS - 1);
        let (a, da) = self.radius[k];
        let (b, db) = self.radius[k + 1];
        let t = at - k as f64;
        let s = 1.0 - t;
        let value =
            s * s * ((1.0 + 2.0 * t) * a + t * step * da) + t * t * ((1.0 + 2.0 * s) * b - s * step * db);
        let slope = 6.0 * s * t * (b - a) / step + s * (1.0 - 3.0 * t) * da + t * (1.0 - 3.0 * s) * db;
        (value, slope)
    }
}

/// Radial stretch between 1/8 and 8 at which the radial stress is `pressed` (Pa) and rises with the stretch,
/// by bisection; `None` if there is none. The stress of a law such as that of Saint-Venant and Kirchhoff falls
/// again under strong compression, and such a wall collapses.
fn radial_stretch(law: &Hyperelastic, [second, third]: [f64; 2], pressed: f64) -> Option<f64> {
    let is_below = |radial: f64| law.principal_stress([radial, second, third])[0] < pressed;
    rising([LEAST, MOST], is_below).or_else(|| {
        // The whole range has no bracket if the stress is above `pressed` at both of its ends.
        let mut high = MOST;
        while high > LEAST && !is_below(high) {
            let low = SEARCH * high;
            if is_below(low) {
                return rising([low, high], is_below);
            }
            high = low;
        }
        None
    })
}

/// Smallest and largest radial stretch, and the ratio of two stretches in a search for a bracket.
const LEAST: f64 = 0.125;
const MOST: f64 = 8.0;
const SEARCH: f64 = 0.95;

/// Bisects between two stretches; `None` if the ends are not seen on both sides of the root.
fn rising([mut low, mut high]: [f64; 2], is_below: impl Fn(f64) -> bool) -> Option<f64> {
    let ends = [low, high];
    for _ in 0..56 {
        let middle = 0.5 * (low + high);
        if is_below(middle) { low = middle } else { high = middle }
    }
    (low > ends[0] || is_below(ends[0])).then_some(())?;
    (high < ends[1] || !is_below(ends[1])).then_some(0.5 * (low + high))
}

//! Time functions of loads, supports and tools.

/// Fraction of a full value as a function of time, 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ramp {
    /// Full value from the start.
    AtOnce,
    /// Proportional to time over the duration, then constant. The velocity of driven supports jumps at the
    /// start and the end, which causes waves in a body with inertia.
    Linear {
        /// Duration, s.
        over: f64,
    },
    /// `10 s^3 - 15 s^4 + 6 s^5`, `s = t / over`, then constant: velocity and acceleration are continuous.
    Smooth {
        /// Duration, s.
        over: f64,
    },
}

/// Ramps of loads, supports and tools.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ramps {
    /// Ramp of the loads.
    pub loads: Ramp,
    /// Ramp of the prescribed displacements, at nodes and on surfaces constrained by penalty.
    pub supports: Ramp,
    /// Ramp of the tools' prescribed displacements and forces.
    pub tools: Ramp,
}

impl Ramps {
    /// Uses the same ramp for everything.
    pub fn all(ramp: Ramp) -> Ramps {
        Ramps { loads: ramp, supports: ramp, tools: ramp }
    }
}

impl Ramp {
    /// Returns the fraction at the time `t >= 0` (s).
    pub fn value(self, t: f64) -> f64 {
        self.derivatives(t)[0]
    }

    /// Duration, s; `None` for a value that acts at once.
    pub(crate) fn over(self) -> Option<f64> {
        match self {
            Ramp::AtOnce => None,
            Ramp::Linear { over } | Ramp::Smooth { over } => Some(over),
        }
    }

    /// Returns value, first derivative (1/s) and second derivative (1/s^2). At a kink, derivatives are those
    /// just after it.
    pub(crate) fn derivatives(self, t: f64) -> [f64; 3] {
        match self {
            Ramp::Linear { over } if t < over => [t / over, 1.0 / over, 0.0],
            Ramp::Smooth { over } if t < over => {
                let s = t / over;
                [
                    s * s * s * (10.0 + s * (6.0 * s - 15.0)),
                    30.0 * (s * (1.0 - s)).powi(2) / over,
                    60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / (over * over),
                ]
            }
            _ => [1.0, 0.0, 0.0],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_are_those_of_the_value() {
        let h = 1e-5;
        for ramp in [Ramp::AtOnce, Ramp::Linear { over: 2.0 }, Ramp::Smooth { over: 2.0 }] {
            for t in [0.3, 0.9, 1.7, 2.5] {
                let [value, first, second] = ramp.derivatives(t);
                let (up, down) = (ramp.derivatives(t + h), ramp.derivatives(t - h));
                assert_eq!(value, ramp.value(t));
                assert!(((up[0] - down[0]) / (2.0 * h) - first).abs() < 1e-8, "{ramp:?} {t}");
                assert!(((up[1] - down[1]) / (2.0 * h) - second).abs() < 1e-8, "{ramp:?} {t}");
            }
        }
    }

    #[test]
    fn a_smooth_ramp_has_no_kink() {
        let ramp = Ramp::Smooth { over: 2.0 };
        assert_eq!(ramp.derivatives(0.0), [0.0; 3]);
        assert_eq!(ramp.derivatives(2.0), [1.0, 0.0, 0.0]);
        let [value, first, second] = ramp.derivatives(2.0 - 1e-6);
        assert!((value - 1.0).abs() < 1e-15 && first < 1e-11 && second.abs() < 2e-5);
        assert!((ramp.value(1.0) - 0.5).abs() < 1e-15);
    }
}

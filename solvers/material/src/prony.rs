//! Relaxation by a Prony series.

use shape::Matrix3;

use crate::error::MaterialError;

/// Prony series `g(t) = g_inf + sum_i g_i exp(-t / tau_i)` with `g_inf = 1 - sum_i g_i`: the fraction of a
/// suddenly applied stress that remains after the time `t`. `g_i` is dimensionless, `tau_i` in seconds.
///
/// The series acts on a material stress, the deviatoric part of the instantaneous second Piola-Kirchhoff
/// stress `S0` (see [`deviator`](super::deviator)):
///
/// ```text
/// S(t) = g_inf S0(t) + sum_i h_i(t),   h_i(t) = integral_0^t g_i exp(-(t - s) / tau_i) dS0/ds ds
/// h_i(t + dt) = exp(-dt / tau_i) h_i(t) + g_i (1 - exp(-dt / tau_i)) / (dt / tau_i) (S0(t + dt) - S0(t))
/// ```
///
/// The recursion is exact if `S0` is linear in time over the step, and stable for any step. Sources: Taylor,
/// Pister and Goudreau, Int. J. Numer. Methods Eng. 2 (1970) 45-59; Simo and Hughes, Computational
/// Inelasticity, section 10.3.
#[derive(Clone, Debug, PartialEq)]
pub struct Prony {
    terms: Vec<(f64, f64)>,
}

/// Coefficients of the series for a given step length. The `h_i` of a point are a slice with one tensor per
/// term, initially zero; the slices of all points form one flat array.
#[derive(Clone, Debug, PartialEq)]
pub struct PronyStep {
    relaxed: f64,
    /// `exp(-dt / tau_i)` and `g_i (1 - exp(-dt / tau_i)) / (dt / tau_i)`.
    terms: Vec<(f64, f64)>,
}

impl Prony {
    /// Builds the series from the terms `(g_i, tau_i)`. All must be positive and finite, and the sum of the
    /// `g_i` must be less than 1.
    pub fn new(terms: &[(f64, f64)]) -> Result<Prony, MaterialError> {
        for (term, &(g, tau)) in terms.iter().enumerate() {
            if !(g > 0.0 && tau > 0.0 && tau.is_finite()) {
                return Err(MaterialError::PronyTerm { term, g, tau });
            }
        }
        let sum = terms.iter().map(|(g, _)| g).sum();
        if !(sum < 1.0) {
            return Err(MaterialError::PronySum { sum });
        }
        Ok(Prony { terms: terms.to_vec() })
    }

    /// Returns the terms `(g_i, tau_i)`: `g_i` dimensionless, `tau_i` in seconds.
    pub fn terms(&self) -> &[(f64, f64)] {
        &self.terms
    }

    /// Returns `g(t)`, with `t` in seconds.
    pub fn relaxation(&self, t: f64) -> f64 {
        self.relaxed() + self.terms.iter().map(|(g, tau)| g * (-t / tau).exp()).sum::<f64>()
    }

    /// Returns `g_inf`, the fraction that never relaxes.
    pub fn relaxed(&self) -> f64 {
        1.0 - self.terms.iter().map(|(g, _)| g).sum::<f64>()
    }

    /// Returns the coefficients for steps of `dt` seconds. 0 gives the instantaneous response, infinity the
    /// relaxed response.
    pub fn step(&self, dt: f64) -> Result<PronyStep, MaterialError> {
        if !(dt >= 0.0) {
            return Err(MaterialError::TimeStep { dt });
        }
        let term = |&(g, tau): &(f64, f64)| {
            let x = dt / tau;
            let mean = if x == 0.0 { 1.0 } else { -(-x).exp_m1() / x };
            ((-x).exp(), g * mean)
        };
        Ok(PronyStep { relaxed: self.relaxed(), terms: self.terms.iter().map(term).collect() })
    }
}

impl PronyStep {
    /// Returns `S` at the end of the step, Pa, from `S0` at its start (`old`) and end (`new`) and the `h_i`
    /// at its start.
    pub fn stress(&self, old: &Matrix3, new: &Matrix3, history: &[Matrix3]) -> Matrix3 {
        new * self.modulus() + self.carried(old, history)
    }

    /// Returns `dS / dS0` at the end of the step: `g_inf + sum_i g_i (1 - exp(-dt / tau_i)) / (dt / tau_i)`.
    pub fn modulus(&self) -> f64 {
        self.relaxed + self.terms.iter().map(|(_, gain)| gain).sum::<f64>()
    }

    /// Returns the part of `S` at the end of the step that is known at its start, Pa, from `S0` (`old`) and
    /// the `h_i` (`history`) at the start.
    pub fn carried(&self, old: &Matrix3, history: &[Matrix3]) -> Matrix3 {
        assert_eq!(history.len(), self.terms.len(), "one tensor for each term");
        let sum = |sum, (&(decay, gain), h): (&(f64, f64), &Matrix3)| sum + h * decay - old * gain;
        self.terms.iter().zip(history).fold(Matrix3::zeros(), sum)
    }

    /// Updates the `h_i` (`history`, Pa) from the start of the step to its end, given `S0` at the start
    /// (`old`) and the end (`new`), Pa.
    pub fn advance(&self, old: &Matrix3, new: &Matrix3, history: &mut [Matrix3]) {
        assert_eq!(history.len(), self.terms.len(), "one tensor for each term");
        for (&(decay, gain), h) in self.terms.iter().zip(history) {
            *h = *h * decay + (new - old) * gain;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Returns random series of three terms with a relaxed fraction of at least a tenth.
    fn series() -> impl Strategy<Value = Prony> {
        (prop::array::uniform3(0.01..0.3f64), prop::array::uniform3(-3.0..2.0f64)).prop_map(|(g, tau)| {
            let terms: Vec<_> = g.into_iter().zip(tau.map(|t| 10.0_f64.powf(t))).collect();
            Prony::new(&terms).unwrap()
        })
    }

    /// Returns random steps of 1e-4 to 10 s.
    fn steps() -> impl Strategy<Value = Vec<f64>> {
        prop::collection::vec((-4.0..1.0f64).prop_map(|e| 10.0_f64.powf(e)), 1..40)
    }

    const S: Matrix3 = Matrix3::new(3.0, 1.0, -2.0, 1.0, -4.0, 0.5, -2.0, 0.5, 1.0);

    // Rounding over a few dozen steps is 1e-13.
    proptest! {
        #[test]
        fn a_step_strain_relaxes_by_the_series(prony in series(), steps in steps()) {
            let mut history = vec![Matrix3::zeros(); 3];
            let jump = prony.step(0.0).unwrap();
            prop_assert!((jump.stress(&Matrix3::zeros(), &S, &history) - S).norm() < 1e-14);
            jump.advance(&Matrix3::zeros(), &S, &mut history);
            let mut t = 0.0;
            for dt in steps {
                let step = prony.step(dt).unwrap();
                t += dt;
                let exact = S * prony.relaxation(t);
                prop_assert!((step.stress(&S, &S, &history) - exact).norm() < 1e-13 * S.norm());
                step.advance(&S, &S, &mut history);
            }
        }

        #[test]
        fn loading_at_constant_rate_is_exact(prony in series(), steps in steps()) {
            let mut history = vec![Matrix3::zeros(); 3];
            let mut t = 0.0;
            for dt in steps {
                let step = prony.step(dt).unwrap();
                let old = S * t;
                let new = S * (t + dt);
                t += dt;
                let share = prony.relaxed() * t
                    + prony.terms().iter().map(|(g, tau)| g * tau * -(-t / tau).exp_m1()).sum::<f64>();
                let exact = S * share;
                prop_assert!((step.stress(&old, &new, &history) - exact).norm() < 1e-13 * exact.norm());
                step.advance(&old, &new, &mut history);
            }
        }
    }

    #[test]
    fn the_longest_and_the_shortest_step() {
        let prony = Prony::new(&[(0.3, 0.1), (0.2, 2.0)]).unwrap();
        assert!((prony.relaxed() - 0.5).abs() < 1e-15);
        let history = vec![S, S * 2.0];
        let relaxed = prony.step(f64::INFINITY).unwrap().stress(&S, &(S * 3.0), &history);
        assert!((relaxed - S * 1.5).norm() < 1e-14);
        // (1 - exp(-x)) / x = 1 - x/2 at x = 1e-9: no digit of x/2 may be lost.
        let modulus = prony.step(1e-10).unwrap().modulus();
        assert!((1.0 - modulus - (0.3 * 0.5e-9 + 0.2 * 0.25e-10)).abs() < 2e-16, "{modulus}");
    }

    #[test]
    fn bad_terms_and_steps_are_refused() {
        let refused = |terms: &[(f64, f64)]| Prony::new(terms).unwrap_err();
        assert_eq!(
            refused(&[(0.2, 1.0), (-0.1, 1.0)]),
            MaterialError::PronyTerm { term: 1, g: -0.1, tau: 1.0 }
        );
        assert_eq!(refused(&[(0.2, 0.0)]), MaterialError::PronyTerm { term: 0, g: 0.2, tau: 0.0 });
        assert!(matches!(refused(&[(f64::NAN, 1.0)]), MaterialError::PronyTerm { .. }));
        assert_eq!(refused(&[(0.5, 1.0), (0.5, 2.0)]), MaterialError::PronySum { sum: 1.0 });
        let prony = Prony::new(&[(0.5, 1.0)]).unwrap();
        assert_eq!(prony.step(-1.0).unwrap_err(), MaterialError::TimeStep { dt: -1.0 });
        assert!(prony.step(f64::NAN).is_err());
    }
}

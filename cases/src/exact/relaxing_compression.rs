//! Free-slip compression of tissue that relaxes: shortened at a constant rate between frictionless plates,
//! then held.
//!
//! ```text
//! Source      Tschoegl, The Phenomenological Theory of Linear Viscoelastic Behavior (1989), standard solid;
//!             the modulus in tension by the correspondence principle, 1 / E = 1 / (3 G) + 1 / (9 K) of the
//!             transforms.
//!
//!   z   ======= plate =======
//!   |     |           |  ^
//!   |     |           |  |  h -> h (1 - e(t))   e = e0 t / T until T, then e0; at once with T = 0
//!   +--   |           |  |
//!       ======= plate =======                   sides free, plates slip, no inertia
//!
//! Material    G(t) = mu (1 - g + g exp(-t / tau)) and K: the shear response relaxes, the volumetric response
//!             does not.
//! Field       E(t) = E_inf + (E - E_inf) exp(-t / T'),  E_inf = 9 K G_inf / (3 K + G_inf),
//!             T' = tau (3 K + mu) / (3 K + G_inf),  sigma_zz = -integral_0^t E(t - s) de(s),
//!             u = (l x, l y, -e z),  l = e / 2 + sigma_zz / (6 K).
//! Conditions  as for `uniaxial-compression`, which is the state at time 0 of a sudden compression.
//! Must hold   homogeneous: exact up to the error of the time steps, of order 2. In the hold phase the sides
//!             move outwards.
//! ```

use catalogue::{Dimension, Entry, Parameter};

use super::elastic::Elastic;
use super::error::ExactError;
use super::solution::{Exact, SolutionEntry, numbers};
use super::vectors::{Matrix3, Point3, Vector3};

/// Homogeneous uniaxial stress along z in a linear material whose shear modulus relaxes by one term.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RelaxingCompression {
    elastic: Elastic,
    strain: f64,
    over: f64,
    share: f64,
    tau: f64,
    time: f64,
}

impl RelaxingCompression {
    /// A prism at time 0. The shortening `strain` per unit height is reached after `over` (s; 0 for a sudden
    /// load). The part `share` of the shear modulus relaxes with the time `tau` (s).
    ///
    /// # Errors
    ///
    /// A negative `over`, a share outside of `0 <= g < 1`, or a time that is not positive.
    pub fn new(
        elastic: Elastic,
        strain: f64,
        over: f64,
        [share, tau]: [f64; 2],
    ) -> Result<RelaxingCompression, ExactError> {
        for (name, value, sound, need) in [
            ("over", over, over >= 0.0, "zero or above"),
            ("share", share, (0.0..1.0).contains(&share), "from 0 to below 1"),
            ("tau", tau, tau > 0.0, "above zero"),
        ] {
            if !sound {
                return Err(ExactError::BadParameter {
                    solution: ENTRY.name,
                    name,
                    value,
                    need: need.into(),
                });
            }
        }
        Ok(RelaxingCompression { elastic, strain, over, share, tau, time: 0.0 })
    }

    /// Strain `e` and compressive stress `-sigma_zz` (Pa).
    fn state(&self) -> (f64, f64) {
        let bulk = 3.0 * self.elastic.bulk();
        let mu = self.elastic.mu();
        let relaxed = mu * (1.0 - self.share);
        let tau = self.tau * (bulk + mu) / (bulk + relaxed);
        let long = 3.0 * bulk * relaxed / (bulk + relaxed);
        let falls = self.elastic.young() - long;
        if self.over == 0.0 {
            return (self.strain, self.strain * (long + falls * (-self.time / tau).exp()));
        }
        let rate = self.strain / self.over;
        let led = self.time.min(self.over);
        let fading = (-(self.time - led) / tau).exp() - (-self.time / tau).exp();
        (rate * led, rate * (long * led + falls * tau * fading))
    }
}

impl Exact for RelaxingCompression {
    fn displacement(&self, x: &Point3) -> Vector3 {
        self.gradient(x) * x.coords
    }

    fn gradient(&self, _x: &Point3) -> Matrix3 {
        let (strain, pressed) = self.state();
        let lateral = 0.5 * strain - pressed / (6.0 * self.elastic.bulk());
        Matrix3::from_diagonal(&Vector3::new(lateral, lateral, -strain))
    }

    /// Cauchy stress (Pa) of the strain history. Hooke's law for the present gradient would give another
    /// value.
    fn stress(&self, _x: &Point3) -> Matrix3 {
        Matrix3::from_diagonal(&Vector3::new(0.0, 0.0, -self.state().1))
    }

    fn at(&self, time: f64) -> Option<Box<dyn Exact>> {
        Some(Box::new(RelaxingCompression { time, ..*self }))
    }
}

pub(super) const ENTRY: SolutionEntry = Entry {
    name: "relaxing-compression",
    meaning: "a prism of viscoelastic tissue, shortened along z between frictionless plates and then held",
    source: "Tschoegl, The Phenomenological Theory of Linear Viscoelastic Behavior (1989)",
    parameters: &[
        Parameter::required(
            "strain",
            Dimension::None,
            "shortening per unit height along z, positive in compression",
        ),
        Parameter::required("share", Dimension::None, "fraction of the shear modulus that relaxes"),
        Parameter::required("tau", Dimension::Time, "relaxation time"),
        Parameter::default("over", Dimension::Time, 0.0, "time over which the shortening grows"),
    ],
    build: |medium, values| {
        let [strain, share, tau, over] = numbers(values, ["strain", "share", "tau", "over"])?;
        Ok(Box::new(RelaxingCompression::new(medium.elastic, strain, over, [share, tau])?))
    },
};

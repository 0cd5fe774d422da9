//! Contact law of one point, in the tool's frame: penalty along the normal, Coulomb friction across it.
//!
//! With the gap `g` (signed distance, m), its unit gradient `n` and the multiplier `l` (Pa, 0 for a plain
//! penalty):
//!
//! ```text
//! p   = max(0, l - k_n g)                          normal pressure; the point touches while p > 0
//! e*  = (I - n n^T)(e_n + x - x_n)                 trial elastic slip: committed slip plus motion, projected
//! t_t = -k_t e*                if k_t |e*| <= mu p (stick)
//!     = -mu p e* / |e*|        otherwise           (slip: radial return)
//! t   = p n + t_t,             e = -t_t / k_t
//! ```
//!
//! Positions are relative to the tool's frame, so a moving tool drags the tissue. Projecting `e_n` onto the
//! current tangent plane can only shorten it: on a curved tool the spring never gains energy.
//!
//! A point that comes into contact has `e_n = 0`. Only the part `g / (g - g_n)` of its motion since the last
//! commit counts, which is the part after contact; `g_n > 0` is its gap at the last commit. Without this
//! factor friction lags by one step, and a step in which many points come into contact slides away sideways.
//! A point whose last position is unknown starts at its current position.
//!
//! Source: Wriggers, Computational Contact Mechanics (2006), ch. 5 and 6; Simo & Laursen (1992).

use shape::{Matrix3, Vector3};

use crate::error::ContactError;

/// Moduli of a contact per undeformed area, Pa/m, and the coefficient of friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactLaw {
    penalty: f64,
    friction: f64,
    stick: f64,
}

impl ContactLaw {
    /// Makes a law with normal penalty `k_n` (Pa/m) and without friction.
    ///
    /// # Errors
    ///
    /// [`ContactError::Modulus`] if the penalty is not positive and finite.
    pub fn frictionless(penalty: f64) -> Result<ContactLaw, ContactError> {
        modulus("penalty", penalty)?;
        Ok(ContactLaw { penalty, friction: 0.0, stick: 0.0 })
    }

    /// Makes a law with normal penalty `k_n` (Pa/m), coefficient of friction `mu` and elastic stick slope
    /// `k_t` (Pa/m).
    ///
    /// # Errors
    ///
    /// [`ContactError::Modulus`] or [`ContactError::Friction`] if a value is not positive and finite.
    pub fn coulomb(penalty: f64, friction: f64, stick: f64) -> Result<ContactLaw, ContactError> {
        modulus("penalty", penalty)?;
        modulus("stick slope", stick)?;
        // Written so that a NaN fails.
        if !(friction > 0.0 && friction.is_finite()) {
            return Err(ContactError::Friction { value: friction });
        }
        Ok(ContactLaw { penalty, friction, stick })
    }

    /// Normal penalty `k_n`, Pa/m.
    pub fn penalty(&self) -> f64 {
        self.penalty
    }

    /// Coefficient of friction; 0 without friction.
    pub fn friction(&self) -> f64 {
        self.friction
    }

    /// Elastic stick slope `k_t`, Pa/m; 0 without friction.
    pub fn stick(&self) -> f64 {
        self.stick
    }

    /// Returns the response at position `at` (tool's frame) with gap and unit normal; `None` if separated.
    #[inline]
    pub(super) fn respond(
        &self,
        gap: f64,
        normal: &Vector3,
        at: &Vector3,
        history: &Slip,
        multiplier: f64,
    ) -> Option<Response> {
        let pressure = multiplier - self.penalty * gap;
        if !(pressure > 0.0) {
            return None;
        }
        let mut response = Response {
            pressure,
            traction: normal * pressure,
            slip: Slip::NONE,
            drift: Vector3::zeros(),
            after: 0.0,
            speed: Vector3::zeros(),
            state: State::Free,
            dissipated: 0.0,
        };
        if self.friction == 0.0 {
            return Some(response);
        }
        let Some(last) = history.0 else {
            response.slip = Slip::at(at, 0.0);
            return Some(response);
        };
        let motion = at - last.at;
        // The part of the motion after contact. A point that a multiplier keeps in contact from outside has
        // none.
        let (after, by_gap) = if last.gap > 0.0 && gap < 0.0 {
            let whole = last.gap - gap;
            (-gap / whole, -last.gap / (whole * whole))
        } else {
            (if last.gap > 0.0 { 0.0 } else { 1.0 }, 0.0)
        };
        let drift = last.stretch + motion * after;
        response.after = after;
        response.speed = motion * by_gap;
        let trial = drift - normal * normal.dot(&drift);
        let length = trial.norm();
        let limit = self.friction * pressure;
        let mut stretch = trial;
        response.drift = drift;
        response.state = State::Stick;
        if self.stick * length > limit {
            stretch *= limit / (self.stick * length);
            response.state = State::Slide { direction: trial / length, length };
            response.dissipated = limit * (length - limit / self.stick);
        }
        response.traction -= stretch * self.stick;
        response.slip = Slip(Some(Stick { stretch, at: *at, gap: 0.0 }));
        Some(response)
    }

    /// Returns the consistent tangent `dt/dx` (3, 3), Pa/m, in the tool's frame; `hessian` is the Hessian of
    /// the distance.
    ///
    /// ```text
    /// normal  -k_n n n^T + p H
    /// stick   -k_t A,    A = de*/dx = (I - n n^T) V - (n . v) H - n (H v)^T
    ///                    v = e_n + c (x - x_n),  V = dv/dx = c I + (x - x_n) (dc/dg n)^T
    /// slip    mu k_n s n^T - (mu p / |e*|) (I - s s^T) A,                    s = e* / |e*|
    /// ```
    ///
    /// Here `c` is 1, or the part of the motion after contact. The slip part is not symmetric. As `x` is
    /// relative to the tool, the derivative with respect to the tool's own displacement `d` is
    /// `dt/dd = -dt/dx`, history included: for a tool that closes along `a`, `dt/dclosure = -(dt/dx) a`.
    #[inline]
    pub(super) fn tangent(&self, response: &Response, normal: &Vector3, hessian: &Matrix3) -> Matrix3 {
        let mut tangent = hessian * response.pressure - normal * normal.transpose() * self.penalty;
        let trial_slope = || {
            let v = &response.drift;
            let across = Matrix3::identity() - normal * normal.transpose();
            across * response.after + (across * response.speed) * normal.transpose()
                - hessian * normal.dot(v)
                - normal * (hessian * v).transpose()
        };
        match response.state {
            State::Free => {}
            State::Stick => tangent -= trial_slope() * self.stick,
            State::Slide { direction: s, length } => {
                let slope = trial_slope();
                let turned = slope - s * (slope.tr_mul(&s)).transpose();
                tangent += s * normal.transpose() * (self.friction * self.penalty)
                    - turned * (self.friction * response.pressure / length);
            }
        }
        tangent
    }
}

fn modulus(what: &'static str, value: f64) -> Result<(), ContactError> {
    // Written so that a NaN fails.
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(ContactError::Modulus { what, value }) }
}

/// Friction history of one point between converged steps, in the tool's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slip(Option<Stick>);

#[derive(Clone, Copy, Debug, PartialEq)]
struct Stick {
    /// Elastic slip `e`, m.
    stretch: Vector3,
    /// Position of the point, m.
    at: Vector3,
    /// Gap of the point, m; 0 if it touched.
    gap: f64,
}

impl Slip {
    /// History of a point that has none.
    pub const NONE: Slip = Slip(None);

    /// Makes the history of a point without elastic slip at `at` (tool's frame, m) with `gap` (m, 0 if it
    /// touches).
    pub(super) fn at(at: &Vector3, gap: f64) -> Slip {
        Slip(Some(Stick { stretch: Vector3::zeros(), at: *at, gap }))
    }

    /// The same place with another elastic slip, m; no history stays none.
    pub(super) fn with_stretch(self, stretch: Vector3) -> Slip {
        Slip(self.0.map(|stick| Stick { stretch, ..stick }))
    }

    /// Elastic slip `e` (m) in the tool's frame, `t_t = -k_t e`; zero for a point that is not in contact.
    pub fn stretch(&self) -> Vector3 {
        self.0.map_or_else(Vector3::zeros, |s| s.stretch)
    }
}

/// Response of a point in contact, in the tool's frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Response {
    /// Normal pressure `p`, per undeformed area, Pa.
    pub pressure: f64,
    /// Traction `t` on the tissue, per undeformed area, Pa.
    pub traction: Vector3,
    /// Friction history to commit if the step converges in this state.
    pub slip: Slip,
    /// Frictional work since the last commit, J/m^2: `mu p (|e*| - mu p / k_t)` with the trial slip `e*`
    /// while the point slips, 0 while it sticks.
    pub dissipated: f64,
    /// Trial slip before projection, `v = e_n + c (x - x_n)`, m.
    drift: Vector3,
    /// Factor `c`: the part of the motion that friction sees.
    after: f64,
    /// Derivative of the trial slip by the gap, `(x - x_n) dc/dg`.
    speed: Vector3,
    state: State,
}

#[derive(Clone, Copy, Debug)]
enum State {
    /// No friction, or none yet at first contact.
    Free,
    Stick,
    /// Sliding in direction `s` with trial slip `|e*|`, m.
    Slide {
        direction: Vector3,
        length: f64,
    },
}

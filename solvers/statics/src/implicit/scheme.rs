//! The generalised-alpha scheme.

use shape::Vector3;

/// Parameters of the balance of the step from `n` to `n + 1`, with forces as weighted averages of both ends:
///
/// ```text
/// M a_m + c M v_f = (1 - alpha_f) g(u_n+1) + alpha_f g(u_n),    g = f_ext + f_contact - f_int
/// a_m = (1 - alpha_m) a_n+1 + alpha_m a_n,    v_f = (1 - alpha_f) v_n+1 + alpha_f v_n
/// u_n+1 = u_n + dt v_n + dt^2 ((1/2 - beta) a_n + beta a_n+1)
/// v_n+1 = v_n + dt ((1 - gamma) a_n + gamma a_n+1)
/// ```
///
/// The scheme is of second order for every `rho_inf`, the spectral radius at `omega dt -> infinity`; 1 is the
/// trapezoidal rule. Sources: Chung and Hulbert, J. Appl. Mech. 60 (1993) 371-375; averaged forces: Erlicher,
/// Bonaventura and Bursi, Comput. Mech. 28 (2002) 83-104.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Scheme {
    alpha_m: f64,
    pub alpha_f: f64,
    beta: f64,
    gamma: f64,
}

/// Update of a degree of freedom, `u_n+1 -> a_n+1, v_n+1`, over a step `dt` from a velocity and an
/// acceleration.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Update {
    scheme: Scheme,
    dt: f64,
}

impl Scheme {
    pub fn new(rho_inf: f64) -> Scheme {
        let alpha_m = (2.0 * rho_inf - 1.0) / (rho_inf + 1.0);
        let alpha_f = rho_inf / (rho_inf + 1.0);
        let beta = 0.25 * (1.0 - alpha_m + alpha_f).powi(2);
        Scheme { alpha_m, alpha_f, beta, gamma: 0.5 - alpha_m + alpha_f }
    }

    /// The alpha method: means of the forces and not of the inertia, `alpha_f = -alpha`. Source: Hilber,
    /// Hughes and Taylor, Earthquake Eng. Struct. Dyn. 5 (1977) 283-292.
    pub fn hilber(alpha: f64) -> Scheme {
        Scheme { alpha_m: 0.0, alpha_f: -alpha, beta: 0.25 * (1.0 - alpha).powi(2), gamma: 0.5 - alpha }
    }

    pub fn over(self, dt: f64) -> Update {
        Update { scheme: self, dt }
    }
}

impl Update {
    /// Returns the acceleration `a_n+1` (m/s^2) from the displacement increment `gain` of the step (m), the
    /// velocity `v_n` (m/s) and the acceleration `a_n`.
    pub fn acceleration(&self, gain: &Vector3, v: &Vector3, a: &Vector3) -> Vector3 {
        let beta = self.scheme.beta;
        let dt = self.dt;
        (gain / dt - v) / (beta * dt) - a * (0.5 / beta - 1.0)
    }

    /// Returns the velocity `v_n+1` (m/s) from `v_n` and the accelerations `a_n` and `a_n+1` (`new`), m/s^2.
    pub fn velocity(&self, v: &Vector3, a: &Vector3, new: &Vector3) -> Vector3 {
        v + (a * (1.0 - self.scheme.gamma) + new * self.scheme.gamma) * self.dt
    }

    /// Returns `r = (a_m + c v_f) / (1 - alpha_f)`, m/s^2. `M r` is the left side of the balance if the
    /// balance is divided by `1 - alpha_f`. `damping` is `c` (1/s); `a` (m/s^2) and `v` (m/s) hold the
    /// values at the start and the end of the step.
    pub fn rate(&self, damping: f64, a: [&Vector3; 2], v: [&Vector3; 2]) -> Vector3 {
        let Scheme { alpha_m, alpha_f, .. } = self.scheme;
        let carried = alpha_f / (1.0 - alpha_f);
        (a[1] * (1.0 - alpha_m) + a[0] * alpha_m) / (1.0 - alpha_f) + (v[1] + v[0] * carried) * damping
    }

    /// Returns `dr / du_n+1`, 1/s^2.
    pub fn factor(&self, damping: f64) -> f64 {
        let Scheme { alpha_m, alpha_f, beta, gamma } = self.scheme;
        (1.0 - alpha_m) / ((1.0 - alpha_f) * beta * self.dt * self.dt) + damping * gamma / (beta * self.dt)
    }

    /// Returns `dv_n+1 / du_n+1`, 1/s.
    pub fn velocity_factor(&self) -> f64 {
        self.scheme.gamma / (self.scheme.beta * self.dt)
    }

    /// Returns the norm of the local error of `u_n+1`, m: the third-order term of the Taylor series that the
    /// step lacks, `(beta - 1/6) dt^2 (a_n+1 - a_n)`. Source: Zienkiewicz and Xie, Earthquake Eng. Struct.
    /// Dyn. 20 (1991) 871-887.
    pub fn error(&self, a: &Vector3, new: &Vector3) -> f64 {
        (self.scheme.beta - 1.0 / 6.0) * self.dt * self.dt * (new - a).norm()
    }
}

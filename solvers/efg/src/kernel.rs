//! Kernels (weight functions) of moving least squares: radial, of compact support, one at the centre.

use crate::EfgError;

/// A weight function `w(q)` of the relative distance `q = d / R`, zero for `q >= 1`, one at `q = 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kernel {
    /// `2/3 - 4q^2 + 4q^3` up to 1/2, then `4/3 (1 - q)^3`, here times 3/2. C2. Dolbow and Belytschko (1998).
    CubicSpline,
    /// `1 - 6q^2 + 8q^3 - 3q^4`. C2. Belytschko et al. (1996).
    QuarticSpline,
    /// `(e^{-(q/alpha)^2} - e^{-(1/alpha)^2}) / (1 - e^{-(1/alpha)^2})`. Belytschko, Lu and Gu (1994), `k = 1`.
    Gaussian {
        /// Width relative to the support radius; the default is 0.4.
        alpha: f64,
    },
    /// `(e^{-(q/alpha)^{2k}} - e^{-(1/alpha)^{2k}}) / (1 - e^{-(1/alpha)^{2k}})`: the exponential weight of
    /// Belytschko, Lu and Gu (1994) at a free `k`; flat-topped for `k > 1`.
    Exponential {
        /// Width relative to the support radius; the default is 0.5.
        alpha: f64,
        /// `k`, at least 1; the default is 2.
        power: u32,
    },
    /// `(1 - q)^4 (4q + 1)`. Wendland (1995).
    WendlandC2,
    /// `(1 - q)^6 (35q^2 + 18q + 3) / 3`. Wendland (1995).
    WendlandC4,
    /// `(1 - q)^8 (32q^3 + 25q^2 + 8q + 1)`. Wendland (1995).
    WendlandC6,
    /// `((q^2 + eps)^-2 - (1 + eps)^-2) / (eps^-2 - (1 + eps)^-2)`: almost interpolating shape functions. Most and
    /// Bucher (2005).
    RegularisedInterpolating {
        /// Regularisation; the default is 1e-5.
        eps: f64,
    },
}

impl Kernel {
    /// Every kernel with its default parameters, in the order tables list them.
    pub const ALL: [Kernel; 8] = [
        Kernel::CubicSpline,
        Kernel::QuarticSpline,
        Kernel::Gaussian { alpha: 0.4 },
        Kernel::Exponential { alpha: 0.5, power: 2 },
        Kernel::WendlandC2,
        Kernel::WendlandC4,
        Kernel::WendlandC6,
        Kernel::RegularisedInterpolating { eps: 1e-5 },
    ];

    /// The name used in scene files and tables.
    pub fn name(self) -> &'static str {
        match self {
            Kernel::CubicSpline => "cubic-spline",
            Kernel::QuarticSpline => "quartic-spline",
            Kernel::Gaussian { .. } => "gaussian",
            Kernel::Exponential { .. } => "exponential",
            Kernel::WendlandC2 => "wendland-c2",
            Kernel::WendlandC4 => "wendland-c4",
            Kernel::WendlandC6 => "wendland-c6",
            Kernel::RegularisedInterpolating { .. } => "regularised-interpolating",
        }
    }

    /// The kernel of that name with its default parameters.
    pub fn from_name(name: &str) -> Option<Kernel> {
        Kernel::ALL.into_iter().find(|kernel| kernel.name() == name)
    }

    /// Refuses parameters that make no kernel.
    pub(crate) fn check(self) -> Result<(), EfgError> {
        let (what, value) = match self {
            Kernel::Gaussian { alpha } | Kernel::Exponential { alpha, .. } => ("kernel width alpha", alpha),
            Kernel::RegularisedInterpolating { eps } => ("kernel regularisation eps", eps),
            _ => return Ok(()),
        };
        // Below 0.05 the kernel is zero to rounding before it has reached a neighbour; above 10 it has no shape left.
        let allowed = if matches!(self, Kernel::RegularisedInterpolating { .. }) {
            (1e-8..=1.0, "a value from 1e-8 to 1")
        } else {
            (0.05..=10.0, "a value from 0.05 to 10")
        };
        if !allowed.0.contains(&value) {
            return Err(EfgError::BadParameter { what, value, allowed: allowed.1 });
        }
        match self {
            Kernel::Exponential { power, .. } if !(1..=8).contains(&power) => Err(EfgError::BadParameter {
                what: "kernel power",
                value: power as f64,
                allowed: "a whole number from 1 to 8",
            }),
            _ => Ok(()),
        }
    }

    /// Value and derivative `(w, dw/dq)` at the relative distance `q >= 0`.
    #[inline]
    pub fn eval(self, q: f64) -> (f64, f64) {
        if q >= 1.0 {
            return (0.0, 0.0);
        }
        match self {
            Kernel::CubicSpline => cubic(q),
            Kernel::QuarticSpline => quartic(q),
            Kernel::Gaussian { alpha } => exponential(alpha, 1)(q),
            Kernel::Exponential { alpha, power } => exponential(alpha, power)(q),
            Kernel::WendlandC2 => wendland_c2(q),
            Kernel::WendlandC4 => wendland_c4(q),
            Kernel::WendlandC6 => wendland_c6(q),
            Kernel::RegularisedInterpolating { eps } => regularised(q, eps),
        }
    }

    /// [`Kernel::eval`] over a list, all `q < 1`: one branch on the kind for the list, not one per node.
    #[inline(always)]
    pub(crate) fn eval_all(self, q: &[f64], w: &mut [f64], dw: &mut [f64]) {
        match self {
            Kernel::CubicSpline => each(q, w, dw, cubic),
            Kernel::QuarticSpline => each(q, w, dw, quartic),
            Kernel::Gaussian { alpha } => each(q, w, dw, exponential(alpha, 1)),
            Kernel::Exponential { alpha, power } => each(q, w, dw, exponential(alpha, power)),
            Kernel::WendlandC2 => each(q, w, dw, wendland_c2),
            Kernel::WendlandC4 => each(q, w, dw, wendland_c4),
            Kernel::WendlandC6 => each(q, w, dw, wendland_c6),
            Kernel::RegularisedInterpolating { eps } => each(q, w, dw, |q| regularised(q, eps)),
        }
    }
}

#[inline(always)]
fn each(q: &[f64], w: &mut [f64], dw: &mut [f64], kernel: impl Fn(f64) -> (f64, f64)) {
    for ((&q, w), dw) in q.iter().zip(w).zip(dw) {
        (*w, *dw) = kernel(q);
    }
}

#[inline(always)]
fn cubic(q: f64) -> (f64, f64) {
    // Both branches are computed and one is selected, so that the loop over a list vectorises.
    let s = 1.0 - q;
    let inner = (1.0 - 6.0 * q * q * s, q * (18.0 * q - 12.0));
    let outer = (2.0 * s * s * s, -6.0 * s * s);
    if q <= 0.5 { inner } else { outer }
}

#[inline(always)]
fn quartic(q: f64) -> (f64, f64) {
    let s = 1.0 - q;
    // 1 - 6q^2 + 8q^3 - 3q^4 factored, free of cancellation near the rim.
    (s * s * s * (1.0 + 3.0 * q), -12.0 * q * s * s)
}

/// The part that does not depend on `q` is computed once per list.
#[inline(always)]
fn exponential(alpha: f64, power: u32) -> impl Fn(f64) -> (f64, f64) {
    let k = power as i32;
    let inverse = 1.0 / alpha;
    let rim = (-inverse.powi(2 * k)).exp();
    let height = 1.0 / (1.0 - rim);
    let slope = -2.0 * k as f64 * inverse * height;
    move |q| {
        let t = q * inverse;
        let odd = t.powi(2 * k - 1);
        let e = (-(odd * t)).exp();
        ((e - rim) * height, slope * odd * e)
    }
}

#[inline(always)]
fn wendland_c2(q: f64) -> (f64, f64) {
    let s = 1.0 - q;
    (s * s * s * s * (4.0 * q + 1.0), -20.0 * q * s * s * s)
}

#[inline(always)]
fn wendland_c4(q: f64) -> (f64, f64) {
    let s = 1.0 - q;
    let s5 = s * s * s * s * s;
    (s5 * s * (35.0 * q * q + 18.0 * q + 3.0) / 3.0, -56.0 / 3.0 * q * (5.0 * q + 1.0) * s5)
}

#[inline(always)]
fn wendland_c6(q: f64) -> (f64, f64) {
    let s = 1.0 - q;
    let s2 = s * s;
    let s7 = s2 * s2 * s2 * s;
    (s7 * s * (((32.0 * q + 25.0) * q + 8.0) * q + 1.0), -22.0 * q * ((16.0 * q + 7.0) * q + 1.0) * s7)
}

#[inline(always)]
fn regularised(q: f64, eps: f64) -> (f64, f64) {
    let inverse_square = |t: f64| 1.0 / (t * t);
    let rim = inverse_square(1.0 + eps);
    let height = inverse_square(eps) - rim;
    let t = q * q + eps;
    ((inverse_square(t) - rim) / height, -4.0 * q / (t * t * t) / height)
}

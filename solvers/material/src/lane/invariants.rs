//! Stresses of the form `a H + b (cof H - H^T) + c I` as straight-line scalar code, which a loop over lanes
//! turns into vector instructions. All differences that vanish at `H = 0` are formed without cancellation.

use super::Real;

/// Invariants of `H` that a law needs in addition to `H`.
#[derive(Clone, Copy)]
pub struct Invariants<T = f64> {
    /// `tr H`.
    pub trace: T,
    /// Sum of the second invariant and the determinant, `II(H) + det H`.
    pub rest: T,
    /// `J - 1 = tr H + II(H) + det H`.
    pub j: T,
}

/// First row of the minors: the (1, 1) entry of `cof H`, and the (1, 2) and (1, 3) entries of `cof H - H^T`.
pub type Minors<T = f64> = [T; 3];

/// Coefficients `a`, `b`, `c` of `w P = a H + b (cof H - H^T) + c I`. Every isotropic stress of this file has
/// this form, because `cof F = (1 + tr H) I + cof H - H^T`.
pub type Coefficients<T = f64> = [T; 3];

impl<T: Real> Invariants<T> {
    /// Builds the invariants from `tr H` and `II(H) + det H`.
    #[inline(always)]
    pub fn new(trace: T, rest: T) -> Invariants<T> {
        Invariants { trace, rest, j: trace + rest }
    }

    /// Computes the invariants of `H`, given row by row, and returns the minors used. `II + det` follows from
    /// the minors of the first row, each including its part of `II`: ten products.
    #[inline(always)]
    pub fn of<const FMA: bool>(h: &[T; 9]) -> (Invariants<T>, Minors<T>) {
        let m = T::madd::<FMA>;
        let x = m(h[4], h[8], -(h[5] * h[7]));
        let y = m(h[5], h[6], -(h[3] * (T::ONE + h[8])));
        let z = m(h[3], h[7], -(h[6] * (T::ONE + h[4])));
        let rest = m(T::ONE + h[0], x, m(h[1], y, m(h[2], z, h[0] * (h[4] + h[8]))));
        (Invariants::new(h[0] + h[4] + h[8], rest), [x, y, z])
    }

    /// Returns the [`Coefficients`] of `w/J (s J (F - F^-T) + v cof F)`, with the arguments `stretch = s w`,
    /// `shape = s w/J` and `volume = v w/J`. Uses `J (F - F^-T) = J H - (cof H - H^T) + rest I`.
    #[inline(always)]
    pub fn combined<const FMA: bool>(&self, stretch: T, shape: T, volume: T) -> Coefficients<T> {
        let m = T::madd::<FMA>;
        [stretch, volume - shape, m(shape, self.rest, m(volume, self.trace, volume))]
    }

    /// Returns the [`Coefficients`] of the neo-Hookean stress
    /// `w P = w/J (mu J (F - F^-T) + lambda ln(J) cof F)`, with moduli in Pa and the volume `w` of the point
    /// in m^3.
    #[inline(always)]
    pub fn stress<const FMA: bool>(&self, w: T, mu: T, lambda: T) -> Coefficients<T> {
        // The logarithm contains the same quotient, so a single division suffices.
        let per_j = w * (T::ONE / (T::ONE + self.j));
        self.combined::<FMA>(w * mu, mu * per_j, lambda * T::ln_1p::<FMA>(self.j) * per_j)
    }

    /// Returns `b = J^(-2/3) I1 / 3 - 1` and the [`Coefficients`] of `w mu J^(-2/3) (F - I1/3 F^-T)`, for
    /// `w_mu = w mu` (J) and `H` row by row. `3/2 mu b` is the isochoric energy density of the point, and
    /// the coefficients give its isochoric stress. If the dilation is shared with a group, [`pressed`]
    /// completes the stress.
    #[inline(always)]
    pub fn isochoric<const FMA: bool>(&self, h: &[T; 9], w_mu: T) -> (T, Coefficients<T>) {
        let m = T::madd::<FMA>;
        let row = |k: usize| m(h[k], h[k], m(h[k + 1], h[k + 1], h[k + 2] * h[k + 2]));
        // (I1 - 3) / 3 = (2 tr H + H : H) / 3.
        let i = m(T::of(2.0), self.trace, row(0) + row(3) + row(6)) * T::of(1.0 / 3.0);
        let d = T::inverse_cbrt_less_1::<FMA>(self.j);
        let (y, z) = (T::ONE + d, d * (T::of(2.0) + d));
        let stretch = w_mu * (y * y);
        // J^-1 = y^3, so no division is needed.
        let shape = stretch * (y * y * y);
        (m(z, i, z + i), self.combined::<FMA>(stretch, shape, -shape * i))
    }
}

/// Returns the [`Coefficients`] of the stress of a point with a shared dilation: `s` times the isochoric
/// stress plus `w p cof F`. Both `s = sum share J_a^(2/3)` and `p = sum share p_a` (Pa) are sums over the
/// groups of the point. `trace` is `tr H`, and `wp = w p`.
#[inline(always)]
pub fn pressed<const FMA: bool, T: Real>(
    [a, b, c]: Coefficients<T>,
    trace: T,
    s: T,
    wp: T,
) -> Coefficients<T> {
    let m = T::madd::<FMA>;
    [s * a, m(s, b, wp), m(s, c, m(wp, trace, wp))]
}

/// Returns `w P` row by row, J, from `H`, the minors of [`Invariants::of`] and the coefficients. Reusing the
/// minors saves six of 36 products (0.99 of the time of hex8, 0.98 with mean dilation).
#[inline(always)]
pub fn piola<const FMA: bool, T: Real>(
    h: &[T; 9],
    [x, y, z]: Minors<T>,
    [a, b, c]: Coefficients<T>,
) -> [T; 9] {
    let m = T::madd::<FMA>;
    // Entry `k` with `cof H` from the places of its minor; `t` is the transposed entry.
    let entry =
        |k: usize, t: usize, [p, q, r, s]: [usize; 4]| m(a, h[k], b * (m(h[p], h[q], -(h[r] * h[s])) - h[t]));
    [
        m(a, h[0], m(b, x - h[0], c)),
        m(a, h[1], b * y),
        m(a, h[2], b * z),
        entry(3, 1, [2, 7, 1, 8]),
        entry(4, 4, [0, 8, 2, 6]) + c,
        entry(5, 7, [1, 6, 0, 7]),
        entry(6, 2, [1, 5, 2, 4]),
        entry(7, 5, [2, 3, 0, 5]),
        entry(8, 8, [0, 4, 1, 3]) + c,
    ]
}

/// Adds `c cof F` to the stress `p`, row by row, from `H`, the minors of [`Invariants::of`] and
/// `trace = tr H`.
#[inline(always)]
pub fn add_cofactor<const FMA: bool, T: Real>(
    h: &[T; 9],
    [x, y, z]: Minors<T>,
    trace: T,
    c: T,
    p: &mut [T; 9],
) {
    let m = T::madd::<FMA>;
    let diagonal = m(c, trace, c);
    let entry =
        |k: usize, t: usize, [a, b, d, e]: [usize; 4]| m(c, m(h[a], h[b], -(h[d] * h[e])) - h[t], p[k]);
    *p = [
        m(c, x - h[0], p[0]) + diagonal,
        m(c, y, p[1]),
        m(c, z, p[2]),
        entry(3, 1, [2, 7, 1, 8]),
        entry(4, 4, [0, 8, 2, 6]) + diagonal,
        entry(5, 7, [1, 6, 0, 7]),
        entry(6, 2, [1, 5, 2, 4]),
        entry(7, 5, [2, 3, 0, 5]),
        entry(8, 8, [0, 4, 1, 3]) + diagonal,
    ];
}

//! `C = F^T F` of eight points by its mean eigenvalue and its deviator, for laws in logarithmic strain.
//!
//! Each law traverses the lanes once with a long straight-line body. With many short loops over lanes the
//! compiler disassembles and reassembles the vectors between loops (Ogden's law: 1.4 times the time).

use lanes::{LANES, madd};

use super::series::horner;
use super::{LaneStrain, Lanes};

/// `C = c (I + X)` with `tr X = 0`. Functions of `X` are three numbers each, `x0 I + x1 X + x2 X^2`.
#[repr(align(64))]
pub(crate) struct Stretch {
    /// `X` as xx, yy, zz, xy, xz, yz.
    x: [Lanes; 6],
    /// `adj X` in the same order; `X^2 = adj X + a I`.
    adjugate: [Lanes; 6],
    /// `X^3 = a X + b I`.
    pub a: Lanes,
    pub b: Lanes,
    /// `c^2 / J^2 = 1 / (c det(I + X))`.
    scale: Lanes,
}

/// Returns the indices `0..count` in pairs; if `count` is odd, the last index occurs twice. A law is a chain
/// of about 250 cycles, and two chains overlap.
#[inline(always)]
pub(crate) fn pairs(count: usize) -> impl Iterator<Item = [usize; 2]> {
    (0..count).step_by(2).map(move |k| [k, (k + 1).min(count - 1)])
}

#[inline(always)]
pub(crate) fn pair_of<const FMA: bool>(strains: &[LaneStrain], [a, b]: [usize; 2]) -> [Stretch; 2] {
    [Stretch::new::<FMA>(&strains[a]), Stretch::new::<FMA>(&strains[b])]
}

impl Stretch {
    #[inline(always)]
    pub fn new<const FMA: bool>(strain: &LaneStrain) -> Stretch {
        let zero = [0.0; LANES];
        let mut out = Stretch { x: [zero; 6], adjugate: [zero; 6], a: zero, b: zero, scale: zero };
        deviator::<FMA>(strain, &mut out);
        out
    }

    /// Returns `dev ln C` of a lane, twice the isochoric logarithmic strain, as three numbers
    /// `x0 I + x1 X + x2 X^2`. `g` are the coefficients of `ln(1 + x) = x (g_0 + g_1 x + ...)`.
    #[inline(always)]
    pub fn logarithm<const FMA: bool, const N: usize>(&self, g: &[f64; N], l: usize) -> [f64; 3] {
        deviator_of::<FMA>(self.a[l], horner::<FMA, N>(g, self.a[l], self.b[l]))
    }

    /// Returns `dev (e g(e))` for a traceless tensor `e` that is a function of `X`, and a power series `g`
    /// with the coefficients `g_0, g_1, ...`. `e`, its `square` and the result are given by three numbers
    /// each, the coefficients of `I`, `X` and `X^2`. The last argument has `a` and `b` of
    /// `e^3 = a e + b I`, which differ from those of `X`.
    #[inline(always)]
    pub fn series<const FMA: bool, const N: usize>(
        &self,
        g: &[f64; N],
        e: &[f64; 3],
        square: &[f64; 3],
        [a, b]: [f64; 2],
    ) -> [f64; 3] {
        in_powers_of_x::<FMA>(e, square, deviator_of::<FMA>(a, horner::<FMA, N>(g, a, b)))
    }

    /// Returns `P = F C^-1 tau` of a lane, row by row, Pa. The argument `tau` has the three numbers
    /// `x0 I + x1 X + x2 X^2` of the Kirchhoff stress in the reference frame (`tau` shares the axes of `C`).
    #[inline(always)]
    pub fn stress<const FMA: bool>(&self, h: &[f64; 9], tau: &[f64; 3], l: usize) -> [f64; 9] {
        first_piola::<FMA>(self, h, &over_c::<FMA>(self.a[l], self.b[l], self.scale[l], tau), l)
    }
}

#[inline(always)]
fn deviator<const FMA: bool>(strain: &LaneStrain, out: &mut Stretch) {
    let m = madd::<FMA>;
    for l in 0..LANES {
        let h = strain.lane(l);
        let dot = |i: usize, j: usize, first: f64| {
            m(h[i], h[j], m(h[3 + i], h[3 + j], m(h[6 + i], h[6 + j], first)))
        };
        // C - I = H + H^T + H^T H.
        let (xx, yy, zz) = (dot(0, 0, 2.0 * h[0]), dot(1, 1, 2.0 * h[4]), dot(2, 2, 2.0 * h[8]));
        let (xy, xz, yz) = (dot(0, 1, h[1] + h[3]), dot(0, 2, h[2] + h[6]), dot(1, 2, h[5] + h[7]));
        let mean = (xx + yy + zz) * (1.0 / 3.0);
        let c = 1.0 + mean;
        let J = 1.0 + (strain.invariants[0][l] + strain.invariants[1][l]);
        // A single division gives both reciprocals.
        let per = 1.0 / (c * J);
        let per_c = per * J;
        let c_over_j = per * c * c;
        let (xx, yy, zz) = ((xx - mean) * per_c, (yy - mean) * per_c, (zz - mean) * per_c);
        let (xy, xz, yz) = (xy * per_c, xz * per_c, yz * per_c);
        let (axx, axy, axz) = (m(yy, zz, -(yz * yz)), m(xz, yz, -(xy * zz)), m(xy, yz, -(xz * yy)));
        let (ayy, azz, ayz) = (m(xx, zz, -(xz * xz)), m(xx, yy, -(xy * xy)), m(xy, xz, -(xx * yz)));
        (out.x[0][l], out.x[1][l], out.x[2][l]) = (xx, yy, zz);
        (out.x[3][l], out.x[4][l], out.x[5][l]) = (xy, xz, yz);
        (out.adjugate[0][l], out.adjugate[1][l], out.adjugate[2][l]) = (axx, ayy, azz);
        (out.adjugate[3][l], out.adjugate[4][l], out.adjugate[5][l]) = (axy, axz, ayz);
        // tr adj X = -a.
        out.a[l] = -(axx + ayy + azz);
        out.b[l] = m(xx, axx, m(xy, axy, xz * axz));
        out.scale[l] = c_over_j * c_over_j;
    }
}

/// Returns the deviator of `X g(X)`, given `g(X)`.
#[inline(always)]
fn deviator_of<const FMA: bool>(a: f64, [g0, g1, g2]: [f64; 3]) -> [f64; 3] {
    // tr X^2 = 2 a.
    [a * g1 * (-2.0 / 3.0), madd::<FMA>(a, g2, g0), g1]
}

/// Converts three numbers in `I`, `e`, `e^2` to those in `I`, `X`, `X^2`.
#[inline(always)]
fn in_powers_of_x<const FMA: bool>(e: &[f64; 3], square: &[f64; 3], [g0, g1, g2]: [f64; 3]) -> [f64; 3] {
    let m = madd::<FMA>;
    [m(g1, e[0], m(g2, square[0], g0)), m(g1, e[1], g2 * square[1]), m(g1, e[2], g2 * square[2])]
}

/// Returns `e^2` and the `a`, `b` of `e^3 = a e + b I`.
#[inline(always)]
pub(crate) fn squared<const FMA: bool>(a: f64, b: f64, [e0, e1, e2]: [f64; 3]) -> ([f64; 3], [f64; 2]) {
    let m = madd::<FMA>;
    // X^3 = a X + b I, X^4 = a X^2 + b X.
    let cube = 2.0 * e1 * e2;
    let fourth = e2 * e2;
    let s0 = m(e0, e0, cube * b);
    let s1 = m(2.0 * e0, e1, m(cube, a, fourth * b));
    let s2 = m(2.0 * e0, e2, m(e1, e1, fourth * a));
    // Half of tr e^2 and a third of tr e^3; tr X^2 = 2 a, tr X^3 = 3 b, tr X^4 = 2 a^2.
    let half = m(1.5, s0, a * s2);
    let (second, third) = (2.0 * a, 3.0 * b);
    let of_x = m(s1, second, s2 * third);
    let of_square = m(s0, second, m(s1, third, s2 * (second * a)));
    let trace = 2.0 * half;
    ([s0, s1, s2], [half, m(e0, trace, m(e1, of_x, e2 * of_square)) * (1.0 / 3.0)])
}

/// Returns `C^-1 tau`, from `(I + X)^-1 det(I + X) = X^2 - X + (1 - a) I`.
#[inline(always)]
fn over_c<const FMA: bool>(a: f64, b: f64, scale: f64, &[t0, t1, t2]: &[f64; 3]) -> [f64; 3] {
    let m = madd::<FMA>;
    let k = 1.0 - a;
    // (X - I) tau, then another multiplication by X.
    let (v0, v1, v2) = (m(b, t2, -t0), m(a, t2, t0 - t1), t1 - t2);
    [scale * m(b, v2, k * t0), scale * m(a, v2, m(k, t1, v0)), scale * m(k, t2, v1)]
}

/// Returns `P = F S` with `S = s0 I + s1 X + s2 X^2`.
#[inline(always)]
fn first_piola<const FMA: bool>(
    Stretch { x, adjugate, a, .. }: &Stretch,
    h: &[f64; 9],
    &[s0, s1, s2]: &[f64; 3],
    l: usize,
) -> [f64; 9] {
    let m = madd::<FMA>;
    // X^2 = adj X + a I.
    let s0 = m(s2, a[l], s0);
    let at = |n: usize, first: f64| m(s1, x[n][l], m(s2, adjugate[n][l], first));
    let (xx, yy, zz) = (at(0, s0), at(1, s0), at(2, s0));
    let (xy, xz, yz) = (at(3, 0.0), at(4, 0.0), at(5, 0.0));
    let rows = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    let mut p = [0.0; 9];
    for i in 0..3 {
        for j in 0..3 {
            let (a, b, c) = (h[3 * i], h[3 * i + 1], h[3 * i + 2]);
            p[3 * i + j] = m(a, rows[0][j], m(b, rows[1][j], m(c, rows[2][j], rows[i][j])));
        }
    }
    p
}

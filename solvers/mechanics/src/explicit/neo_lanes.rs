//! The neo-Hookean point for lanes: the formulas of [`crate::NeoHookean`] as straight-line scalar code, which a loop
//! over lanes turns into vector instructions.

use super::lane_math::{inverse_cbrt_less_1, ln_1p, madd};

/// `H` (row by row) with what follows from it; every difference that vanishes at `H = 0` is formed without
/// cancellation.
#[derive(Clone, Copy)]
pub(super) struct Strained {
    h: [f64; 9],
    cof: [f64; 9],
    trace: f64,
    /// Second invariant and determinant of `H`.
    rest: f64,
    /// `J - 1 = tr H + II(H) + det H`.
    pub j: f64,
}

#[inline(always)]
pub(super) fn strained<const FMA: bool>(h: [f64; 9]) -> Strained {
    let m = madd::<FMA>;
    let minor = |a: usize, d: usize, b: usize, c: usize| m(h[a], h[d], -(h[b] * h[c]));
    let cof = [
        minor(4, 8, 5, 7),
        minor(5, 6, 3, 8),
        minor(3, 7, 4, 6),
        minor(2, 7, 1, 8),
        minor(0, 8, 2, 6),
        minor(1, 6, 0, 7),
        minor(1, 5, 2, 4),
        minor(2, 3, 0, 5),
        minor(0, 4, 1, 3),
    ];
    let trace = h[0] + h[4] + h[8];
    let det = m(h[0], cof[0], m(h[1], cof[1], h[2] * cof[2]));
    let rest = cof[0] + cof[4] + cof[8] + det;
    Strained { h, cof, trace, rest, j: trace + rest }
}

impl Strained {
    /// `cof F = J F^-T = (1 + tr H) I - H^T + cof H`, and `J (F - F^-T) = H + H^T - cof H + (II + det) I + (J-1) H`.
    #[inline(always)]
    fn parts<const FMA: bool>(&self) -> ([f64; 9], [f64; 9]) {
        let (mut cof_f, mut less) = ([0.0; 9], [0.0; 9]);
        for r in 0..3 {
            for c in 0..3 {
                let (k, t) = (3 * r + c, 3 * c + r);
                let swapped = self.h[t] - self.cof[k];
                cof_f[k] = -swapped;
                less[k] = madd::<FMA>(self.h[k], 1.0 + self.j, swapped);
            }
            cof_f[4 * r] += 1.0 + self.trace;
            less[4 * r] += self.rest;
        }
        (cof_f, less)
    }

    /// `w P = w/J (mu J (F - F^-T) + lambda ln(J) cof F)`.
    #[inline(always)]
    pub fn stress<const FMA: bool>(&self, w: f64, mu: f64, lambda: f64) -> [f64; 9] {
        let (cof_f, less) = self.parts::<FMA>();
        let per_j = w / (1.0 + self.j);
        let (shape, volume) = (mu * per_j, lambda * ln_1p::<FMA>(self.j) * per_j);
        combined::<FMA>(shape, &less, volume, &cof_f)
    }

    /// `I1 - 3 = 2 tr H + H : H`.
    #[inline(always)]
    fn i1<const FMA: bool>(&self) -> f64 {
        let mut square = 0.0;
        for k in 0..9 {
            square = madd::<FMA>(self.h[k], self.h[k], square);
        }
        madd::<FMA>(2.0, self.trace, square)
    }

    /// `b = J^(-2/3) I1 / 3 - 1`.
    #[inline(always)]
    pub fn isochoric<const FMA: bool>(&self) -> f64 {
        let d = inverse_cbrt_less_1::<FMA>(self.j);
        let (z, i) = (d * (2.0 + d), self.i1::<FMA>() / 3.0);
        madd::<FMA>(z, i, z + i)
    }

    /// `w P` with a shared dilation: `w mu S J^(-2/3) (F - I1/3 F^-T) + w p cof F`, where over the groups of the point
    /// `S = sum share J_a^(2/3)` and `p = sum share p_a`.
    #[inline(always)]
    pub fn dilated_stress<const FMA: bool>(&self, w: f64, mu: f64, s: f64, p: f64) -> [f64; 9] {
        let (cof_f, less) = self.parts::<FMA>();
        let y = 1.0 + inverse_cbrt_less_1::<FMA>(self.j);
        // J^-1 = y^3: no division.
        let shape = w * mu * s * (y * y) * (y * y * y);
        let volume = madd::<FMA>(-shape, self.i1::<FMA>() / 3.0, w * p);
        combined::<FMA>(shape, &less, volume, &cof_f)
    }
}

#[inline(always)]
fn combined<const FMA: bool>(a: f64, x: &[f64; 9], b: f64, y: &[f64; 9]) -> [f64; 9] {
    let mut sum = [0.0; 9];
    for k in 0..9 {
        sum[k] = madd::<FMA>(a, x[k], b * y[k]);
    }
    sum
}

/// `J_a^(2/3)` and `p_a = (1/V_a) dE/dJ_a` of one dilation group from its mean `J_a - 1`, `B_a = sum share w mu b`,
/// `1 / V_a`, `M_a = sum share w mu` and `L_a = sum share w lambda`.
#[inline(always)]
pub(super) fn close_group<const FMA: bool>(
    j: f64,
    b: f64,
    per_volume: f64,
    mu: f64,
    lambda: f64,
) -> [f64; 2] {
    let d = inverse_cbrt_less_1::<FMA>(j);
    // J^(2/3) - 1 = (1 + j) (1 + d) - 1.
    let sigma = madd::<FMA>(j, d, j + d);
    let (y, s) = (1.0 + d, 1.0 + sigma);
    let p = madd::<FMA>(b, s, madd::<FMA>(sigma, mu, lambda * ln_1p::<FMA>(j)));
    [s, p * (y * y * y) * per_volume]
}

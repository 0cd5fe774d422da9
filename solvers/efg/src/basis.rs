//! Polynomial bases in shifted and scaled coordinates `xi = (x_I - x) / s`.

/// Complete polynomial basis of moving least squares.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Basis {
    /// `1, x, y, z`: 4 terms.
    Linear,
    /// `1, x, y, z, xx, yy, zz, xy, yz, zx`: 10 terms.
    Quadratic,
}

impl Basis {
    /// Both bases.
    pub const ALL: [Basis; 2] = [Basis::Linear, Basis::Quadratic];

    /// Name in scene files and tables.
    pub fn name(self) -> &'static str {
        match self {
            Basis::Linear => "linear",
            Basis::Quadratic => "quadratic",
        }
    }

    /// Returns the basis with this name, or `None` for an unknown name.
    pub fn from_name(name: &str) -> Option<Basis> {
        Basis::ALL.into_iter().find(|basis| basis.name() == name)
    }

    /// Number of terms, 4 or 10: the least number of neighbours at every point.
    pub fn terms(self) -> usize {
        match self {
            Basis::Linear => 4,
            Basis::Quadratic => 10,
        }
    }
}

/// Evaluates the `M` terms at a scaled offset; `M` is 4 or 10. The terms after the fourth form the quadratic
/// block.
#[inline(always)]
pub(crate) fn terms<const M: usize>([x, y, z]: [f64; 3]) -> [f64; M] {
    first([1.0, x, y, z, x * x, y * y, z * z, x * y, y * z, z * x])
}

/// Number of monomials of three variables up to degree 4.
pub(crate) const MONOMIALS: usize = 35;

/// Exponents of x, y and z of each monomial; the first ten are the terms of the basis.
#[rustfmt::skip]
const EXPONENTS: [[u8; 3]; MONOMIALS] = [
    [0, 0, 0],
    [1, 0, 0], [0, 1, 0], [0, 0, 1],
    [2, 0, 0], [0, 2, 0], [0, 0, 2], [1, 1, 0], [0, 1, 1], [1, 0, 1],
    [3, 0, 0], [0, 3, 0], [0, 0, 3], [2, 1, 0], [0, 2, 1], [1, 0, 2], [2, 0, 1], [1, 2, 0], [0, 1, 2], [1, 1, 1],
    [4, 0, 0], [0, 4, 0], [0, 0, 4], [3, 1, 0], [0, 3, 1], [1, 0, 3], [3, 0, 1], [1, 3, 0], [0, 1, 3],
    [2, 2, 0], [0, 2, 2], [2, 0, 2], [2, 1, 1], [1, 2, 1], [1, 1, 2],
];

/// Index of the monomial that is the product of two terms. Sums of weighted products have 35 distinct
/// entries, whereas the lower triangle of the quadratic basis has 55.
pub(crate) const PRODUCT: [[usize; 10]; 10] = {
    let mut table = [[MONOMIALS; 10]; 10];
    let (mut i, mut j, mut n) = (0, 0, 0);
    while i < 10 {
        while j < 10 {
            while n < MONOMIALS {
                let (a, b, c) = (EXPONENTS[i], EXPONENTS[j], EXPONENTS[n]);
                if a[0] + b[0] == c[0] && a[1] + b[1] == c[1] && a[2] + b[2] == c[2] {
                    table[i][j] = n;
                }
                n += 1;
            }
            (j, n) = (j + 1, 0);
        }
        (i, j) = (i + 1, 0);
    }
    table
};

/// Evaluates the first `N` monomials (10, 20 or 35: up to degree 2, 3 or 4) at a scaled offset, times a
/// weight.
#[inline(always)]
pub(crate) fn monomials<const N: usize>(w: f64, [x, y, z]: [f64; 3]) -> [f64; N] {
    let (wx, wy, wz) = (w * x, w * y, w * z);
    let (wxx, wyy, wzz) = (wx * x, wy * y, wz * z);
    let (wxy, wyz, wzx) = (wx * y, wy * z, wz * x);
    let (wxxx, wyyy, wzzz) = (wxx * x, wyy * y, wzz * z);
    let (wxxy, wyyz, wzzx) = (wxx * y, wyy * z, wzz * x);
    let (wxxz, wyyx, wzzy) = (wxx * z, wyy * x, wzz * y);
    let wxyz = wxy * z;
    first([
        w,
        wx,
        wy,
        wz,
        wxx,
        wyy,
        wzz,
        wxy,
        wyz,
        wzx,
        wxxx,
        wyyy,
        wzzz,
        wxxy,
        wyyz,
        wzzx,
        wxxz,
        wyyx,
        wzzy,
        wxyz,
        wxxx * x,
        wyyy * y,
        wzzz * z,
        wxxx * y,
        wyyy * z,
        wzzz * x,
        wxxx * z,
        wyyy * x,
        wzzz * y,
        wxxy * y,
        wyyz * z,
        wzzx * x,
        wxxy * z,
        wyyx * z,
        wzzx * y,
    ])
}

/// Copies by a loop: `array::from_fn` is not always inlined and then not compiled for wide registers.
#[inline(always)]
fn first<const A: usize, const N: usize>(all: [f64; A]) -> [f64; N] {
    let mut some = [0.0; N];
    some.copy_from_slice(&all[..N]);
    some
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_of_terms_are_the_monomials_of_the_table() {
        // Powers of two with distinct exponents: every product is exact, and all monomials differ.
        let x = [2.0, 2f64.powi(9), 2f64.powi(-30)];
        let p = terms::<10>(x);
        let all = monomials::<MONOMIALS>(3.0, x);
        for i in 0..10 {
            for j in 0..10 {
                assert_eq!(all[PRODUCT[i][j]], 3.0 * p[i] * p[j], "{i} {j}");
            }
        }
        assert_eq!(monomials::<20>(3.0, x), all[..20]);
        assert!((1..MONOMIALS).all(|n| !all[..n].contains(&all[n])));
    }
}

//! Trilinear hexahedron with corners at `xi, eta, zeta = +-1` and 2 x 2 x 2 Gauss points, in terms of its
//! coefficients. `du/dxi` takes 156 operations per element and three components instead of 576.
//!
//! Sums and differences turn eight corner values into the coefficients of 1, xi, eta, xi eta, ..., xi eta
//! zeta, in 24 operations. A derivative along one axis does not depend on that axis: it has four values at
//! the eight points, computed by eight sums. The code has no loops, because a loop over lanes around an inner
//! loop stays scalar.

use geometry::element::{Element, HEX_CORNERS, Hex8};
use material::lane::{LaneStrain, Real};
use shape::{Matrix3, Vector3, VolumeRows};

use super::cell_lanes::Cell;
use super::scalar::Scalar;

/// Gauss coordinate 1 / sqrt 3.
const GAUSS: f64 = 0.577_350_269_189_625_8;

/// Node at the corner with the given index bits: bit 0 for xi, 1 for eta, 2 for zeta. The table is its own
/// inverse.
const NODE: [usize; 8] = [0, 1, 3, 2, 4, 5, 7, 6];

/// Returns `dN_a/dxi` at the Gauss point with the given signs.
fn reference(signs: &[f64; 3]) -> [Vector3; 8] {
    Hex8::shape_grad(signs.map(|s| s * GAUSS)).map(Vector3::from)
}

/// Returns the `A` of `grad N_a = A dN_a/dxi` by least squares, if the fit has no remainder.
pub(super) fn fit(grads: &[Vector3], table: &[Vector3]) -> Option<Matrix3> {
    let (mut cross, mut square) = (Matrix3::zeros(), Matrix3::zeros());
    for (g, t) in grads.iter().zip(table) {
        cross += g * t.transpose();
        square += t * t.transpose();
    }
    let map = cross * square.try_inverse()?;
    let size = grads.iter().map(Vector3::norm).fold(0.0, f64::max);
    let fits = grads.iter().zip(table).all(|(g, t)| (g - map * t).norm() <= 1e-13 * size);
    fits.then_some(map)
}

/// Converts corner values, by index bits, to eight times the coefficients; those of products are multiplied
/// by their powers of 1 / sqrt 3.
#[inline(always)]
fn coefficients<T: Real>(v: [T; 8]) -> [T; 8] {
    let gauss = T::of(GAUSS);
    let pair = |a: T, b: T| (b + a, b - a);
    let ((a0, a1), (a2, a3)) = (pair(v[0], v[1]), pair(v[2], v[3]));
    let ((a4, a5), (a6, a7)) = (pair(v[4], v[5]), pair(v[6], v[7]));
    let ((b0, b2), (b1, b3)) = (pair(a0, a2), pair(a1, a3));
    let ((b4, b6), (b5, b7)) = (pair(a4, a6), pair(a5, a7));
    let ((c0, c4), (c1, c5)) = (pair(b0, b4), pair(b1, b5));
    let ((c2, c6), (c3, c7)) = (pair(b2, b6), pair(b3, b7));
    [c0, c1, c2, gauss * c3, c4, gauss * c5, gauss * c6, T::of(GAUSS * GAUSS) * c7]
}

/// Returns the index 0 to 3 of the value of the derivative along `beta` at the point with index bits `q`, by
/// the signs (low, high) of the two other axes.
#[inline(always)]
fn value_at(beta: usize, q: usize) -> usize {
    match beta {
        0 => q >> 1,
        1 => (q & 1) + (q >> 2) * 2,
        _ => q & 3,
    }
}

/// Returns eight times the derivatives at the Gauss points, [beta][value], from corner values by index bits.
#[inline(always)]
fn slopes<T: Real>(corners: [T; 8]) -> [[T; 4]; 3] {
    let c = coefficients(corners);
    let values = |flat: T, along_a: T, along_b: T, both: T| {
        let (low, high) = ((flat - along_a, along_b - both), (flat + along_a, along_b + both));
        [low.0 - low.1, high.0 - high.1, low.0 + low.1, high.0 + high.1]
    };
    [values(c[1], c[3], c[5], c[7]), values(c[2], c[3], c[6], c[7]), values(c[4], c[5], c[6], c[7])]
}

/// Applies the transpose of [`slopes`].
#[inline(always)]
fn slopes_back<T: Real>(d: &[[T; 4]; 3]) -> [T; 8] {
    let gauss = T::of(GAUSS);
    let sums = |v: &[T; 4]| {
        let (up, down) = ((v[2] + v[0], v[3] + v[1]), (v[2] - v[0], v[3] - v[1]));
        (up.1 + up.0, up.1 - up.0, down.1 + down.0, down.1 - down.0)
    };
    let (x, y, z) = (sums(&d[0]), sums(&d[1]), sums(&d[2]));
    let (xy, xz, yz) = (gauss * (x.1 + y.1), gauss * (x.2 + z.1), gauss * (y.2 + z.2));
    let xyz = T::of(GAUSS * GAUSS) * (x.3 + y.3 + z.3);
    let pair = |sum: T, difference: T| (sum - difference, sum + difference);
    let (b0, b4) = (-z.0, z.0);
    let (b1, b5) = pair(x.0, xz);
    let (b2, b6) = pair(y.0, yz);
    let (b3, b7) = pair(xy, xyz);
    let ((a0, a2), (a1, a3)) = (pair(b0, b2), pair(b1, b3));
    let ((a4, a6), (a5, a7)) = (pair(b4, b6), pair(b5, b7));
    let ((v0, v1), (v2, v3)) = (pair(a0, a1), pair(a2, a3));
    let ((v4, v5), (v6, v7)) = (pair(a4, a5), pair(a6, a7));
    [v0, v1, v2, v3, v4, v5, v6, v7]
}

/// Trilinear hexahedron. Points and nodes are indexed by corner bits.
pub(super) struct Trilinear;

impl<T: Scalar> Cell<T, 8, 8> for Trilinear {
    /// Derivatives `8 du_i/dxi_beta`, [i][beta][value].
    type Slopes = [[[T::Lanes; 4]; 3]; 3];
    const SLOPES: Self::Slopes = [[[T::ZEROS; 4]; 3]; 3];
    const NODE: [usize; 8] = NODE;

    /// Finds the order of the Gauss points, such as lowest axis fastest or corner order, in the first
    /// element. The maps are divided by eight.
    fn fitted(volume: &VolumeRows) -> Option<(Self, [usize; 8], Vec<Matrix3>)> {
        let tables = NODE.map(|a| reference(&HEX_CORNERS[a]));
        let mut place = [0; 8];
        for q in 0..8 {
            place[q] = (0..8).find(|&c| fit(volume.row(q).1, &tables[c]).is_some())?;
        }
        let map = |q| fit(volume.row(q).1, &tables[place[q % 8]]).map(|map| 0.125 * map);
        let maps = (0..volume.weights().len()).map(map).collect::<Option<_>>()?;
        Some((Trilinear, place, maps))
    }

    #[inline(always)]
    fn slopes(&self, u: &[[T::Lanes; 8]; 3], out: &mut Self::Slopes) {
        for i in 0..3 {
            derivatives::<T>(&u[i], &mut out[i]);
        }
    }

    #[inline(always)]
    fn strain<const FMA: bool>(
        &self,
        _: &[[T::Lanes; 8]; 3],
        d: &Self::Slopes,
        map: &[T::Lanes; 9],
        q: usize,
        out: &mut LaneStrain<T>,
    ) {
        let m = T::madd::<FMA>;
        let v = [value_at(0, q) & 3, value_at(1, q) & 3, value_at(2, q) & 3];
        for l in 0..T::LANES {
            let mut h = [T::ZERO; 9];
            for i in 0..3 {
                let (x, y, z) = (d[i][0][v[0]][l], d[i][1][v[1]][l], d[i][2][v[2]][l]);
                for j in 0..3 {
                    h[3 * i + j] = m(x, map[j][l], m(y, map[3 + j][l], z * map[6 + j][l]));
                }
            }
            out.set::<FMA>(l, &h);
        }
    }

    #[inline(always)]
    fn forces<const FMA: bool>(&self, points: &[LaneStrain<T>; 8], f: &mut [[T::Lanes; 8]; 3]) {
        for i in 0..3 {
            derivatives_back::<T>(points, i, &mut f[i]);
        }
    }
}

/// Computes the derivatives of one component.
#[inline(always)]
fn derivatives<T: Scalar>(v: &[T::Lanes; 8], [x, y, z]: &mut [[T::Lanes; 4]; 3]) {
    for l in 0..T::LANES {
        // Values are relative to the first node.
        let d = slopes([T::ZERO, v[1][l], v[2][l], v[3][l], v[4][l], v[5][l], v[6][l], v[7][l]]);
        (x[0][l], x[1][l], x[2][l], x[3][l]) = (d[0][0], d[0][1], d[0][2], d[0][3]);
        (y[0][l], y[1][l], y[2][l], y[3][l]) = (d[1][0], d[1][1], d[1][2], d[1][3]);
        (z[0][l], z[1][l], z[2][l], z[3][l]) = (d[2][0], d[2][1], d[2][2], d[2][3]);
    }
}

/// Applies the transpose of [`derivatives`], for component `i`.
#[inline(always)]
fn derivatives_back<T: Scalar>(s: &[LaneStrain<T>; 8], i: usize, out: &mut [T::Lanes; 8]) {
    for l in 0..T::LANES {
        // Each value belongs to the two points along the axis on which it does not depend.
        let two = |beta: usize, a: usize, b: usize| s[a].h[3 * i + beta][l] + s[b].h[3 * i + beta][l];
        let v = slopes_back(&[
            [two(0, 0, 1), two(0, 2, 3), two(0, 4, 5), two(0, 6, 7)],
            [two(1, 0, 2), two(1, 1, 3), two(1, 4, 6), two(1, 5, 7)],
            [two(2, 0, 4), two(2, 1, 5), two(2, 2, 6), two(2, 3, 7)],
        ]);
        (out[0][l], out[1][l], out[2][l], out[3][l]) = (v[0], v[1], v[2], v[3]);
        (out[4][l], out[5][l], out[6][l], out[7][l]) = (v[4], v[5], v[6], v[7]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_are_those_of_the_shape_functions() {
        let v: [f64; 8] = std::array::from_fn(|k| (1.3 * k as f64).sin());
        let d = slopes(v);
        for q in 0..8 {
            let table = reference(&Hex8::NODES[NODE[q]]);
            let expected: Vector3 = (0..8).map(|k| table[NODE[k]] * v[k]).sum();
            for beta in 0..3 {
                // Eight values near 1.
                assert!((0.125 * d[beta][value_at(beta, q)] - expected[beta]).abs() < 1e-15, "{q} {beta}");
            }
        }
    }

    #[test]
    fn the_way_back_is_the_transpose() {
        let v: [f64; 8] = std::array::from_fn(|k| (1.3 * k as f64).sin());
        let w: [[f64; 4]; 3] =
            std::array::from_fn(|b| std::array::from_fn(|k| (0.7 * (4 * b + k) as f64).cos()));
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let forward = dot(slopes(v).as_flattened(), w.as_flattened());
        assert!((forward - dot(&v, &slopes_back(&w))).abs() < 1e-14);
    }
}

//! Quadratic cells: a table of reference derivatives for each point.
//!
//! The derivatives of the first cell in the body serve as the reference of all others, so nothing here knows
//! a shape function or a quadrature rule. Their columns are made orthonormal at each point, because a
//! slender first cell would otherwise cost digits.

use lanes::{LANES, madd, madd_f32};
use material::lane::LaneStrain;
use shape::{Matrix3, Vector3, VolumeRows};

use super::cell_lanes::Cell;
use super::scalar::Scalar;
use super::trilinear::fit;

/// Nodes whose terms are summed in registers. All quadratic cells have a multiple of five.
const TOGETHER: usize = 5;

/// Cell with reference derivatives `t_a`, [point][node][beta].
pub(super) struct Quadratic<T, const N: usize, const Q: usize>(Box<[[[T; 3]; N]; Q]>);

impl<T: Sums, const N: usize, const Q: usize> Cell<T, N, Q> for Quadratic<T, N, Q> {
    type Slopes = ();
    const SLOPES: () = ();
    const NODE: [usize; N] = {
        let mut order = [0; N];
        let mut a = 0;
        while a < N {
            order[a] = a;
            a += 1;
        }
        order
    };

    fn fitted(volume: &VolumeRows) -> Option<(Self, [usize; Q], Vec<Matrix3>)> {
        let count = volume.weights().len();
        if count == 0 {
            return None;
        }
        let tables: Vec<Vec<Vector3>> = (0..Q).map(|q| orthonormal(volume.row(q).1)).collect();
        let map = |q: usize| fit(volume.row(q).1, &tables[q % Q]);
        let maps = (0..count).map(map).collect::<Option<_>>()?;
        let mut table = Box::new([[[T::ZERO; 3]; N]; Q]);
        for q in 0..Q {
            for a in 0..N {
                table[q][a] = <[f64; 3]>::from(tables[q][a]).map(T::of);
            }
        }
        Some((Quadratic(table), std::array::from_fn(|q| q), maps))
    }

    #[inline(always)]
    fn slopes(&self, _: &[[T::Lanes; N]; 3], _: &mut ()) {}

    #[inline(always)]
    fn strain<const FMA: bool>(
        &self,
        [x, y, z]: &[[T::Lanes; N]; 3],
        _: &(),
        map: &[T::Lanes; 9],
        q: usize,
        out: &mut LaneStrain<T>,
    ) {
        let mut d = [T::ZEROS; 9];
        let nodes = x.as_chunks().0.iter().zip(y.as_chunks().0).zip(z.as_chunks().0);
        for (t, ((x, y), z)) in self.0[q].as_chunks().0.iter().zip(nodes) {
            T::add_slopes::<FMA>(t, [x, y, z], &mut d);
        }
        mapped::<FMA, T>(&d, map, out);
    }

    #[inline(always)]
    fn forces<const FMA: bool>(&self, points: &[LaneStrain<T>; Q], f: &mut [[T::Lanes; N]; 3]) {
        *f = [[T::ZEROS; N]; 3];
        let [x, y, z] = f;
        for (table, point) in self.0.iter().zip(points) {
            let nodes = x.as_chunks_mut().0.iter_mut().zip(y.as_chunks_mut().0).zip(z.as_chunks_mut().0);
            for (t, ((x, y), z)) in table.as_chunks().0.iter().zip(nodes) {
                T::add_forces::<FMA>(t, &point.h, x, y, z);
            }
        }
    }
}

/// Returns an orthonormal basis of the columns of the gradients; zero columns if they have none.
fn orthonormal(grads: &[Vector3]) -> Vec<Vector3> {
    let mut basis = grads.to_vec();
    for j in 0..3 {
        // The second pass removes what rounding leaves in the first.
        for k in (0..j).chain(0..j) {
            let c: f64 = basis.iter().map(|t| t[k] * t[j]).sum();
            basis.iter_mut().for_each(|t| t[j] -= c * t[k]);
        }
        let length = basis.iter().map(|t| t[j] * t[j]).sum::<f64>().sqrt().max(f64::MIN_POSITIVE);
        basis.iter_mut().for_each(|t| t[j] /= length);
    }
    basis
}

/// Computes `H_ij = sum_beta d_i beta A_j beta`.
#[inline(always)]
fn mapped<const FMA: bool, T: Scalar>(d: &[T::Lanes; 9], map: &[T::Lanes; 9], out: &mut LaneStrain<T>) {
    let m = T::madd::<FMA>;
    for l in 0..T::LANES {
        let mut h = [T::ZERO; 9];
        for i in 0..3 {
            let (x, y, z) = (d[3 * i][l], d[3 * i + 1][l], d[3 * i + 2][l]);
            for j in 0..3 {
                h[3 * i + j] = m(x, map[j][l], m(y, map[3 + j][l], z * map[6 + j][l]));
            }
        }
        out.set::<FMA>(l, &h);
    }
}

/// Scalar with the sums over nodes. They are written over arrays of known length, because the loop over lanes
/// stays scalar behind the indexing of [`material::lane::Real::Lanes`] (up to five times the time).
pub(super) trait Sums: Scalar {
    /// Adds the terms of a few nodes to the derivatives `d`, [3 i + beta].
    fn add_slopes<const FMA: bool>(
        t: &[[Self; 3]; TOGETHER],
        u: [&[Self::Lanes; TOGETHER]; 3],
        d: &mut [Self::Lanes; 9],
    );

    /// Adds the forces `sum_beta t_a beta S_i beta` of one point to a few nodes.
    fn add_forces<const FMA: bool>(
        t: &[[Self; 3]; TOGETHER],
        s: &[Self::Lanes; 9],
        x: &mut [Self::Lanes; TOGETHER],
        y: &mut [Self::Lanes; TOGETHER],
        z: &mut [Self::Lanes; TOGETHER],
    );
}

macro_rules! sums {
    ($type:ident, $lanes:expr, $madd:ident) => {
        impl Sums for $type {
            #[inline(always)]
            fn add_slopes<const FMA: bool>(
                t: &[[$type; 3]; TOGETHER],
                u: [&[[$type; $lanes]; TOGETHER]; 3],
                d: &mut [[$type; $lanes]; 9],
            ) {
                for l in 0..$lanes {
                    for i in 0..3 {
                        for beta in 0..3 {
                            let mut sum = d[3 * i + beta][l];
                            for a in 0..TOGETHER {
                                sum = $madd::<FMA>(t[a][beta], u[i][a][l], sum);
                            }
                            d[3 * i + beta][l] = sum;
                        }
                    }
                }
            }

            #[inline(always)]
            fn add_forces<const FMA: bool>(
                t: &[[$type; 3]; TOGETHER],
                s: &[[$type; $lanes]; 9],
                x: &mut [[$type; $lanes]; TOGETHER],
                y: &mut [[$type; $lanes]; TOGETHER],
                z: &mut [[$type; $lanes]; TOGETHER],
            ) {
                let m = $madd::<FMA>;
                for l in 0..$lanes {
                    let of = |t: &[$type; 3], i: usize, f: $type| {
                        m(t[0], s[3 * i][l], m(t[1], s[3 * i + 1][l], m(t[2], s[3 * i + 2][l], f)))
                    };
                    for a in 0..TOGETHER {
                        x[a][l] = of(&t[a], 0, x[a][l]);
                        y[a][l] = of(&t[a], 1, y[a][l]);
                        z[a][l] = of(&t[a], 2, z[a][l]);
                    }
                }
            }
        }
    };
}

sums!(f64, LANES, madd);
sums!(f32, 2 * LANES, madd_f32);

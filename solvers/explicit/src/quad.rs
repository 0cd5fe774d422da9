//! Operations on four numbers of one node in one register.
//!
//! The compiler vectorises loops over lanes, but leaves sums of four numbers scalar and builds lanes one
//! number at a time, which stalls the loads behind them. Explicit intrinsics are twice as fast. `WIDE` is
//! true only inside kernels compiled for AVX2 and FMA; `BITS` is the width of a kernel's registers. Without
//! them the same sums run as plain loops.

use super::scalar::{Align32, Scalar, Slot};
use lanes::{LANES, madd};
use material::lane::LaneStrain;
use material::{Law, Material};

#[cfg(target_arch = "x86_64")]
use std::arch::x86_64::*;

/// Computes `y += a x`.
#[inline(always)]
pub(super) fn axpy<const WIDE: bool>(a: f64, x: &Slot<f64>, y: &mut Slot<f64>) {
    #[cfg(target_arch = "x86_64")]
    if WIDE {
        // SAFETY: WIDE implies AVX2 and FMA. Slots are aligned; other loads and stores need no alignment and
        // stay inside their arrays.
        unsafe {
            let sum = _mm256_fmadd_pd(
                _mm256_set1_pd(a),
                _mm256_load_pd(x.0.as_ptr()),
                _mm256_load_pd(y.0.as_ptr()),
            );
            _mm256_store_pd(y.0.as_mut_ptr(), sum);
        }
        return;
    }
    for i in 0..4 {
        y.0[i] = madd::<WIDE>(a, x.0[i], y.0[i]);
    }
}

/// Returns the components x, y, z of `u[nodes[l]] - origin[l]` for eight lanes. Plain loops are used, because
/// the closures of `array::from_fn` were not inlined and made the whole kernel three times slower.
///
/// # Safety
///
/// Registers of `BITS` must be available, and all nodes must lie within `u`.
#[inline(always)]
unsafe fn lanes_of<const BITS: usize>(
    u: &[Slot<f64>],
    nodes: &[u16; LANES],
    origin: &[[f64; LANES]; 3],
) -> [[f64; LANES]; 3] {
    let mut out = [[0.0; LANES]; 3];
    // SAFETY: guaranteed by the caller. Slots are aligned; other stores need no alignment and stay inside
    // their arrays.
    unsafe {
        match BITS {
            #[cfg(target_arch = "x86_64")]
            512 => {
                // Lanes 0 and 2 in one register, 1 and 3, 4 and 6, 5 and 7: pairwise unpacking then gives
                // them in order.
                let two = |low: u16, high: u16| {
                    _mm512_insertf64x4::<1>(_mm512_castpd256_pd512(quad(u, low)), quad(u, high))
                };
                let (a, b) = (two(nodes[0], nodes[2]), two(nodes[1], nodes[3]));
                let (c, d) = (two(nodes[4], nodes[6]), two(nodes[5], nodes[7]));
                let (xz, more_xz) = (_mm512_unpacklo_pd(a, b), _mm512_unpacklo_pd(c, d));
                let (y, more_y) = (_mm512_unpackhi_pd(a, b), _mm512_unpackhi_pd(c, d));
                let t = [
                    _mm512_shuffle_f64x2::<0x88>(xz, more_xz),
                    _mm512_shuffle_f64x2::<0x88>(y, more_y),
                    _mm512_shuffle_f64x2::<0xdd>(xz, more_xz),
                ];
                for i in 0..3 {
                    let from = _mm512_loadu_pd(origin[i].as_ptr());
                    _mm512_storeu_pd(out[i].as_mut_ptr(), _mm512_sub_pd(t[i], from));
                }
            }
            #[cfg(target_arch = "x86_64")]
            256 => {
                for half in 0..2 {
                    let mut quads = [_mm256_setzero_pd(); 4];
                    for k in 0..4 {
                        quads[k] = quad(u, nodes[4 * half + k]);
                    }
                    let t = transposed(quads);
                    for i in 0..3 {
                        let from = _mm256_loadu_pd(origin[i].as_ptr().add(4 * half));
                        _mm256_storeu_pd(out[i].as_mut_ptr().add(4 * half), _mm256_sub_pd(t[i], from));
                    }
                }
            }
            _ => out = plain_lanes_of(u, nodes, origin),
        }
    }
    out
}

/// Adds (x, y, z) of every lane to its node, one lane after the other; the reverse of [`lanes_of`].
///
/// # Safety
///
/// As for [`lanes_of`].
#[inline(always)]
unsafe fn add_lanes<const BITS: usize>(
    x: &[f64; LANES],
    y: &[f64; LANES],
    z: &[f64; LANES],
    nodes: &[u16; LANES],
    f: &mut [Slot<f64>],
) {
    // SAFETY: as in `lanes_of`.
    unsafe {
        #[cfg(target_arch = "x86_64")]
        if BITS > 64 {
            for half in 0..2 {
                let row = |v: &[f64; LANES]| _mm256_loadu_pd(v.as_ptr().add(4 * half));
                let t = transposed([row(x), row(y), row(z), _mm256_setzero_pd()]);
                for k in 0..4 {
                    let at = f.as_mut_ptr().add(nodes[4 * half + k] as usize).cast();
                    _mm256_store_pd(at, _mm256_add_pd(t[k], _mm256_load_pd(at)));
                }
            }
            return;
        }
        plain_add_lanes([x, y, z], nodes, f);
    }
}

/// Loads the four numbers of a node.
///
/// # Safety
///
/// AVX must be available, and the node must lie within `u`.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
unsafe fn quad(u: &[Slot<f64>], node: u16) -> __m256d {
    // SAFETY: guaranteed by the caller.
    unsafe { _mm256_load_pd(u.as_ptr().add(node as usize).cast()) }
}

/// Returns for eight lanes both numbers of `pairs`, summed over four nodes. Tet4 with nodal dilation takes
/// 0.95 of the time with one number after the other.
#[inline(always)]
fn lanes_of_sums<const WIDE: bool>(pairs: &[[f64; 2]], nodes: &[[u16; LANES]; 4]) -> [[f64; LANES]; 2] {
    #[cfg(target_arch = "x86_64")]
    if WIDE {
        let mut out = [[0.0; LANES]; 2];
        // SAFETY: as in `axpy`.
        unsafe {
            for half in 0..2 {
                let mut s = [_mm_setzero_pd(); 4];
                for k in 0..4 {
                    for a in 0..4 {
                        let at = &pairs[nodes[a][4 * half + k] as usize];
                        s[k] = _mm_add_pd(s[k], _mm_loadu_pd(at.as_ptr()));
                    }
                }
                let (even, odd) = (_mm256_set_m128d(s[2], s[0]), _mm256_set_m128d(s[3], s[1]));
                _mm256_storeu_pd(out[0].as_mut_ptr().add(4 * half), _mm256_unpacklo_pd(even, odd));
                _mm256_storeu_pd(out[1].as_mut_ptr().add(4 * half), _mm256_unpackhi_pd(even, odd));
            }
        }
        return out;
    }
    plain_lanes_of_sums::<f64>(pairs, nodes)
}

/// Transposes a 4 x 4 matrix.
///
/// # Safety
///
/// AVX must be available.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
unsafe fn transposed(r: [__m256d; 4]) -> [__m256d; 4] {
    // SAFETY: guaranteed by the caller.
    unsafe {
        let (a, b) = (_mm256_unpacklo_pd(r[0], r[1]), _mm256_unpackhi_pd(r[0], r[1]));
        let (c, d) = (_mm256_unpacklo_pd(r[2], r[3]), _mm256_unpackhi_pd(r[2], r[3]));
        [
            _mm256_permute2f128_pd(a, c, 0x20),
            _mm256_permute2f128_pd(b, d, 0x20),
            _mm256_permute2f128_pd(a, c, 0x31),
            _mm256_permute2f128_pd(b, d, 0x31),
        ]
    }
}

/// Portable code of [`lanes_of`], for any scalar.
///
/// # Safety
///
/// All nodes must lie within `u`.
#[inline(always)]
pub(super) unsafe fn plain_lanes_of<T: Scalar>(
    u: &[Slot<T>],
    nodes: &T::Nodes,
    origin: &[T::Lanes; 3],
) -> [T::Lanes; 3] {
    let mut out = [T::ZEROS; 3];
    for l in 0..T::LANES {
        // SAFETY: guaranteed by the caller.
        let at = unsafe { u.get_unchecked(nodes[l] as usize) };
        for i in 0..3 {
            out[i][l] = at.0[i] - origin[i][l];
        }
    }
    out
}

/// Portable code of [`add_lanes`], for any scalar.
///
/// # Safety
///
/// As for [`plain_lanes_of`].
#[inline(always)]
pub(super) unsafe fn plain_add_lanes<T: Scalar>(
    [x, y, z]: [&T::Lanes; 3],
    nodes: &T::Nodes,
    f: &mut [Slot<T>],
) {
    for l in 0..T::LANES {
        // SAFETY: guaranteed by the caller.
        let at = unsafe { f.get_unchecked_mut(nodes[l] as usize) };
        for (i, v) in [x[l], y[l], z[l]].into_iter().enumerate() {
            at.0[i] += v;
        }
    }
}

/// Portable code of [`lanes_of_sums`], for any scalar.
#[inline(always)]
pub(super) fn plain_lanes_of_sums<T: Scalar>(pairs: &[[T; 2]], nodes: &[T::Nodes; 4]) -> [T::Lanes; 2] {
    let mut out = [T::ZEROS; 2];
    for l in 0..T::LANES {
        for a in 0..4 {
            let at = &pairs[nodes[a][l] as usize];
            out[0][l] += at[0];
            out[1][l] += at[1];
        }
    }
    out
}

impl Scalar for f64 {
    type Nodes = [u16; LANES];
    type Align = Align32;

    #[inline(always)]
    fn displacement(u: f64, _: f64, _: f64) -> f64 {
        u
    }

    #[inline(always)]
    unsafe fn lanes_of<const BITS: usize>(
        u: &[Slot<f64>],
        nodes: &[u16; LANES],
        origin: &[[f64; LANES]; 3],
    ) -> [[f64; LANES]; 3] {
        // SAFETY: guaranteed by the caller.
        unsafe { lanes_of::<BITS>(u, nodes, origin) }
    }

    #[inline(always)]
    unsafe fn add_lanes<const BITS: usize>(
        [x, y, z]: [&[f64; LANES]; 3],
        nodes: &[u16; LANES],
        f: &mut [Slot<f64>],
    ) {
        // SAFETY: guaranteed by the caller.
        unsafe { add_lanes::<BITS>(x, y, z, nodes, f) }
    }

    #[inline(always)]
    fn lanes_of_sums<const WIDE: bool>(pairs: &[[f64; 2]], nodes: &[[u16; LANES]; 4]) -> [[f64; LANES]; 2] {
        lanes_of_sums::<WIDE>(pairs, nodes)
    }

    #[inline(always)]
    fn stress<const FMA: bool>(law: &Law, strains: &[LaneStrain], p: &mut [[[f64; LANES]; 9]]) {
        law.stress_batch::<FMA>(strains, p);
    }
}

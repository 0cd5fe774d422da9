//! Four numbers of one node in one register.
//!
//! The compiler turns loops over eight lanes into vector instructions by itself, but leaves sums of `[f64; 4]` scalar
//! and builds lanes one number at a time, which stalls the loads behind them: written out here, at twice the speed.
//! `WIDE` is true only inside kernels compiled for AVX2 and FMA; elsewhere the same sums run as plain loops.

use super::chunks::Slot;
use lanes::{LANES, madd};

#[cfg(target_arch = "x86_64")]
use std::arch::x86_64::*;

/// `y += a x`.
#[inline(always)]
pub(super) fn axpy<const WIDE: bool>(a: f64, x: &Slot, y: &mut Slot) {
    #[cfg(target_arch = "x86_64")]
    if WIDE {
        // SAFETY: WIDE stands for AVX2 and FMA; slots are aligned, and other loads and stores ask for no alignment and stay
        // inside their arrays.
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

/// Components x, y, z of `u[nodes[l]] - origin[l]` for eight lanes. Loops and no `array::from_fn`: its closures were
/// left as calls, which made the whole kernel three times as slow.
#[inline(always)]
pub(super) fn lanes_of_differences<const WIDE: bool>(
    u: &[Slot],
    nodes: &[u16; LANES],
    origin: &[Slot; LANES],
) -> [[f64; LANES]; 3] {
    let mut out = [[0.0; LANES]; 3];
    #[cfg(target_arch = "x86_64")]
    if WIDE {
        // SAFETY: as in `axpy`.
        unsafe {
            for half in 0..2 {
                let mut d = [_mm256_setzero_pd(); 4];
                for k in 0..4 {
                    let l = 4 * half + k;
                    let at = &u[nodes[l] as usize];
                    d[k] = _mm256_sub_pd(_mm256_load_pd(at.0.as_ptr()), _mm256_load_pd(origin[l].0.as_ptr()));
                }
                let t = transposed(d);
                for i in 0..3 {
                    _mm256_storeu_pd(out[i].as_mut_ptr().add(4 * half), t[i]);
                }
            }
        }
        return out;
    }
    for l in 0..LANES {
        let at = &u[nodes[l] as usize];
        for i in 0..3 {
            out[i][l] = at.0[i] - origin[l].0[i];
        }
    }
    out
}

/// The other way: for every lane the quad (x, y, z, 0).
#[inline(always)]
pub(super) fn quads_of_lanes<const WIDE: bool>(
    x: &[f64; LANES],
    y: &[f64; LANES],
    z: &[f64; LANES],
) -> [Slot; LANES] {
    let mut out = [Slot::ZERO; LANES];
    #[cfg(target_arch = "x86_64")]
    if WIDE {
        // SAFETY: as in `axpy`.
        unsafe {
            for half in 0..2 {
                let row = |v: &[f64; LANES]| _mm256_loadu_pd(v.as_ptr().add(4 * half));
                let t = transposed([row(x), row(y), row(z), _mm256_setzero_pd()]);
                for l in 0..4 {
                    _mm256_store_pd(out[4 * half + l].0.as_mut_ptr(), t[l]);
                }
            }
        }
        return out;
    }
    for l in 0..LANES {
        out[l] = Slot([x[l], y[l], z[l], 0.0]);
    }
    out
}

/// For eight lanes, both numbers of `pairs` summed over four nodes. Tet4 with nodal dilation takes 0.95 of the time that it
/// took with one number after the other.
#[inline(always)]
pub(super) fn lanes_of_sums<const WIDE: bool>(
    pairs: &[[f64; 2]],
    nodes: &[[u16; LANES]; 4],
) -> [[f64; LANES]; 2] {
    let mut out = [[0.0; LANES]; 2];
    #[cfg(target_arch = "x86_64")]
    if WIDE {
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
    for l in 0..LANES {
        for a in 0..4 {
            let at = &pairs[nodes[a][l] as usize];
            out[0][l] += at[0];
            out[1][l] += at[1];
        }
    }
    out
}

/// `y += x`.
#[inline(always)]
pub(super) fn add<const WIDE: bool>(x: &Slot, y: &mut Slot) {
    #[cfg(target_arch = "x86_64")]
    if WIDE {
        // SAFETY: as in `axpy`.
        unsafe {
            let sum = _mm256_add_pd(_mm256_load_pd(x.0.as_ptr()), _mm256_load_pd(y.0.as_ptr()));
            _mm256_store_pd(y.0.as_mut_ptr(), sum);
        }
        return;
    }
    for i in 0..4 {
        y.0[i] += x.0[i];
    }
}

/// 4 x 4 transpose.
///
/// # Safety
/// AVX must be there.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
unsafe fn transposed(r: [__m256d; 4]) -> [__m256d; 4] {
    // SAFETY: the caller's promise.
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

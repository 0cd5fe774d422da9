//! Sixteen lanes in single precision: access to nodes, and laws.

use lanes::LANES;
use material::lane::LaneStrain;
use material::{Law, Material};

use super::quad::{plain_add_lanes, plain_lanes_of, plain_lanes_of_sums};
use super::scalar::{Align16, Scalar, Slot};

#[cfg(target_arch = "x86_64")]
use std::arch::x86_64::*;

/// Number of lanes.
const MANY: usize = 2 * LANES;

type Many = [f32; MANY];

/// Returns the components x, y, z of `u[nodes[l]] - origin[l]` for sixteen lanes.
///
/// Four nodes at a distance of four lanes share a register. A transposition within each quarter of the
/// registers then gives the components in the order of the lanes.
///
/// # Safety
///
/// Registers of `BITS` must be available, and all nodes must lie within `u`.
#[inline(always)]
unsafe fn lanes_of<const BITS: usize>(u: &[Slot<f32>], nodes: &[u16; MANY], origin: &[Many; 3]) -> [Many; 3] {
    // SAFETY: guaranteed by the caller. Slots are aligned; other loads and stores need no alignment and stay
    // inside their arrays.
    unsafe {
        match BITS {
            #[cfg(target_arch = "x86_64")]
            512 => {
                let mut out = [[0.0; MANY]; 3];
                let mut quads = [_mm512_setzero_ps(); 4];
                for k in 0..4 {
                    // Masked loads need no shuffle.
                    let first = _mm512_castps128_ps512(quad(u, nodes[k]));
                    let second = _mm512_mask_broadcast_f32x4(first, 0x00f0, quad(u, nodes[k + 4]));
                    let third = _mm512_mask_broadcast_f32x4(second, 0x0f00, quad(u, nodes[k + 8]));
                    quads[k] = _mm512_mask_broadcast_f32x4(third, 0xf000, quad(u, nodes[k + 12]));
                }
                let t = transposed_wide(quads);
                for i in 0..3 {
                    let from = _mm512_loadu_ps(origin[i].as_ptr());
                    _mm512_storeu_ps(out[i].as_mut_ptr(), _mm512_sub_ps(t[i], from));
                }
                out
            }
            #[cfg(target_arch = "x86_64")]
            256 => {
                let mut out = [[0.0; MANY]; 3];
                for half in 0..2 {
                    let mut quads = [_mm256_setzero_ps(); 4];
                    for k in 0..4 {
                        let at = 8 * half + k;
                        quads[k] = _mm256_set_m128(quad(u, nodes[at + 4]), quad(u, nodes[at]));
                    }
                    let t = transposed(quads);
                    for i in 0..3 {
                        let from = _mm256_loadu_ps(origin[i].as_ptr().add(8 * half));
                        _mm256_storeu_ps(out[i].as_mut_ptr().add(8 * half), _mm256_sub_ps(t[i], from));
                    }
                }
                out
            }
            _ => plain_lanes_of(u, nodes, origin),
        }
    }
}

/// Adds (x, y, z) of every lane to its node, one lane after the other; the reverse of [`lanes_of`].
///
/// # Safety
///
/// As for [`lanes_of`].
#[inline(always)]
unsafe fn add_lanes<const BITS: usize>([x, y, z]: [&Many; 3], nodes: &[u16; MANY], f: &mut [Slot<f32>]) {
    // SAFETY: as in `lanes_of`.
    unsafe {
        #[cfg(target_arch = "x86_64")]
        if BITS == 512 {
            let row = |v: &Many| _mm512_loadu_ps(v.as_ptr());
            let t = transposed_wide([row(x), row(y), row(z), _mm512_setzero_ps()]);
            for k in 0..4 {
                add(_mm512_castps512_ps128(t[k]), f, nodes[k]);
            }
            for k in 0..4 {
                add(_mm512_extractf32x4_ps::<1>(t[k]), f, nodes[k + 4]);
            }
            for k in 0..4 {
                add(_mm512_extractf32x4_ps::<2>(t[k]), f, nodes[k + 8]);
            }
            for k in 0..4 {
                add(_mm512_extractf32x4_ps::<3>(t[k]), f, nodes[k + 12]);
            }
            return;
        }
        #[cfg(target_arch = "x86_64")]
        if BITS > 64 {
            for half in 0..2 {
                let row = |v: &Many| _mm256_loadu_ps(v.as_ptr().add(8 * half));
                let t = transposed([row(x), row(y), row(z), _mm256_setzero_ps()]);
                for k in 0..4 {
                    add(_mm256_castps256_ps128(t[k]), f, nodes[8 * half + k]);
                }
                for k in 0..4 {
                    add(_mm256_extractf128_ps::<1>(t[k]), f, nodes[8 * half + k + 4]);
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
/// The node must lie within `u`.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
unsafe fn quad(u: &[Slot<f32>], node: u16) -> __m128 {
    // SAFETY: guaranteed by the caller.
    unsafe { _mm_load_ps(u.as_ptr().add(node as usize).cast()) }
}

/// Adds the four numbers of a node.
///
/// # Safety
///
/// The node must lie within `f`.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
unsafe fn add(four: __m128, f: &mut [Slot<f32>], node: u16) {
    // SAFETY: guaranteed by the caller.
    unsafe {
        let at = f.as_mut_ptr().add(node as usize).cast();
        _mm_store_ps(at, _mm_add_ps(four, _mm_load_ps(at)));
    }
}

/// Transposes the four 4 x 4 matrices in the quarters of four registers.
///
/// # Safety
///
/// AVX-512 must be available.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
unsafe fn transposed_wide(r: [__m512; 4]) -> [__m512; 4] {
    // SAFETY: guaranteed by the caller.
    unsafe {
        let (a, b) = (_mm512_unpacklo_ps(r[0], r[1]), _mm512_unpackhi_ps(r[0], r[1]));
        let (c, d) = (_mm512_unpacklo_ps(r[2], r[3]), _mm512_unpackhi_ps(r[2], r[3]));
        [
            _mm512_shuffle_ps::<0x44>(a, c),
            _mm512_shuffle_ps::<0xee>(a, c),
            _mm512_shuffle_ps::<0x44>(b, d),
            _mm512_shuffle_ps::<0xee>(b, d),
        ]
    }
}

/// Transposes the two 4 x 4 matrices in the halves of four registers.
///
/// # Safety
///
/// AVX must be available.
#[cfg(target_arch = "x86_64")]
#[inline(always)]
unsafe fn transposed(r: [__m256; 4]) -> [__m256; 4] {
    // SAFETY: guaranteed by the caller.
    unsafe {
        let (a, b) = (_mm256_unpacklo_ps(r[0], r[1]), _mm256_unpackhi_ps(r[0], r[1]));
        let (c, d) = (_mm256_unpacklo_ps(r[2], r[3]), _mm256_unpackhi_ps(r[2], r[3]));
        [
            _mm256_shuffle_ps::<0x44>(a, c),
            _mm256_shuffle_ps::<0xee>(a, c),
            _mm256_shuffle_ps::<0x44>(b, d),
            _mm256_shuffle_ps::<0xee>(b, d),
        ]
    }
}

/// Computes the stress of a law in double precision, in two halves, from strains in single precision.
#[inline(always)]
fn stress<const FMA: bool>(law: &Law, strains: &[LaneStrain<f32>], p: &mut [[Many; 9]]) {
    let mut halves = [LaneStrain::<f64>::ZERO; 2];
    let mut stress = [[[0.0; LANES]; 9]; 2];
    for (strain, p) in strains.iter().zip(p) {
        for (half, double) in halves.iter_mut().enumerate() {
            widened::<FMA>(strain, half * LANES, double);
        }
        law.stress_batch::<FMA>(&halves, &mut stress);
        for (half, stress) in stress.iter().enumerate() {
            for k in 0..9 {
                for l in 0..LANES {
                    p[k][half * LANES + l] = stress[k][l] as f32;
                }
            }
        }
    }
}

#[inline(always)]
fn widened<const FMA: bool>(strain: &LaneStrain<f32>, first: usize, out: &mut LaneStrain<f64>) {
    for l in 0..LANES {
        out.set::<FMA>(l, &strain.lane(first + l).map(f64::from));
    }
}

impl Scalar for f32 {
    type Nodes = [u16; 2 * LANES];
    type Align = Align16;

    #[inline(always)]
    fn displacement(u: f64, first: f64, small: f64) -> f32 {
        ((u - first) as f32 + small as f32) - small as f32
    }

    #[inline(always)]
    unsafe fn lanes_of<const BITS: usize>(
        u: &[Slot<f32>],
        nodes: &[u16; 2 * LANES],
        origin: &[[f32; 2 * LANES]; 3],
    ) -> [[f32; 2 * LANES]; 3] {
        // SAFETY: guaranteed by the caller.
        unsafe { lanes_of::<BITS>(u, nodes, origin) }
    }

    #[inline(always)]
    unsafe fn add_lanes<const BITS: usize>(
        xyz: [&[f32; 2 * LANES]; 3],
        nodes: &[u16; 2 * LANES],
        f: &mut [Slot<f32>],
    ) {
        // SAFETY: guaranteed by the caller.
        unsafe { add_lanes::<BITS>(xyz, nodes, f) }
    }

    #[inline(always)]
    fn lanes_of_sums<const WIDE: bool>(
        pairs: &[[f32; 2]],
        nodes: &[[u16; 2 * LANES]; 4],
    ) -> [[f32; 2 * LANES]; 2] {
        plain_lanes_of_sums::<f32>(pairs, nodes)
    }

    #[inline(always)]
    fn stress<const FMA: bool>(law: &Law, strains: &[LaneStrain<f32>], p: &mut [[[f32; 2 * LANES]; 9]]) {
        stress::<FMA>(law, strains, p);
    }
}

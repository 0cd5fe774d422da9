//! One step of central differences over all degrees of freedom, eight in the lanes of one block.
//!
//! The same sums node by node, with a branch for each axis and two divisions, took a fifth of a whole step of
//! 1331 nodes.

use lanes::{LANES, LanePath, Lanes, madd, on_path};
use shape::Vector3;

/// Mass (kg) of every degree of freedom and its inverse, both zero at prescribed degrees of freedom.
pub(super) struct Inertia {
    mass: Vec<f64>,
    per_mass: Vec<f64>,
}

impl Inertia {
    pub fn new(mass: &[f64], constrained: &[bool]) -> Inertia {
        let free = |k: usize| !constrained[k];
        let of = |value: &dyn Fn(f64) -> f64| -> Vec<f64> {
            (0..constrained.len()).map(|k| if free(k) { value(mass[k / 3]) } else { 0.0 }).collect()
        };
        Inertia { mass: of(&|m| m), per_mass: of(&|m| 1.0 / m) }
    }
}

/// Sums over the free degrees of freedom, with velocities `v-` before and `v+` after the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sums {
    /// Sum of `m v- v+`, J: twice the kinetic energy at the whole step.
    pub kinetic: f64,
    /// Sums of `m v- (v- + v+)` and `m v+ (v- + v+)`, J, for the energy lost to damping.
    pub lost: [f64; 2],
    /// Sum of `v+ v+`, m^2/s^2: finite only if every velocity is.
    pub moved: f64,
    /// Sum of `v- (f + f_before)`, W, with the external forces of this step and of the previous step. Half
    /// the time step times this sum is the work of the external forces.
    pub work: f64,
}

/// Forces of every node, N; `before` has the external forces of the previous step.
#[derive(Clone, Copy)]
pub(super) struct Forces<'a> {
    pub external: &'a [Vector3],
    pub before: &'a [Vector3],
    pub internal: &'a [Vector3],
}

/// Computes `v <- keep v + push / m (external - internal)` at the free degrees of freedom. All other
/// velocities must be zero on input and stay zero.
pub(super) fn accelerate(
    path: LanePath,
    inertia: &Inertia,
    factors: [f64; 2],
    forces: Forces,
    v: &mut [Vector3],
) -> Sums {
    // The lanes are added up outside the kernel. Inside, the compiler would arrange the lanes for this sum
    // and rearrange them in every block.
    let mut sums = [[0.0; LANES]; 5];
    blocks(path, inertia, factors, forces, v, &mut sums);
    let [kinetic, lost, next_lost, moved, work] = sums.map(|lanes| lanes.iter().sum());
    Sums { kinetic, lost: [lost, next_lost], moved, work }
}

on_path! {
    fn blocks(inertia: &Inertia, factors: [f64; 2], forces: Forces<'_>, v: &mut [Vector3], sums: &mut [Lanes; 5]) = blocks_lanes
}

#[inline(always)]
fn blocks_lanes<const FMA: bool>(
    inertia: &Inertia,
    factors: [f64; 2],
    Forces { external, before, internal }: Forces,
    v: &mut [Vector3],
    sums: &mut [Lanes; 5],
) {
    let (mass, last_mass) = inertia.mass.as_chunks::<LANES>();
    let (per_mass, last_per_mass) = inertia.per_mass.as_chunks::<LANES>();
    let (external, last_external) = flat(external).as_chunks::<LANES>();
    let (before, last_before) = flat(before).as_chunks::<LANES>();
    let (internal, last_internal) = flat(internal).as_chunks::<LANES>();
    let (v, last_v) = flat_mut(v).as_chunks_mut::<LANES>();
    for (k, v) in v.iter_mut().enumerate() {
        let forces = [&external[k], &before[k], &internal[k]];
        block::<FMA>(&mass[k], &per_mass[k], factors, forces, v, sums);
    }
    // Unused lanes have no mass and add nothing.
    let forces = [&padded(last_external), &padded(last_before), &padded(last_internal)];
    let mut v = padded(last_v);
    block::<FMA>(&padded(last_mass), &padded(last_per_mass), factors, forces, &mut v, sums);
    last_v.copy_from_slice(&v[..last_v.len()]);
}

#[inline(always)]
fn block<const FMA: bool>(
    mass: &Lanes,
    per_mass: &Lanes,
    [keep, push]: [f64; 2],
    [external, before, internal]: [&Lanes; 3],
    v: &mut Lanes,
    [kinetic, lost, next_lost, moved, work]: &mut [Lanes; 5],
) {
    let m = madd::<FMA>;
    for l in 0..LANES {
        let old = v[l];
        let new = m(push * per_mass[l], external[l] - internal[l], keep * old);
        let (p, q) = (mass[l] * old, mass[l] * new);
        kinetic[l] = m(p, new, kinetic[l]);
        lost[l] = m(p, old + new, lost[l]);
        next_lost[l] = m(q, old + new, next_lost[l]);
        moved[l] = m(new, new, moved[l]);
        work[l] = m(old, external[l] + before[l], work[l]);
        v[l] = new;
    }
}

on_path! {
    /// Computes `u <- u + dt v`.
    pub(super) fn advance(dt: f64, v: &[Vector3], u: &mut [Vector3]) = advance_lanes
}

#[inline(always)]
fn advance_lanes<const FMA: bool>(dt: f64, v: &[Vector3], u: &mut [Vector3]) {
    flat_mut(u).iter_mut().zip(flat(v)).for_each(|(u, v)| *u = madd::<FMA>(dt, *v, *u));
}

#[inline(always)]
fn padded(rest: &[f64]) -> Lanes {
    let mut lanes = [0.0; LANES];
    lanes[..rest.len()].copy_from_slice(rest);
    lanes
}

#[inline(always)]
fn flat(vectors: &[Vector3]) -> &[f64] {
    // SAFETY: a vector consists of its three numbers, one after the other, and nothing else.
    unsafe { std::slice::from_raw_parts(vectors.as_ptr().cast(), 3 * vectors.len()) }
}

#[inline(always)]
fn flat_mut(vectors: &mut [Vector3]) -> &mut [f64] {
    // SAFETY: as in `flat`.
    unsafe { std::slice::from_raw_parts_mut(vectors.as_mut_ptr().cast(), 3 * vectors.len()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_step_as_one_degree_of_freedom_after_the_other() {
        // Five nodes leave seven lanes over; two degrees of freedom are constrained.
        let vectors = |seed: f64| -> Vec<Vector3> {
            (0..5).map(|i| Vector3::from_fn(|a, _| (seed + 3.0 * i as f64 + a as f64).sin())).collect()
        };
        let (external, before, internal, start) = (vectors(1.0), vectors(2.0), vectors(3.0), vectors(4.0));
        let mass = [1.0, 2.0, 3.0, 4.0, 5.0];
        let constrained: Vec<bool> = (0..15).map(|k| k == 4 || k == 14).collect();
        let inertia = Inertia::new(&mass, &constrained);
        let (keep, push) = (0.9, 0.1);
        for path in LanePath::available() {
            let mut v = start.clone();
            (v[1][1], v[4][2]) = (0.0, 0.0);
            let forces = Forces { external: &external, before: &before, internal: &internal };
            let sums = accelerate(path, &inertia, [keep, push], forces, &mut v);
            let mut expected = [0.0; 5];
            for k in 0..15 {
                let (i, a) = (k / 3, k % 3);
                let (old, new) = match constrained[k] {
                    true => (0.0, 0.0),
                    false => {
                        let f = external[i][a] - internal[i][a];
                        (start[i][a], keep * start[i][a] + push / mass[i] * f)
                    }
                };
                assert!((v[i][a] - new).abs() < 1e-15, "{k}: {} {new}", v[i][a]);
                expected[0] += mass[i] * old * new;
                expected[1] += mass[i] * old * (old + new);
                expected[2] += mass[i] * new * (old + new);
                expected[3] += new * new;
                expected[4] += old * (external[i][a] + before[i][a]);
            }
            let found = [sums.kinetic, sums.lost[0], sums.lost[1], sums.moved, sums.work];
            for (found, expected) in found.iter().zip(expected) {
                assert!((found - expected).abs() < 1e-14 * expected.abs(), "{found} {expected}");
            }
            let mut u = start.clone();
            advance(path, 0.5, &v, &mut u);
            assert!((u[4] - start[4] - v[4] * 0.5).norm() < 1e-15);
        }
    }
}

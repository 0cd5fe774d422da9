//! Trilinear hexahedra with one point and hourglass control, one of them in each lane of a block.
//!
//! With the products `Lambda_k` of the corner coordinates (`xi, eta, xi eta, zeta, xi zeta, eta zeta,
//! xi eta zeta`) a cell with mean gradients `b_a` has seven vectors, since the gradients sum to zero:
//!
//! ```text
//! b_a = sum_k Lambda_k(a) B_k,   c_k = sum_a Lambda_k(a) u_a,   H = sum_k c_k B_k^T
//! q_m = c_m - H X_m                  for the four k of the patterns
//! S   = w P - sum_m k q_m X_m^T
//! f_a = sum_k Lambda_k(a) (S B_k + k q_k)
//! ```
//!
//! The sums over `a` are 24 additions for each component, in both directions. An element takes 296 bytes
//! (seven vectors, four moments, weight, stiffness, eight 16-bit nodes) instead of the 656 of eight points.

use lanes::{LANES, LanePath};
use shape::{HOURGLASS_MODES, Hourglass, Vector3, locality_order};

use super::body::ExplicitBody;
use super::chunks::{Border, ChunkNodes, load, split};
use super::moduli::LaneLaw;
use super::one_point_lanes::{Block, NODE, internal};
use super::scalar::{Scalar, Slot};
use crate::kernel::{Engine, Kernel};

/// Elements per chunk in double precision, with some 1400 distinct nodes.
const SIZE: usize = 1024;

/// Kernel for hexahedra with one point.
pub(super) struct OnePoint<T: Scalar> {
    /// A displacement that is small for the body, m.
    small: f64,
    border: Border,
    chunks: Vec<Chunk<T>>,
    u: Vec<Slot<T>>,
    f: Vec<Slot<T>>,
    laws: Vec<LaneLaw>,
}

struct Chunk<T: Scalar> {
    blocks: Vec<Block<T>>,
    /// Consecutive blocks of one region: index after the last block, and region index.
    runs: Vec<(usize, u16)>,
}

impl<T: Scalar> OnePoint<T> {
    /// Builds the kernel for rows with hourglass control. Returns `None` if cells share dilations, or if the
    /// rows have no hourglass control.
    pub fn new(body: &ExplicitBody, laws: Vec<LaneLaw>) -> Option<OnePoint<T>> {
        let control = body.volume.hourglass()?;
        if body.groups.is_some() {
            return None;
        }
        let rows = body.volume.rows();
        let order = locality_order(body.volume.points());
        let parts = split(rows.node_count(), &order, SIZE * T::LANES / LANES, |q| rows.row(q).0.to_vec());
        let chunks = parts.iter().map(|part| Chunk::new(body, control, part)).collect();
        let lists: Vec<Vec<u32>> = parts.into_iter().map(|part| part.nodes).collect();
        let border = Border::new(rows.node_count(), &lists);
        let slots = vec![Slot::ZERO; border.slot_count()];
        let small = body.small_displacement();
        Some(OnePoint { small, border, chunks, u: slots.clone(), f: slots, laws })
    }
}

impl<T: Scalar> Engine for OnePoint<T> {
    fn kernel(&self) -> Kernel {
        Kernel::Hex8OnePoint
    }

    fn forces(&mut self, path: LanePath, u: &[Vector3], f: &mut [Vector3]) -> bool {
        let OnePoint { small, border, chunks, u: slots, f: sums, laws } = self;
        let not_inverted = border.for_each(slots, sums, |c, slots, sums| {
            load(border.chunk(c), u, *small, slots);
            sums.fill(Slot::ZERO);
            let (mut not_inverted, mut first) = (true, 0);
            for &(end, region) in &chunks[c].runs {
                let blocks = &chunks[c].blocks[first..end];
                not_inverted &= internal(path, blocks, &laws[region as usize], slots, sums);
                first = end;
            }
            not_inverted
        });
        border.forces(sums, f);
        not_inverted
    }
}

impl<T: Scalar> Chunk<T> {
    fn new(body: &ExplicitBody, control: &Hourglass, part: &ChunkNodes) -> Chunk<T> {
        let region = |k: usize| body.region(part.items[k] as usize);
        let mut order: Vec<usize> = (0..part.items.len()).collect();
        order.sort_by_key(|&k| region(k));
        let (mut blocks, mut runs) = (Vec::new(), Vec::new());
        for alike in order.chunk_by(|&a, &b| region(a) == region(b)) {
            // Elements in the lanes are far apart, as in linear tetrahedra.
            let stride = alike.len().div_ceil(T::LANES);
            for first in 0..stride {
                // An unused lane has no weight and no stiffness: no force, on the chunk's first node.
                let mut block = Block::<T>::empty();
                for (l, &k) in alike[first..].iter().step_by(stride).enumerate() {
                    block.set(l, &Element::new(body, control, part.items[k] as usize));
                    for c in 0..8 {
                        block.nodes[c][l] = part.local[k][NODE[c]] as u16;
                    }
                }
                blocks.push(block);
            }
            runs.push((blocks.len(), region(alike[0])));
        }
        Chunk { blocks, runs }
    }
}

/// Numbers of one element.
struct Element {
    vectors: [Vector3; 7],
    moments: [Vector3; HOURGLASS_MODES],
    weight: f64,
    stiffness: f64,
}

impl Element {
    fn new(body: &ExplicitBody, control: &Hourglass, cell: usize) -> Element {
        let grads = body.volume.row(cell).1;
        // The product of the coordinates of corner c whose bits k has: the sign of the parity of the bits
        // that are low in c.
        let product = |k: usize, c: usize| if (k & !c).count_ones().is_multiple_of(2) { 1.0 } else { -1.0 };
        let vector = |k: usize| (0..8).map(|c| grads[NODE[c]] * (product(k + 1, c) / 8.0)).sum::<Vector3>();
        Element {
            vectors: std::array::from_fn(vector),
            moments: *control.moments(cell),
            weight: body.volume.weights()[cell],
            stiffness: control.stiffness(cell, body.moduli(cell)),
        }
    }
}

impl<T: Scalar> Block<T> {
    fn set(&mut self, l: usize, element: &Element) {
        for (k, vector) in element.vectors.iter().enumerate() {
            (0..3).for_each(|j| self.vectors[3 * k + j][l] = T::of(vector[j]));
        }
        for (m, moment) in element.moments.iter().enumerate() {
            (0..3).for_each(|j| self.moments[3 * m + j][l] = T::of(moment[j]));
        }
        self.weight[l] = T::of(element.weight);
        self.stiffness[l] = T::of(element.stiffness);
    }
}

#[cfg(test)]
mod tests {
    use shape::HOURGLASS;

    use super::super::one_point_lanes::PATTERNS;
    use super::*;

    #[test]
    fn patterns_have_the_order_of_the_moments() {
        for (m, base) in HOURGLASS.iter().enumerate() {
            let k = PATTERNS[m] + 1;
            let product = |c: usize| if (k & !c).count_ones().is_multiple_of(2) { 1.0 } else { -1.0 };
            assert!((0..8).all(|c| base[NODE[c]] == product(c)), "{m}");
        }
    }
}

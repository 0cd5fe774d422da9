//! Scalar types of the kernels: double precision, and single precision with twice the lanes.

use std::ops::{Index, IndexMut};

use material::Law;
use material::lane::{LaneStrain, Real};

/// Scalar of a kernel with its access to nodes.
pub(super) trait Scalar: Real {
    /// Index of a node for each lane.
    type Nodes: Copy + Default + Send + Sync + AsRef<[u16]> + Index<usize, Output = u16> + IndexMut<usize>;
    /// Alignment of a [`Slot`]: four numbers.
    type Align: Copy + Send + Sync;

    /// Returns the displacement `u` (m) of a node of a chunk whose first node has the displacement `first`.
    ///
    /// In single precision it is relative to `first`, so a rigid translation loses no digit, and rounded to
    /// multiples of some 1e-7 `small`. Products of strains far smaller would be subnormal numbers, which slow
    /// the body ahead of a wave (up to 1.8 times the time).
    fn displacement(u: f64, first: f64, small: f64) -> Self;

    /// Returns the components x, y, z of `u[nodes[l]] - origin[l]` for all lanes.
    ///
    /// # Safety
    ///
    /// Registers of `BITS` must be available, and all nodes must lie within `u`.
    unsafe fn lanes_of<const BITS: usize>(
        u: &[Slot<Self>],
        nodes: &Self::Nodes,
        origin: &[Self::Lanes; 3],
    ) -> [Self::Lanes; 3];

    /// Adds (x, y, z) of every lane to its node, one lane after the other; the reverse of
    /// [`Scalar::lanes_of`].
    ///
    /// # Safety
    ///
    /// As for [`Scalar::lanes_of`].
    unsafe fn add_lanes<const BITS: usize>(xyz: [&Self::Lanes; 3], nodes: &Self::Nodes, f: &mut [Slot<Self>]);

    /// Returns for all lanes both numbers of `pairs`, summed over four nodes.
    fn lanes_of_sums<const WIDE: bool>(pairs: &[[Self; 2]], nodes: &[Self::Nodes; 4]) -> [Self::Lanes; 2];

    /// Computes the stress of a law for each strain, Pa.
    fn stress<const FMA: bool>(law: &Law, strains: &[LaneStrain<Self>], p: &mut [[Self::Lanes; 9]]);
}

/// Copy of one node in one chunk: three components and a pad, one register. The alignment matters: without
/// it every other slot straddles two cache lines (with it 0.97 of the time of tet4).
#[repr(C)]
pub(super) struct Slot<T: Scalar>(pub [T; 4], [T::Align; 0]);

impl<T: Scalar> Clone for Slot<T> {
    fn clone(&self) -> Slot<T> {
        *self
    }
}

impl<T: Scalar> Copy for Slot<T> {}

impl<T: Scalar> Slot<T> {
    pub const ZERO: Slot<T> = Slot([T::ZERO; 4], []);

    #[inline(always)]
    pub fn new(four: [T; 4]) -> Slot<T> {
        Slot(four, [])
    }
}

/// Whether all nodes in these rows of lanes are below `count`. The check takes some ten vector instructions
/// for a block, instead of a branch for each node.
#[inline(always)]
pub(super) fn within<T: Scalar>(nodes: &[T::Nodes], count: usize) -> bool {
    let mut last = 0;
    for nodes in nodes {
        for node in nodes.as_ref() {
            last = last.max(*node);
        }
    }
    usize::from(last) < count
}

/// Alignments of slots.
#[derive(Clone, Copy)]
#[repr(align(32))]
pub(super) struct Align32;
#[derive(Clone, Copy)]
#[repr(align(16))]
pub(super) struct Align16;

#[cfg(test)]
mod tests {
    use lanes::LANES;

    use super::*;

    #[test]
    fn one_node_beyond_the_slots_is_seen_wherever_it_is() {
        let mut nodes = [[5; LANES]; 4];
        assert!(within::<f64>(&nodes, 6) && !within::<f64>(&nodes, 5));
        for place in 0..4 * LANES {
            nodes.as_flattened_mut()[place] = 6;
            assert!(!within::<f64>(&nodes, 6), "{place}");
            nodes.as_flattened_mut()[place] = 5;
        }
    }
}

//! Decomposition of the inner part of a cut tetrahedron into tetrahedra (Labelle and Shewchuk 2007, figure
//! 3).

/// Position of a corner relative to the surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Inside,
    On,
    Outside,
}

impl Side {
    /// The side as seen from the other side.
    pub(super) fn turned(self) -> Side {
        match self {
            Side::Inside => Side::Outside,
            Side::On => Side::On,
            Side::Outside => Side::Inside,
        }
    }
}

/// A tetrahedron of a lattice: corners with their sides. The edges 01 and 23 are longer than the others.
pub(super) struct Tet {
    pub corners: [u32; 4],
    pub sides: [Side; 4],
}

/// Whether two corners are the ends of a long edge.
fn long(a: usize, b: usize) -> bool {
    a / 2 == b / 2
}

impl Tet {
    /// Calls `add` with each tetrahedron of the part inside, whose corners may be in any order. `cut` returns
    /// the node where the surface cuts the edge from an inner to an outer corner. `apart` returns the
    /// distance of two nodes.
    pub(super) fn inside<D: PartialOrd>(
        &self,
        cut: impl Fn(u32, u32) -> u32,
        apart: impl Fn(u32, u32) -> D,
        mut add: impl FnMut([u32; 4]),
    ) {
        let (mut ins, mut outs, mut on) = (Vec::with_capacity(4), Vec::with_capacity(4), 0);
        for i in 0..4 {
            match self.sides[i] {
                Side::Inside => ins.push(i),
                Side::On => on = i,
                Side::Outside => outs.push(i),
            }
        }
        let node = |i: usize| self.corners[i];
        let cut = |a: usize, b: usize| cut(self.corners[a], self.corners[b]);
        // There are four corners, so each `..` stands for none.
        match (&ins[..], &outs[..]) {
            ([], _) => {}
            (_, []) => add(self.corners),
            (&[a], _) => {
                let end =
                    |i: usize| if i != a && self.sides[i] == Side::Outside { cut(a, i) } else { node(i) };
                add([0, 1, 2, 3].map(end));
            }
            (&[a, b], &[d]) => {
                let at_a = cut(a, d);
                let at_b = cut(b, d);
                let on = node(on);
                if self.halved_from(a, b, d) {
                    add([on, node(a), node(b), at_b]);
                    add([on, node(a), at_b, at_a]);
                } else {
                    add([on, node(a), node(b), at_a]);
                    add([on, node(b), at_b, at_a]);
                }
            }
            (&[a, b], &[c, d, ..]) if long(a, b) => {
                let (a, b) = if self.halved_from(a, b, c) { (a, b) } else { (b, a) };
                let [ac, ad, bc, bd] = [cut(a, c), cut(a, d), cut(b, c), cut(b, d)];
                add([node(a), node(b), bc, bd]);
                // The quadrilateral on the surface belongs to this tetrahedron alone, or to its two parts on
                // both sides, so the shorter diagonal is free to choose.
                if apart(ac, bd) <= apart(ad, bc) {
                    add([node(a), ac, ad, bd]);
                    add([node(a), ac, bc, bd]);
                } else {
                    add([node(a), ac, ad, bc]);
                    add([node(a), ad, bc, bd]);
                }
            }
            (&[a, b], &[c, d, ..]) => {
                let (c, d) = if long(a, c) { (c, d) } else { (d, c) };
                let [ac, ad, bc, bd] = [cut(a, c), cut(a, d), cut(b, c), cut(b, d)];
                add([bd, node(a), ac, ad]);
                add([ac, node(b), bc, bd]);
                add([node(a), node(b), ac, bd]);
            }
            (&[x, y, z, ..], &[d, ..]) => {
                let [a, b, c] = match (long(x, d), long(y, d)) {
                    (true, _) => [x, y, z],
                    (_, true) => [y, z, x],
                    _ => [z, x, y],
                };
                let [at_a, at_b, at_c] = [a, b, c].map(|corner| cut(corner, d));
                let (b, c, at_b, at_c) =
                    if self.halved_from(b, c, d) { (b, c, at_b, at_c) } else { (c, b, at_c, at_b) };
                add([node(a), node(b), node(c), at_a]);
                add([at_a, node(b), node(c), at_c]);
                add([at_a, node(b), at_c, at_b]);
            }
        }
    }

    /// Whether the diagonal of the quadrilateral between two inner corners and the cuts on their edges to `d`
    /// starts at `a`. The adjacent tetrahedron makes the same choice: the diagonal ends at the cut of the
    /// long edge, or starts at the corner with the lower number if both edges are short.
    fn halved_from(&self, a: usize, b: usize, d: usize) -> bool {
        if long(a, b) { self.corners[a] < self.corners[b] } else { long(b, d) }
    }
}

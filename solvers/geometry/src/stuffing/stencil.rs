//! The part of a tetrahedron inside a surface that cuts its edges, in tetrahedra (Labelle and Shewchuk 2007, figure 3).

/// Where a corner is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    Inside,
    On,
    Outside,
}

/// A tetrahedron of a lattice: corners with their sides, the edges 01 and 23 longer than the others.
pub(super) struct Tet {
    pub corners: [u32; 4],
    pub sides: [Side; 4],
}

/// Whether two corners are the ends of a long edge.
fn long(a: usize, b: usize) -> bool {
    a / 2 == b / 2
}

impl Tet {
    /// Calls `add` with each tetrahedron of the part inside, in any order of corners; `cut` gives the node where the surface cuts
    /// the edge from a corner inside to one outside. `apart` measures the distance of two nodes.
    pub(super) fn inside(
        &self,
        cut: impl Fn(u32, u32) -> u32,
        apart: impl Fn(u32, u32) -> f64,
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
        match (&ins[..], &outs[..]) {
            ([], _) => {}
            (_, []) => add(self.corners),
            (&[a], _) => {
                let end =
                    |i: usize| if i != a && self.sides[i] == Side::Outside { cut(a, i) } else { node(i) };
                add([0, 1, 2, 3].map(end));
            }
            (&[a, b], &[d]) => {
                let (at_a, at_b, on) = (cut(a, d), cut(b, d), node(on));
                if self.halved_from(a, b, d) {
                    add([on, node(a), node(b), at_b]);
                    add([on, node(a), at_b, at_a]);
                } else {
                    add([on, node(a), node(b), at_a]);
                    add([on, node(b), at_b, at_a]);
                }
            }
            (&[a, b], &[c, d]) if long(a, b) => {
                let (a, b) = if self.halved_from(a, b, c) { (a, b) } else { (b, a) };
                let [ac, ad, bc, bd] = [cut(a, c), cut(a, d), cut(b, c), cut(b, d)];
                add([node(a), node(b), bc, bd]);
                // The quadrilateral on the surface is this tetrahedron's own.
                if apart(ac, bd) <= apart(ad, bc) {
                    add([node(a), ac, ad, bd]);
                    add([node(a), ac, bc, bd]);
                } else {
                    add([node(a), ac, ad, bc]);
                    add([node(a), ad, bc, bd]);
                }
            }
            (&[a, b], &[c, d]) => {
                let (c, d) = if long(a, c) { (c, d) } else { (d, c) };
                let [ac, ad, bc, bd] = [cut(a, c), cut(a, d), cut(b, c), cut(b, d)];
                add([bd, node(a), ac, ad]);
                add([ac, node(b), bc, bd]);
                add([node(a), node(b), ac, bd]);
            }
            (&[x, y, z], &[d]) => {
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
            _ => unreachable!("of four corners"),
        }
    }

    /// Whether the quadrilateral of two corners inside and the cuts on their edges to `d` is halved from `a`; the tetrahedron on the other
    /// side says the same. The cut of a long edge takes the diagonal; where both edges are short, the corner of the lower number.
    fn halved_from(&self, a: usize, b: usize, d: usize) -> bool {
        if long(a, b) { self.corners[a] < self.corners[b] } else { long(b, d) }
    }
}

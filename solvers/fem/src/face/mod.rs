//! Faces of the elements: shape functions of two coordinates, on the triangle (0,0), (1,0), (0,1) or the
//! square `[-1, 1]^2`. The restriction of an element to a face is the face element.

mod lagrange;
mod quad4;
mod quad8;
mod tri3;
mod tri6;

pub(crate) use lagrange::Face;
pub(crate) use quad4::Quad4;
pub(crate) use quad8::Quad8;
pub(crate) use tri3::Tri3;
pub(crate) use tri6::Tri6;

use geometry::CellKind;

/// Runs `$body` with `$F` as the face type of a face kind and `$N` as its number of nodes.
macro_rules! with_face {
    ($kind:expr, $F:ident, $N:ident => $body:expr) => {
        match $kind {
            geometry::FaceKind::Tri3 => with_face!(@ $crate::face::Tri3, 3, $F, $N, $body),
            geometry::FaceKind::Tri6 => with_face!(@ $crate::face::Tri6, 6, $F, $N, $body),
            geometry::FaceKind::Quad4 => with_face!(@ $crate::face::Quad4, 4, $F, $N, $body),
            geometry::FaceKind::Quad8 => with_face!(@ $crate::face::Quad8, 8, $F, $N, $body),
        }
    };
    (@ $type:ty, $count:literal, $F:ident, $N:ident, $body:expr) => {{
        #[allow(dead_code)]
        type $F = $type;
        #[allow(dead_code)]
        const $N: usize = $count;
        $body
    }};
}
pub(crate) use with_face;

/// Returns the reference coordinates in the cell of the point `s` of one of its faces. Reference faces are
/// flat, so the (bi)linear functions of the corners map a face into the cell for every order.
pub(crate) fn into_cell(kind: CellKind, face: usize, s: [f64; 2]) -> [f64; 3] {
    let nodes = kind.entry().nodes;
    let corners = kind.faces()[face].iter();
    let mut xi = [0.0; 3];
    let mut add = |values: &[f64]| {
        for (&local, n) in corners.clone().zip(values) {
            for i in 0..3 {
                xi[i] += n * nodes[local][i];
            }
        }
    };
    if kind.face_kind(face).is_triangle() {
        add(&Tri3::shape(s))
    } else {
        add(&Quad4::shape(s))
    }
    xi
}

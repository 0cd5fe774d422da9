//! Edges of triangles.

use super::soup::Soup;

/// An edge of one triangle.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Side {
    /// Lower and higher corner.
    pub(super) edge: [u32; 2],
    pub(super) triangle: u32,
    /// Corner of the triangle at which the edge begins.
    pub(super) corner: u8,
    /// Whether the edge goes from the lower corner to the higher.
    pub(super) upwards: bool,
}

/// Returns the edges of all triangles. Equal edges follow each other.
pub(super) fn sides(soup: &Soup) -> Vec<Side> {
    let mut sides: Vec<Side> = Vec::with_capacity(3 * soup.triangles.len());
    for (triangle, t) in soup.triangles.iter().enumerate() {
        for corner in 0..3 {
            let (a, b) = (t[corner], t[(corner + 1) % 3]);
            let edge = [a.min(b), a.max(b)];
            sides.push(Side { edge, triangle: triangle as u32, corner: corner as u8, upwards: a < b });
        }
    }
    sides.sort_unstable();
    sides
}

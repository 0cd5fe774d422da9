//! Boxes that are certain to contain a cell or a facet, curved or not.

use geometry::{Facet, Mesh, Point3};

/// Axis-parallel box, m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounds {
    pub(crate) min: [f64; 3],
    pub(crate) max: [f64; 3],
}

impl Bounds {
    fn empty() -> Bounds {
        Bounds { min: [f64::INFINITY; 3], max: [f64::NEG_INFINITY; 3] }
    }

    fn include(&mut self, p: &Point3) {
        for i in 0..3 {
            self.min[i] = self.min[i].min(p[i]);
            self.max[i] = self.max[i].max(p[i]);
        }
    }

    pub(crate) fn join(&mut self, other: &Bounds) {
        for i in 0..3 {
            self.min[i] = self.min[i].min(other.min[i]);
            self.max[i] = self.max[i].max(other.max[i]);
        }
    }

    /// Length of the diagonal, m.
    pub(crate) fn diagonal(&self) -> f64 {
        (0..3).map(|i| (self.max[i] - self.min[i]).powi(2)).sum::<f64>().sqrt()
    }

    /// Returns the box enlarged by `margin` (m) on every side.
    fn grown(mut self, margin: f64) -> Bounds {
        for i in 0..3 {
            self.min[i] -= margin;
            self.max[i] += margin;
        }
        self
    }

    pub(crate) fn contains(&self, p: &Point3) -> bool {
        (0..3).all(|i| self.min[i] <= p[i] && p[i] <= self.max[i])
    }

    /// Distance from a point to the box, m; zero inside.
    pub(crate) fn distance(&self, p: &Point3) -> f64 {
        (0..3).map(|i| (self.min[i] - p[i]).max(p[i] - self.max[i]).max(0.0).powi(2)).sum::<f64>().sqrt()
    }
}

/// Returns a box that contains one cell.
///
/// A quadratic map is the (tri)linear map of its corners plus, per edge, the deviation of the mid-edge node
/// from the middle times a function between 0 and 1. The sum of these functions is bounded by the cell's
/// [`bulge`](geometry::element::ReferenceCell::bulge). The corners plus that many largest deviations
/// therefore bound the cell. The box is enlarged by 1e-9 of its diagonal, so that rounding leaves no gap
/// between cells.
pub(crate) fn cell_bounds(mesh: &Mesh, cell: usize) -> Bounds {
    let kind = mesh.kind(cell);
    let local: Vec<usize> = (0..kind.node_count()).collect();
    quadratic_bounds(
        mesh,
        mesh.cell(cell),
        &local,
        kind.corner_count(),
        kind.edges(),
        kind.entry().cell.bulge,
    )
}

/// Returns a box that contains one facet, by the argument of [`cell_bounds`]: 4/3 on a triangle, 2 on a
/// quadrilateral.
pub(crate) fn facet_bounds(mesh: &Mesh, facet: Facet) -> Bounds {
    const EDGES: [[usize; 2]; 4] = [[0, 1], [1, 2], [2, 3], [3, 0]];
    const TRIANGLE: [[usize; 2]; 3] = [[0, 1], [1, 2], [2, 0]];
    let kind = mesh.kind(facet.cell as usize);
    let corners = mesh.facet_kind(facet).corner_count();
    let local = kind.faces()[facet.face as usize];
    let (edges, reach): (&[_], f64) = if corners == 3 { (&TRIANGLE, 4.0 / 3.0) } else { (&EDGES, 2.0) };
    quadratic_bounds(mesh, mesh.cell(facet.cell as usize), local, corners, edges, reach)
}

fn quadratic_bounds(
    mesh: &Mesh,
    cell: &[u32],
    local: &[usize],
    corners: usize,
    edges: &[[usize; 2]],
    reach: f64,
) -> Bounds {
    let point = |i: usize| &mesh.points()[cell[local[i]] as usize];
    let mut bounds = Bounds::empty();
    for corner in 0..corners {
        bounds.include(point(corner));
    }
    let (mut below, mut above) = ([0.0_f64; 3], [0.0_f64; 3]);
    // Linear kinds have no nodes after the corners: the zip is empty.
    for (middle, &[a, b]) in (corners..local.len()).zip(edges) {
        for i in 0..3 {
            let deviation = point(middle)[i] - 0.5 * (point(a)[i] + point(b)[i]);
            below[i] = below[i].min(deviation);
            above[i] = above[i].max(deviation);
        }
    }
    for i in 0..3 {
        bounds.min[i] += reach * below[i];
        bounds.max[i] += reach * above[i];
    }
    let margin = 1e-9 * bounds.diagonal();
    bounds.grown(margin)
}

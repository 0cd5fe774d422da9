//! Which tetrahedron holds a point: for barycentric transfer and for finding integration cells.

use crate::{Matrix3, Mesh, Point3};

/// Barycentric coordinates may be this negative and still count as inside: faces shared by two cells lose nothing
/// to rounding.
const TOLERANCE: f64 = 1e-10;

/// A point's place in a mesh of tetrahedra.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Location {
    /// Cell index.
    pub cell: u32,
    /// Barycentric coordinates with respect to the cell's four corners; they sum to one. Outside the mesh they
    /// belong to the point of the cell closest to the one asked for.
    pub barycentric: [f64; 4],
    /// Distance from the mesh (m); 0 inside.
    pub outside: f64,
}

/// What makes a mesh unlocatable.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum LocateError {
    /// A cell that is no tetrahedron.
    #[error("cell {cell} is a {kind}; points are located in tetrahedra (convert the mesh first)", kind = kind.name())]
    NotTetrahedron {
        /// Cell index.
        cell: usize,
        /// Its kind.
        kind: crate::CellKind,
    },
    /// A tetrahedron without volume.
    #[error("cell {cell} has no volume: det J = {det_j:e} m^3")]
    Flat {
        /// Cell index.
        cell: usize,
        /// Its Jacobian determinant (m^3).
        det_j: f64,
    },
    /// A query that is not a finite position.
    #[error("point {point} to be located has a coordinate that is not finite")]
    NotFinite {
        /// Index among the queries.
        point: usize,
    },
}

/// Locates each point among the tetrahedra of `mesh`, taken flat through their corners. Points in several cells go
/// to the lowest-numbered one; points outside all go to the closest cell and carry their distance.
pub fn locate(mesh: &Mesh, points: &[Point3]) -> Result<Vec<Location>, LocateError> {
    let cells = Cells::new(mesh)?;
    (points.iter().enumerate())
        .map(|(point, p)| {
            if !p.coords.iter().all(|c| c.is_finite()) {
                return Err(LocateError::NotFinite { point });
            }
            Ok(cells.holding(p).unwrap_or_else(|| cells.closest(p)))
        })
        .collect()
}

/// Tetrahedra in a uniform grid of bins.
struct Cells {
    corners: Vec<[Point3; 4]>,
    inverse: Vec<Matrix3>,
    boxes: Vec<[Point3; 2]>,
    low: Point3,
    /// Bin widths (m) and counts per axis.
    width: [f64; 3],
    bins: [usize; 3],
    /// Cells of bin b, ascending: `members[offsets[b]..offsets[b + 1]]`.
    offsets: Vec<usize>,
    members: Vec<u32>,
}

impl Cells {
    fn new(mesh: &Mesh) -> Result<Cells, LocateError> {
        let count = mesh.cell_count();
        let (mut corners, mut inverse, mut boxes) = (Vec::new(), Vec::new(), Vec::new());
        for cell in 0..count {
            let kind = mesh.kind(cell);
            if !kind.is_tet() {
                return Err(LocateError::NotTetrahedron { cell, kind });
            }
            let mut p = [Point3::origin(); 4];
            for (slot, q) in p.iter_mut().zip(mesh.cell_points(cell)) {
                *slot = *q;
            }
            let edges = Matrix3::from_columns(&[p[1] - p[0], p[2] - p[0], p[3] - p[0]]);
            let det_j = edges.determinant();
            match edges.try_inverse() {
                Some(m) if m.iter().all(|c| c.is_finite()) => inverse.push(m),
                _ => return Err(LocateError::Flat { cell, det_j }),
            }
            boxes.push([
                p[1..].iter().fold(p[0], |low, q| low.inf(q)),
                p[1..].iter().fold(p[0], |high, q| high.sup(q)),
            ]);
            corners.push(p);
        }
        let low = boxes.iter().fold(boxes[0][0], |low, b| low.inf(&b[0]));
        let high = boxes.iter().fold(boxes[0][1], |high, b| high.sup(&b[1]));
        // About one bin per cell, no bin much longer than it is wide.
        let extent = high - low;
        let side = (extent.product() / count as f64).cbrt();
        let bins: [usize; 3] = std::array::from_fn(|d| ((extent[d] / side).ceil() as usize).clamp(1, 256));
        let width = std::array::from_fn(|d| extent[d] / bins[d] as f64);
        let mut cells = Cells { corners, inverse, boxes, low, width, bins, offsets: vec![], members: vec![] };
        cells.fill_bins();
        Ok(cells)
    }

    fn fill_bins(&mut self) {
        let total = self.bins.iter().product::<usize>();
        let mut offsets = vec![0; total + 1];
        let ranges: Vec<_> = self.boxes.iter().map(|b| (self.bin(&b[0]), self.bin(&b[1]))).collect();
        for &(low, high) in &ranges {
            self.each_bin(low, high, |bin| offsets[bin + 1] += 1);
        }
        for bin in 0..total {
            offsets[bin + 1] += offsets[bin];
        }
        let mut next = offsets.clone();
        let mut members = vec![0; offsets[total]];
        for (cell, &(low, high)) in ranges.iter().enumerate() {
            self.each_bin(low, high, |bin| {
                members[next[bin]] = cell as u32;
                next[bin] += 1;
            });
        }
        (self.offsets, self.members) = (offsets, members);
    }

    /// Bin of a position along each axis; positions outside go to the nearest bin.
    fn bin(&self, p: &Point3) -> [usize; 3] {
        std::array::from_fn(|d| {
            // The cast saturates: negative numbers become 0.
            (((p[d] - self.low[d]) / self.width[d]) as usize).min(self.bins[d] - 1)
        })
    }

    fn each_bin(&self, low: [usize; 3], high: [usize; 3], mut visit: impl FnMut(usize)) {
        for k in low[2]..=high[2] {
            for j in low[1]..=high[1] {
                for i in low[0]..=high[0] {
                    visit((k * self.bins[1] + j) * self.bins[0] + i);
                }
            }
        }
    }

    fn barycentric(&self, cell: usize, p: &Point3) -> [f64; 4] {
        let l = self.inverse[cell] * (p - self.corners[cell][0]);
        [1.0 - l.x - l.y - l.z, l.x, l.y, l.z]
    }

    fn holding(&self, p: &Point3) -> Option<Location> {
        let at = self.bin(p);
        let bin = (at[2] * self.bins[1] + at[1]) * self.bins[0] + at[0];
        let members = &self.members[self.offsets[bin]..self.offsets[bin + 1]];
        members.iter().find_map(|&cell| {
            let barycentric = self.barycentric(cell as usize, p);
            let inside = barycentric.iter().all(|&l| l >= -TOLERANCE);
            inside.then_some(Location { cell, barycentric, outside: 0.0 })
        })
    }

    /// The closest cell to a point outside all (of several, the lowest-numbered), box distances pruning the scan. It starts from
    /// the closest box, whose cell is about as close as any: ten times faster than from the first.
    fn closest(&self, p: &Point3) -> Location {
        let away =
            |bounds: &[Point3; 2]| (bounds[0] - p).sup(&(p - bounds[1])).map(|c| c.max(0.0)).norm_squared();
        let squares: Vec<f64> = self.boxes.iter().map(away).collect();
        let first = (0..squares.len()).min_by(|&a, &b| squares[a].total_cmp(&squares[b])).unwrap_or(0);
        let (mut best, mut at) = self.closest_on_cell(first, p);
        let mut closest = first;
        for (cell, &square) in squares.iter().enumerate() {
            if square > best {
                continue;
            }
            let (distance, q) = self.closest_on_cell(cell, p);
            if distance < best || (distance == best && cell < closest) {
                (best, at, closest) = (distance, q, cell);
            }
        }
        let barycentric = self.barycentric(closest, &at);
        Location { cell: closest as u32, barycentric, outside: best.sqrt() }
    }

    /// Squared distance to the faces of a cell, and the point there.
    fn closest_on_cell(&self, cell: usize, p: &Point3) -> (f64, Point3) {
        let mut best = (f64::INFINITY, self.corners[cell][0]);
        for face in crate::CellKind::Tet4.faces() {
            let q = closest_on_triangle(p, &[0, 1, 2].map(|k| self.corners[cell][face[k]]));
            let distance = (q - p).norm_squared();
            if distance < best.0 {
                best = (distance, q);
            }
        }
        best
    }
}

/// The point of a triangle closest to `p` (Ericson 2005, Real-Time Collision Detection, section 5.1.5).
pub fn closest_on_triangle(p: &Point3, &[a, b, c]: &[Point3; 3]) -> Point3 {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(&bp), ac.dot(&bp));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(&cp), ac.dot(&cp));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let sum = va + vb + vc;
    a + ab * (vb / sum) + ac * (vc / sum)
}

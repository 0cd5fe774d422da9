//! Finds the tetrahedron that contains a point, for barycentric transfer and for integration cells.

use rayon::prelude::*;

use crate::element::CellKind;
use crate::mesh::Mesh;
use crate::triangle::closest_on_triangle;
use crate::{Matrix3, Point3, Vector3};

/// Tolerance on negative barycentric coordinates of a point inside a cell, so that rounding loses no point on
/// a face between two cells.
const TOLERANCE: f64 = 1e-10;
/// Bound on the relative error of barycentric coordinates in the search for the closest cell.
const SLACK: f64 = 1e-6;

/// Location of a point in a mesh of tetrahedra.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Location {
    /// Cell index.
    pub cell: u32,
    /// Barycentric coordinates with respect to the cell's four corners; they sum to one. For a point outside
    /// the mesh they belong to the closest point of the cell.
    pub barycentric: [f64; 4],
    /// Distance from the mesh (m); 0 for points inside.
    pub outside: f64,
}

/// Errors of point location.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum LocateError {
    /// A cell that is not a tetrahedron.
    #[error("cell {cell} is a {kind}; points are located in tetrahedra (convert the mesh first)", kind = kind.name())]
    NotTetrahedron {
        /// Cell index.
        cell: usize,
        /// Kind of the cell.
        kind: CellKind,
    },
    /// A tetrahedron without volume.
    #[error("cell {cell} has no volume: det J = {det_j:e} m^3")]
    Flat {
        /// Cell index.
        cell: usize,
        /// Jacobian determinant of the cell (m^3).
        det_j: f64,
    },
    /// A query that is not a finite position.
    #[error("point {point} to be located has a coordinate that is not finite")]
    NotFinite {
        /// Index among the queries.
        point: usize,
    },
}

/// Points per parallel task.
const CHUNK: usize = 128;

/// Locates each point among the tetrahedra of `mesh`, with straight edges between their corners. A point in
/// several cells is assigned to the cell with the lowest number. A point outside all cells is assigned to the
/// closest cell and has a positive distance.
///
/// # Errors
/// A cell that is not a tetrahedron or has no volume, or a point that is not finite.
pub fn locate(mesh: &Mesh, points: &[Point3]) -> Result<Vec<Location>, LocateError> {
    Locator::new(mesh)?.locate(points)
}

/// Tetrahedra in a uniform grid of bins, with straight edges between their corners, for repeated batches of
/// points.
pub struct Locator {
    corners: Vec<[Point3; 4]>,
    frames: Vec<Frame>,
    boxes: Vec<[Point3; 2]>,
    low: Point3,
    /// Bin widths (m) and counts per axis.
    width: [f64; 3],
    bins: [usize; 3],
    /// Cells of bin b, ascending: `members[offsets[b]..offsets[b + 1]]`.
    offsets: Vec<usize>,
    members: Vec<u32>,
}

/// Affine map from positions to barycentric coordinates of a cell.
struct Frame {
    origin: Point3,
    inverse: Matrix3,
}

impl Frame {
    fn barycentric(&self, p: &Point3) -> [f64; 4] {
        let l = self.inverse * (p - self.origin);
        [1.0 - l.x - l.y - l.z, l.x, l.y, l.z]
    }

    /// Gradients of the barycentric coordinates, 1/m.
    fn slopes(&self) -> [Vector3; 4] {
        let [x, y, z] = [0, 1, 2].map(|axis| self.inverse.row(axis).transpose());
        [-(x + y + z), x, y, z]
    }

    /// Lower bound of the squared distance (m^2) of a point from the cell: its largest squared distance
    /// beyond a face plane.
    fn beyond(&self, p: &Point3) -> f64 {
        let slopes = self.slopes().map(|slope| slope.norm_squared());
        // The slack far exceeds rounding, so that of two equally close cells neither counts as farther away.
        let past = |l: f64| (l + SLACK * (1.0 - l)).min(0.0);
        let of_face = self.barycentric(p).into_iter().zip(slopes).map(|(l, square)| past(l).powi(2) / square);
        of_face.fold(0.0, f64::max)
    }
}

/// Buffers of the search for the closest cell, reused from point to point.
#[derive(Default)]
struct Scratch {
    stamp: usize,
    /// Stamp of the last point for which each cell was visited, because most cells are in several bins. Empty
    /// until a point lies outside.
    seen: Vec<usize>,
    /// Lower bound of the squared distance (m^2) to the cell, and the cell.
    near: Vec<(f64, usize)>,
}

/// The closest cell so far.
struct Closest {
    /// Squared distance to the cell, m^2.
    square: f64,
    /// Closest point of the cell.
    at: Point3,
    cell: usize,
}

impl Locator {
    /// Builds the search structure from the cells of a mesh.
    ///
    /// # Errors
    /// A cell that is not a tetrahedron or has no volume.
    pub fn new(mesh: &Mesh) -> Result<Locator, LocateError> {
        let count = mesh.cell_count();
        let mut cells = Locator {
            corners: Vec::with_capacity(count),
            frames: Vec::with_capacity(count),
            boxes: Vec::with_capacity(count),
            low: Point3::origin(),
            width: [0.0; 3],
            bins: [0; 3],
            offsets: vec![],
            members: vec![],
        };
        for cell in 0..count {
            let kind = mesh.kind(cell);
            if kind.corner_count() != 4 {
                return Err(LocateError::NotTetrahedron { cell, kind });
            }
            let mut p = [Point3::origin(); 4];
            for (slot, q) in p.iter_mut().zip(mesh.cell_points(cell)) {
                *slot = *q;
            }
            let edges = Matrix3::from_columns(&[p[1] - p[0], p[2] - p[0], p[3] - p[0]]);
            let inverse = edges.try_inverse().filter(|m| m.iter().all(|c| c.is_finite()));
            let inverse = inverse.ok_or_else(|| LocateError::Flat { cell, det_j: edges.determinant() })?;
            cells.frames.push(Frame { origin: p[0], inverse });
            cells.boxes.push([
                p[1..].iter().fold(p[0], |low, q| low.inf(q)),
                p[1..].iter().fold(p[0], |high, q| high.sup(q)),
            ]);
            cells.corners.push(p);
        }
        let boxes = &cells.boxes;
        cells.low = boxes.iter().fold(boxes[0][0], |low, b| low.inf(&b[0]));
        let high = boxes.iter().fold(boxes[0][1], |high, b| high.sup(&b[1]));
        // About one bin per cell, with bins nearly cubic.
        let extent = high - cells.low;
        let side = (extent.product() / count as f64).cbrt();
        cells.bins = std::array::from_fn(|d| ((extent[d] / side).ceil() as usize).clamp(1, 256));
        cells.width = std::array::from_fn(|d| extent[d] / cells.bins[d] as f64);
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

    /// Bin of a position along each axis, or the nearest bin for positions outside the grid.
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

    /// The four corners of a cell, m.
    pub fn corners(&self, cell: usize) -> &[Point3; 4] {
        &self.corners[cell]
    }

    /// Barycentric coordinates of any point with respect to a cell. Outside the cell some are negative.
    pub fn barycentric(&self, cell: usize, p: &Point3) -> [f64; 4] {
        self.frames[cell].barycentric(p)
    }

    /// Gradients (1/m) of the four barycentric coordinates of a cell.
    pub fn slopes(&self, cell: usize) -> [Vector3; 4] {
        self.frames[cell].slopes()
    }

    /// Returns the location of each point (m) among the tetrahedra. A point in several cells is assigned to
    /// the cell with the lowest number. A point outside all cells is assigned to the closest cell and has a
    /// positive distance.
    ///
    /// # Errors
    /// A point that is not finite.
    pub fn locate(&self, points: &[Point3]) -> Result<Vec<Location>, LocateError> {
        if let Some(point) = points.iter().position(|p| !p.coords.iter().all(|c| c.is_finite())) {
            return Err(LocateError::NotFinite { point });
        }
        let locations = points.par_chunks(CHUNK).flat_map_iter(|chunk| {
            let mut scratch = Scratch::default();
            chunk.iter().map(move |p| self.holding(p).unwrap_or_else(|| self.closest(p, &mut scratch)))
        });
        Ok(locations.collect())
    }

    fn holding(&self, p: &Point3) -> Option<Location> {
        let [i, j, k] = self.bin(p);
        self.members((k * self.bins[1] + j) * self.bins[0] + i).iter().find_map(|&cell| {
            let barycentric = self.frames[cell as usize].barycentric(p);
            let inside = barycentric.iter().all(|&l| l >= -TOLERANCE);
            inside.then_some(Location { cell, barycentric, outside: 0.0 })
        })
    }

    fn members(&self, bin: usize) -> &[u32] {
        &self.members[self.offsets[bin]..self.offsets[bin + 1]]
    }

    /// Finds the closest cell to a point outside all cells; of several equally close, the lowest-numbered.
    /// Cubes of bins around the point's bin grow until they hold cells. Then all bins that the ball to the
    /// closest of these cells touches are searched.
    fn closest(&self, p: &Point3, scratch: &mut Scratch) -> Location {
        scratch.stamp += 1;
        scratch.seen.resize(self.corners.len(), 0);
        let centre = self.bin(p);
        let mut best = Closest { square: f64::INFINITY, at: *p, cell: usize::MAX };
        for ring in std::iter::once(0).chain((0..).map(|k| 1 << k)) {
            let low = centre.map(|c| c.saturating_sub(ring));
            let high = std::array::from_fn(|d| (centre[d] + ring).min(self.bins[d] - 1));
            self.search(p, low, high, &mut best, scratch);
            if best.cell != usize::MAX {
                break;
            }
        }
        // The margin beyond the ball far exceeds rounding.
        let reach =
            Vector3::repeat(best.square.sqrt() * (1.0 + 1e-9) + 1e-9 * self.width.iter().sum::<f64>());
        self.search(p, self.bin(&(p - reach)), self.bin(&(p + reach)), &mut best, scratch);
        let barycentric = self.frames[best.cell].barycentric(&best.at);
        Location { cell: best.cell as u32, barycentric, outside: best.square.sqrt() }
    }

    /// Searches the cells in a range of bins that have not been visited for this point. The cell with the
    /// smallest lower bound comes first: it mostly is the closest, and one comparison dismisses any other.
    fn search(
        &self,
        p: &Point3,
        low: [usize; 3],
        high: [usize; 3],
        best: &mut Closest,
        scratch: &mut Scratch,
    ) {
        let away =
            |bounds: &[Point3; 2]| (bounds[0] - p).sup(&(p - bounds[1])).map(|c| c.max(0.0)).norm_squared();
        let Scratch { stamp, seen, near } = scratch;
        near.clear();
        self.each_bin(low, high, |bin| {
            for &cell in self.members(bin) {
                let cell = cell as usize;
                if std::mem::replace(&mut seen[cell], *stamp) != *stamp
                    && away(&self.boxes[cell]) <= best.square
                {
                    near.push((self.frames[cell].beyond(p), cell));
                }
            }
        });
        if let Some(first) = (0..near.len()).min_by(|&a, &b| near[a].0.total_cmp(&near[b].0)) {
            near.swap(0, first);
        }
        for &(square, cell) in &*near {
            if square > best.square {
                continue;
            }
            let (square, at) = self.closest_on_cell(cell, p);
            if square < best.square || (square == best.square && cell < best.cell) {
                *best = Closest { square, at, cell };
            }
        }
    }

    /// Squared distance (m^2) to the faces of a cell, and the closest point.
    fn closest_on_cell(&self, cell: usize, p: &Point3) -> (f64, Point3) {
        let mut best = (f64::INFINITY, self.corners[cell][0]);
        for face in CellKind::Tet4.faces() {
            let q = closest_on_triangle(p, &[0, 1, 2].map(|k| self.corners[cell][face[k]]));
            let distance = (q - p).norm_squared();
            if distance < best.0 {
                best = (distance, q);
            }
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generate::{box_mesh, kidney_mesh};
    use crate::{CellKind, Vector3};

    #[test]
    fn growing_cubes_of_bins_find_what_a_scan_of_all_cells_does() {
        let slab = box_mesh(
            CellKind::Tet4,
            Point3::origin(),
            Point3::new(0.9, 0.1, 0.03),
            [18, 2, 1],
            [1.0; 3],
            None,
        );
        for mesh in [kidney_mesh(CellKind::Tet4, 4).unwrap(), slab.unwrap()] {
            let cells = Locator::new(&mesh).unwrap();
            let [low, high] = [cells.low, cells.boxes.iter().fold(cells.low, |high, b| high.sup(&b[1]))];
            let middle = nalgebra::center(&low, &high);
            let extent = high - low;
            // Low-discrepancy points in three times the box, by multiples of irrational steps, and mesh nodes
            // moved by whole extents, which are equally close to several cells.
            let at =
                |q: usize, d: usize| ((q as f64 * [0.8191725, 0.6710436, 0.5497005][d]).fract() - 0.5) * 3.0;
            let scattered =
                (1..400).map(|q| middle + Vector3::from_fn(|d, _| at(q, d)).component_mul(&extent));
            let moved = mesh.points().iter().step_by(7).map(|p| p + Vector3::new(0.0, 0.0, 2.0 * extent.z));
            let mut scratch = Scratch::default();
            let mut outside = 0;
            for p in scattered.chain(moved).filter(|p| cells.holding(p).is_none()) {
                outside += 1;
                let found = cells.closest(&p, &mut scratch);
                let squares: Vec<f64> =
                    (0..mesh.cell_count()).map(|cell| cells.closest_on_cell(cell, &p).0).collect();
                let least = squares.iter().copied().fold(f64::INFINITY, f64::min);
                let lowest = squares.iter().position(|&square| square == least);
                assert_eq!((found.outside, Some(found.cell as usize)), (least.sqrt(), lowest), "{p}");
            }
            assert!(outside > 300, "{outside}");
        }
    }
}

//! Search for the cell that contains a point, and the reference coordinates in it: boxes on a grid, then the
//! inverse of the isoparametric map.

use geometry::{CellKind, Mesh, Point3, Vector3};

use crate::bounds::{Bounds, cell_bounds};
use crate::map::{Nodes, cofactors};
use geometry::element::{Element, with_element};

/// Largest distance outside its reference cell at which a point counts as inside, in reference units.
/// Rounding leaves points of a face some 1e-15 outside both its cells.
const INSIDE: f64 = 1e-9;

/// Place in a mesh: cell and reference coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Place {
    pub(crate) cell: usize,
    pub(crate) xi: [f64; 3],
}

/// Cell boxes sorted into the bins of a regular grid.
pub(crate) struct Locator<'a> {
    mesh: &'a Mesh,
    boxes: Vec<Bounds>,
    all: Bounds,
    bins: [usize; 3],
    /// Cells of bin `b`, ascending: `cells[starts[b]..starts[b + 1]]`.
    starts: Vec<usize>,
    cells: Vec<u32>,
}

impl<'a> Locator<'a> {
    pub(crate) fn new(mesh: &'a Mesh) -> Locator<'a> {
        let boxes: Vec<Bounds> = (0..mesh.cell_count()).map(|cell| cell_bounds(mesh, cell)).collect();
        let mut all = boxes[0];
        boxes.iter().for_each(|b| all.join(b));
        // About one bin per cell; a body that is flat along an axis gets one bin there.
        let extent: [f64; 3] = std::array::from_fn(|i| all.max[i] - all.min[i]);
        let volume: f64 = extent.iter().map(|e| e.max(1e-2 * all.diagonal())).product();
        let side = (volume / boxes.len() as f64).cbrt();
        // The saturating cast also turns 0 / 0 into one bin.
        let bins = extent.map(|e| ((e / side).ceil() as usize).clamp(1, 256));
        let mut locator = Locator { mesh, boxes, all, bins, starts: Vec::new(), cells: Vec::new() };
        locator.fill_bins();
        locator
    }

    /// Sorts the cells into all bins that their boxes touch (counting sort).
    fn fill_bins(&mut self) {
        let mut counts = vec![0; self.bins.iter().product::<usize>() + 1];
        for cell in 0..self.boxes.len() {
            self.for_bins(cell, |bin| counts[bin + 1] += 1);
        }
        for bin in 1..counts.len() {
            counts[bin] += counts[bin - 1];
        }
        let mut cells = vec![0; counts[counts.len() - 1]];
        let mut next = counts.clone();
        for cell in 0..self.boxes.len() {
            self.for_bins(cell, |bin| {
                cells[next[bin]] = cell as u32;
                next[bin] += 1;
            });
        }
        (self.starts, self.cells) = (counts, cells);
    }

    fn for_bins(&self, cell: usize, mut visit: impl FnMut(usize)) {
        let low: [usize; 3] = std::array::from_fn(|i| self.bin(i, self.boxes[cell].min[i]));
        let high: [usize; 3] = std::array::from_fn(|i| self.bin(i, self.boxes[cell].max[i]));
        for z in low[2]..=high[2] {
            for y in low[1]..=high[1] {
                for x in low[0]..=high[0] {
                    visit((z * self.bins[1] + y) * self.bins[0] + x);
                }
            }
        }
    }

    fn bin(&self, axis: usize, x: f64) -> usize {
        let share = (x - self.all.min[axis]) / (self.all.max[axis] - self.all.min[axis]);
        ((share * self.bins[axis] as f64) as usize).min(self.bins[axis] - 1)
    }

    /// Returns the place of a point in the cell of lowest index that contains it, or `None` outside the mesh.
    pub(crate) fn find(&self, p: &Point3) -> Option<Place> {
        if !self.all.contains(p) {
            return None;
        }
        let at: [usize; 3] = std::array::from_fn(|i| self.bin(i, p[i]));
        let bin = (at[2] * self.bins[1] + at[1]) * self.bins[0] + at[0];
        let candidates = || {
            let cells = &self.cells[self.starts[bin]..self.starts[bin + 1]];
            cells.iter().map(|&c| c as usize).filter(|&c| self.boxes[c].contains(p))
        };
        let from = |cell, start| {
            invert(self.mesh, cell, p, start)
                .filter(|&xi| (self.mesh.kind(cell).entry().cell.excess)(xi) <= INSIDE)
                .map(|xi| Place { cell, xi })
        };
        candidates()
            .find_map(|cell| from(cell, self.mesh.kind(cell).entry().cell.centre))
            // In a strongly distorted cell, Newton's method from the middle may leave the cell and miss: it
            // is repeated from near every node. Of 3000 hex20 (tet10) with all nodes shifted by up to 12 %
            // (15 %) of the edge, 19 (104) contained points that only the repetition finds; none were left
            // over.
            .or_else(|| {
                candidates().filter(|&cell| self.mesh.kind(cell) != CellKind::Tet4).find_map(|cell| {
                    let entry = self.mesh.kind(cell).entry();
                    let middle = entry.cell.centre;
                    entry.nodes.iter().find_map(|node| {
                        from(cell, std::array::from_fn(|i| middle[i] + 0.8 * (node[i] - middle[i])))
                    })
                })
            })
    }
}

/// Solves `x(xi) = p` in one cell by Newton's method with step halving, from `start`. Returns `None` if the
/// iteration leaves the neighbourhood of the reference cell, meets a singular Jacobian or stalls.
fn invert(mesh: &Mesh, cell: usize, p: &Point3, start: [f64; 3]) -> Option<[f64; 3]> {
    with_element!(mesh.kind(cell), E, N => newton::<E, N>(mesh, cell, p, start))
}

fn newton<E: Element<N>, const N: usize>(
    mesh: &Mesh,
    cell: usize,
    p: &Point3,
    start: [f64; 3],
) -> Option<[f64; 3]> {
    let x = Nodes::gather(mesh, &mesh.cell(cell).as_chunks::<N>().0[0]);
    let target = p - x.origin;
    let mut xi = start;
    let mut miss = target - x.offset(&E::shape(xi));
    for _ in 0..50 {
        let (det_j, c) = cofactors(&x.tangents(&E::shape_grad(xi)));
        let step: Vector3 = Vector3::from_fn(|k, _| c[k].dot(&miss) / det_j);
        // Fails for a NaN and for a singular Jacobian as well.
        if !step.iter().all(|s| s.abs() < 1e3) {
            return None;
        }
        let mut share = 1.0;
        loop {
            let trial = std::array::from_fn(|k| xi[k] + share * step[k]);
            let rest = target - x.offset(&E::shape(trial));
            // The square of a step this small is below rounding. The residual is noise by now and is not
            // tested.
            if step.amax() < 1e-8 {
                return Some(trial);
            }
            if rest.norm_squared() < miss.norm_squared() {
                (xi, miss) = (trial, rest);
                break;
            }
            share *= 0.5;
            if share < 1e-3 {
                return None;
            }
        }
        if (E::ENTRY.cell.excess)(xi) > 10.0 {
            return None;
        }
    }
    None
}

//! A cloud coupled to linear finite elements: hat functions of some background vertices, and the remaining
//! moments of the cloud.
//!
//! With the hats `N_h` of the listed vertices, the cloud's functions have the moments
//! `p(x) - sum_h N_h(x) p(x_h)` instead of `p(x)`. In a tetrahedron this is `sum_v N_v(x) p(x_v)` over its
//! unlisted corners. The functions therefore vanish, except for rounding, in cells without unlisted corners,
//! and towards faces without unlisted corners. In cells without listed corners they are plain moving least
//! squares. The hats are continuous, and so are all functions.
//!
//! If the vertices of a border between regions are listed, the cloud's functions vanish there from both
//! sides, and each side may have its own nodes: the field is continuous and its gradient may jump. Source:
//! Huerta and Fernandez-Mendez (2000), Int. J. Numer. Meth. Engng 48, 1615-1636.

use geometry::{CellKind, Locator, Mesh};
use shape::{Point3, Vector3};

use crate::error::EfgError;
use crate::mls::Moments;
use crate::row_list::RowList;

/// Marks a vertex that is not a finite-element node.
const NONE: u32 = u32::MAX;

/// Remainder of the partition of unity above which a node of the cloud is kept. A node on the constrained
/// surface would have a function that vanishes at the node and is negative around it. The volume of its
/// dilation group would not be positive. The same happens to nodes nearby (kidney, 1331 nodes: at a remainder
/// of 0.3).
const LEAST_SHARE: f64 = 0.5;

/// Returns the vertices shared by cells of two or more regions, ascending.
pub fn border_vertices(mesh: &Mesh) -> Vec<u32> {
    let mut first = vec![None; mesh.points().len()];
    let mut border = Vec::new();
    for cell in 0..mesh.cell_count() {
        let region = mesh.region(cell);
        for &vertex in mesh.cell(cell) {
            if *first[vertex as usize].get_or_insert(region) != region {
                border.push(vertex);
            }
        }
    }
    border.sort_unstable();
    border.dedup();
    border
}

/// Background cells with the corners that are finite-element nodes.
pub(crate) struct Coupling {
    locator: Locator,
    /// Region of each cell.
    regions: Vec<u16>,
    /// Index of each corner of each cell among the finite-element nodes, or [`NONE`].
    corners: Vec<[u32; 4]>,
}

/// Finite-element part of the shape functions at a point.
#[derive(Clone, Copy)]
pub(crate) struct Layer {
    count: usize,
    /// Index, value and gradient (1/m) of the first `count` hats, by ascending index.
    hats: [(u32, f64, Vector3); 4],
    /// Moments left to the cloud.
    pub(crate) moments: Moments,
    /// Region of the cell.
    pub(crate) region: u16,
}

/// Returns the node positions (m) of a cloud that is [coupled](crate::Approximation::coupled) to finite
/// elements. The nodes of the cloud come first, without the nodes at which the hat functions of the vertices
/// sum to one half or more. The vertices follow.
pub fn coupled_nodes(nodes: &[Point3], background: &Mesh, vertices: &[u32]) -> Result<Vec<Point3>, EfgError> {
    let kept = Coupling::new(background, vertices)?.kept(nodes)?;
    let of_cloud = kept.into_iter().map(|(n, _)| nodes[n]);
    Ok(of_cloud.chain(vertices.iter().map(|&v| background.points()[v as usize])).collect())
}

impl Layer {
    /// Whether the cell of the point has no finite-element node.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Whether all corners of the cell of the point are finite-element nodes, which leaves nothing to the
    /// cloud.
    pub fn is_full(&self) -> bool {
        self.count == 4
    }
}

impl Coupling {
    pub fn new(background: &Mesh, vertices: &[u32]) -> Result<Coupling, EfgError> {
        let mut number = vec![NONE; background.points().len()];
        for (index, &vertex) in vertices.iter().enumerate() {
            let ascending = index == 0 || vertices[index - 1] < vertex;
            match number.get_mut(vertex as usize) {
                Some(slot) if ascending => *slot = index as u32,
                _ => return Err(EfgError::BadVertex { vertex, count: background.points().len() }),
            }
        }
        let mut corners = Vec::with_capacity(background.cell_count());
        for cell in 0..background.cell_count() {
            let kind = background.kind(cell);
            if kind != CellKind::Tet4 {
                return Err(EfgError::CellKind { cell, kind, what: "coupling", allowed: "tet4" });
            }
            let nodes = background.cell(cell);
            corners.push([0, 1, 2, 3].map(|c| number[nodes[c] as usize]));
        }
        let regions = (0..background.cell_count()).map(|cell| background.region(cell)).collect();
        Ok(Coupling { locator: Locator::new(background)?, regions, corners })
    }

    /// Returns the indices of the cloud's nodes that are kept, because the hats sum to less than one half
    /// there, with their regions.
    pub fn kept(&self, nodes: &[Point3]) -> Result<Vec<(usize, u16)>, EfgError> {
        let mut layers = Vec::new();
        self.layers(nodes, &mut layers)?;
        let each = layers.iter().enumerate();
        let stays = |layer: &Layer| layer.moments.values[0] > LEAST_SHARE;
        Ok(each.filter(|(_, layer)| stays(layer)).map(|(n, layer)| (n, layer.region)).collect())
    }

    /// Replaces the contents of `layers` by the finite-element part of the shape functions at each point.
    pub fn layers(&self, points: &[Point3], layers: &mut Vec<Layer>) -> Result<(), EfgError> {
        layers.clear();
        let places = self.locator.locate(points)?;
        layers.extend(points.iter().zip(places).map(|(x, place)| self.layer(x, place.cell as usize)));
        Ok(())
    }

    /// Computes the finite-element part at a point in a cell or closest to the cell. Outside the cell the
    /// hats are extended linearly.
    fn layer(&self, x: &Point3, cell: usize) -> Layer {
        let region = self.regions[cell];
        let mut layer =
            Layer { count: 0, hats: [(NONE, 0.0, Vector3::zeros()); 4], moments: Moments::COMPLETE, region };
        if self.corners[cell] == [NONE; 4] {
            return layer;
        }
        let values = self.locator.barycentric(cell, x);
        let slopes = self.locator.slopes(cell);
        let mut left = Moments { values: [0.0; 4], slopes: [[0.0; 3]; 4] };
        for (corner, &index) in self.corners[cell].iter().enumerate() {
            let (value, slope) = (values[corner], slopes[corner]);
            if index != NONE {
                layer.hats[layer.count] = (index, value, slope);
                layer.count += 1;
                continue;
            }
            let e = self.locator.corners(cell)[corner] - x;
            for (i, p) in [1.0, e.x, e.y, e.z].into_iter().enumerate() {
                left.values[i] += value * p;
                for axis in 0..3 {
                    left.slopes[i][axis] += slope[axis] * p;
                }
            }
        }
        layer.hats[..layer.count].sort_unstable_by_key(|hat| hat.0);
        layer.moments = left;
        layer
    }
}

/// Returns the rows of the cloud's own functions, each followed by its hats, whose indices count from
/// `first`.
pub(crate) fn joined<const GRAD: bool>(rows: &RowList, layers: &[Layer], first: usize) -> RowList {
    let room = rows.nodes.len() + 4 * layers.len();
    let mut all = RowList::with_capacity(layers.len(), room, if GRAD { room } else { 0 });
    for (q, layer) in layers.iter().enumerate() {
        let range = rows.range(q);
        all.nodes.extend_from_slice(&rows.nodes[range.clone()]);
        all.values.extend_from_slice(&rows.values[range.clone()]);
        all.grads.extend_from_slice(if GRAD { &rows.grads[range] } else { &[] });
        for &(index, value, slope) in &layer.hats[..layer.count] {
            all.nodes.push(first as u32 + index);
            all.values.push(value);
            all.grads.extend(GRAD.then_some(slope));
        }
        all.close();
    }
    all
}

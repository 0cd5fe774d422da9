//! Node clouds: nodes without cells, each with a local spacing that support radii are multiples of.

mod error;
mod farthest;
mod generate;
mod read;
mod sizes;

pub use error::CloudError;
pub use generate::{Refinement, cloud, cloud_of_sizes};
pub use read::{PointFile, PointFileError, PointProblem, read_points, read_points_text};
pub use sizes::Sizes;

use rayon::prelude::*;

use crate::Point3;
use crate::mesh::Mesh;
use crate::search::Search;

/// Number of neighbours whose mean distance is the spacing of a node in a cloud without a mesh, close to the
/// number of edges at a node of a tetrahedral mesh.
const NEIGHBOURS: usize = 14;
/// Smallest number of nodes per parallel task.
const CHUNK: usize = 32;

/// Nodes and their local spacing.
#[derive(Clone, Debug, PartialEq)]
pub struct Cloud {
    /// Node positions (m).
    pub points: Vec<Point3>,
    /// Local spacing at each node (m): mean length of the mesh edges at the node, or mean distance to the 14
    /// nearest nodes (to all others, if there are fewer).
    pub spacing: Vec<f64>,
}

impl Cloud {
    /// Creates a cloud from nodes and computes each spacing as the mean distance to the nearest neighbours.
    ///
    /// # Errors
    /// Fewer than two nodes, a coordinate that is not finite, or two nodes at the same position.
    pub fn from_points(points: Vec<Point3>) -> Result<Cloud, CloudError> {
        if points.len() < 2 {
            return Err(CloudError::TooFew { nodes: points.len(), least: 2 });
        }
        let search = Search::new(&points)?;
        let of_node = |(node, p): (usize, &Point3)| {
            let near = search.nearest(p, NEIGHBOURS + 1);
            let others = || near.iter().filter(|n| n.index as usize != node).take(NEIGHBOURS);
            match others().next() {
                Some(other) if other.distance == 0.0 => {
                    let other = other.index as usize;
                    Err(CloudError::Coincident { first: node.min(other), second: node.max(other) })
                }
                _ => Ok(others().map(|n| n.distance).sum::<f64>() / others().count() as f64),
            }
        };
        let spacing: Vec<_> = points.par_iter().with_min_len(CHUNK).enumerate().map(of_node).collect();
        let spacing = spacing.into_iter().collect::<Result<Vec<f64>, CloudError>>()?;
        Ok(Cloud { points, spacing })
    }

    /// Returns a coarser cloud of `count` of the nodes, spread out: each is the farthest from those before
    /// it, relative to the spacing.
    ///
    /// # Errors
    /// Fewer than two nodes.
    pub fn thinned(&self, count: usize) -> Result<Cloud, CloudError> {
        let widest = self.spacing.iter().copied().fold(0.0, f64::max);
        let sized = self.points.iter().copied().zip(self.spacing.iter().map(|h| h / widest));
        let mut candidates = farthest::Farthest::new(sized, widest);
        let mut points = Vec::with_capacity(count);
        while points.len() < count.min(self.points.len())
            && let Some((next, _)) = candidates.farthest()
        {
            candidates.choose(&next);
            points.push(next);
        }
        Cloud::from_points(points)
    }
}

/// Nodes of a mesh as a cloud. The spacing at a node (m) is the mean length of the edges that meet there. An
/// edge of a quadratic cell counts as its two halves. A node that no cell uses gets the spacing 0.
pub fn cloud_from_mesh(mesh: &Mesh) -> Cloud {
    let points = mesh.points();
    let (mut total, mut count) = (vec![0.0; points.len()], vec![0u32; points.len()]);
    for (a, b) in edges(mesh) {
        let length = nalgebra::distance(&points[a as usize], &points[b as usize]);
        for node in [a as usize, b as usize] {
            total[node] += length;
            count[node] += 1;
        }
    }
    let spacing = total.iter().zip(&count).map(|(t, &n)| t / f64::from(n.max(1))).collect();
    Cloud { points: points.to_vec(), spacing }
}

/// Edges of the mesh as pairs of nodes, lower node first. Each edge occurs once, in ascending order. An edge
/// of a quadratic cell counts as its two halves.
pub fn edges(mesh: &Mesh) -> Vec<(u32, u32)> {
    let mut edges: Vec<(u32, u32)> = Vec::new();
    for cell in 0..mesh.cell_count() {
        let (kind, nodes) = (mesh.kind(cell), mesh.cell(cell));
        let mut add = |a: u32, b: u32| edges.push((a.min(b), a.max(b)));
        for (edge, &[a, b]) in kind.edges().iter().enumerate() {
            if kind.order() == 2 {
                let middle = nodes[kind.corner_count() + edge];
                add(nodes[a], middle);
                add(middle, nodes[b]);
            } else {
                add(nodes[a], nodes[b]);
            }
        }
    }
    edges.sort_unstable();
    edges.dedup();
    edges
}

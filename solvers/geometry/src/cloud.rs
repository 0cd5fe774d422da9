//! Node clouds: nodes without cells, each with the local spacing that supports are measured in.

mod farthest;
mod generate;
mod read;
mod sizes;

pub use generate::{CloudError, Refinement, cloud, cloud_of_sizes};
pub use read::{PointFile, PointFileError, PointProblem, read_points, read_points_text};
pub use sizes::Sizes;

use rayon::prelude::*;

use crate::{Mesh, Point3, Search};

/// Neighbours whose mean distance is the spacing of a node in a cloud without a mesh: about as many as a node of a
/// tetrahedral mesh has edges.
const NEIGHBOURS: usize = 14;
/// Nodes per parallel task at least.
const CHUNK: usize = 32;

/// Nodes and their local spacing.
#[derive(Clone, Debug, PartialEq)]
pub struct Cloud {
    /// Node positions (m).
    pub points: Vec<Point3>,
    /// Local spacing at each node (m): mean length of the mesh edges that meet there, or mean distance to the 14
    /// nearest nodes (all others, if there are fewer).
    pub spacing: Vec<f64>,
}

impl Cloud {
    /// Takes the nodes as they are and measures the spacing by nearest neighbours.
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
}

/// The nodes of a mesh, spacing = mean length of the edges that meet at each. In quadratic cells an edge counts as
/// its two halves. A node that no cell uses gets the spacing 0.
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

/// Every edge of the mesh once, by ascending nodes, the lower one first. In quadratic cells an edge counts as its two halves.
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

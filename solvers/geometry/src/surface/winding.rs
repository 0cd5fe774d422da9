//! Winding numbers of triangles that need not be closed: how often they surround a position (Jacobson, Kavan
//! and Sorkine-Hornung 2013). Boxes of triangles far away act as a dipole (Barill et al. 2018).

use std::f64::consts::PI;

use super::tree::{Node, Tree};
use crate::{Point3, Vector3};

/// Distance from a box, over the radius of its triangles, beyond which the box acts as a dipole. The errors
/// are then below 0.01.
const FAR: f64 = 2.5;

/// A tree of triangles with the dipoles of its boxes.
pub(super) struct Winding {
    tree: Tree,
    dipoles: Vec<Dipole>,
}

struct Dipole {
    /// Sum of the areas times the normals over `4 pi`, m^2.
    moment: Vector3,
    /// Centre of area.
    at: Point3,
    /// Square of the distance beyond which the dipole is used, m^2.
    beyond: f64,
}

impl Winding {
    pub(super) fn new(tree: Tree) -> Winding {
        let mut sums = vec![(Vector3::zeros(), Vector3::zeros(), 0.0); tree.nodes.len()];
        let mut dipoles = Vec::with_capacity(tree.nodes.len());
        // Children follow their parents.
        for (k, node) in tree.nodes.iter().enumerate().rev() {
            let first = node.start as usize;
            sums[k] = match node.count {
                0 => add(sums[first], sums[first + 1]),
                count => tree.corners[first..first + count as usize].iter().map(weighed).fold(sums[k], add),
            };
            let (moment, weighted, area) = sums[k];
            let middle = nalgebra::center(&node.low, &node.high);
            let at = if area > 0.0 { Point3::from(weighted / area) } else { middle };
            let beyond = (FAR * farthest(node, &at)).powi(2);
            dipoles.push(Dipole { moment: moment / (4.0 * PI), at, beyond });
        }
        dipoles.reverse();
        Winding { tree, dipoles }
    }

    pub(super) fn tree(&self) -> &Tree {
        &self.tree
    }

    /// Winding number of a position: 1 inside a closed surface, 0 outside, and between where it is open.
    pub(super) fn at(&self, p: &Point3) -> f64 {
        let (mut far, mut near) = (0.0, 0.0);
        let mut open = vec![0u32];
        while let Some(k) = open.pop() {
            let (node, dipole) = (&self.tree.nodes[k as usize], &self.dipoles[k as usize]);
            let line = dipole.at - p;
            let square = line.norm_squared();
            if square > dipole.beyond {
                far += dipole.moment.dot(&line) / (square * square.sqrt());
            } else if node.count == 0 {
                open.extend([node.start, node.start + 1]);
            } else {
                let slots = node.start as usize..(node.start + node.count) as usize;
                near += self.tree.corners[slots].iter().map(|t| solid_angle(t, p)).sum::<f64>();
            }
        }
        far + near / (4.0 * PI)
    }
}

type Sum = (Vector3, Vector3, f64);

fn add(a: Sum, b: Sum) -> Sum {
    (a.0 + b.0, a.1 + b.1, a.2 + b.2)
}

/// Area times normal, centre times area, and area of a triangle.
fn weighed([a, b, c]: &[Point3; 3]) -> Sum {
    let normal = 0.5 * (b - a).cross(&(c - a));
    let area = normal.norm();
    (normal, (a.coords + b.coords + c.coords) * (area / 3.0), area)
}

/// Distance from a position in a box to the farthest corner of the box.
fn farthest(node: &Node, at: &Point3) -> f64 {
    (at - node.low).abs().zip_map(&(node.high - at).abs(), f64::max).norm()
}

/// Solid angle of a triangle seen from a position, positive from inside (van Oosterom and Strackee 1983).
pub(super) fn solid_angle(corners: &[Point3; 3], p: &Point3) -> f64 {
    let [a, b, c] = corners.map(|q| q - p);
    let [x, y, z] = [a, b, c].map(|v| v.norm());
    let below = x * y * z + a.dot(&b) * z + b.dot(&c) * x + c.dot(&a) * y;
    2.0 * a.dot(&b.cross(&c)).atan2(below)
}

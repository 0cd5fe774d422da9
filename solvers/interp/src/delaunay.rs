//! Delaunay tetrahedralisation of a cloud, by insertion (Bowyer 1981, Watson 1981) with exact predicates
//! (Shewchuk 1997). Lattices, in which every sphere passes through more than four nodes, need no special
//! treatment.

use robust::{Coord3D, insphere, orient3d};
use shape::Point3;

/// Index for "no tetrahedron" (beyond the hull) and for the vertex at infinity.
pub(crate) const NONE: u32 = u32::MAX;

/// Corners of the face opposite corner `k`, oriented so that corner `k` lies on its positive side.
pub(crate) const FACES: [[usize; 3]; 4] = [[1, 3, 2], [0, 2, 3], [0, 3, 1], [0, 1, 2]];

/// Tetrahedra that fill the convex hull of the nodes, with no node inside a circumsphere.
pub(crate) struct Delaunay {
    /// Corners, positive in the sense of `orient3d`.
    pub(crate) cells: Vec<[u32; 4]>,
    /// Cell across the face opposite each corner, or [`NONE`].
    pub(crate) neighbours: Vec<[u32; 4]>,
}

/// Reason why there is no tetrahedralisation.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Degenerate {
    /// Two nodes at the same place, lower index first.
    Coincident(u32, u32),
    /// All nodes in one plane.
    Flat,
}

impl Delaunay {
    /// Builds the tetrahedralisation of at least four finite positions.
    pub(crate) fn new(nodes: &[Point3]) -> Result<Delaunay, Degenerate> {
        let mut mesh = Insertion::new(nodes)?;
        for node in shuffled(nodes.len()) {
            mesh.insert(node)?;
        }
        Ok(mesh.finite())
    }
}

/// Returns all nodes in a fixed random order, which minimises the expected work for any input order.
fn shuffled(n: usize) -> impl Iterator<Item = u32> {
    // The mixing step of SplitMix64 (Steele, Lea and Flood 2014) is a bijection, so all keys differ.
    let key = |i: u64| {
        let mut z = i.wrapping_add(0x9e37_79b9_7f4a_7c15);
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    };
    let mut order: Vec<u32> = (0..n as u32).collect();
    order.sort_by_cached_key(|&i| key(i as u64));
    order.into_iter()
}

/// The growing mesh. Its hull is closed by ghosts, i.e. tetrahedra with a corner at infinity ([`NONE`]), so
/// every face has a neighbour.
struct Insertion {
    at: Vec<Coord3D<f64>>,
    cells: Vec<[u32; 4]>,
    neighbours: Vec<[u32; 4]>,
    /// Stamp of the last insertion for which the cell was tested; odd if the cell was in conflict.
    seen: Vec<u32>,
    stamp: u32,
    free: Vec<u32>,
    /// A finite cell at which the next walk starts.
    last: u32,
    cavity: Vec<u32>,
    rim: Vec<(u32, usize)>,
    open: Vec<([u32; 2], u32, usize)>,
}

impl Insertion {
    /// Builds the first tetrahedron and its four ghosts.
    fn new(nodes: &[Point3]) -> Result<Insertion, Degenerate> {
        let at: Vec<Coord3D<f64>> = nodes.iter().map(|p| Coord3D { x: p.x, y: p.y, z: p.z }).collect();
        let farthest = |size: &dyn Fn(&Point3) -> f64| {
            (0..nodes.len()).max_by(|&a, &b| size(&nodes[a]).total_cmp(&size(&nodes[b]))).unwrap_or(0)
        };
        let origin = nodes[0];
        let b = farthest(&|p| (p - origin).norm_squared());
        let c = farthest(&|p| (p - origin).cross(&(nodes[b] - origin)).norm_squared());
        let side = |d: usize| orient3d(at[0], at[b], at[c], at[d]);
        let d = farthest(&|p| (p - origin).dot(&(nodes[b] - origin).cross(&(nodes[c] - origin))).abs());
        let [b, c, d] = match side(d) {
            s if s > 0.0 => [b, c, d],
            s if s < 0.0 => [c, b, d],
            _ => return Err(Degenerate::Flat),
        };
        let first = [0, b as u32, c as u32, d as u32];
        let mut cells = vec![first];
        let mut neighbours = vec![[1, 2, 3, 4]];
        for k in 0..4 {
            let [p, q, r] = FACES[k].map(|i| first[i]);
            cells.push([p, r, q, NONE]);
            // The ghost across face `k` touches the ghost across face `j` at the face that lacks corner `j`.
            let beside = [p, r, q].map(|v| 1 + first.iter().position(|&w| w == v).unwrap_or(0) as u32);
            neighbours.push([beside[0], beside[1], beside[2], 0]);
        }
        Ok(Insertion {
            at,
            cells,
            neighbours,
            seen: vec![0; 5],
            stamp: 0,
            free: Vec::new(),
            last: 0,
            cavity: Vec::new(),
            rim: Vec::new(),
            open: Vec::new(),
        })
    }

    fn insert(&mut self, node: u32) -> Result<(), Degenerate> {
        let start = self.locate(node);
        for &corner in self.cells[start as usize].iter().filter(|&&v| v != NONE) {
            if corner == node {
                return Ok(());
            }
            if self.at[corner as usize] == self.at[node as usize] {
                return Err(Degenerate::Coincident(corner.min(node), corner.max(node)));
            }
        }
        self.empty(start, node);
        self.fill(node);
        Ok(())
    }

    /// Walks towards the node, through any face that separates it from the cell, and returns the cell that
    /// contains the node or a ghost that sees it. The walk terminates because the circumspheres of a Delaunay
    /// mesh are ordered along it (Edelsbrunner 1990).
    fn locate(&self, node: u32) -> u32 {
        let mut cell = self.last;
        'walk: loop {
            let corners = self.cells[cell as usize];
            if corners.contains(&NONE) {
                return cell;
            }
            for k in 0..4 {
                if self.side(corners, k, node) < 0.0 {
                    cell = self.neighbours[cell as usize][k];
                    continue 'walk;
                }
            }
            return cell;
        }
    }

    /// Returns a positive number if the node lies on the inner side of face `k`.
    fn side(&self, corners: [u32; 4], k: usize, node: u32) -> f64 {
        let [a, b, c] = FACES[k].map(|i| self.at[corners[i] as usize]);
        orient3d(a, b, c, self.at[node as usize])
    }

    /// Whether the circumsphere contains the node, inside or on the sphere.
    ///
    /// The test is exact, so every face of the cavity has the node strictly on its inner side. Of two cells
    /// at a face, the node is on the side of the cell whose sphere contains it more deeply. The ball of a
    /// ghost is the half-space beyond its face and, in the plane of the face, the disc of the face.
    fn conflict(&self, cell: u32, node: u32) -> bool {
        let corners = self.cells[cell as usize];
        match corners.iter().position(|&v| v == NONE) {
            None => {
                let [a, b, c, d] = corners.map(|v| self.at[v as usize]);
                insphere(a, b, c, d, self.at[node as usize]) >= 0.0
            }
            Some(k) => match self.side(corners, k, node) {
                0.0 => self.conflict(self.neighbours[cell as usize][k], node),
                s => s > 0.0,
            },
        }
    }

    /// Collects the cells in conflict, starting from one of them, and the faces around them.
    fn empty(&mut self, start: u32, node: u32) {
        self.stamp += 2;
        let out = self.stamp;
        let within = self.stamp + 1;
        self.cavity.clear();
        self.rim.clear();
        self.cavity.push(start);
        self.seen[start as usize] = within;
        let mut next = 0;
        while next < self.cavity.len() {
            let cell = self.cavity[next];
            next += 1;
            for k in 0..4 {
                let across = self.neighbours[cell as usize][k];
                if self.seen[across as usize] < out {
                    if self.conflict(across, node) {
                        self.seen[across as usize] = within;
                        self.cavity.push(across);
                        continue;
                    }
                    self.seen[across as usize] = out;
                }
                if self.seen[across as usize] == out {
                    self.rim.push((cell, k));
                }
            }
        }
    }

    /// Connects every face of the rim with the node.
    fn fill(&mut self, node: u32) {
        self.open.clear();
        let rim = std::mem::take(&mut self.rim);
        let mut freed = std::mem::take(&mut self.free);
        for &(cell, k) in &rim {
            let [a, b, c] = FACES[k].map(|i| self.cells[cell as usize][i]);
            let across = self.neighbours[cell as usize][k];
            let new = freed.pop().unwrap_or(self.cells.len() as u32);
            if new as usize == self.cells.len() {
                self.cells.push([0; 4]);
                self.neighbours.push([NONE; 4]);
                self.seen.push(0);
            }
            self.cells[new as usize] = [a, b, c, node];
            self.neighbours[new as usize][3] = across;
            let back = self.neighbours[across as usize].iter().position(|&n| n == cell);
            if let Some(back) = back {
                self.neighbours[across as usize][back] = new;
            }
            for (slot, edge) in [[b, c], [c, a], [a, b]].into_iter().enumerate() {
                let edge = [edge[0].min(edge[1]), edge[0].max(edge[1])];
                match self.open.iter().position(|(other, ..)| *other == edge) {
                    Some(found) => {
                        let (_, other, side) = self.open.swap_remove(found);
                        self.neighbours[other as usize][side] = new;
                        self.neighbours[new as usize][slot] = other;
                    }
                    None => self.open.push((edge, new, slot)),
                }
            }
            if ![a, b, c].contains(&NONE) {
                self.last = new;
            }
        }
        freed.append(&mut self.cavity);
        self.free = freed;
        self.rim = rim;
    }

    /// Returns the mesh without ghosts and freed cells.
    fn finite(self) -> Delaunay {
        let mut kept = vec![true; self.cells.len()];
        self.free.iter().for_each(|&cell| kept[cell as usize] = false);
        let kept = |cell: usize| kept[cell] && !self.cells[cell].contains(&NONE);
        let list: Vec<usize> = (0..self.cells.len()).filter(|&cell| kept(cell)).collect();
        let mut index = vec![NONE; self.cells.len()];
        list.iter().zip(0..).for_each(|(&cell, new)| index[cell] = new);
        Delaunay {
            cells: list.iter().map(|&cell| self.cells[cell]).collect(),
            neighbours: list.iter().map(|&cell| self.neighbours[cell].map(|n| index[n as usize])).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lattice(n: usize, spacing: f64) -> Vec<Point3> {
        let at = |i: usize| Point3::new((i % n) as f64, (i / n % n) as f64, (i / n / n) as f64) * spacing;
        (0..n * n * n).map(at).collect()
    }

    fn scattered(n: usize) -> Vec<Point3> {
        (0..n)
            .map(|i| {
                let t = i as f64;
                Point3::new((12.9 * t).sin(), (78.2 * t).cos() * (3.1 * t).sin(), (37.7 * t + 1.0).sin())
            })
            .collect()
    }

    /// Checks that neighbours are mutual, that cells are positive and fill the volume, and that no sphere
    /// contains a node.
    fn check(nodes: &[Point3], volume: Option<f64>) {
        let mesh = Delaunay::new(nodes).unwrap();
        let at = |v: u32| nodes[v as usize];
        let coordinate = |v: u32| Coord3D { x: at(v).x, y: at(v).y, z: at(v).z };
        let mut used = vec![false; nodes.len()];
        let mut sum = 0.0;
        for (cell, corners) in mesh.cells.iter().enumerate() {
            let [a, b, c, d] = corners.map(coordinate);
            assert!(orient3d(a, b, c, d) > 0.0);
            corners.iter().for_each(|&v| used[v as usize] = true);
            sum += (at(corners[0]) - at(corners[3]))
                .dot(&(at(corners[1]) - at(corners[3])).cross(&(at(corners[2]) - at(corners[3]))))
                / 6.0;
            for node in 0..nodes.len() as u32 {
                assert!(insphere(a, b, c, d, coordinate(node)) <= 0.0, "{corners:?} {node}");
            }
            for k in 0..4 {
                let across = mesh.neighbours[cell][k];
                if across != NONE {
                    let back = mesh.neighbours[across as usize].iter().position(|&n| n == cell as u32);
                    let back = back.unwrap();
                    let face = |corners: [u32; 4], k: usize| {
                        let mut face = FACES[k].map(|i| corners[i]);
                        face.sort_unstable();
                        face
                    };
                    assert_eq!(face(*corners, k), face(mesh.cells[across as usize], back));
                }
            }
        }
        assert!(used.iter().all(|&u| u));
        if let Some(volume) = volume {
            assert!((sum / volume - 1.0).abs() < 1e-12, "{sum} {volume}");
        }
    }

    #[test]
    fn lattices_and_scattered_clouds() {
        check(&lattice(2, 1e-3), Some(1e-9));
        check(&lattice(5, 0.7e-3), Some((4.0 * 0.7e-3f64).powi(3)));
        check(&scattered(120), None);
        // A rotated lattice: spheres through many nodes, except for rounding.
        let turn = nalgebra::Rotation3::from_euler_angles(0.3, 0.7, -0.4);
        check(&lattice(4, 1.0).iter().map(|p| turn * p).collect::<Vec<_>>(), Some(27.0));
        // Nodes in a plane, and one node outside of it.
        let mut plane = lattice(4, 1.0);
        plane.truncate(16);
        plane.push(Point3::new(1.3, 1.4, 0.7));
        check(&plane, Some(9.0 * 0.7 / 3.0));
    }

    #[test]
    fn nodes_in_a_plane_or_in_one_place_are_refused() {
        let flat = &lattice(4, 1.0)[..16];
        assert_eq!(Delaunay::new(flat).err(), Some(Degenerate::Flat));
        assert_eq!(Delaunay::new(&flat[..4]).err(), Some(Degenerate::Flat));
        let mut twice = lattice(3, 0.1);
        twice.push(twice[11]);
        assert_eq!(Delaunay::new(&twice).err(), Some(Degenerate::Coincident(11, 27)));
    }
}

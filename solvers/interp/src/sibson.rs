//! Sibson coordinates in a Delaunay mesh.
//!
//! A point inserted into the cloud takes the volume `V_i` from the Voronoi cell of each natural neighbour `i`
//! (Sibson 1980). `V_i` is the volume of the cell before minus the volume after the insertion. A Voronoi cell
//! is the sum of one share of every tetrahedron at its node: the signed part of the tetrahedron that is
//! closer to the node than to the other corners, bounded by the perpendiculars from the circumcentre. `V_i`
//! is therefore a difference of two sums of shares. The first sum is over the tetrahedra whose circumsphere
//! contains the point, and is known in advance. The second is over the tetrahedra that the point forms with
//! the faces around them. No Voronoi cell is ever built.

use lanes::LANES;
use nalgebra::Matrix3;
use shape::{Point3, Vector3};

use crate::circumcentre::circumcentre;
use crate::delaunay::{Delaunay, FACES, NONE};
use crate::hull::DEPTH;
use crate::lanes::Lanes;

/// Tolerance of circumspheres: a sphere also contains points beyond it by up to half of this fraction of the
/// tetrahedron's size. The error of the resulting volumes is of third order in this tolerance. A point of a
/// lattice that lies on many spheres is then inside all of them, despite rounding.
const CLOSED: f64 = 1e-9;
/// Largest distance from a point to the mean of its neighbours, relative to the half-extent of the cloud,
/// that is corrected as rounding.
const PRECISION: f64 = 1e-6;
/// Distance below which no correction is needed.
const EXACT: f64 = 1e-14;
/// Coordinate scale of the weights of a linear fit. Coordinates far below it have proportional weights,
/// coordinates far above it have equal weights. Beneath the hull, all coordinates except those of its own
/// nodes are of the order of the depth.
const FADE: f64 = DEPTH;

/// A tetrahedralised cloud of half-extent 1 around the origin, with all data that do not depend on a target.
pub(crate) struct Voronoi {
    nodes: Vec<Point3>,
    cells: Vec<Cell>,
    /// Faces, four per cell.
    faces: Vec<Face>,
}

/// A tetrahedron.
struct Cell {
    corners: [u32; 4],
    /// Cell across each face, or the number of cells if there is none.
    neighbours: [u32; 4],
    /// Circumspheres of the neighbours, which are tested together.
    around: Spheres<4>,
    /// Planes of the faces, `n . x - d`, positive on the side of the cell; always positive for faces on the
    /// hull.
    walls: [Lanes<4>; 4],
    /// Three times the share of each corner in the volume.
    shares: [f64; 4],
}

/// Circumspheres of tetrahedra.
#[derive(Clone, Copy)]
struct Spheres<const N: usize> {
    /// First corners.
    origin: [Lanes<N>; 3],
    /// Twice the circumcentres, relative to the first corners.
    centre: [Lanes<N>; 3],
    /// [`CLOSED`] times size times circumradius.
    reach: Lanes<N>,
}

/// A face, in the order of its corners in [`FACES`].
#[repr(align(64))] // one cache line
struct Face {
    nodes: [u32; 3],
    /// Normal with the length of twice the area; the cell is on its positive side.
    normal: Vector3,
    /// Shares of the corners in the triangle's area, divided by `|normal|`. Multiplied by the height of a
    /// circumcentre along the normal, they give the contribution to three times a corner's share of the
    /// tetrahedron.
    shares: [f64; 3],
}

/// Buffers for a target, reused from target to target.
pub(crate) struct Workspace {
    /// Natural neighbours.
    pub(crate) nodes: Vec<u32>,
    /// Coordinates of the natural neighbours.
    pub(crate) values: Vec<f64>,
    /// Whether rounding spoiled the volumes. The coordinates are then those of the linear field that best
    /// fits the neighbours.
    pub(crate) fallback: bool,
    weights: Vec<f64>,
    volumes: Vec<f64>,
    listed: Vec<bool>,
    seen: Vec<u32>,
    stamp: u32,
    /// Opened cells: the first `cells` entries of a list that never shrinks and is overwritten for the next
    /// target.
    cavity: Vec<u32>,
    cells: usize,
    /// Faces around the opened cells, in the same form.
    rim: Vec<u32>,
    faces: usize,
    last: u32,
}

impl Workspace {
    pub(crate) fn new(voronoi: &Voronoi) -> Workspace {
        let (nodes, cells) = (voronoi.nodes.len(), voronoi.cells.len());
        Workspace {
            nodes: Vec::new(),
            values: Vec::new(),
            fallback: false,
            weights: Vec::new(),
            volumes: vec![0.0; nodes],
            listed: vec![false; nodes],
            // An additional entry for the outside of the hull.
            seen: vec![0; cells + 1],
            stamp: 0,
            cavity: vec![0; 64],
            cells: 0,
            rim: vec![0; 64],
            faces: 0,
            last: 0,
        }
    }
}

impl Voronoi {
    /// Prepares a cloud whose nodes surround the origin and have coordinates of order 1.
    pub(crate) fn new(nodes: Vec<Point3>, mesh: &Delaunay) -> Voronoi {
        let count = mesh.cells.len();
        let (mut spheres, mut faces) = (Vec::with_capacity(count + 1), Vec::with_capacity(4 * count));
        let mut shares = vec![[0.0; 4]; count];
        for (corners, shares) in mesh.cells.iter().zip(&mut shares) {
            let at = corners.map(|v| nodes[v as usize]);
            let centre = circumcentre(&at);
            for corner in FACES {
                let face = Face::new(corner.map(|i| corners[i]), corner.map(|i| at[i]));
                let height = (centre - (at[corner[0]] - at[0])).dot(&face.normal);
                for (i, share) in corner.into_iter().zip(face.shares) {
                    shares[i] += height * share;
                }
                faces.push(face);
            }
            let size = at.iter().map(|x| (x - at[0]).norm()).fold(0.0, f64::max);
            spheres.push((at[0].coords, 2.0 * centre, CLOSED * size * centre.norm()));
        }
        // There is no sphere beyond the hull.
        spheres.push((Vector3::zeros(), Vector3::zeros(), f64::NEG_INFINITY));
        let cells = (mesh.cells.iter().zip(&mesh.neighbours).zip(shares).zip(faces.as_chunks::<4>().0))
            .map(|(((&corners, neighbours), shares), faces)| {
                let mut walls = [Lanes::all(0.0); 4];
                walls[3] = Lanes::all(f64::NEG_INFINITY);
                for k in (0..4).filter(|&k| neighbours[k] != NONE) {
                    let face: &Face = &faces[k];
                    (0..3).for_each(|axis| walls[axis].0[k] = face.normal[axis]);
                    walls[3].0[k] = face.normal.dot(&nodes[face.nodes[0] as usize].coords);
                }
                let neighbours = neighbours.map(|n| if n == NONE { count as u32 } else { n });
                Cell {
                    corners,
                    neighbours,
                    around: Spheres::new(neighbours.map(|n| &spheres[n as usize])),
                    walls,
                    shares,
                }
            })
            .collect();
        Voronoi { nodes, cells, faces }
    }

    /// Computes the coordinates of a point inside the hull. If `inner` is given, its coordinates are computed
    /// instead, and the point takes the linear field that best fits the neighbours of `inner`.
    #[inline(always)]
    pub(crate) fn coordinates(&self, x: &Point3, inner: Option<&Point3>, at: &mut Workspace) {
        let inside = inner.unwrap_or(x);
        at.nodes.clear();
        at.values.clear();
        at.fallback = false;
        let cell = self.locate(inside, at.last);
        at.last = cell;
        let corners = self.cells[cell as usize].corners;
        if let Some(&node) = corners.iter().find(|&&v| self.nodes[v as usize] == *x) {
            at.nodes.push(node);
            at.values.push(1.0);
            return;
        }
        self.open(inside, cell, at);
        self.volumes(inside, at);
        let total: f64 = at.values.iter().sum();
        at.values.iter_mut().for_each(|v| *v /= total);
        let gap = self.gap(inside, at);
        // The form of the test also rejects NaN.
        if !(gap.norm() < PRECISION) {
            at.values.fill(1.0 / at.nodes.len() as f64);
            at.fallback = true;
        }
        self.extend(x, at);
    }

    /// Returns the vector from the point to the weighted mean of its neighbours, which is zero except for
    /// rounding (Sibson 1980).
    #[inline(always)]
    fn gap(&self, x: &Point3, at: &Workspace) -> Vector3 {
        // Loops here and below, because closures of sums would not be inlined and not be compiled for wide
        // registers.
        let mut gap = Vector3::zeros();
        for (&node, &value) in at.nodes.iter().zip(&at.values) {
            gap += (self.nodes[node as usize] - x) * value;
        }
        gap
    }

    /// Returns the cell that contains the point, by a walk that always crosses the face beyond which the
    /// point is farthest. The circumsphere of this cell then also contains the point.
    #[inline(always)]
    fn locate(&self, x: &Point3, start: u32) -> u32 {
        let mut cell = start;
        for _ in 0..self.cells.len() {
            let Cell { walls: [x_of, y_of, z_of, from], neighbours, .. } = &self.cells[cell as usize];
            let mut deepest = (0.0, cell);
            for k in 0..4 {
                let height = x_of.0[k] * x.x + y_of.0[k] * x.y + z_of.0[k] * x.z - from.0[k];
                deepest = if height < deepest.0 { (height, neighbours[k]) } else { deepest };
            }
            if deepest.1 == cell {
                break;
            }
            cell = deepest.1;
        }
        // A flat cell may seem to contain any point of its plane, or make the walk circular.
        let sphere_holds = |cell: &u32| {
            let across = self.cells[*cell as usize].neighbours;
            let seen_from = across.into_iter().find(|&n| (n as usize) < self.cells.len());
            seen_from.is_none_or(|from| {
                let Cell { neighbours, around, .. } = &self.cells[from as usize];
                neighbours.iter().zip(around.hold(x)).any(|(n, holds)| n == cell && holds)
            })
        };
        if sphere_holds(&cell) {
            return cell;
        }
        (0..self.cells.len() as u32).find(sphere_holds).unwrap_or(cell)
    }

    /// Collects the cells whose circumsphere contains the point, and the rim of faces around them. All rim
    /// faces have the point on their inner side: of two cells at a face, the point is on the side of the cell
    /// whose sphere contains it more deeply.
    ///
    /// Every neighbour is written to both lists and counted in one, because inside and outside are equally
    /// frequent and a branch would be mispredicted.
    #[inline(always)]
    fn open(&self, x: &Point3, start: u32, at: &mut Workspace) {
        at.stamp = match at.stamp.checked_add(1) {
            Some(stamp) => stamp,
            None => {
                at.seen.fill(0);
                1
            }
        };
        at.seen[start as usize] = at.stamp;
        let Workspace { cavity, rim, seen, stamp, .. } = at;
        cavity[0] = start;
        let (mut next, mut cells, mut faces) = (0, 1, 0);
        while next < cells {
            let cell = cavity[next];
            next += 1;
            grow(cavity, cells + 4);
            grow(rim, faces + 4);
            let (found, open) = (&mut cavity[cells..cells + 4], &mut rim[faces..faces + 4]);
            let (mut new, mut closed) = (0, 0);
            let Cell { neighbours, around, .. } = &self.cells[cell as usize];
            let holds = around.hold(x);
            for k in 0..4 {
                let seen = &mut seen[neighbours[k] as usize];
                let known = *seen == *stamp;
                let within = holds[k] | known;
                *seen = if within { *stamp } else { *seen };
                // At most `k` are counted so far.
                found[new % 4] = neighbours[k];
                new += usize::from(holds[k] & !known);
                open[closed % 4] = 4 * cell + k as u32;
                closed += usize::from(!within);
            }
            cells += new;
            faces += closed;
        }
        (at.cells, at.faces) = (cells, faces);
    }

    /// Computes three times the volumes that the point takes from its neighbours.
    #[inline(always)]
    fn volumes(&self, x: &Point3, at: &mut Workspace) {
        for &cell in &at.cavity[..at.cells] {
            let Cell { corners, shares, .. } = &self.cells[cell as usize];
            let listed = at.nodes.len();
            at.nodes.extend_from_slice(corners);
            let mut new = 0;
            for (&node, share) in corners.iter().zip(shares) {
                at.nodes[listed + new % 4] = node;
                new += usize::from(!std::mem::replace(&mut at.listed[node as usize], true));
                at.volumes[node as usize] += share;
            }
            at.nodes.truncate(listed + new);
        }
        for group in at.rim[..at.faces].chunks(LANES) {
            // Lanes beyond the last face repeat it and are not read.
            let mut tets = Tetrahedra::new();
            let mut nodes = [[0; 3]; LANES];
            for lane in 0..LANES {
                let face = &self.faces[group[lane.min(group.len() - 1)] as usize];
                nodes[lane] = face.nodes;
                tets.set(lane, face, face.nodes.map(|v| self.nodes[v as usize] - x));
            }
            let shares = tets.shares();
            for (lane, nodes) in nodes.iter().enumerate().take(group.len()) {
                for (&node, share) in nodes.iter().zip(&shares) {
                    at.volumes[node as usize] -= share.0[lane];
                }
            }
        }
        for &node in &at.nodes {
            at.values.push(std::mem::take(&mut at.volumes[node as usize]));
            at.listed[node as usize] = false;
        }
    }

    /// Extends the coordinates to a point away from the mean of the neighbours, by the linear field that best
    /// fits their values.
    ///
    /// The fit has the weights `omega_i = lambda_i / (lambda_i + FADE)`:
    /// `lambda_i + omega_i (x - sum_j lambda_j x_j) . M^-1 (x_i - m)`, with the weighted mean `m` and second
    /// moment `M` of the neighbours. The extension is repeated twice, so linear fields are exact to the last
    /// digits for any distance of the point and any rounding of the volumes.
    ///
    /// Sibson (1981) uses the weights `lambda_i / |x_i - x|^2`. On an almost flat hull the slope across the
    /// hull is then determined by the neighbours just beneath it. At a tenth of the kidney's size beyond its
    /// hull this gives coordinates of 37; with the weights used here they stay below 8.
    #[inline(always)]
    fn extend(&self, x: &Point3, at: &mut Workspace) {
        at.weights.clear();
        for _ in 0..2 {
            let gap = self.gap(x, at);
            let Workspace { nodes, values, weights, .. } = &mut *at;
            let offset = |i: u32| self.nodes[i as usize] - x;
            if gap.norm() < EXACT {
                return;
            }
            if weights.is_empty() {
                weights.extend(values.iter().map(|value| value.max(0.0) / (value.max(0.0) + FADE)));
            }
            let total: f64 = weights.iter().sum();
            let (mut mean, mut moment) = (Vector3::zeros(), Matrix3::zeros());
            for (&i, &w) in nodes.iter().zip(&*weights) {
                mean += offset(i) * w;
            }
            mean /= total;
            for (&i, &w) in nodes.iter().zip(&*weights) {
                moment += (offset(i) - mean) * (offset(i) - mean).transpose() * w;
            }
            let Some(inverse) = moment.try_inverse() else { return };
            let missing = 1.0 - values.iter().sum::<f64>();
            let slope = inverse * (gap + mean * missing);
            for ((&node, weight), value) in nodes.iter().zip(&*weights).zip(&mut *values) {
                *value += weight * (missing / total - slope.dot(&(offset(node) - mean)));
            }
        }
    }
}

/// Grows a list to twice `length` if it is shorter than `length`.
#[inline(always)]
fn grow(list: &mut Vec<u32>, length: usize) {
    if list.len() < length {
        list.resize(2 * length, 0);
    }
}

impl<const N: usize> Spheres<N> {
    /// Builds spheres from origins, centres and tolerances.
    fn new(each: [&(Vector3, Vector3, f64); N]) -> Spheres<N> {
        Spheres {
            origin: [0, 1, 2].map(|axis| Lanes(each.map(|sphere| sphere.0[axis]))),
            centre: [0, 1, 2].map(|axis| Lanes(each.map(|sphere| sphere.1[axis]))),
            reach: Lanes(each.map(|sphere| sphere.2)),
        }
    }

    /// Returns for each sphere whether it contains the point: `|x - c|^2 <= R^2`, without the difference of
    /// two large squares.
    #[inline(always)]
    fn hold(&self, x: &Point3) -> [bool; N] {
        let mut beyond = [0.0; N];
        for lane in 0..N {
            let y = [0, 1, 2].map(|axis| x[axis] - self.origin[axis].0[lane]);
            let z = [0, 1, 2].map(|axis| y[axis] - self.centre[axis].0[lane]);
            beyond[lane] = y[0] * z[0] + y[1] * z[1] + y[2] * z[2] - self.reach.0[lane];
        }
        beyond.map(|beyond| beyond <= 0.0)
    }
}

impl Face {
    fn new(nodes: [u32; 3], [a, b, c]: [Point3; 3]) -> Face {
        // `orient3d` is positive on the side from which the corners appear clockwise.
        let normal = (c - a).cross(&(b - a));
        let square = normal.norm_squared();
        let dots = [(b - a).dot(&(c - a)), (c - b).dot(&(a - b)), (a - c).dot(&(b - c))];
        let sides = [(c - b).norm_squared(), (a - c).norm_squared(), (b - a).norm_squared()];
        // The share of corner 0 in the triangle is (|01|^2 cot 2 + |02|^2 cot 1) / 8, with a cotangent equal
        // to the dot product divided by |normal|.
        let shares = std::array::from_fn(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            (sides[k] * dots[k] + sides[j] * dots[j]) / (8.0 * square)
        });
        Face { nodes, normal, shares }
    }
}

/// The tetrahedra formed by eight faces with the origin, which is on their positive side.
struct Tetrahedra {
    normal: [Lanes; 3],
    shares: [Lanes; 3],
    /// Corners of the faces, relative to the origin.
    corners: [[Lanes; 3]; 3],
}

impl Tetrahedra {
    #[inline(always)]
    fn new() -> Tetrahedra {
        let zeros = [Lanes::all(0.0); 3];
        Tetrahedra { normal: zeros, shares: zeros, corners: [zeros; 3] }
    }

    #[inline(always)]
    fn set(&mut self, lane: usize, face: &Face, corners: [Vector3; 3]) {
        for i in 0..3 {
            self.normal[i].0[lane] = face.normal[i];
            self.shares[i].0[lane] = face.shares[i];
            for axis in 0..3 {
                self.corners[i][axis].0[lane] = corners[i][axis];
            }
        }
    }

    /// Returns three times the shares of the faces' corners in the volumes. The code goes lane by lane: the
    /// compiler scalarises sums and products of whole lanes, but vectorises a loop over lanes.
    #[inline(always)]
    fn shares(&self) -> [Lanes; 3] {
        let mut shares = [[0.0; LANES]; 3];
        for lane in 0..LANES {
            let of = |lanes: &[Lanes; 3]| [lanes[0].0[lane], lanes[1].0[lane], lanes[2].0[lane]];
            let corners = [of(&self.corners[0]), of(&self.corners[1]), of(&self.corners[2])];
            let of_lane = corner_shares(&of(&self.normal), &of(&self.shares), &corners);
            (shares[0][lane], shares[1][lane], shares[2][lane]) = (of_lane[0], of_lane[1], of_lane[2]);
        }
        shares.map(Lanes)
    }
}

/// Returns three times the shares of the corners of a face in the volume of the tetrahedron that the face
/// forms with the origin.
#[inline(always)]
fn corner_shares(normal: &[f64; 3], areas: &[f64; 3], [a, b, c]: &[[f64; 3]; 3]) -> [f64; 3] {
    let dot = |a: &[f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (aa, bb, cc) = (dot(a, a), dot(b, b), dot(c, c));
    let (ab, bc, ca) = (dot(a, b), dot(b, c), dot(c, a));
    // Products of the normals b x c, c x a and a x b: cofactors of the matrix of the products above.
    let (naa, nbb, ncc) = (bb * cc - bc * bc, cc * aa - ca * ca, aa * bb - ab * ab);
    let (nab, nbc, nca) = (bc * ca - ab * cc, ca * ab - bc * aa, ab * bc - ca * bb);
    // Heights of the circumcentre over the four faces, times the inward normals.
    let height = -dot(normal, a);
    let scale = 0.5 / height;
    let ha = (aa * naa + bb * nab + cc * nca) * scale;
    let hb = (aa * nab + bb * nbb + cc * nbc) * scale;
    let hc = (aa * nca + bb * nbc + cc * ncc) * scale;
    let top = height - (ha + hb + hc);
    // Division by eight times each product; one division serves all three.
    let each = 0.125 / (naa * nbb * ncc);
    let (ha, hb, hc) = (ha * (nbb * ncc * each), hb * (ncc * naa * each), hc * (naa * nbb * each));
    // Share of a in the triangle (0, a, b): |b|^2 (|a|^2 + a.b) - 2 (a.b)^2 over 8 |a x b|.
    let share = |p: f64, q: f64, pq: f64| q * (p + pq) - (pq + pq) * pq;
    [
        top * areas[0] + hb * share(aa, cc, ca) + hc * share(aa, bb, ab),
        top * areas[1] + hc * share(bb, aa, ab) + ha * share(bb, cc, bc),
        top * areas[2] + ha * share(cc, bb, bc) + hb * share(cc, aa, ca),
    ]
}
